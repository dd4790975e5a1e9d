/*
 * J. F. Favier, M. H. Abbaspour-Fard, M. Kremmer, A. O. Raji, Shape representation of axi-symmetrical, non-spherical
 * particles in discrete element simulation using multi-element model particles, Eng. Comput. 16 (1999) 467.
 * docs/methods/favier.md says what was left open and how it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shared/ms_bisect_count.h"
#include "shared/ms_judge.h"
#include "shared/ms_nodes.h"
#include "shared/ms_order.h"

static const ms_option OPTIONS[] = {{0}};

/* Centres nearer to each other than this, in voxels, would make much the same spheres. */
static const double LEAST_SPACING = 0.25;

/* The longest principal axis, cut where it passes from one voxel into the next. */
typedef struct axis_cut {
    double origin[3], direction[3]; /* in voxels, through the centroid */
    double *at;                     /* `count` places along it, ascending */
    size_t count;
    double inside; /* length of the pieces inside the shape */
} axis_cut;

typedef struct favier {
    const ms_run *run;
    ms_nodes nodes;
    axis_cut axis;
} favier;

static int compare_places(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void place_on_axis(double place[3], const axis_cut *axis, double at)
{
    for (int a = 0; a < 3; a++) {
        place[a] = axis->origin[a] + at * axis->direction[a];
    }
}

/* The length of the piece before a cut if it is inside the shape, else 0. */
static double length_inside(const axis_cut *axis, size_t cut, const ms_grid *grid)
{
    double middle[3];
    place_on_axis(middle, axis, 0.5 * (axis->at[cut - 1] + axis->at[cut]));
    return ms_grid_holds(grid, middle) ? axis->at[cut] - axis->at[cut - 1] : 0;
}

static void cut_axis(axis_cut *axis, const ms_grid *grid)
{
    for (int a = 0; a < 3; a++) {
        for (int plane = 0; plane <= grid->n[a] && fabs(axis->direction[a]) > 1e-12; plane++) {
            axis->at[axis->count++] = (plane - 0.5 - axis->origin[a]) / axis->direction[a];
        }
    }
    qsort(axis->at, axis->count, sizeof *axis->at, compare_places);
    for (size_t cut = 1; cut < axis->count; cut++) {
        axis->inside += length_inside(axis, cut, grid);
    }
}

static ms_status find_axis(axis_cut *axis, const ms_target *target, ms_error *err)
{
    const ms_grid *grid = &target->grid;
    ms_principal principal;
    ms_status status = ms_inertia_principal(&principal, &target->body, err);
    if (status != MS_OK) {
        return status;
    }
    axis->at = malloc((size_t)(grid->n[0] + grid->n[1] + grid->n[2] + 3) * sizeof *axis->at);
    if (!axis->at) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to cut an axis");
    }
    ms_grid_at(axis->origin, grid, target->body.centroid);
    memcpy(axis->direction, principal.axis[0], sizeof axis->direction); /* of the least moment: the longest */
    cut_axis(axis, grid);
    return axis->inside > 0 ? MS_OK
                            : ms_fail(err, MS_ERR_SHAPE,
                                      "favier: the longest principal axis passes through no voxel of the shape; use "
                                      "another method");
}

/* The n centres in the middle of n equal parts of what the axis has inside the shape, and their radii, those above 0
 * and no smaller than the least. */
static size_t make_balls(ms_ball *ball, size_t n, const favier *f)
{
    const ms_target *target = f->run->target;
    const double least = f->run->stop.radius / target->grid.h;
    double before = 0;
    size_t kept = 0, cut = 1;
    for (size_t i = 0; i < n; i++) {
        const double wanted = ((double)i + 0.5) / (double)n * f->axis.inside;
        double length = length_inside(&f->axis, cut, &target->grid);
        while (before + length < wanted && cut + 1 < f->axis.count) {
            before += length;
            length = length_inside(&f->axis, ++cut, &target->grid);
        }
        place_on_axis(ball[kept].centre, &f->axis, f->axis.at[cut - 1] + (wanted - before));
        ms_nodes_nearest(&ball[kept].radius, &f->nodes, ball[kept].centre, MS_NORM_EUCLIDEAN);
        ball[kept].radius += target->mesh ? 0 : 0.5; /* the surface lies beyond the centres of the border's voxels */
        kept += ball[kept].radius > 0 && !(ball[kept].radius < least);
    }
    return kept;
}

/* The clump of n spheres; ms_bisect_count_solve. */
static ms_status place_spheres(void *context, ms_clump *clump, ms_stop_reason *reason, size_t n, ms_error *err)
{
    const favier *f = context;
    ms_ball *ball = malloc((n + 1) * sizeof *ball);
    if (!ball) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", n);
    }
    const size_t kept = make_balls(ball, n, f);
    ms_status status = ms_judge_union(NULL, reason, f->run, ball, kept, err);
    if (status == MS_OK) {
        status = ms_order_by_gain(clump, ball, kept, f->run, err);
    }
    const int is_last = n == f->run->stop.spheres || f->axis.inside < LEAST_SPACING * (double)n;
    if (*reason == MS_STOP_NOT && is_last) {
        *reason = kept < n ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    }
    free(ball);
    return status;
}

static ms_status generate_by_favier(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const ms_stop *stop = &run->stop;
    favier f = {.run = run};
    ms_status status = ms_nodes_of_target(&f.nodes, run->target, err);
    if (status == MS_OK) {
        status = find_axis(&f.axis, run->target, err);
    }
    if (status == MS_OK) {
        const size_t most = stop->spheres > 0 ? stop->spheres : MS_CLUMP_MAX_SPHERES;
        status = stop->spheres > 0 && !ms_stop_has_measure(stop)
                     ? place_spheres(&f, clump, reason, stop->spheres, err)
                     : ms_bisect_count(clump, reason, most, place_spheres, &f, err);
    }
    free(f.axis.at);
    ms_nodes_free(&f.nodes);
    return status;
}

const ms_generator ms_generator_favier = {
    .name = "favier",
    .summary = "baseline: spheres along the longest principal axis, each to the nearest vertex",
    .source = "J. F. Favier et al., Eng. Comput. 16 (1999) 467",
    .nested = 0,
    .baseline = 1,
    .options = OPTIONS,
    .generate = generate_by_favier,
};
