/** Is a choice fitted to chance? */
#ifndef MS_POPULATION_SPLIT_H
#define MS_POPULATION_SPLIT_H

#include <stdint.h>

#include "ms_population.h"

/** How well a choice from one half of the grains stands for the other. */
typedef struct ms_population_split {
    double choice; /* largest Kolmogorov-Smirnov distance of the choice from one half to the other half */
    double halves; /* of the half that was chosen from to the other */
} ms_population_split;

/**
 * Means over splits at random: chosen from one half, quickly, and judged on the other. A choice that is much
 * farther from the other half than its own half is has been fitted to chance.
 *
 * @param splits how many
 * @return as ms_population_choose; MS_ERR_ARG if the halves have fewer than k grains
 */
ms_status ms_population_split_of(ms_population_split *out, const ms_population *p, size_t k, size_t splits,
                                 double share, uint64_t seed, ms_error *err);

#endif
