/** Where variational starts. Private to it. */
#ifndef MS_VARIATIONAL_START_H
#define MS_VARIATIONAL_START_H

#include "ms_coarse_view.h"

/**
 * How much coarser than the target's grid the start and the fit may be for n spheres: they follow the size of spheres
 * and of the shape.
 *
 * @param[out] cover voxels of the grid to one of the cover, along an axis: 1 to 4
 * @param[out] field to one step of the signed distances: 1 to 3, without a closed mesh 2
 *
 * Cost: one pass over the voxels.
 */
void ms_variational_start_steps(int *cover, int *field, const ms_target *target, size_t n);

/**
 * Covers voxels of a coarse view greedily (ms_cover) by the inscribed spheres about the shape's ridge: the
 * coarse voxels whose sphere no neighbour's sphere contains.
 *
 * @param[out] ball   in voxels of the target's grid, the first the most useful; room for `wanted`
 * @param[out] count  how many: `wanted`, or fewer if no other one covers anything
 * @param      view   what is to be covered stands in its grid: all of the target, or part of it
 * @param      least  no radius below this, in voxels of the target
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT
 *
 * Source: Yuan 2019, algorithm 2. Cost: one pass over the coarse voxels with 26 neighbours each, and
 * ms_cover.
 */
ms_status ms_variational_start_cover(ms_ball *ball, size_t *count, const ms_coarse_view *view, size_t wanted,
                                     double least, ms_error *err);

#endif
