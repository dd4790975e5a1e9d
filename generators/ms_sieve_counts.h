/** Whole numbers of particles: arithmetic alone. */
#ifndef MS_SIEVE_COUNTS_H
#define MS_SIEVE_COUNTS_H

#include <stddef.h>
#include <stdint.h>

/**
 * How many particles of each class make up so many whose mass goes by shares: whole numbers of that sum with the least
 * sum of squares of (mass of a class - that of as many particles by the very shares).
 *
 * Without the sum each number is the nearest one; from there it is reached by steps of one particle, always the one
 * that costs least, which for a sum of convex functions is the best of all (Fox 1966, as ms_allocate.h).
 *
 * @param[out] count n of them
 * @param      share of the mass, above 0
 * @param      mass  of a particle, above 0
 * @param      total at most 1e9
 */
void ms_sieve_counts_round(uint64_t *count, const double *share, const double *mass, size_t n, uint64_t total);

/**
 * Takes so many particles out of the classes, from each in proportion to what is left in it, and no more than that: the
 * whole parts, and one more of those with the largest remainders (Hamilton's method).
 *
 * @param[out]    taken of each class
 * @param[in,out] left  in each class; at most 1e9 in all
 * @param         total at most what is left
 */
void ms_sieve_counts_take(uint64_t *taken, uint64_t *left, size_t n, uint64_t total);

#endif
