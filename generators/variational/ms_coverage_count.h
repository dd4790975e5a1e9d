/** How often spheres cover voxels, and what |S xor U| would be with other ones. Private to variational. */
#ifndef MS_COVERAGE_COUNT_H
#define MS_COVERAGE_COUNT_H

#include <stdint.h>

#include "voxel/ms_grid.h"
#include "voxel/ms_raster.h"

/** Voxels are covered by a sphere that holds their centres. */
typedef struct ms_coverage_count {
    const ms_grid *grid; /* S; borrowed */
    uint16_t *covers;    /* spheres that cover each voxel */
    int64_t mismatch;    /* |S xor U| */
} ms_coverage_count;

/**
 * Counts the spheres over each voxel.
 *
 * @param[out] out  the caller frees it; empty on failure
 * @param      ball `count` spheres, in voxels; what lies beyond the grid does not count
 * @return MS_OK; MS_ERR_NOMEM: two bytes a voxel
 *
 * Cost: one pass over the spheres' voxels and one over the grid; all cores, the same numbers at
 * any number of threads.
 */
ms_status ms_coverage_count_open(ms_coverage_count *out, const ms_grid *grid, const ms_ball *ball, size_t count,
                                 ms_error *err);

/** By how many voxels |S xor U| would grow without this sphere, one of those counted. Cost: its voxels. */
int64_t ms_coverage_count_loss(const ms_coverage_count *o, const ms_ball *ball);

/** By how many voxels |S xor U| would shrink with one more sphere. Cost: its voxels. */
int64_t ms_coverage_count_gain(const ms_coverage_count *o, const ms_ball *ball);

/** Adds a sphere, or takes away one of those counted. */
void ms_coverage_count_add(ms_coverage_count *o, const ms_ball *ball);
void ms_coverage_count_remove(ms_coverage_count *o, const ms_ball *ball);

/** Takes the voxels whose centres a sphere holds out of the grid. */
void ms_coverage_count_clear(ms_grid *grid, const ms_ball *ball, size_t count);

void ms_coverage_count_close(ms_coverage_count *o);

#endif
