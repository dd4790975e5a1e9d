/** How often voxels are covered: what the mismatch would be without each sphere. Private to variational. */
#ifndef MS_OVERLAP_H
#define MS_OVERLAP_H

#include <stdint.h>

#include "ms_grid.h"
#include "ms_raster.h"

/**
 * Counts voxels by their centres.
 *
 * @param[out] loss     by how many voxels |S xor U| grows if only this sphere is removed; `count`
 *                      values, below 0 where it shrinks; may be NULL
 * @param[out] mismatch |S xor U|
 * @return MS_OK; MS_ERR_NOMEM: two bytes a voxel
 *
 * Spheres beyond the grid count for nothing there. Cost: two passes over the spheres' voxels and one
 * over the grid; all cores, the same numbers at any number of threads.
 */
ms_status overlap_losses(int64_t *loss, int64_t *mismatch, const ms_grid *grid, const ms_ball *ball, size_t count,
                         ms_error *err);

/** Takes the voxels whose centres a sphere holds out of the grid. */
void overlap_clear(ms_grid *grid, const ms_ball *ball, size_t count);

#endif
