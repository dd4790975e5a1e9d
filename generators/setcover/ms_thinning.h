/** Topological thinning: the medial surface or the medial axis of a set of voxels. */
#ifndef MS_THINNING_H
#define MS_THINNING_H

#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/** Which voxels are never removed, once they appear. */
typedef enum ms_skeleton {
    MS_SKELETON_SURFACE, /* ends of surfaces: border voxels without an interior voxel at any face */
    MS_SKELETON_CURVE    /* ends of curves: voxels with just one of their 26 neighbours */
} ms_skeleton;

/**
 * Thins a set of voxels, layer by layer, until none can be removed: the result has as many
 * pieces (26-connected), cavities (6-connected) and tunnels as the set, and each of its voxels
 * is an end (ms_skeleton) or not simple.
 *
 * @param[in,out] inside n[0]*n[1]*n[2] voxels, x fastest, 1 inside and 0 outside, the outermost
 *                       layer all 0; on return 1 on the skeleton
 * @return MS_OK; MS_ERR_ARG if a voxel of the outermost layer is inside; MS_ERR_NOMEM, and then
 *         inside is of no more use
 *
 * Source: critical kernels, Yuan 2019, algorithm 1. Cost: O(voxels inside): each step looks at
 * the layer only that the step before has laid bare. All cores; the same result at any number
 * of threads. Memory: one byte a voxel, and some 16 for each voxel of the largest layer.
 */
ms_status ms_thinning(uint8_t *inside, const int n[3], ms_skeleton kind, ms_error *err);

MS_C_END

#endif
