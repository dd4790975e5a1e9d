/*
 * The Euclidean method of CLUMP: V. Angelidakis, S. Nadimi, M. Otsubo, S. Utili, CLUMP: a code library to generate
 * universal multi-sphere particles, SoftwareX 15 (2021) 100735. docs/methods/euclid.md says what was left open and how
 * it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shared/ms_nested.h"
#include "voxel/ms_distance.h"

enum { OVERLAP, OFFSET };

static const ms_option OPTIONS[] = {
    [OVERLAP] = {"overlap", MS_OPTION_REAL, 0.9, 0, 0.99, NULL, NULL,
                 "of a sphere of radius R the voxels within (1 - overlap) R of its centre are taken out; 0: all"},
    [OFFSET] = {"radius-offset", MS_OPTION_REAL, 1, -100, 100, NULL, "voxels", "added to every radius"},
    {0},
};

/* The voxels that are left, and their distance field. */
typedef struct euclid {
    const ms_run *run;
    uint8_t *left;
    float *distance;
} euclid;

/* The lowest of the voxels with the greatest distance; if all are 0 the first. */
static size_t find_deepest(const float *distance, size_t voxels)
{
    size_t best = 0;
    for (size_t v = 1; v < voxels; v++) {
        best = distance[v] > distance[best] ? v : best;
    }
    return best;
}

static void take_out(euclid *e, const ms_ball *ball, double radius)
{
    const ms_grid *grid = &e->run->target->grid;
    const double reach = (1 - e->run->settings->value[OVERLAP]) * radius;
    int lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = (int)fmax(0, ceil(ball->centre[a] - reach));
        hi[a] = (int)fmin(grid->n[a] - 1, floor(ball->centre[a] + reach));
    }
    for (int k = lo[2]; k <= hi[2]; k++) {
        for (int j = lo[1]; j <= hi[1]; j++) {
            for (int i = lo[0]; i <= hi[0]; i++) {
                const double x = i - ball->centre[0], y = j - ball->centre[1], z = k - ball->centre[2];
                if (x * x + y * y + z * z <= reach * reach) {
                    e->left[ms_grid_index(grid, i, j, k)] = 0;
                }
            }
        }
    }
}

/* ms_nested_choose. */
static ms_status choose_largest(void *context, ms_ball *ball, ms_stop_reason *reason, const ms_raster *placed,
                                ms_error *err)
{
    euclid *e = context;
    const ms_grid *grid = &e->run->target->grid;
    if (placed->n_balls > 0) {
        const ms_status status = ms_distance(e->distance, e->left, grid->n, err);
        if (status != MS_OK) {
            return status;
        }
    }
    const size_t v = find_deepest(e->distance, ms_grid_voxels(grid));
    const double depth = (double)e->distance[v];
    int at[3];
    ms_grid_voxel(at, grid->n, v);
    *ball = (ms_ball){{at[0], at[1], at[2]}, depth + e->run->settings->value[OFFSET]};
    if (!(depth > 0 && ball->radius > 0)) {
        *reason = MS_STOP_EXHAUSTED;
    } else if (ball->radius * grid->h < e->run->stop.radius) {
        *reason = MS_STOP_RADIUS;
    } else {
        take_out(e, ball, depth);
    }
    return MS_OK;
}

static ms_status generate_by_euclid(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(&run->target->grid);
    euclid e = {run, malloc(voxels), malloc(voxels * sizeof *e.distance)};
    ms_status status = MS_OK;
    if (e.left && e.distance) {
        memcpy(e.left, run->target->grid.inside, voxels);
        memcpy(e.distance, run->target->distance, voxels * sizeof *e.distance);
        status = ms_nested_run(clump, reason, run, choose_largest, &e, err);
    } else {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the distance field of %zu voxels; use fewer cells", voxels);
    }
    free(e.left);
    free(e.distance);
    return status;
}

const ms_generator ms_generator_euclid = {
    .name = "euclid",
    .summary = "baseline: the largest sphere of the distance field of what those before, shrunk, have left",
    .source = "V. Angelidakis et al. (CLUMP), SoftwareX 15 (2021) 100735",
    .nested = 1,
    .baseline = 1,
    .bytes_per_voxel = 8, /* distance field 4, first-cover index 2, what is left 1, and a plane for each thread */
    .options = OPTIONS,
    .generate = generate_by_euclid,
};
