#include "ms_sieve_counts.h"

#include <math.h>

/* What one particle more (step 1) or less (-1) adds to the sum of squares. */
static double cost_of(double count, double wanted, double mass, int step)
{
    return mass * mass * (1 + 2 * step * (count - wanted));
}

void ms_sieve_counts_round(uint64_t *count, const double *share, const double *mass, size_t n, uint64_t total)
{
    double per_mass = 0; /* particles of all classes in a unit of mass */
    uint64_t sum = 0;
    for (size_t c = 0; c < n; c++) {
        per_mass += share[c] / mass[c];
    }
    const double all = (double)total / per_mass; /* the mass */
    for (size_t c = 0; c < n; c++) {
        count[c] = (uint64_t)round(all * share[c] / mass[c]);
        sum += count[c];
    }
    while (sum != total) {
        const int step = sum < total ? 1 : -1;
        size_t best = n;
        double least = HUGE_VAL;
        for (size_t c = 0; c < n; c++) {
            const double cost = cost_of((double)count[c], all * share[c] / mass[c], mass[c], step);
            if ((step > 0 || count[c] > 0) && cost < least) {
                best = c;
                least = cost;
            }
        }
        count[best] += (uint64_t)step;
        sum += (uint64_t)step;
    }
}

void ms_sieve_counts_take(uint64_t *taken, uint64_t *left, size_t n, uint64_t total)
{
    uint64_t all = 0, missing = total;
    for (size_t c = 0; c < n; c++) {
        all += left[c];
    }
    for (size_t c = 0; c < n; c++) {
        taken[c] = all > 0 ? total * left[c] / all : 0;
        missing -= taken[c];
    }
    for (; missing > 0; missing--) {
        size_t best = n;
        uint64_t largest = 0;
        for (size_t c = 0; c < n; c++) {
            const uint64_t remainder = total * left[c] % all;
            if (taken[c] == total * left[c] / all && remainder > largest) { /* has no more yet */
                best = c;
                largest = remainder;
            }
        }
        taken[best]++;
    }
    for (size_t c = 0; c < n; c++) {
        left[c] -= taken[c];
    }
}
