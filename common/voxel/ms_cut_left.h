/** What of cut cells (ms_cut_cells.h) no ball covers yet. */
#ifndef MS_CUT_LEFT_H
#define MS_CUT_LEFT_H

#include <stdint.h>

#include "ms_cut_cells.h"

MS_C_BEGIN

/** Which are left: of the cells, and of the whole voxels. A ball covers those whose centroids it holds; on its surface
 * counts. */
typedef struct ms_cut_left {
    const ms_cut_cells *cells;
    uint8_t *cell, *voxel; /* of each: 1 if it is left */
    uint32_t *in_block;    /* cells left of each block */
    uint16_t *in_row;      /* whole voxels left of each row (., j, k) */
} ms_cut_left;

/** What balls have covered last, in turn: the t-th cell is cell[t % MS_CUT_TAKEN]. */
enum { MS_CUT_TAKEN = 1 << 15 };
typedef struct ms_cut_taken {
    ms_cut_cell cell[MS_CUT_TAKEN];
    uint64_t count; /* of all that were covered */
} ms_cut_taken;

/** All of the cells, which are borrowed. @return NULL without memory; else ms_cut_left_free frees it. Memory: a byte a
 * cell and a voxel. */
ms_cut_left *ms_cut_left_build(const ms_cut_cells *cells);
void ms_cut_left_free(ms_cut_left *left);

/**
 * The weight of what is left and a ball holds.
 *
 * @param ball in voxels
 * Cost: a test for each block in the ball's box, for each cell of those that its surface may pass through, and for each
 * row of voxels; 8 voxels of a row at a time.
 */
int64_t ms_cut_left_count(const ms_cut_left *left, const ms_ball *ball);

/** The same, and covers it. @param[in,out] taken what it covers is put there, whole voxels as cells; may be NULL */
int64_t ms_cut_left_cover(ms_cut_left *left, const ms_ball *ball, ms_cut_taken *taken);

/** The weight of those taken from the `from`-th on, at most MS_CUT_TAKEN, that a ball holds: by so much its count has
 * fallen since. Cost: a test for each. */
int64_t ms_cut_left_fallen(const ms_cut_taken *taken, uint64_t from, const ms_ball *ball);

MS_C_END

#endif
