/** A set of voxels as bits, and what balls hold of it. Private to ms_cover. */
#ifndef MS_COVER_BITS_H
#define MS_COVER_BITS_H

#include <stddef.h>
#include <stdint.h>

#include "voxel/ms_grid.h"

MS_C_BEGIN

/** 64 voxels of a row in a word. */
typedef struct ms_cover_bits {
    int n[3];
    size_t words;           /* per row */
    uint64_t *left;         /* rows along x; one word more, so that a window may overhang */
    size_t columns, groups; /* tiles of 8 voxels along a row, and groups of 64 rows in a plane */
    uint64_t *tiles;        /* by plane, column and group: of which rows the tile has anything left */
} ms_cover_bits;

/** What a row of a ball holds of the set, within one word. */
typedef struct ms_cover_run {
    size_t word;
    uint64_t bits;
} ms_cover_run;

/** Where the runs of a ball are put; those for which there is no room are lost. */
typedef struct ms_cover_room {
    ms_cover_run *found; /* `room` of them, and one */
    size_t room;
} ms_cover_room;

/** The voxels inside a grid. @return 0 without memory; else ms_cover_bits_free frees it. Cost: one pass, all cores. */
int ms_cover_bits_alloc(ms_cover_bits *set, const ms_grid *grid);
void ms_cover_bits_free(ms_cover_bits *set);

/**
 * Counts the voxels of the set whose centres a ball holds, by the same operations, to the bit, as ms_raster by the
 * rule CENTRE.
 *
 * @param[out]    n_found how many runs they are
 * @param[in,out] room    where the runs are put
 * Cost: a root for each plane, and for each row that has anything left as near as the ball reaches in its plane.
 */
size_t ms_cover_bits_walk(const ms_cover_bits *set, ms_cover_room *room, size_t *n_found, const ms_ball *ball);

/** The same in every 1st, 2nd, 4th or 8th row (`step`) of such planes only: of about 1/step^2 of them. */
size_t ms_cover_bits_sample(const ms_cover_bits *set, const ms_ball *ball, int step);

/** Takes what a ball holds out of the set. */
void ms_cover_bits_remove(ms_cover_bits *set, const ms_ball *ball);

/** Counts what is left of n runs, and drops those of which nothing is. */
size_t ms_cover_bits_recount(const ms_cover_bits *set, ms_cover_run *run, uint32_t *n);

/** Takes runs out of the set. */
void ms_cover_bits_take(ms_cover_bits *set, const ms_cover_run *run, uint32_t n);

MS_C_END

#endif
