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
#include "ms_variational_solver.h"
#include "ms_volume_hold.h"

/* Part of the surplus that is dropped at a time: what goes at once is chosen without knowing of the rest. */
static const double DROP = 0.1;

/* Part of the spheres that a round adds, one round after the other: what one cannot better, another may. */
static const double ADD[] = {0.1, 0.05, 0.2, 0.025};
enum { ADDS = sizeof ADD / sizeof *ADD };

/* D from which on inscribed spheres are a poor start. */
static const double HOPELESS = 0.2;

/* Mean distance between the surfaces of spheres and shape, in voxels, below which voxels are too coarse: the field is
 * looked up by cubic polynomials, and the mismatch is the one by the exposed surface. */
static const double FINE = 0.1;

/* Of the field at most, in voxels, where it is looked up so. */
enum { FINE_STEP = 2 };

/* Of the fits, and of the search within bounds: so many that more change little. */
enum { START_STEPS = 40, DROP_STEPS = 15, LONG_STEPS = 40, LAST_STEPS = 50, SEARCH_ROUNDS = 20 };

/* Of idle spheres: those put elsewhere may come to be idle there, too. */
enum { REPAIRS = 3 };

/* All steps that are sure to come: rounds may be fewer, idle spheres bring more. */
static double count_steps(const ms_variational_solver *s, double surplus)
{
    const double batches = surplus > 0 ? ceil(surplus / ceil(DROP * surplus)) : 0;
    return (surplus > 0 ? START_STEPS + DROP_STEPS * batches : 0) + LONG_STEPS + LAST_STEPS +
           s->settings->rounds * (DROP_STEPS + DROP_STEPS / DROP + LAST_STEPS);
}

/* A measure is sought by several runs, whose number is not known. */
static ms_status tell_share(const ms_variational_solver *s, ms_error *err)
{
    char text[48];
    const int is_sought = ms_stop_has_measure(&s->run->stop);
    snprintf(text, sizeof text, "fit of %zu spheres", ms_variational_solver_count(s));
    return ms_generator_stage(s->run, text, is_sought ? (double)NAN : fmin(s->steps / s->planned, 1), err);
}

static ms_status fit_spheres(ms_variational_solver *s, int steps, double from, double to, ms_error *err)
{
    const double damping[2] = {from, to};
    const ms_status status = tell_share(s, err);
    s->steps += steps;
    return status == MS_OK ? ms_surface_fit_steps(&s->fit, s->ball, s->count, steps, damping, err) : status;
}

/* |S xor U| in voxels, by their count and, where that is chance, by the exposed surface; both with the price of what of
 * the surface is too far. */
typedef struct mismatch {
    double count, surface;
    int is_fine; /* nonzero: so small that the count is chance. Else `surface` is not known */
} mismatch;

static int is_fine(const ms_variational_solver *s, double count)
{
    const ms_target *target = s->run->target;
    const double h = target->grid.h;
    return ms_signed_distance_is_exact(&s->field) && count < FINE * ms_mesh_area(target->mesh) / (h * h);
}

static ms_status find_mismatch(mismatch *out, ms_variational_solver *s, ms_error *err)
{
    ms_coverage_count o;
    ms_status status = ms_coverage_count_open(&o, &s->run->target->grid, s->all, ms_variational_solver_expand(s), err);
    const double excess = s->fit.gap ? MS_GAP_PRICE * ms_gap_excess(s->fit.gap, s->ball, s->count) : 0;
    *out = (mismatch){.count = (double)o.mismatch + excess};
    ms_coverage_count_close(&o);
    out->is_fine = is_fine(s, out->count);
    if (status == MS_OK && out->is_fine) {
        status = ms_surface_tally(NULL, &out->surface, NULL, &s->fit, s->ball, s->count, err);
        out->surface += excess;
    }
    return status;
}

static int is_improved(const mismatch *after, const mismatch *before)
{
    return before->is_fine ? after->is_fine && after->surface < before->surface : after->count < before->count;
}

/* A fit that is taken back where it makes the mismatch, known before and after, larger. Of spheres that may not stick
 * out, the mismatch says nothing before they are confined. */
static ms_status improve_fit(ms_variational_solver *s, mismatch *now, int steps, double from, double to, ms_error *err)
{
    mismatch after = {0};
    memcpy(s->best, s->ball, s->count * sizeof *s->ball);
    ms_status status = fit_spheres(s, steps, from, to, err);
    if (status == MS_OK) {
        status = find_mismatch(&after, s, err);
    }
    if (status == MS_OK && (ms_bounds_are_set(&s->fit.bounds) || is_improved(&after, now))) {
        *now = after;
    } else {
        memcpy(s->ball, s->best, s->count * sizeof *s->ball);
    }
    return status;
}

/* For spheres that fit so well that the error of a linear look-up would show: the mismatch is looked at anew. Which
 * spheres are dropped before, it does not change. */
static ms_status sharpen_field(ms_variational_solver *s, mismatch *now, ms_error *err)
{
    if (s->field.cubic || !now->is_fine) {
        return MS_OK;
    }
    const ms_status status =
        s->field.step > FINE_STEP ? ms_signed_distance_open(&s->field, s->run->target, FINE_STEP, err) : MS_OK;
    s->field.cubic = 1;
    return status == MS_OK ? find_mismatch(now, s, err) : status;
}

/* Makes the spheres keep to their bounds, and moves them within. */
static ms_status search_within_bounds(ms_variational_solver *s, ms_error *err)
{
    if (!ms_bounds_are_set(&s->fit.bounds)) {
        return MS_OK;
    }
    ms_bounds_confine(&s->fit.bounds, &s->field, s->ball, s->count);
    return ms_pattern_search(s->ball, s->count, &s->run->target->grid, &s->fit, SEARCH_ROUNDS, err);
}

static ms_status prune_surplus(ms_variational_solver *s, ms_error *err)
{
    size_t count = ms_variational_solver_count(s);
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
        count = ms_variational_solver_count(s);
    }
    return status;
}

/* Adds spheres, fits, and drops those above the number that is wanted. */
static ms_status add_and_prune(ms_variational_solver *s, size_t more, ms_error *err)
{
    ms_status status = ms_variational_solver_add_cover(s, more, err);
    if (status == MS_OK) {
        status = fit_spheres(s, DROP_STEPS, 0.8, 0.3, err);
    }
    if (status == MS_OK) {
        status = prune_surplus(s, err);
    }
    return status == MS_OK ? fit_spheres(s, LAST_STEPS, 0.5, 0.05, err) : status;
}

/* Splits spheres, and fits them and those about them. */
static ms_status split_and_settle(ms_variational_solver *s, size_t more, ms_error *err)
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
static ms_status try_change(ms_variational_solver *s, ms_status (*change)(ms_variational_solver *, size_t, ms_error *),
                            size_t more, ms_error *err)
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
    if (status == MS_OK && !is_improved(&after, &before)) {
        memcpy(s->ball, kept, count * sizeof *kept);
        s->count = count;
    }
    free(kept);
    return status;
}

/* Puts idle spheres where the union leaves most, and drops those that are idle there, too. Where the surfaces are close
 * everywhere, no inscribed sphere covers what is left: those that bear most of it are split. */
static ms_status replace_idle(ms_variational_solver *s, ms_error *err)
{
    const int *across = s->settings->mirror.across;
    const int splits = s->field.cubic && !(across[0] || across[1] || across[2]);
    ms_status status = ms_prune_idle(s->ball, &s->count, &s->fit, err);
    for (int round = 0; round < REPAIRS && status == MS_OK && ms_variational_solver_count(s) < s->wanted; round++) {
        status =
            try_change(s, splits ? split_and_settle : add_and_prune, s->wanted - ms_variational_solver_count(s), err);
        if (status == MS_OK) {
            status = ms_prune_idle(s->ball, &s->count, &s->fit, err);
        }
    }
    return status;
}

/* The last fits, all of them with as many spheres as are wanted. */
static ms_status settle_spheres(ms_variational_solver *s, ms_error *err)
{
    mismatch now = {0};
    ms_status status = find_mismatch(&now, s, err);
    if (status == MS_OK) {
        status = sharpen_field(s, &now, err);
    }
    if (status == MS_OK) {
        status = improve_fit(s, &now, LONG_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = sharpen_field(s, &now, err);
    }
    return status == MS_OK ? improve_fit(s, &now, LAST_STEPS, 0.5, 0.05, err) : status;
}

/* All stages. */
static ms_status run_stages(ms_variational_solver *s, ms_error *err)
{
    ms_status status = MS_OK;
    const double surplus = (double)ms_variational_solver_count(s) - (double)s->wanted;
    s->planned = count_steps(s, surplus);
    if (surplus > 0) {
        status = fit_spheres(s, START_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = prune_surplus(s, err);
    }
    if (status == MS_OK) {
        status = settle_spheres(s, err);
    }
    if (status == MS_OK) {
        status = search_within_bounds(s, err);
    }
    for (int round = 0; round < s->settings->rounds && status == MS_OK && s->count > 0; round++) {
        status = try_change(s, add_and_prune, (size_t)ceil(ADD[round % ADDS] * (double)s->wanted), err);
    }
    return status == MS_OK ? replace_idle(s, err) : status;
}

/* Large spheres instead where inscribed ones are hopeless or the surface may not be far, if they are better. */
static ms_status try_bulk(ms_variational_solver *s, ms_error *err)
{
    double dice;
    ms_coarse_view volume = {0};
    const ms_target *target = s->run->target;
    if (s->fit.bounds.least > ms_target_equivalent_radius(target) / target->grid.h) {
        return MS_OK; /* none as large stands for the shape */
    }
    ms_status status = ms_bulk_dice(&dice, s->ball, s->count, &s->fit, err);
    if (status != MS_OK || (dice < HOPELESS && !s->fit.gap && !s->settings->connected)) {
        return status;
    }
    s->fit.connected = s->settings->connected; /* earlier, pieces that are to go would pull others away */
    status = ms_variational_solver_view(&volume, s, s->coarse.step, err);
    if (status == MS_OK) {
        ms_coarse_view_keep_upper(&volume, &s->settings->mirror);
        const ms_bulk_other other = {s->given, s->n_given, &volume, s->wanted};
        status = ms_bulk_improve(s->ball, &s->count, s->room, &other, &s->fit, err);
    }
    ms_coarse_view_free(&volume);
    return status;
}

ms_status ms_variational_solve(ms_ball **ball, size_t *count, const ms_run *run,
                               const ms_variational_settings *settings, size_t n, ms_error *err)
{
    ms_variational_solver s;
    *ball = NULL;
    *count = 0;
    ms_status status = ms_generator_stage(run, "first spheres", (double)NAN, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_variational_solver_begin(&s, run, settings, n, err);
    if (status == MS_OK) {
        status = run_stages(&s, err);
    }
    if (status == MS_OK) {
        status = try_bulk(&s, err);
    }
    if (status == MS_OK && settings->hold_volume) {
        status = ms_volume_hold(s.ball, s.count, &s.fit, run, err);
    }
    if (status == MS_OK) {
        *count = ms_variational_solver_expand(&s);
        *ball = s.all;
        s.all = NULL;
    }
    ms_variational_solver_free(&s);
    return status;
}
