#include "ms_random.h"

#include <stdlib.h>

gsl_rng *ms_random_new(unsigned long seed)
{
    gsl_rng *random = malloc(sizeof *random);
    void *state = malloc(gsl_rng_mt19937->size);
    if (!random || !state) {
        free(random);
        free(state);
        return NULL;
    }
    *random = (gsl_rng){.type = gsl_rng_mt19937, .state = state};
    gsl_rng_set(random, seed);
    return random;
}

void ms_random_free(gsl_rng *random)
{
    if (random) {
        free(random->state);
        free(random);
    }
}
