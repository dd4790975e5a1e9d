/** How many spheres each template of a scene gets: pure arithmetic on curves of error by number of spheres. */
#ifndef MS_ALLOCATE_H
#define MS_ALLOCATE_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/** One shape of a scene. Borrowed. */
typedef struct ms_share {
    uint64_t particles;  /* of this shape, at least 1; over all shapes below 2^53 spheres at the most */
    size_t most;         /* spheres of its largest template, at least 1 */
    const double *error; /* of its templates of 1 to `most` spheres, finite; may rise here and there */
} ms_share;

/** What an allocation comes to. */
typedef struct ms_allocation {
    uint64_t particles, spheres; /* in the whole scene */
    double error;                /* mean over all particles */
    double slack; /* no allocation is better by more: in mean error for a budget, in spheres for an error. 0, the best,
                     unless the search for it was given up as too long */
} ms_allocation;

/** Sums over a scene whose shape i has templates of n[i] spheres; slack is 0. */
MS_API ms_allocation ms_allocate_sum(const ms_share *share, const size_t *n, size_t count);

/**
 * What the least useful spheres of an allocation bring: of all ways to make one template smaller, the least that each
 * sphere of the scene given back adds to the sum of errors over the scene. 0 with one sphere each.
 */
MS_API double ms_allocate_gain(const ms_share *share, const size_t *n, size_t count);

/**
 * The least mean error for a number of spheres in the whole scene.
 *
 * First from one sphere each, always the step to a larger template, of any shape, that takes away most error for each
 * sphere of the scene, among those that the rest of the budget pays. A sphere more on all particles of a shape costs as
 * many spheres as there are particles and lessens the sum of errors by as many times its error: the gain of a step does
 * not depend on their number. While the steepest step of all can be paid, the steps are those along the lower convex
 * hulls of the curves in the order of their slopes, and the allocation is the best for the spheres that it takes. From
 * the first step on that cannot be paid the hulls bound what any allocation could reach; where that is not reached, the
 * best allocation on the curves as they are is searched for (ms_knapsack_improve).
 *
 * @param[out] n         spheres of each template, count values
 * @param[out] allocated what it comes to
 * @return MS_OK; MS_ERR_LIMIT if the budget is below one sphere each; MS_ERR_NOMEM
 *
 * Source: Fox 1966, Discrete optimization via marginal analysis (Management Science 13, 210).
 * Cost: O(shapes) for each step, and one pass over the rest of a curve for each of its steps; the search.
 */
MS_API ms_status ms_allocate_budget(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count,
                                    uint64_t budget, ms_error *err);

/**
 * The fewest spheres in the scene for a mean error: the same steps for budgets between what the hulls need at the least
 * and what their steps take; then the search.
 *
 * @return MS_OK; MS_ERR_LIMIT if the largest templates do not reach it (the message gives what they reach);
 *         MS_ERR_NOMEM
 */
MS_API ms_status ms_allocate_error(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count,
                                   double error, ms_error *err);

/**
 * The knee of a curve: the least number of spheres from which no larger template takes away as much as
 * `part` of the error that is left for each further sphere.
 *
 * @return 0 if there is none before the end of the curve
 */
MS_API size_t ms_allocate_knee(const ms_share *share, double part);

MS_C_END

#endif
