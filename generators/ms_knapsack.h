/** The multiple-choice knapsack: one of each kind, so that the sum of values is least within a limit of weight. */
#ifndef MS_KNAPSACK_H
#define MS_KNAPSACK_H

#include <stddef.h>

#include "base/ms_error.h"

/** What can be chosen of one kind. Borrowed. */
typedef struct ms_kind {
    size_t count;                 /* at least 1 */
    const double *value, *weight; /* count values each, 0 or more */
} ms_kind;

/**
 * Improves a choice until it is the best one.
 *
 * Kind by kind, all choices that another one does not beat in both value and weight are kept, but for those that cannot
 * become better than the choice that is there: at a price for weight, each kind not yet chosen adds at least its least
 * value + price * weight (Lagrange). The nearer the choice is to the best one and the better the price, the
 * fewer are left.
 *
 * @param[in,out] choice index in each kind; its weight is within the limit
 * @param[out]    proven nonzero: no choice is better by `step` or more; zero: the search was given up as too long
 * @param         price  value of a unit of weight, 0 or more: any is right, a good one is quick
 * @param         step   improvements below are not sought; above 0
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: Kellerer, Pferschy & Pisinger 2004, Knapsack Problems, chapter 11. Cost: at most some seconds and 100 MB.
 */
ms_status ms_knapsack_improve(size_t *choice, int *proven, const ms_kind *kind, size_t count, double limit,
                              double price, double step, ms_error *err);

#endif
