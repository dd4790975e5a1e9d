#include "ms_compare_spread.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

#include "base/ms_random.h"

ms_compare_spread ms_compare_spread_of(double *value, size_t n)
{
    if (n == 0) {
        return (ms_compare_spread){0, (double)NAN, (double)NAN, (double)NAN, (double)NAN};
    }
    gsl_sort(value, 1, n);
    return (ms_compare_spread){n, gsl_stats_mean(value, 1, n), gsl_stats_quantile_from_sorted_data(value, 1, n, 0.25),
                               gsl_stats_quantile_from_sorted_data(value, 1, n, 0.5),
                               gsl_stats_quantile_from_sorted_data(value, 1, n, 0.75)};
}

ms_status ms_compare_spread_interval(double *low, double *high, const double *value, size_t n, ms_error *err)
{
    double mean[MS_COMPARE_SPREAD_SAMPLES];
    *low = *high = (double)NAN;
    if (n < MS_COMPARE_SPREAD_LEAST) {
        return MS_OK;
    }
    gsl_rng *random = ms_random_new(1);
    if (!random) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to draw %zu values", n);
    }
    for (int s = 0; s < MS_COMPARE_SPREAD_SAMPLES; s++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++) {
            sum += value[gsl_rng_uniform_int(random, n)];
        }
        mean[s] = sum / (double)n;
    }
    ms_random_free(random);
    gsl_sort(mean, 1, MS_COMPARE_SPREAD_SAMPLES);
    *low = gsl_stats_quantile_from_sorted_data(mean, 1, MS_COMPARE_SPREAD_SAMPLES, 0.025);
    *high = gsl_stats_quantile_from_sorted_data(mean, 1, MS_COMPARE_SPREAD_SAMPLES, 0.975);
    return MS_OK;
}
