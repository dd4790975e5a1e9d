/** Mean and spread of values, and how well their mean is known. */
#ifndef MS_COMPARE_SPREAD_H
#define MS_COMPARE_SPREAD_H

#include <stddef.h>

#include "base/ms_error.h"

/** Of values; all NAN if there are none. */
typedef struct ms_compare_spread {
    size_t count;
    double mean, lower, median, upper; /* lower, upper: quartiles */
} ms_compare_spread;

/**
 * Quartiles are interpolated between order statistics: at (n - 1) p from the least (type 7 of Hyndman and Fan 1996).
 *
 * @param[in,out] value n, is sorted
 */
ms_compare_spread ms_compare_spread_of(double *value, size_t n);

enum { MS_COMPARE_SPREAD_LEAST = 5, MS_COMPARE_SPREAD_SAMPLES = 1000 };

/**
 * The interval of 95 % of a mean by bootstrap (Efron 1979, percentiles): of MS_COMPARE_SPREAD_SAMPLES samples drawn
 * with replacement, by a seed of its own, so that the same values give the same bits.
 *
 * @param[out] low, high NAN for fewer than MS_COMPARE_SPREAD_LEAST values, from which it would come out too narrow
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(samples x n).
 */
ms_status ms_compare_spread_interval(double *low, double *high, const double *value, size_t n, ms_error *err);

#endif
