#include "ms_crofton.h"

#include <math.h>
#include <stdlib.h>

enum { DIRECTIONS = 13 };

/* One of each pair of opposite directions. */
static const int STEP[DIRECTIONS][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {-1, 1, 0},
                                        {1, 0, 1},  {-1, 0, 1}, {0, 1, 1},  {0, -1, 1}, {1, 1, 1},
                                        {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

/* The part of the sphere nearest to a direction or its opposite, by the number of axes it steps along. */
static const double WEIGHT[4] = {0, 0.0915557824095, 0.0739612557522, 0.0703912795647};

/* In how many places two rows differ. */
static int count_steps(const uint8_t *restrict row, const uint8_t *restrict other, int n)
{
    int count = 0;
    for (int i = 0; i < n; i++) {
        count += row[i] ^ other[i];
    }
    return count;
}

double ms_crofton_area(const ms_grid *grid)
{
    int64_t steps[DIRECTIONS] = {0};
    const int n = grid->n[0] - 2; /* the layer around has none to look at */
    double sum = 0;
#pragma omp parallel for schedule(static) reduction(+ : steps[:DIRECTIONS]) \
    if (ms_grid_voxels(grid) >= MS_GRID_THREADS_FROM)
    for (int k = 0; k < grid->n[2] - 1; k++) {
        for (int j = 1; j < grid->n[1] - 1; j++) {
            const uint8_t *row = grid->inside + ms_grid_index(grid, 1, j, k);
            for (int d = 0; d < DIRECTIONS; d++) {
                const int *s = STEP[d];
                steps[d] +=
                    count_steps(row, row + s[0] + (ptrdiff_t)grid->n[0] * (s[1] + (ptrdiff_t)grid->n[1] * s[2]), n);
            }
        }
    }
    for (int d = 0; d < DIRECTIONS; d++) {
        const int axes = abs(STEP[d][0]) + abs(STEP[d][1]) + abs(STEP[d][2]);
        sum += WEIGHT[axes] * (double)steps[d] / sqrt(axes); /* each line has a cross-section of h^2 / its step */
    }
    return 2 * sum * grid->h * grid->h;
}
