/* How often the best allocation over a scene is found and proven, and how long that takes. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

#include "ms_allocate.h"

enum { MOST = 100, SCENES = 5, SPHERES_EACH = 20 };

static uint32_t draw(uint32_t *state, uint32_t below)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 16) % below;
}

/* Curves that fall by a power from 0.4 to 0.8 of the number of spheres, with a noise of 2 %. */
static void make_scene(ms_share *share, double *error, size_t count, uint32_t seed)
{
    for (size_t s = 0; s < count; s++, error += MOST) {
        const double first = 0.1 + 0.0003 * draw(&seed, 1000), power = 0.4 + 0.0004 * draw(&seed, 1000);
        share[s] = (ms_share){1 + draw(&seed, 10000), MOST, error};
        for (int n = 0; n < MOST; n++) {
            error[n] = first * pow(n + 1, -power) * (1 + 0.00002 * draw(&seed, 1000));
        }
    }
}

static int measure(size_t count, int by_budget)
{
    ms_share *share = malloc(count * sizeof *share);
    double *error = malloc(count * MOST * sizeof *error), longest = 0, slack = 0;
    size_t *n = malloc(count * sizeof *n);
    int best = 0, failed = !share || !error || !n;
    for (uint32_t seed = 1; seed <= SCENES && !failed; seed++) {
        ms_allocation a;
        make_scene(share, error, count, seed);
        for (size_t s = 0; s < count; s++) {
            n[s] = SPHERES_EACH;
        }
        const ms_allocation even = ms_allocate_sum(share, n, count);
        const double start = omp_get_wtime();
        failed = (by_budget ? ms_allocate_budget(n, &a, share, count, even.spheres, NULL)
                            : ms_allocate_error(n, &a, share, count, even.error, NULL)) != MS_OK;
        longest = fmax(longest, omp_get_wtime() - start);
        slack = fmax(slack, a.slack / (by_budget ? a.error : (double)a.spheres));
        best += a.slack == 0;
    }
    printf("%4zu shapes by %-6s  best in %d of %d, else within %.1e, longest %.3f s\n", count,
           by_budget ? "budget" : "error", best, SCENES, slack, longest);
    free(share);
    free(error);
    free(n);
    return failed;
}

int main(void)
{
    const size_t counts[] = {2, 5, 10, 20, 50, 100, 300};
    int failed = 0;
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        failed |= measure(counts[c], 1) | measure(counts[c], 0);
    }
    return failed;
}
