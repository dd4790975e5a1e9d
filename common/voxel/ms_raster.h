/** The union of spheres on a grid: which voxels it covers, and which sphere covers each first. */
#ifndef MS_RASTER_H
#define MS_RASTER_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_sphere.h"
#include "ms_tally.h"
#include "voxel/ms_grid.h"
#include "voxel/ms_voxelize.h"

MS_C_BEGIN

/* First-cover index of a voxel that no sphere covers. */
#define MS_RASTER_NONE UINT16_MAX

/* Indices are 16 bits wide, and the last says "none". */
enum { MS_RASTER_MAX_BALLS = UINT16_MAX - 1 };

/** Of a plane of voxels those that the balls so far cover in part, hashed. */
typedef struct ms_raster_partial {
    struct ms_raster_slot *slot;
    uint32_t used, room;
} ms_raster_partial;

/**
 * Union of spheres on a grid. The first-cover index makes every prefix of the spheres a
 * union too: prefix k covers the voxels with first < k.
 */
typedef struct ms_raster {
    const ms_grid *grid; /* borrowed: the target */
    ms_voxel_rule rule;
    uint16_t *first;  /* one per voxel of the grid */
    uint64_t *vacant; /* of each row along x, 64 voxels in a word: those that no ball covers */
    size_t n_balls, capacity;
    ms_ball *ball;
    ms_raster_partial *partial; /* one per plane across z, by the rule HALF */
    struct ms_cut_left *left;   /* of the cut cells of the grid (ms_cut_left.h); NULL without them */
    uint8_t *buried;            /* one per ball: 1 if it lies within an earlier one */
    ms_tally *tally;            /* one per ball: sums over the voxels that it is the first to cover */
    int lo[3], hi[3]; /* box lo <= (i,j,k) < hi of the voxels that the last ms_raster_add covered; empty: lo = hi */
} ms_raster;

/**
 * Starts with nothing covered.
 *
 * @param[out] raster the caller frees it; empty on failure
 * @param      grid   the target; borrowed until ms_raster_free
 * @return MS_OK; MS_ERR_NOMEM. Two bytes and a bit a voxel, and by the rule HALF some 24 for each that a ball's
 *         surface passes through and that is not covered.
 */
MS_API ms_status ms_raster_alloc(ms_raster *raster, const ms_grid *grid, ms_voxel_rule rule, ms_error *err);

/**
 * Adds spheres, in order. By the rule MS_VOXEL_HALF a voxel is covered once more than half
 * of its 4x4x4 sample points lie in the union of the spheres so far (MSS eq. 5 for the
 * union; just half of them, if its centre does too), by MS_VOXEL_CENTRE once its centre does.
 *
 * Parts of spheres beyond the grid are not counted: use a grid that holds them
 * (ms_grid_enlarge).
 *
 * After a failure the raster is of no more use but to be freed.
 *
 * @return MS_OK; MS_ERR_ARG for a radius or place that is not finite or a radius below 0;
 *         MS_ERR_LIMIT above MS_RASTER_MAX_BALLS; MS_ERR_NOMEM
 * Cost: O(voxels in the spheres' boxes); all cores, the same bits at any number of threads.
 */
MS_API ms_status ms_raster_add(ms_raster *raster, const ms_ball *balls, size_t count, ms_error *err);

MS_API void ms_raster_free(ms_raster *raster);

/** The sums over the union of spheres. @return, cost: as ms_raster_alloc and ms_raster_add */
MS_API ms_status ms_raster_union(ms_tally *sum, const ms_grid *grid, ms_voxel_rule rule, const ms_ball *balls,
                                 size_t count, ms_error *err);

MS_C_END

#endif
