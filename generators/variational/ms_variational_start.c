#include "ms_variational_start.h"

#include <math.h>
#include <stdlib.h>

#include "shared/ms_cover.h"

/* A voxel lies on the ridge unless the distance rises by this much of the way to a neighbour: no
 * direction is more than 27 degrees from one. */
static const double RISING = 0.85;

/* Coarse voxels per edge of the cube that is a sphere's share of the volume, about. */
static const double RESOLUTION = 10;

/* Steps of the field to one voxel of the cover: its look-up is off by as much of a radius, however large. */
static const double FINER = 1.25;

/* Of the coarse grid and of the field at most, in voxels. Finer ones may be better, and take longer; but not a field
 * that is read off voxels. */
enum { MOST_COVER = 4, MOST_FIELD = 3, MOST_FROM_VOXELS = 2 };

void ms_variational_start_steps(int *cover, int *field, const ms_target *target, size_t n)
{
    const size_t voxels = ms_grid_voxels(&target->grid);
    double deepest = 0;
    for (size_t v = 0; v < voxels; v++) {
        deepest = fmax(deepest, (double)target->distance[v]);
    }
    const double step = fmin(cbrt((double)target->voxels / (double)n) / RESOLUTION, deepest / 4);
    /* A cover by all voxels takes many times as long as by every second one, and gains little. */
    *cover = step < 1.5 ? 1 : (int)fmin(fmax(step, 2), MOST_COVER);
    const int most = target->mesh && target->closed ? MOST_FIELD : MOST_FROM_VOXELS;
    *field = step < 1.5 ? 1 : (int)fmin(fmax(step * FINER, 2), most);
}

/* Does no neighbour's inscribed sphere contain that of this voxel, but for some slack? */
static int is_ridge(const ms_coarse_view *view, int i, int j, int k)
{
    const ms_grid *grid = &view->target->grid, *coarse = &view->grid;
    const float *e = view->distance;
    const int step = view->step;
    const double here = (double)e[ms_grid_index(grid, i * step, j * step, k * step)];
    for (int t = 0; t < 27; t++) {
        const int d[3] = {t % 3 - 1, t / 3 % 3 - 1, t / 9 - 1}, x = i + d[0], y = j + d[1], z = k + d[2];
        if (t == 13 || x < 0 || y < 0 || z < 0 || x >= coarse->n[0] || y >= coarse->n[1] || z >= coarse->n[2]) {
            continue;
        }
        const double there = (double)e[ms_grid_index(grid, x * step, y * step, z * step)];
        if (there - here >= RISING * step * sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])) {
            return 0;
        }
    }
    return 1;
}

/* The inscribed spheres about the ridge, in coarse voxels. */
static ms_status list_ridge(ms_ball **ball, size_t *count, const ms_coarse_view *view, double least, ms_error *err)
{
    const ms_grid *coarse = &view->grid;
    const int step = view->step;
    *count = 0;
    *ball = malloc(ms_grid_voxels(coarse) * sizeof **ball);
    if (!*ball) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the spheres to start from; use fewer cells");
    }
    for (int k = 0; k < coarse->n[2]; k++) {
        for (int j = 0; j < coarse->n[1]; j++) {
            for (int i = 0; i < coarse->n[0]; i++) {
                const size_t voxel = ms_grid_index(&view->target->grid, i * step, j * step, k * step);
                const double radius = (double)view->distance[voxel] - 0.5;
                if (radius > 0 && radius >= least && is_ridge(view, i, j, k)) {
                    (*ball)[(*count)++] = (ms_ball){.centre = {i, j, k}, .radius = radius / step};
                }
            }
        }
    }
    return MS_OK;
}

ms_status ms_variational_start_cover(ms_ball *ball, size_t *count, const ms_coarse_view *view, size_t wanted,
                                     double least, ms_error *err)
{
    ms_ball *candidate;
    ms_cover *cover = NULL;
    size_t candidates, which;
    *count = 0;
    ms_status status = list_ridge(&candidate, &candidates, view, least, err);
    if (status == MS_OK) {
        status = ms_cover_build(&cover, &view->grid, candidate, candidates, MS_COVER_ANY, err);
    }
    while (status == MS_OK && *count < wanted && ms_cover_next(&which, cover)) {
        ball[(*count)++] = ms_coarse_view_target_ball(view, &candidate[which]);
    }
    ms_cover_free(cover);
    free(candidate);
    return status;
}
