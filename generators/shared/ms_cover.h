/** Greedy set cover: which balls, one after the other, cover most of a set of voxels. */
#ifndef MS_COVER_H
#define MS_COVER_H

#include <stddef.h>

#include "voxel/ms_grid.h"
#include "voxel/ms_raster.h"

MS_C_BEGIN

/** Opaque: the voxels not yet covered, one bit each, and what each ball would cover of them. */
typedef struct ms_cover ms_cover;

/** Which candidate may be next. */
typedef enum ms_cover_rule {
    MS_COVER_ANY,       /* the one that covers most */
    MS_COVER_CONNECTED, /* of those that overlap one taken before, so that every prefix is one piece */
    MS_COVER_ADMITTED,  /* any of those that were admitted (ms_cover_admit); large ones are estimated from some of their
                           rows before they are counted, so that another one may have been a few percent better */
    MS_COVER_GROUPED    /* any, but candidates whose centres lie within a sixteenth of their radius are looked at only
                           when the largest of them is the best, or when gains have fallen to an eighth of such a
                           ball; large ones are estimated from some of their rows before they are counted: nearly the
                           same choice at much less cost */
} ms_cover_rule;

/**
 * Starts with nothing covered. A candidate covers the voxels inside the shape whose centres it contains
 * (on the surface counts, but for rounding: ms_raster's rule MS_VOXEL_CENTRE).
 *
 * @param[out] out       freed by ms_cover_free; NULL on failure
 * @param      grid      the target; read here only
 * @param      candidate `count` balls, in voxels; borrowed until ms_cover_free
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT for 2^32-1 candidates or more
 *
 * Cost: one pass over the grid, all cores; 48 bytes per candidate, 6.5 per voxel of the grid at most.
 */
ms_status ms_cover_build(ms_cover **out, const ms_grid *grid, const ms_ball *candidate, size_t count,
                         ms_cover_rule rule, ms_error *err);

/**
 * Takes the candidate that covers the most voxels not yet covered: of equals the one of larger
 * radius, then the earlier one. What it covers is covered from then on.
 *
 * Gains only fall, so that a stale count is a bound: only candidates whose bound beats the
 * best exact count are counted again (lazy evaluation; Minoux 1978). The choice is exactly
 * the greedy one (Yuan 2019, algorithm 2; but for MS_COVER_GROUPED). Cost: a count takes one pass over the rows of
 * the ball that have anything left, 64 voxels at a time; each candidate is counted at least once before the
 * choice comes down to its size. All cores: the best bounds are counted several at once; the same at any number of
 * them.
 *
 * @param[out] which index of the candidate
 * @return how many voxels it covers that were not covered; 0: no candidate covers any, and
 *         nothing was taken
 */
size_t ms_cover_next(size_t *which, ms_cover *cover);

/** The candidate that ms_cover_next would take, without taking it. @return as ms_cover_next */
size_t ms_cover_best(size_t *which, ms_cover *cover);

/** A candidate, which is as it shall be from now on, may be chosen (MS_COVER_ADMITTED); at most once each. */
void ms_cover_admit(ms_cover *cover, size_t which);

/** How many voxels not yet covered a ball covers, whether it is a candidate or not. */
size_t ms_cover_count(const ms_cover *cover, const ms_ball *ball);

/** Covers what a ball covers, whether it is a candidate or not (but for MS_COVER_CONNECTED). */
void ms_cover_take(ms_cover *cover, const ms_ball *ball);

void ms_cover_free(ms_cover *cover);

MS_C_END

#endif
