/** Where variational starts. Private to it. */
#ifndef MS_VARIATIONAL_START_H
#define MS_VARIATIONAL_START_H

#include "voxel/ms_raster.h"
#include "voxel/ms_target.h"

/**
 * Every step-th voxel of a target: voxel i of the copy lies on voxel i * step.
 *
 * @param[out] coarse the caller frees it; empty on failure
 */
ms_status ms_variational_start_coarsen(ms_grid *coarse, const ms_target *target, int step, ms_error *err);

/** A sphere in voxels of the copy. */
ms_ball ms_variational_start_to_coarse(const ms_ball *ball, int step);

/**
 * Covers voxels of a coarse copy greedily (ms_cover) by the inscribed spheres about the shape's ridge: the
 * coarse voxels whose sphere no neighbour's sphere contains.
 *
 * @param[out] ball   in voxels of the target's grid, the first the most useful; room for `wanted`
 * @param[out] count  how many: `wanted`, or fewer if no other one covers anything
 * @param      e      distances as the target's, or less where spheres have to be smaller
 * @param      coarse what is to be covered: a copy of the target, or part of it
 * @param      least  no radius below this, in voxels of the target
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT
 *
 * Source: Yuan 2019, algorithm 2. Cost: one pass over the coarse voxels with 26 neighbours each, and
 * ms_cover.
 */
ms_status ms_variational_start_cover(ms_ball *ball, size_t *count, const ms_target *target, const float *e,
                                     const ms_grid *coarse, int step, size_t wanted, double least, ms_error *err);

#endif
