#include "ms_variational_solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_coverage_count.h"
#include "ms_variational_start.h"

/* Spheres at the start: so many times those asked for, and some more, without which few spheres of a rough shape have
 * little to be chosen from. Which numbers are best depends on the shape. */
static const double SURPLUS = 1.25;
enum { MORE = 12 };

/* Radii that become smaller, in voxels, say nothing about the shape. */
static const double LEAST_RADIUS = 0.5;

/* A sphere whose centre is nearer to a plane of symmetry, as part of its radius, moves onto it: it and its
 * image would be two spheres for one place. */
static const double SNAP = 0.3;

static double find_least_radius(const ms_run *run)
{
    return fmax(0, run->stop.radius / run->target->grid.h);
}

void ms_variational_solver_free(ms_variational_solver *s)
{
    ms_coarse_view_free(&s->coarse);
    ms_lattice_free(&s->lattice);
    free(s->walled);
    free(s->ball);
    free(s->best);
    free(s->all);
    free(s->given);
    ms_gap_close(&s->gap);
    memset(s, 0, sizeof *s);
}

/* Fills in the mirror images; returns how many spheres there are in all. */
size_t ms_variational_solver_expand(ms_variational_solver *s)
{
    return ms_mirror_expand(s->all, s->ball, s->count, &s->settings->mirror);
}

size_t ms_variational_solver_count(const ms_variational_solver *s)
{
    size_t sum = 0;
    for (size_t b = 0; b < s->count; b++) {
        sum += ms_mirror_images(&s->settings->mirror, &s->ball[b]);
    }
    return sum;
}

/* All spheres, images too, in voxels of the coarse grid; returns how many. */
static size_t all_to_coarse(ms_variational_solver *s)
{
    const size_t all = ms_variational_solver_expand(s);
    for (size_t b = 0; b < all; b++) {
        s->all[b] = ms_coarse_view_ball(&s->coarse, &s->all[b]);
    }
    return all;
}

/* The target at every step-th voxel, as this run sees it. */
ms_status ms_variational_solver_view(ms_coarse_view *view, const ms_variational_solver *s, int step, ms_error *err)
{
    const ms_target *target = s->run->target;
    return ms_coarse_view_make(view, target, s->walled ? s->walled : target->distance, step, err);
}

/* Appends inscribed spheres that cover most of what is left in a view: up to `most`, mirror images among them. */
static ms_status append_cover(ms_variational_solver *s, ms_coarse_view *left, size_t most, ms_error *err)
{
    const size_t before = s->count, limit = ms_variational_solver_count(s) + most;
    size_t added = 0;
    ms_coarse_view_keep_upper(left, &s->settings->mirror);
    const ms_status status =
        ms_variational_start_cover(s->ball + before, &added, left, most < s->room - before ? most : s->room - before,
                                   find_least_radius(s->run), err);
    for (size_t b = before; b < before + added; b++) {
        ms_mirror_fold(&s->ball[b], &s->settings->mirror, SNAP);
    }
    s->count += added;
    while (s->count > before + 1 && ms_variational_solver_count(s) > limit) {
        s->count--;
    }
    return status;
}

/* Adds up to `most` spheres where the union leaves most. */
ms_status ms_variational_solver_add_cover(ms_variational_solver *s, size_t most, ms_error *err)
{
    ms_coarse_view left = {0};
    ms_status status = ms_variational_solver_view(&left, s, s->coarse.step, err);
    if (status == MS_OK) {
        const size_t all = all_to_coarse(s);
        ms_coverage_count_clear(&left.grid, s->all, all);
        status = append_cover(s, &left, most, err);
    }
    ms_coarse_view_free(&left);
    return status;
}

/* The cover to start from, of this step; on a finer grid where it gives too few spheres. */
static ms_status start_from_cover(ms_variational_solver *s, int step, ms_error *err)
{
    for (;; step--) {
        ms_coarse_view half = {0};
        ms_status status = ms_variational_solver_view(&s->coarse, s, step, err);
        s->count = 0;
        if (status == MS_OK) {
            status = ms_variational_solver_view(&half, s, step, err);
        }
        if (status == MS_OK) {
            status = append_cover(s, &half, s->room, err);
        }
        ms_coarse_view_free(&half);
        if (status != MS_OK || ms_variational_solver_count(s) >= s->wanted || step == 1) {
            return status;
        }
        ms_coarse_view_free(&s->coarse);
    }
}

/* Spheres that are given, one of each set of mirror images, and others where they are too few. */
static ms_status start_from_given(ms_variational_solver *s, const ms_clump *given, int step, ms_error *err)
{
    const ms_target *target = s->run->target;
    const ms_mirror *m = &s->settings->mirror;
    const ms_status status = ms_variational_solver_view(&s->coarse, s, step, err);
    for (size_t g = 0; g < given->n_spheres; g++) {
        ms_ball *ball = &s->ball[s->count];
        *ball = ms_grid_ball(&target->grid, &given->sphere[g]);
        const double reach = SNAP * ball->radius;
        int below = 0;
        for (int a = 0; a < 3; a++) {
            below |= m->across[a] && ball->centre[a] < m->at[a] - reach;
        }
        if (!below) {
            ms_mirror_fold(ball, m, SNAP);
            s->count++;
        }
    }
    s->given = malloc((s->count + 1) * sizeof *s->given);
    if (!s->given) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", s->count);
    }
    s->n_given = s->count;
    memcpy(s->given, s->ball, s->count * sizeof *s->given);
    const size_t all = ms_variational_solver_count(s);
    return status == MS_OK && all < s->wanted ? ms_variational_solver_add_cover(s, s->wanted - all, err) : status;
}

ms_status ms_variational_solver_begin(ms_variational_solver *s, const ms_run *run,
                                      const ms_variational_settings *settings, size_t n, ms_error *err)
{
    const int *across = settings->mirror.across;
    const ms_clump *given = settings->refine;
    const size_t most = n < run->target->voxels ? n : run->target->voxels; /* more would be alike */
    const size_t room = (size_t)ceil(SURPLUS * (double)most) + MORE;
    *s = (ms_variational_solver){
        .run = run, .settings = settings, .wanted = n, .room = room > given->n_spheres ? room : given->n_spheres};
    s->ball = malloc(s->room * sizeof *s->ball);
    s->best = malloc(s->room * sizeof *s->best);
    s->all = malloc((s->room << (across[0] + across[1] + across[2])) * sizeof *s->all);
    if (!s->ball || !s->best || !s->all) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", s->room);
    }
    if (settings->bounds.planes->n_planes > 0) {
        s->walled = malloc(ms_grid_voxels(&run->target->grid) * sizeof *s->walled);
        if (!s->walled) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for distances to planes; use fewer cells");
        }
        ms_planes_cut(s->walled, run->target, run->settings);
    }
    int cover, field;
    ms_variational_start_steps(&cover, &field, run->target, n);
    ms_status status = given->n_spheres > 0 ? start_from_given(s, given, cover, err) : start_from_cover(s, cover, err);
    if (status == MS_OK) {
        status = ms_signed_distance_open(&s->field, run->target, s->coarse.step < cover ? s->coarse.step : field, err);
    }
    if (status == MS_OK) {
        status = ms_lattice_alloc(&s->lattice, settings->points, err);
    }
    s->fit = (ms_surface_fit){.field = &s->field,
                              .bounds = settings->bounds,
                              .mirror = settings->mirror,
                              .lattice = &s->lattice,
                              .seed = run->seed};
    s->fit.bounds.least = fmax(find_least_radius(run), LEAST_RADIUS);
    if (status == MS_OK && settings->gap < HUGE_VAL) {
        status = ms_gap_open(&s->gap, run->target, &settings->mirror, settings->gap, s->room, err);
        s->fit.gap = &s->gap;
    }
    return status;
}
