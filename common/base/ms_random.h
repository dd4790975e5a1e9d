/** Random numbers by GSL's MT19937. Private. */
#ifndef MS_RANDOM_H
#define MS_RANDOM_H

#include <gsl/gsl_rng.h>

/**
 * A generator for GSL's functions. What gsl_rng_alloc makes, too, but that one calls GSL's error handler where
 * there is no memory, and by default that ends the host.
 *
 * @return freed by ms_random_free; NULL without memory
 */
gsl_rng *ms_random_new(unsigned long seed);

void ms_random_free(gsl_rng *random);

#endif
