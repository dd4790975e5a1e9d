/** The best weights of given grains, by a linear programme. Private to ms_population_choose. */
#ifndef MS_POPULATION_WEIGHTS_H
#define MS_POPULATION_WEIGHTS_H

#include "ms_population.h"

/** An error of a correlation counts as a distance of distributions this many times smaller: a little less than
 * ms_population_choice_mismatch has, as ranks within the few are not quite those within the population. */
#define MS_POPULATION_CORRELATION_SCALE 1.5

/** Weights of k grains of a population, and what another grain would be worth. */
typedef struct ms_population_weights {
    size_t k, n_descriptors, n_pairs;
    double mismatch; /* the largest Kolmogorov-Smirnov distance or scaled error of a correlation: the least there is */
    double *weight;  /* k, sum 1 */
    size_t *order;   /* n_descriptors x k: the grains by ascending value */
    double *short_of, *beyond; /* n_descriptors x k: prices of the bounds of each step of the distributions */
    double *pair;              /* n_pairs: of the correlations */
    double level;              /* of the sum of the weights */
    int *row, *column;         /* room for the programme */
    double *entry;
} ms_population_weights;

/** @return MS_OK; MS_ERR_NOMEM. @param[out] w empty on failure; the caller frees it */
ms_status ms_population_weights_init(ms_population_weights *w, const ms_population *p, size_t k, ms_error *err);

/**
 * Finds the weights of least mismatch. Its dual is what GLPK solves: k + 1 rows instead of some 2 k for each
 * descriptor. Called within ms_linear_program_apart, with GLPK's error hook set, as it calls that where it has no
 * memory.
 *
 * @param chosen w->k grains
 * @return nonzero if the simplex method came to its end; mismatch is 1 if not
 * Cost: about 1 ms for 20 grains and 5 descriptors.
 */
int ms_population_weights_solve(ms_population_weights *w, const ms_population *p, const size_t *chosen);

/**
 * What another grain would bring, by the prices of the last solution: how fast the mismatch falls with its weight, if
 * above 0.
 */
double ms_population_weights_gain(const ms_population_weights *w, const ms_population *p, const size_t *chosen,
                                  size_t grain);

void ms_population_weights_free(ms_population_weights *w);

#endif
