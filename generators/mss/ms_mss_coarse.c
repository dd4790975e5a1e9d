#include "ms_mss_coarse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_distance.h"

/* A coarse voxel touches at most so many of the target's along an axis; all of it is WHOLE, in halves of sides. */
enum { TAPS = MS_MSS_COARSE + 1, WHOLE = 8 * MS_MSS_COARSE * MS_MSS_COARSE * MS_MSS_COARSE };

/* Which voxels of the target coarse voxel 0 of an axis touches, the first of them first, and how many halves of each it
 * holds. Those of the next one lie MS_MSS_COARSE farther on. */
typedef struct axis_taps {
    int first;
    uint8_t halves[TAPS];
} axis_taps;

static axis_taps find_taps(double shift)
{
    const double centre = floor(shift);
    if (shift > centre) { /* between two voxels */
        return (axis_taps){(int)centre, {2, 2, 0}};
    }
    return (axis_taps){(int)centre - 1, {1, 2, 1}};
}

/* The voxels of the target that a row of coarse ones touches, summed across the row. */
static void sum_rows(uint8_t *sum, const ms_grid *fine, const axis_taps taps[3], int y, int z)
{
    memset(sum, 0, (size_t)fine->n[0]);
    for (int c = 0; c < TAPS; c++) {
        for (int b = 0; b < TAPS; b++) {
            const int j = taps[1].first + MS_MSS_COARSE * y + b, k = taps[2].first + MS_MSS_COARSE * z + c;
            const uint8_t weight = (uint8_t)(taps[1].halves[b] * taps[2].halves[c]);
            if (weight == 0 || j < 0 || j >= fine->n[1] || k < 0 || k >= fine->n[2]) {
                continue;
            }
            const uint8_t *inside = fine->inside + ms_grid_index(fine, 0, j, k);
            for (int i = 0; i < fine->n[0]; i++) {
                sum[i] = (uint8_t)(sum[i] + (inside[i] ? weight : 0));
            }
        }
    }
}

/* @return how many are inside */
static size_t fill_coarse_row(uint8_t *inside, int length, const uint8_t *sum, int n, const axis_taps *taps)
{
    size_t count = 0;
    for (int x = 0; x < length; x++) {
        int halves = 0;
        for (int a = 0; a < TAPS; a++) {
            const int i = taps->first + MS_MSS_COARSE * x + a;
            halves += i >= 0 && i < n ? taps->halves[a] * sum[i] : 0;
        }
        inside[x] = 2 * halves > WHOLE;
        count += inside[x];
    }
    return count;
}

static ms_status fill_coarse_grid(ms_mss_coarse *coarse, const ms_grid *fine, ms_error *err)
{
    const ms_grid *grid = &coarse->target.grid;
    const axis_taps taps[3] = {find_taps(coarse->shift[0]), find_taps(coarse->shift[1]), find_taps(coarse->shift[2])};
    size_t count = 0;
    int complete = 1;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : count) reduction(& : complete) if (ms_grid_voxels(fine) >= \
                                                                                               MS_GRID_THREADS_FROM)
    for (int z = 0; z < grid->n[2]; z++) {
        uint8_t *sum = malloc((size_t)fine->n[0]);
        complete &= sum != NULL;
        for (int y = 0; sum && y < grid->n[1]; y++) {
            sum_rows(sum, fine, taps, y, z);
            count +=
                fill_coarse_row(grid->inside + ms_grid_index(grid, 0, y, z), grid->n[0], sum, fine->n[0], &taps[0]);
        }
        free(sum);
    }
    coarse->target.voxels = count;
    return complete ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for a row of %d voxels", fine->n[0]);
}

ms_status ms_mss_coarse_make(ms_mss_coarse *coarse, const ms_target *target, ms_error *err)
{
    const ms_grid *fine = &target->grid;
    double origin[3];
    int n[3];
    for (int a = 0; a < 3; a++) {
        n[a] = (fine->n[a] - 2 * MS_GRID_HULL + MS_MSS_COARSE - 1) / MS_MSS_COARSE + 2 * MS_GRID_HULL;
        coarse->shift[a] = 0.5 * (fine->n[a] - 1) - 0.5 * MS_MSS_COARSE * (n[a] - 1);
        origin[a] = fine->origin[a] + fine->h * coarse->shift[a];
    }
    coarse->target = *target;
    coarse->target.distance = NULL;
    ms_status status = ms_grid_alloc(&coarse->target.grid, n, MS_MSS_COARSE * fine->h, origin, err);
    if (status == MS_OK) {
        status = fill_coarse_grid(coarse, fine, err);
    }
    if (status == MS_OK) {
        const size_t voxels = ms_grid_voxels(&coarse->target.grid);
        coarse->target.distance = malloc(voxels * sizeof *coarse->target.distance);
        status = coarse->target.distance
                     ? ms_distance(coarse->target.distance, coarse->target.grid.inside, n, err)
                     : ms_fail(err, MS_ERR_NOMEM, "no memory for a coarse distance field of %zu voxels", voxels);
    }
    if (status != MS_OK) {
        ms_mss_coarse_free(coarse);
    }
    return status;
}

ms_ball ms_mss_coarse_target_ball(const ms_mss_coarse *coarse, const ms_ball *ball)
{
    ms_ball own = {.radius = MS_MSS_COARSE * ball->radius};
    for (int a = 0; a < 3; a++) {
        own.centre[a] = MS_MSS_COARSE * ball->centre[a] + coarse->shift[a];
    }
    return own;
}

ms_ball ms_mss_coarse_ball(const ms_mss_coarse *coarse, const ms_ball *ball)
{
    ms_ball seen = {.radius = ball->radius / MS_MSS_COARSE};
    for (int a = 0; a < 3; a++) {
        seen.centre[a] = (ball->centre[a] - coarse->shift[a]) / MS_MSS_COARSE;
    }
    return seen;
}

void ms_mss_coarse_free(ms_mss_coarse *coarse)
{
    ms_grid_free(&coarse->target.grid);
    free(coarse->target.distance);
    memset(coarse, 0, sizeof *coarse);
}
