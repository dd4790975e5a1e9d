#include "ms_planes.h"

#include <math.h>

/* Positive on the side that the normal points to. */
static double side_of(const double plane[4], const double place[3])
{
    return plane[0] * place[0] + plane[1] * place[1] + plane[2] * place[2] - plane[3];
}

double ms_planes_distance(const ms_settings *settings, const double place[3])
{
    double least = HUGE_VAL;
    for (size_t p = 0; p < settings->n_planes; p++) {
        least = fmin(least, fabs(side_of(settings->plane[p], place)));
    }
    return least;
}

double ms_planes_beyond(const ms_settings *settings, const double from[3], const double place[3])
{
    double most = -HUGE_VAL;
    for (size_t p = 0; p < settings->n_planes; p++) {
        const double sign = side_of(settings->plane[p], from) < 0 ? 1 : -1;
        most = fmax(most, sign * side_of(settings->plane[p], place));
    }
    return most;
}

void ms_planes_cut(float *e, const ms_target *target, const ms_settings *settings)
{
    const ms_grid *grid = &target->grid;
#pragma omp parallel for if (ms_grid_voxels(grid) >= MS_GRID_THREADS_FROM)
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            const size_t start = ms_grid_index(grid, 0, j, k);
            for (int i = 0; i < grid->n[0]; i++) {
                const double place[3] = {grid->origin[0] + grid->h * i, grid->origin[1] + grid->h * j,
                                         grid->origin[2] + grid->h * k};
                const double least = ms_planes_distance(settings, place) / grid->h;
                e[start + (size_t)i] = (float)fmin((double)target->distance[start + (size_t)i], least);
            }
        }
    }
}
