/* The stages of variational for one number of spheres: docs/methods/variational.md. */
#include "ms_variational_solve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_bulk.h"
#include "ms_coverage_count.h"
#include "ms_pattern_search.h"
#include "ms_prune.h"
#include "ms_split.h"
#include "ms_surface_tally.h"
#include "ms_variational_start.h"

/* Spheres at the start: so many times those asked for, and some more, without which few spheres of a rough shape have
 * little to be chosen from. Which numbers are best depends on the shape. */
static const double SURPLUS = 1.25;
enum { MORE = 12 };

/* Part of the surplus that is dropped at a time: what goes at once is chosen without knowing of the rest. */
static const double DROP = 0.1;

/* Part of the spheres that a round adds, one round after the other: what one cannot better, another may. */
static const double ADD[] = {0.1, 0.05, 0.2, 0.025};
enum { ADDS = sizeof ADD / sizeof *ADD };

/* D from which on inscribed spheres are a poor start. */
static const double HOPELESS = 0.2;

/* Radii that become smaller, in voxels, say nothing about the shape. */
static const double LEAST_RADIUS = 0.5;

/* Of the field at most, in voxels: its look-up is off by far less than a voxel, and finer ones take longer. */
enum { FIELD_STEP = 2 };

/* Mean distance between the surfaces of spheres and shape, in voxels, below which voxels are too coarse: the field is
 * looked up by cubic polynomials, and the mismatch is the one by the exposed surface. */
static const double FINE = 0.1;

/* Of the fits, and of the search within bounds: so many that more change little. */
enum { START_STEPS = 40, DROP_STEPS = 15, LONG_STEPS = 80, LAST_STEPS = 50, SEARCH_ROUNDS = 20 };

/* Of idle spheres: those put elsewhere may come to be idle there, too. */
enum { REPAIRS = 3 };

/* A sphere whose centre is nearer to a plane of symmetry, as part of its radius, moves onto it: it and its
 * image would be two spheres for one place. */
static const double SNAP = 0.3;

/* A run for one number of spheres. */
typedef struct solver {
    const ms_run *run;
    const ms_variational_settings *settings;
    float *walled; /* the target's distances, cut down to those to planes; NULL without planes */
    ms_coarse_view coarse;
    ms_signed_distance field;
    ms_lattice lattice;
    ms_surface_fit fit;
    double steps, planned; /* of the fit, done and in all: for who watches */
    size_t count, wanted;  /* spheres that are fitted; asked for, mirror images among them */
    ms_ball *ball, *best;  /* in voxels of the target's grid; room for `room` */
    ms_ball *all;          /* with mirror images: room for `room` times the planes' images */
    size_t room;
    ms_ball *given; /* copy of those that were given to start from; NULL: none */
    size_t n_given;
} solver;

static void free_solver(solver *s)
{
    ms_coarse_view_free(&s->coarse);
    ms_lattice_free(&s->lattice);
    free(s->walled);
    free(s->ball);
    free(s->best);
    free(s->all);
    free(s->given);
    memset(s, 0, sizeof *s);
}

static double find_least_radius(const ms_run *run)
{
    return fmax(0, run->stop.radius / run->target->grid.h);
}

/* Fills in the mirror images; returns how many spheres there are in all. */
static size_t expand_images(solver *s)
{
    return ms_mirror_expand(s->all, s->ball, s->count, &s->settings->mirror);
}

static size_t count_with_images(const solver *s)
{
    size_t sum = 0;
    for (size_t b = 0; b < s->count; b++) {
        sum += ms_mirror_images(&s->settings->mirror, &s->ball[b]);
    }
    return sum;
}

/* All steps that are sure to come: rounds may be fewer, idle spheres bring more. */
static double count_steps(const solver *s, double surplus)
{
    const double batches = surplus > 0 ? ceil(surplus / ceil(DROP * surplus)) : 0;
    return (surplus > 0 ? START_STEPS + DROP_STEPS * batches : 0) + LONG_STEPS + LAST_STEPS +
           s->settings->rounds * (DROP_STEPS + DROP_STEPS / DROP + LAST_STEPS);
}

/* A measure is sought by several runs, whose number is not known. */
static void tell_share(const solver *s)
{
    char text[48];
    const int is_sought = ms_stop_has_measure(&s->run->stop);
    snprintf(text, sizeof text, "fit of %zu spheres", count_with_images(s));
    ms_generator_stage(s->run, text, is_sought ? (double)NAN : fmin(s->steps / s->planned, 1));
}

static ms_status fit_spheres(solver *s, int steps, double from, double to, ms_error *err)
{
    const double damping[2] = {from, to};
    tell_share(s);
    s->steps += steps;
    return ms_surface_fit_steps(&s->fit, s->ball, s->count, steps, damping, err);
}

/* |S xor U| in voxels, by their count and by the exposed surface. */
typedef struct mismatch {
    double count, surface;
} mismatch;

static ms_status find_mismatch(mismatch *out, solver *s, ms_error *err)
{
    ms_coverage_count o;
    ms_status status = ms_coverage_count_open(&o, &s->run->target->grid, s->all, expand_images(s), err);
    *out = (mismatch){.count = (double)o.mismatch};
    ms_coverage_count_close(&o);
    if (status == MS_OK && ms_signed_distance_is_exact(&s->field)) {
        status = ms_surface_tally(NULL, &out->surface, &s->fit, s->ball, s->count, err);
    }
    return status;
}

/* Is it so small that the count of voxels is chance? */
static int is_fine(const solver *s, const mismatch *m)
{
    const ms_target *target = s->run->target;
    const double h = target->grid.h;
    return ms_signed_distance_is_exact(&s->field) && m->count < FINE * ms_mesh_area(target->mesh) / (h * h);
}

static int is_improved(const solver *s, const mismatch *after, const mismatch *before)
{
    return is_fine(s, before) ? is_fine(s, after) && after->surface < before->surface : after->count < before->count;
}

/* A fit that is taken back where it makes the mismatch larger. Of spheres that may not stick out, the
 * mismatch says nothing before they are confined. */
static ms_status improve_fit(solver *s, int steps, double from, double to, ms_error *err)
{
    mismatch before = {0}, after = {0};
    if (ms_bounds_are_set(&s->fit.bounds)) {
        return fit_spheres(s, steps, from, to, err);
    }
    memcpy(s->best, s->ball, s->count * sizeof *s->ball);
    ms_status status = find_mismatch(&before, s, err);
    if (status == MS_OK) {
        status = fit_spheres(s, steps, from, to, err);
    }
    if (status == MS_OK) {
        status = find_mismatch(&after, s, err);
    }
    if (status == MS_OK && !is_improved(s, &after, &before)) {
        memcpy(s->ball, s->best, s->count * sizeof *s->ball);
    }
    return status;
}

/* For spheres that fit so well that the error of a linear look-up would show. */
static ms_status sharpen_field(solver *s, ms_error *err)
{
    mismatch left = {0};
    if (s->field.cubic || !ms_signed_distance_is_exact(&s->field)) {
        return MS_OK;
    }
    ms_status status = find_mismatch(&left, s, err);
    if (status == MS_OK && is_fine(s, &left)) {
        s->field.cubic = 1;
    }
    return status;
}

/* Makes the spheres keep to their bounds, and moves them within. */
static ms_status search_within_bounds(solver *s, ms_error *err)
{
    if (!ms_bounds_are_set(&s->fit.bounds)) {
        return MS_OK;
    }
    ms_bounds_confine(&s->fit.bounds, &s->field, s->ball, s->count);
    return ms_pattern_search(s->ball, s->count, &s->run->target->grid, &s->fit, SEARCH_ROUNDS, err);
}

/* All spheres, images too, in voxels of the coarse grid; returns how many. */
static size_t all_to_coarse(solver *s)
{
    const size_t all = expand_images(s);
    for (size_t b = 0; b < all; b++) {
        s->all[b] = ms_coarse_view_ball(&s->coarse, &s->all[b]);
    }
    return all;
}

static ms_status prune_surplus(solver *s, ms_error *err)
{
    size_t count = count_with_images(s);
    const size_t surplus = count > s->wanted ? count - s->wanted : 0, part = (size_t)ceil(DROP * (double)surplus);
    /* Whole sets of images, or all that can go lie on planes. */
    const int *across = s->settings->mirror.across;
    const size_t set = (size_t)1 << (across[0] + across[1] + across[2]), most = part > set ? part : set;
    ms_status status = MS_OK;
    while (status == MS_OK && count > s->wanted) {
        const size_t gone = count - s->wanted < most ? count - s->wanted : most;
        status = ms_prune_cheapest(s->ball, &s->count, gone, &s->coarse, &s->fit, err);
        if (status == MS_OK) {
            status = fit_spheres(s, DROP_STEPS, 0.5, 0.3, err);
        }
        count = count_with_images(s);
    }
    return status;
}

/* The target at every step-th voxel, as this run sees it. */
static ms_status make_view(ms_coarse_view *view, const solver *s, int step, ms_error *err)
{
    const ms_target *target = s->run->target;
    return ms_coarse_view_make(view, target, s->walled ? s->walled : target->distance, step, err);
}

/* Appends inscribed spheres that cover most of what is left in a view: up to `most`, mirror images among them. */
static ms_status append_cover(solver *s, ms_coarse_view *left, size_t most, ms_error *err)
{
    const size_t before = s->count, limit = count_with_images(s) + most;
    size_t added = 0;
    ms_coarse_view_keep_upper(left, &s->settings->mirror);
    const ms_status status =
        ms_variational_start_cover(s->ball + before, &added, left, most < s->room - before ? most : s->room - before,
                                   find_least_radius(s->run), err);
    for (size_t b = before; b < before + added; b++) {
        ms_mirror_fold(&s->ball[b], &s->settings->mirror, SNAP);
    }
    s->count += added;
    while (s->count > before + 1 && count_with_images(s) > limit) {
        s->count--;
    }
    return status;
}

/* Adds up to `most` spheres where the union leaves most. */
static ms_status add_to_cover(solver *s, size_t most, ms_error *err)
{
    ms_coarse_view left = {0};
    ms_status status = make_view(&left, s, s->coarse.step, err);
    if (status == MS_OK) {
        const size_t all = all_to_coarse(s);
        ms_coverage_count_clear(&left.grid, s->all, all);
        status = append_cover(s, &left, most, err);
    }
    ms_coarse_view_free(&left);
    return status;
}

/* The cover to start from; on a finer grid where it gives too few spheres. */
static ms_status start_from_cover(solver *s, ms_error *err)
{
    for (int step = ms_variational_start_step(s->run->target, s->wanted);; step--) {
        ms_coarse_view half = {0};
        ms_status status = make_view(&s->coarse, s, step, err);
        s->count = 0;
        if (status == MS_OK) {
            status = make_view(&half, s, step, err);
        }
        if (status == MS_OK) {
            status = append_cover(s, &half, s->room, err);
        }
        ms_coarse_view_free(&half);
        if (status != MS_OK || count_with_images(s) >= s->wanted || step == 1) {
            return status;
        }
        ms_coarse_view_free(&s->coarse);
    }
}

/* Spheres that are given, one of each set of mirror images, and others where they are too few. */
static ms_status start_from_given(solver *s, const ms_clump *given, ms_error *err)
{
    const ms_target *target = s->run->target;
    const ms_mirror *m = &s->settings->mirror;
    const ms_status status = make_view(&s->coarse, s, ms_variational_start_step(target, s->wanted), err);
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
    const size_t all = count_with_images(s);
    return status == MS_OK && all < s->wanted ? add_to_cover(s, s->wanted - all, err) : status;
}

static ms_status begin_solver(solver *s, const ms_run *run, const ms_variational_settings *settings, size_t n,
                              ms_error *err)
{
    const int *across = settings->mirror.across;
    const ms_clump *given = settings->refine;
    const size_t most = n < run->target->voxels ? n : run->target->voxels; /* more would be alike */
    const size_t room = (size_t)ceil(SURPLUS * (double)most) + MORE;
    *s = (solver){
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
    ms_status status = given->n_spheres > 0 ? start_from_given(s, given, err) : start_from_cover(s, err);
    if (status == MS_OK) {
        status = ms_signed_distance_open(&s->field, run->target,
                                         s->coarse.step < FIELD_STEP ? s->coarse.step : FIELD_STEP, err);
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
    return status;
}

/* Adds spheres, fits, and drops those above the number that is wanted. */
static ms_status add_and_prune(solver *s, size_t more, ms_error *err)
{
    ms_status status = add_to_cover(s, more, err);
    if (status == MS_OK) {
        status = fit_spheres(s, DROP_STEPS, 0.8, 0.3, err);
    }
    if (status == MS_OK) {
        status = prune_surplus(s, err);
    }
    return status == MS_OK ? fit_spheres(s, LAST_STEPS, 0.5, 0.05, err) : status;
}

/* Splits spheres, and fits them and those about them. */
static ms_status split_and_settle(solver *s, size_t more, ms_error *err)
{
    const size_t before = s->count, room = s->room - before;
    uint8_t *moving = malloc(s->room);
    ms_status status = moving ? ms_split_worst(s->ball, &s->count, more < room ? more : room, &s->fit, err)
                              : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", s->room);
    if (status == MS_OK && !s->fit.bounds.equal) {
        ms_split_mark_near(moving, s->ball, s->count, before);
        s->fit.moving = moving;
    }
    if (status == MS_OK) {
        status = fit_spheres(s, DROP_STEPS, 0.8, 0.3, err);
    }
    if (status == MS_OK) {
        status = fit_spheres(s, LAST_STEPS, 0.5, 0.05, err);
    }
    s->fit.moving = NULL;
    free(moving);
    return status;
}

/* A change that is taken back where it makes the mismatch no smaller. */
static ms_status try_change(solver *s, ms_status (*change)(solver *, size_t, ms_error *), size_t more, ms_error *err)
{
    mismatch before = {0}, after = {0};
    const size_t count = s->count;
    ms_ball *kept = malloc((count + 1) * sizeof *kept);
    ms_status status =
        kept ? find_mismatch(&before, s, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    if (status == MS_OK) {
        memcpy(kept, s->ball, count * sizeof *kept);
        status = change(s, more, err);
    }
    if (status == MS_OK) {
        status = search_within_bounds(s, err);
    }
    if (status == MS_OK) {
        status = find_mismatch(&after, s, err);
    }
    if (status == MS_OK && !is_improved(s, &after, &before)) {
        memcpy(s->ball, kept, count * sizeof *kept);
        s->count = count;
    }
    free(kept);
    return status;
}

/* Puts idle spheres where the union leaves most, and drops those that are idle there, too. Where the surfaces are close
 * everywhere, no inscribed sphere covers what is left: those that bear most of it are split. */
static ms_status replace_idle(solver *s, ms_error *err)
{
    const int *across = s->settings->mirror.across;
    const int splits = s->field.cubic && !(across[0] || across[1] || across[2]);
    ms_status status = ms_prune_idle(s->ball, &s->count, &s->fit, err);
    for (int round = 0; round < REPAIRS && status == MS_OK && count_with_images(s) < s->wanted; round++) {
        status = try_change(s, splits ? split_and_settle : add_and_prune, s->wanted - count_with_images(s), err);
        if (status == MS_OK) {
            status = ms_prune_idle(s->ball, &s->count, &s->fit, err);
        }
    }
    return status;
}

/* All stages. */
static ms_status run_stages(solver *s, ms_error *err)
{
    ms_status status = MS_OK;
    const double surplus = (double)count_with_images(s) - (double)s->wanted;
    s->planned = count_steps(s, surplus);
    if (surplus > 0) {
        status = fit_spheres(s, START_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = sharpen_field(s, err);
    }
    if (status == MS_OK) {
        status = prune_surplus(s, err);
    }
    if (status == MS_OK) {
        status = improve_fit(s, LONG_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = sharpen_field(s, err);
    }
    if (status == MS_OK) {
        status = improve_fit(s, LAST_STEPS, 0.5, 0.05, err);
    }
    if (status == MS_OK) {
        status = search_within_bounds(s, err);
    }
    for (int round = 0; round < s->settings->rounds && status == MS_OK && s->count > 0; round++) {
        status = try_change(s, add_and_prune, (size_t)ceil(ADD[round % ADDS] * (double)s->wanted), err);
    }
    return status == MS_OK ? replace_idle(s, err) : status;
}

/* Large spheres instead where inscribed ones are hopeless, if they are better. */
static ms_status try_bulk(solver *s, ms_error *err)
{
    double dice;
    ms_coarse_view volume = {0};
    ms_status status = ms_bulk_dice(&dice, s->ball, s->count, &s->fit, err);
    if (status != MS_OK || dice < HOPELESS) {
        return status;
    }
    status = make_view(&volume, s, s->coarse.step, err);
    if (status == MS_OK) {
        ms_coarse_view_keep_upper(&volume, &s->settings->mirror);
        const ms_bulk_other other = {s->given, s->n_given, &volume, s->wanted};
        status = ms_bulk_improve(s->ball, &s->count, s->room, dice, &other, &s->fit, err);
    }
    ms_coarse_view_free(&volume);
    return status;
}

ms_status ms_variational_solve(ms_ball **ball, size_t *count, const ms_run *run,
                               const ms_variational_settings *settings, size_t n, ms_error *err)
{
    solver s;
    *ball = NULL;
    *count = 0;
    ms_generator_stage(run, "first spheres", (double)NAN);
    ms_status status = begin_solver(&s, run, settings, n, err);
    if (status == MS_OK) {
        status = run_stages(&s, err);
    }
    if (status == MS_OK) {
        status = try_bulk(&s, err);
    }
    if (status == MS_OK) {
        *count = expand_images(&s);
        *ball = s.all;
        s.all = NULL;
    }
    free_solver(&s);
    return status;
}
