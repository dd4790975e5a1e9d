/** Fuzzy c-means and k-means on points of four coordinates. */
#ifndef MS_CLUSTER_H
#define MS_CLUSTER_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/** Opaque: the points. */
typedef struct ms_cluster ms_cluster;

/** Where the centres are to begin with. */
typedef enum ms_cluster_spread {
    MS_CLUSTER_FAR,   /* points, each with a chance that grows with its squared distance from those before */
    MS_CLUSTER_RANDOM /* points, each with the same chance */
} ms_cluster_spread;

typedef struct ms_cluster_rule {
    double fuzzifier;  /* m of eq. 4, above 1; 1: k-means, eq. 3 */
    double tolerance;  /* ends when the objective falls by no more than this part of itself */
    size_t iterations; /* ends after as many; at least 1 */
} ms_cluster_rule;

/** What a run came to. */
typedef struct ms_cluster_result {
    double objective; /* J, of the centres before the last update */
    size_t iterations;
} ms_cluster_result;

/**
 * @param[out] out   freed by ms_cluster_free; NULL on failure
 * @param      point `count` of them; copied
 * @return MS_OK; MS_ERR_ARG without a point or with one that is not finite; MS_ERR_NOMEM
 */
ms_status ms_cluster_build(ms_cluster **out, const double (*point)[4], size_t count, ms_error *err);

/**
 * Adds centres to those there are.
 *
 * @param[in,out] centre room for `wanted`; the first `given` are kept. Points equal to a centre are
 *                       taken only where there are no others
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: Arthur & Vassilvitskii, k-means++ (2007); MT19937 of GSL. Cost: O(points * (wanted - given)).
 */
ms_status ms_cluster_start(double (*centre)[4], size_t given, size_t wanted, const ms_cluster *cluster,
                           ms_cluster_spread spread, uint64_t seed, ms_error *err);

/**
 * Moves the centres to where the objective has a minimum: memberships from the centres, centres from the
 * memberships, and again. The objective never rises.
 *
 * A centre to which no point belongs moves to the point that is farthest from all centres. Where centres
 * coincide, one of them is tried there, too, and stays if the objective becomes lower.
 *
 * @param[in,out] centre  `count` of them
 * @param[out]    result  may be NULL
 * @return MS_OK; MS_ERR_ARG without a centre or for a fuzzifier below 1; MS_ERR_NOMEM
 *
 * Source: Bezdek, Pattern Recognition with Fuzzy Objective Function Algorithms (1981); MacQueen (1967),
 * Lloyd (1982). Cost: O(points * count) per iteration, all cores; the same bits at any number of threads.
 */
ms_status ms_cluster_run(ms_cluster_result *result, double (*centre)[4], size_t count, const ms_cluster *cluster,
                         const ms_cluster_rule *rule, ms_error *err);

/**
 * How much each point belongs to each centre: u of eq. 4; for fuzzifier 1 the nearest centre has all.
 *
 * @param[out] u [point][centre], each row sums to 1
 */
ms_status ms_cluster_memberships(double *u, const double (*centre)[4], size_t count, const ms_cluster *cluster,
                                 double fuzzifier, ms_error *err);

void ms_cluster_free(ms_cluster *cluster);

MS_C_END

#endif
