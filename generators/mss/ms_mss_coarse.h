/** A target seen on a lattice of twice its voxel, about the same centre. Private to ms_mss. */
#ifndef MS_MSS_COARSE_H
#define MS_MSS_COARSE_H

#include "voxel/ms_raster.h"
#include "voxel/ms_target.h"

/* Voxels of the target along a side of a coarse one. */
enum { MS_MSS_COARSE = 2 };

typedef struct ms_mss_coarse {
    ms_target target; /* grid and distance are its own, all else is borrowed */
    double shift[3];  /* a place on the target's lattice is MS_MSS_COARSE times that here, and this; whole halves */
} ms_mss_coarse;

/**
 * A coarse voxel is inside if more than half of it is. Where the target's extent is odd, coarse voxels lie centre on
 * centre and take half of the voxels at their sides, so that a mirror-symmetric target stays one.
 *
 * @param[out] coarse freed by ms_mss_coarse_free; empty on failure
 * @param      target borrowed until then
 * @return MS_OK; as ms_grid_alloc, ms_distance
 * Cost: one pass over the target; 5 bytes for each coarse voxel; all cores.
 */
ms_status ms_mss_coarse_make(ms_mss_coarse *coarse, const ms_target *target, ms_error *err);

/** A sphere in voxels of the target, from one in coarse voxels; and back. Exact but where numbers end. */
ms_ball ms_mss_coarse_target_ball(const ms_mss_coarse *coarse, const ms_ball *ball);
ms_ball ms_mss_coarse_ball(const ms_mss_coarse *coarse, const ms_ball *ball);

void ms_mss_coarse_free(ms_mss_coarse *coarse);

#endif
