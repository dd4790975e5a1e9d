/** Few grains that stand for a population. */
#ifndef MS_POPULATION_CHOOSE_H
#define MS_POPULATION_CHOOSE_H

#include <stdint.h>

#include "ms_population_distance.h"

enum { MS_POPULATION_MAX_CHOSEN = 500 };

/** Grains of a population and their weights. */
typedef struct ms_population_choice {
    size_t k;
    size_t *grain;   /* k, ascending */
    double *weight;  /* k, none below 0, sum 1; in the sense of the population's shares */
    double mismatch; /* ms_population_choice_mismatch of its distance */
} ms_population_choice;

/** The largest Kolmogorov-Smirnov distance, or half the error of a correlation if that is larger: correlations span 2
 * and distributions 1. */
double ms_population_choice_mismatch(const ms_population_distance *distance);

/**
 * Chooses k grains and weights of small mismatch: grains by exchange, those tried first that the prices of the linear
 * programme of the weights say to bring most, for those of least weight; where no exchange helps, two grains are drawn
 * anew and the search goes on from there, back to the best if nothing comes of it.
 * The programme takes ranks within the population; what is best is judged by those within the choice.
 *
 * @param[out] c     the caller frees it; empty on failure
 * @param      k     from 1 to n and to MS_POPULATION_MAX_CHOSEN
 * @param      share of the full search: 1, or less for a quick one
 * @return MS_OK; MS_ERR_ARG for another k; MS_ERR_LIMIT if the simplex method finds no weights; MS_ERR_NOMEM.
 * Cost: about 6 s for 20 grains and 5 descriptors, much the same for others: the more grains, the fewer exchanges are
 * tried.
 */
ms_status ms_population_choose(ms_population_choice *c, const ms_population *p, size_t k, double share, uint64_t seed,
                               ms_error *err);

void ms_population_choice_free(ms_population_choice *c);

#endif
