#include "ms_voxel_area.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

/* How far the voxels are that a normal is made of, from the middle of the face, and the width of their weights. Chosen
 * on digitised planes and balls: narrower, normals follow the steps of the voxels; wider, they cut off edges. */
static const double REACH = 3.5, SIGMA = 1.35;

enum { SIDE = 4, MOST_TAPS = 8 * 8 * 8 };

/* A voxel near a face, from the one below it. */
typedef struct tap {
    int step[3];
    ptrdiff_t offset; /* the same in memory */
    double pull[3];   /* its weight times where it is from the middle of the face */
} tap;

/* What is near the faces normal to an axis. */
typedef struct window {
    tap taps[MOST_TAPS];
    int count;
} window;

static void make_window(window *w, const ms_grid *grid, int axis)
{
    w->count = 0;
    for (int t = 0; t < MOST_TAPS; t++) {
        tap one = {.step = {t % 8 - SIDE + 1, t / 8 % 8 - SIDE + 1, t / 64 - SIDE + 1}};
        double square = 0, at[3];
        for (int a = 0; a < 3; a++) {
            at[a] = one.step[a] - (a == axis ? 0.5 : 0);
            square += at[a] * at[a];
        }
        if (square > REACH * REACH) {
            continue;
        }
        for (int a = 0; a < 3; a++) {
            one.pull[a] = at[a] * exp(-square / (2 * SIGMA * SIGMA));
        }
        one.offset = one.step[0] + (ptrdiff_t)grid->n[0] * (one.step[1] + (ptrdiff_t)grid->n[1] * one.step[2]);
        w->taps[w->count++] = one;
    }
}

static int is_beyond(const ms_grid *grid, const int voxel[3], const int step[3])
{
    int beyond = 0;
    for (int a = 0; a < 3; a++) {
        beyond |= voxel[a] + step[a] < 0 || voxel[a] + step[a] >= grid->n[a];
    }
    return beyond;
}

/* Cosine between the axis and the surface's normal at the face above a voxel; what is beyond the grid is outside. */
static double cosine_at(const ms_grid *grid, const window *w, const int voxel[3], int axis)
{
    const uint8_t *at = grid->inside + ms_grid_index(grid, voxel[0], voxel[1], voxel[2]);
    double pull[3] = {0};
    int near_border = 0;
    for (int a = 0; a < 3; a++) {
        near_border |= voxel[a] < SIDE || voxel[a] >= grid->n[a] - SIDE;
    }
    for (int t = 0; t < w->count; t++) {
        const tap *one = &w->taps[t];
        if ((!near_border || !is_beyond(grid, voxel, one->step)) && at[one->offset]) {
            for (int a = 0; a < 3; a++) {
                pull[a] += one->pull[a];
            }
        }
    }
    const double length = sqrt(ms_dot(pull, pull));
    return length > 0 ? fabs(pull[axis]) / length : 1;
}

/* The faces above the voxels of a slice, and those towards the next. */
static double sum_slice(const ms_grid *grid, const window w[3], int k)
{
    double sum = 0;
    for (int j = 0; j < grid->n[1]; j++) {
        for (int i = 0; i < grid->n[0]; i++) {
            const int voxel[3] = {i, j, k};
            const uint8_t *at = grid->inside + ms_grid_index(grid, i, j, k);
            const ptrdiff_t above[3] = {1, grid->n[0], (ptrdiff_t)grid->n[0] * grid->n[1]};
            for (int a = 0; a < 3; a++) {
                if (voxel[a] + 1 < grid->n[a] && *at != at[above[a]]) {
                    sum += cosine_at(grid, &w[a], voxel, a);
                }
            }
        }
    }
    return sum;
}

ms_status ms_voxel_area(double *area, const ms_grid *grid, ms_error *err)
{
    *area = 0;
    window *w = malloc(3 * sizeof *w);
    double *slice = malloc((size_t)grid->n[2] * sizeof *slice);
    if (!w || !slice) {
        free(w);
        free(slice);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to measure the surface of the voxels");
    }
    for (int a = 0; a < 3; a++) {
        make_window(&w[a], grid, a);
    }
#pragma omp parallel for schedule(dynamic, 1) if (ms_grid_voxels(grid) >= MS_GRID_THREADS_FROM)
    for (int k = 0; k < grid->n[2]; k++) {
        slice[k] = sum_slice(grid, w, k);
    }
    for (int k = 0; k < grid->n[2]; k++) {
        *area += slice[k] * grid->h * grid->h;
    }
    free(w);
    free(slice);
    return MS_OK;
}
