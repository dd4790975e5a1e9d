/** How far a sample with weights is from a population. */
#ifndef MS_POPULATION_DISTANCE_H
#define MS_POPULATION_DISTANCE_H

#include "ms_population.h"

/** Of a sample from a population. */
typedef struct ms_population_distance {
    double ks[MS_POPULATION_DESCRIPTORS]; /* Kolmogorov-Smirnov: the largest difference of the distributions */
    double largest;                       /* of these */
    double correlation;                   /* largest difference of Spearman's correlations of two descriptors */
} ms_population_distance;

/**
 * @param value  k x n_descriptors of the sample, finite
 * @param weight k, none below 0; counted over their sum
 * @return MS_OK; MS_ERR_NOMEM. Cost: O((n + k) log(n + k)) for each descriptor.
 */
ms_status ms_population_distance_of(ms_population_distance *out, const ms_population *p, const double *value,
                                    const double *weight, size_t k, ms_error *err);

/**
 * The energy distance of Szekely and Rizzo (2013), 2 E|X - Y| - E|X - X'| - E|Y - Y'|: 0 only if the joint
 * distributions are one. Descriptors are over their standard deviations in the population; one without any is passed
 * over.
 *
 * @param value, weight as above
 * @return MS_OK; MS_ERR_NOMEM. Cost: O((n + k)^2), by all threads.
 */
ms_status ms_population_energy(double *out, const ms_population *p, const double *value, const double *weight, size_t k,
                               ms_error *err);

/**
 * What chance alone does: the mean over samples of n grains, drawn with replacement from the population (bootstrap),
 * of their distances from it.
 *
 * @param samples how many
 * @return MS_OK; MS_ERR_NOMEM. Cost: that of `samples` distances.
 */
ms_status ms_population_noise(ms_population_distance *out, const ms_population *p, size_t samples, unsigned long seed,
                              ms_error *err);

#endif
