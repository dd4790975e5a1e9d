/** D of a clump whose spheres may reach far beyond the grid. Private to variational. */
#ifndef MS_DICE_H
#define MS_DICE_H

#include "voxel/ms_raster.h"

/**
 * D = 1 - 2 |S and U| / (|S| + |U|), MSS eq. 27: what lies in both is counted by voxels, what spheres hold is exact.
 *
 * @param[out] dice   1 for no spheres
 * @param      ball   in voxels of the grid
 * @param      voxels of the grid, inside
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: ms_coverage_count_open and ms_union_measure.
 */
ms_status ms_dice_compute(double *dice, const ms_grid *grid, size_t voxels, const ms_ball *ball, size_t count,
                          ms_error *err);

/** |U|, exact, in voxels. @return, cost: as ms_union_measure */
ms_status ms_dice_union_volume(double *volume, const ms_ball *ball, size_t count, ms_error *err);

#endif
