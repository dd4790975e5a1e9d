#include "ms_voxel_normal.h"

#include <math.h>

#include "base/ms_vector.h"

/* Width of the weights, and where they have come down to 0, so that it does not matter where among the voxels the
 * window ends; voxels along each axis. With the width of 1.35 that is enough for an area, single normals err by twice
 * as much: the steps of the voxels are wider apart. */
static const double SIGMA = 2, REACH = 6;
enum { WINDOW = 12 };

/* A plane pulls by some 150. Voxels of one kind pull by less than this, as the window is not quite even. */
static const double LEAST = 1;

/* Of the voxels around a place along an axis. */
typedef struct axis_weights {
    int first;                           /* voxel */
    double weight[WINDOW], pull[WINDOW]; /* pull: the weight times the way from the place */
} axis_weights;

static axis_weights weigh_axis(double place)
{
    axis_weights w = {.first = (int)floor(place) - WINDOW / 2 + 1};
    for (int i = 0; i < WINDOW; i++) {
        const double away = w.first + i - place;
        w.weight[i] = fmax(0, exp(-away * away / (2 * SIGMA * SIGMA)) - exp(-REACH * REACH / (2 * SIGMA * SIGMA)));
        w.pull[i] = w.weight[i] * away;
    }
    return w;
}

/* Sums over a row along x: inside +1, outside -1, so that a window cut off unevenly pulls nowhere. */
static void sum_row(double *weight, double *pull, const ms_grid *grid, const axis_weights *x, int j, int k)
{
    const int in_grid = j >= 0 && j < grid->n[1] && k >= 0 && k < grid->n[2];
    *weight = *pull = 0;
    for (int i = 0; i < WINDOW; i++) {
        const int at = x->first + i;
        const int inside = in_grid && at >= 0 && at < grid->n[0] && grid->inside[ms_grid_index(grid, at, j, k)];
        *weight += inside ? x->weight[i] : -x->weight[i];
        *pull += inside ? x->pull[i] : -x->pull[i];
    }
}

static int is_near(const ms_grid *grid, const double place[3])
{
    int near = 1;
    for (int a = 0; a < 3; a++) {
        near &= place[a] > -WINDOW && place[a] < grid->n[a] + WINDOW;
    }
    return near;
}

int ms_voxel_normal(double normal[3], const ms_grid *grid, const double place[3])
{
    axis_weights w[3];
    double pull[3] = {0};
    if (!is_near(grid, place)) {
        return 0;
    }
    for (int a = 0; a < 3; a++) {
        w[a] = weigh_axis(place[a]);
    }
    for (int k = 0; k < WINDOW; k++) {
        for (int j = 0; j < WINDOW; j++) {
            double weight, along;
            sum_row(&weight, &along, grid, &w[0], w[1].first + j, w[2].first + k);
            pull[0] += along * w[1].weight[j] * w[2].weight[k];
            pull[1] += weight * w[1].pull[j] * w[2].weight[k];
            pull[2] += weight * w[1].weight[j] * w[2].pull[k];
        }
    }
    const double length = sqrt(ms_dot(pull, pull));
    for (int a = 0; a < 3; a++) {
        normal[a] = -pull[a] / length;
    }
    return length > LEAST;
}
