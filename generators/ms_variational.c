/*
 * Spheres that minimise what they are judged by, the mismatch |S xor U| (MSS eq. 2): start from a
 * greedy cover with more spheres than asked for, fit their exposed surfaces to the target's, drop the
 * least useful ones, fit again. docs/methods/variational.md derives it.
 */
#include "ms_variational.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_exposed.h"
#include "ms_overlap.h"
#include "ms_pattern.h"
#include "ms_variational_start.h"
#include "ms_vector.h"

enum { EFFORT, POINTS, PROTRUSION, EQUAL_RADIUS, REFINE };

static const ms_option OPTIONS[] = {
    [EFFORT] = {"effort", MS_OPTION_INTEGER, 0, 0, 3, NULL, NULL,
                "rounds of adding spheres and dropping the least useful ones after the fit: none, 5, 20, 80"},
    [POINTS] = {"points", MS_OPTION_INTEGER, 192, 16, 4096, NULL, NULL, "places on each sphere where it is fitted"},
    [PROTRUSION] = {"protrusion", MS_OPTION_REAL, -1, -1, 1e6, NULL, "voxels",
                    "no sphere sticks out of the shape by more; 0: inscribed; below 0: no bound"},
    [EQUAL_RADIUS] = {"equal-radius", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL, "all spheres of one radius"},
    [REFINE] = {"refine", MS_OPTION_CLUMP, 0, 0, 0, NULL, NULL,
                "spheres to start from, of any method: a file as mskit score reads it"},
    {0},
};

/* Spheres at the start: so many times those asked for, and some more. */
static const double SURPLUS = 1.25;
enum { MORE = 2 };

/* Part of the surplus that is dropped at a time, and part of the spheres that a round adds. */
static const double DROP = 0.1;

/* Radii that become smaller, in voxels, say nothing about the shape. */
static const double LEAST_RADIUS = 0.5;

/* Coarse voxels per edge of the cube that is a sphere's share of the volume, about. */
static const double RESOLUTION = 8;

/* Of the coarse grid and of the field at most, in voxels. */
enum { MAX_STEP = 4, FIELD_STEP = 2 };

/* Of the fits, and of the search within bounds. */
enum { START_STEPS = 40, DROP_STEPS = 10, LONG_STEPS = 100, LAST_STEPS = 60, SEARCH_ROUNDS = 20 };

static const int ROUNDS[] = {0, 5, 20, 80};

/* A run for one number of spheres. */
typedef struct solver {
    const ms_run *run;
    ms_grid coarse;
    int step; /* of the coarse grid, in voxels */
    ms_field field;
    exposed_fit fit;
    size_t count, wanted;
    ms_ball *ball, *best; /* in voxels of the target's grid; room for `room` */
    size_t room;
} solver;

static double option(const ms_run *run, int which)
{
    return run->settings->value[which];
}

/* How much coarser the start may be: its voxels follow the size of spheres and of the shape. */
static int choose_step(const ms_target *target, size_t n)
{
    const size_t voxels = ms_grid_voxels(&target->grid);
    double deepest = 0;
    for (size_t v = 0; v < voxels; v++) {
        deepest = fmax(deepest, (double)target->distance[v]);
    }
    const double step = fmin(cbrt((double)target->voxels / (double)n) / RESOLUTION, deepest / 4);
    return (int)fmin(fmax(step, 1), MAX_STEP);
}

static void solver_free(solver *s)
{
    ms_grid_free(&s->coarse);
    ms_field_free(&s->field);
    free(s->ball);
    free(s->best);
    memset(s, 0, sizeof *s);
}

static double least_radius(const ms_run *run)
{
    return fmax(0, run->stop.radius / run->target->grid.h);
}

static ms_status fit(solver *s, int steps, double from, double to, ms_error *err)
{
    const double damping[2] = {from, to};
    return exposed_fit_steps(&s->fit, s->ball, s->count, steps, damping, err);
}

static ms_status mismatch(int64_t *out, const solver *s, ms_error *err)
{
    overlap o;
    const ms_status status = overlap_open(&o, &s->run->target->grid, s->ball, s->count, err);
    *out = o.mismatch;
    overlap_close(&o);
    return status;
}

static int is_bounded(const solver *s)
{
    return s->fit.bounds.protrusion < HUGE_VAL;
}

/* A fit that is taken back where it makes the mismatch larger. Of spheres that may not stick out, the
 * mismatch says nothing before they are confined. */
static ms_status improve(solver *s, int steps, double from, double to, ms_error *err)
{
    int64_t before = 0, after = 0;
    if (is_bounded(s)) {
        return fit(s, steps, from, to, err);
    }
    memcpy(s->best, s->ball, s->count * sizeof *s->ball);
    ms_status status = mismatch(&before, s, err);
    if (status == MS_OK) {
        status = fit(s, steps, from, to, err);
    }
    if (status == MS_OK) {
        status = mismatch(&after, s, err);
    }
    if (status == MS_OK && after >= before) {
        memcpy(s->ball, s->best, s->count * sizeof *s->ball);
    }
    return status;
}

/* Makes the spheres keep to their bounds, and moves them within. */
static ms_status settle(solver *s, ms_error *err)
{
    if (!is_bounded(s)) {
        return MS_OK;
    }
    exposed_confine(&s->fit, s->ball, s->count);
    return pattern_search(s->ball, s->count, &s->run->target->grid, &s->fit, SEARCH_ROUNDS, err);
}

static int do_overlap(const ms_ball *a, const ms_ball *b)
{
    const double reach = a->radius + b->radius;
    return ms_squared_distance(a->centre, b->centre) < reach * reach;
}

/* The cheapest sphere that overlaps none of those dropped already: their losses have changed. */
static size_t cheapest(const ms_ball *ball, const int64_t *loss, size_t count, const ms_ball *dropped, size_t n_dropped)
{
    size_t best = SIZE_MAX;
    for (size_t b = 0; b < count; b++) {
        int passed = best != SIZE_MAX && loss[b] >= loss[best];
        for (size_t d = 0; d < n_dropped && !passed; d++) {
            passed = do_overlap(&ball[b], &dropped[d]);
        }
        if (!passed) {
            best = b;
        }
    }
    return best;
}

/* The spheres in voxels of the coarse grid. */
static void to_coarse(ms_ball *coarse, const solver *s)
{
    for (size_t b = 0; b < s->count; b++) {
        coarse[b] = s->ball[b];
        for (int a = 0; a < 3; a++) {
            coarse[b].centre[a] /= s->step;
        }
        coarse[b].radius /= s->step;
    }
}

/* What the mismatch would grow by without each sphere, on the coarse grid. */
static ms_status find_losses(int64_t *loss, ms_ball *coarse, const solver *s, ms_error *err)
{
    overlap o;
    to_coarse(coarse, s);
    const ms_status status = overlap_open(&o, &s->coarse, coarse, s->count, err);
#pragma omp parallel for schedule(dynamic, 4) if (status == MS_OK)
    for (size_t b = 0; b < (status == MS_OK ? s->count : 0); b++) {
        loss[b] = overlap_loss(&o, &coarse[b]);
    }
    overlap_close(&o);
    return status;
}

/* Drops up to `most` spheres, the least useful ones: at least one. */
static ms_status drop(solver *s, size_t most, ms_error *err)
{
    ms_ball *coarse = malloc((s->count + 1) * sizeof *coarse), *dropped = malloc((most + 1) * sizeof *dropped);
    int64_t *loss = malloc((s->count + 1) * sizeof *loss);
    size_t n_dropped = 0, b;
    ms_status status = coarse && dropped && loss
                           ? find_losses(loss, coarse, s, err)
                           : ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", s->count);
    while (status == MS_OK && n_dropped < most &&
           (b = cheapest(s->ball, loss, s->count, dropped, n_dropped)) != SIZE_MAX) {
        dropped[n_dropped++] = s->ball[b];
        s->ball[b] = s->ball[--s->count];
        loss[b] = loss[s->count];
    }
    free(coarse);
    free(dropped);
    free(loss);
    return status;
}

static ms_status prune(solver *s, ms_error *err)
{
    const size_t surplus = s->count > s->wanted ? s->count - s->wanted : 0, most = (size_t)ceil(DROP * (double)surplus);
    ms_status status = MS_OK;
    while (status == MS_OK && s->count > s->wanted) {
        status = drop(s, s->count - s->wanted < most ? s->count - s->wanted : most, err);
        if (status == MS_OK) {
            status = fit(s, DROP_STEPS, 0.5, 0.3, err);
        }
        if (s->run->progress) {
            s->run->progress(s->run->progress_context, s->count, (double)NAN);
        }
    }
    return status;
}

/* Adds up to `most` of the inscribed spheres that cover most of what the union leaves. */
static ms_status add(solver *s, size_t most, ms_error *err)
{
    const size_t free_room = s->room - s->count;
    ms_ball *coarse = malloc((s->count + 1) * sizeof *coarse);
    ms_grid left = {0};
    size_t added = 0;
    ms_status status = start_coarsen(&left, s->run->target, s->step, err);
    if (status == MS_OK && !coarse) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", s->count);
    }
    if (status == MS_OK) {
        to_coarse(coarse, s);
        overlap_clear(&left, coarse, s->count);
        status = start_cover(s->ball + s->count, &added, s->run->target, &left, s->step,
                             most < free_room ? most : free_room, least_radius(s->run), err);
    }
    s->count += added;
    ms_grid_free(&left);
    free(coarse);
    return status;
}

/* The cover to start from; on a finer grid where it gives too few spheres. */
static ms_status start(solver *s, ms_error *err)
{
    const ms_target *target = s->run->target;
    ms_status status = MS_OK;
    for (s->step = choose_step(target, s->wanted);; s->step--) {
        status = start_coarsen(&s->coarse, target, s->step, err);
        if (status == MS_OK) {
            status = start_cover(s->ball, &s->count, target, &s->coarse, s->step, s->room, least_radius(s->run), err);
        }
        if (status != MS_OK || s->count == s->room || s->step == 1) {
            return status;
        }
        ms_grid_free(&s->coarse);
    }
}

/* Spheres that are given, and others where they are too few. */
static ms_status start_from(solver *s, const ms_clump *given, ms_error *err)
{
    const ms_target *target = s->run->target;
    s->step = choose_step(target, s->wanted);
    ms_status status = start_coarsen(&s->coarse, target, s->step, err);
    for (s->count = 0; s->count < given->n_spheres; s->count++) {
        const ms_sphere *sphere = &given->sphere[s->count];
        ms_target_to_voxels(s->ball[s->count].centre, &s->ball[s->count].radius, &target->grid, sphere->centre,
                            sphere->radius);
    }
    return status == MS_OK && s->count < s->wanted ? add(s, s->wanted - s->count, err) : status;
}

static ms_status solver_begin(solver *s, const ms_run *run, size_t n, ms_error *err)
{
    const double protrusion = option(run, PROTRUSION);
    const ms_clump *given = &run->settings->clump;
    const size_t most = n < run->target->voxels ? n : run->target->voxels; /* more would be alike */
    const size_t room = (size_t)ceil(SURPLUS * (double)most) + MORE;
    *s = (solver){.run = run, .wanted = n, .room = room > given->n_spheres ? room : given->n_spheres};
    s->ball = malloc(s->room * sizeof *s->ball);
    s->best = malloc(s->room * sizeof *s->best);
    if (!s->ball || !s->best) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", s->room);
    }
    ms_status status = given->n_spheres > 0 ? start_from(s, given, err) : start(s, err);
    if (status == MS_OK) {
        status = ms_field_alloc(&s->field, run->target, s->step < FIELD_STEP ? s->step : FIELD_STEP, err);
    }
    s->fit = (exposed_fit){.field = &s->field,
                           .bounds = {.least = fmax(least_radius(run), LEAST_RADIUS),
                                      .protrusion = protrusion < 0 ? HUGE_VAL : protrusion,
                                      .equal = option(run, EQUAL_RADIUS) != 0},
                           .points = (int)option(run, POINTS),
                           .seed = run->seed};
    return status;
}

/* Adds spheres, drops as many; taken back where it makes the mismatch larger. */
static ms_status round_trip(solver *s, ms_error *err)
{
    int64_t before = 0, after = 0;
    const size_t count = s->count;
    ms_ball *kept = malloc((count + 1) * sizeof *kept);
    ms_status status =
        kept ? mismatch(&before, s, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    if (status == MS_OK) {
        memcpy(kept, s->ball, count * sizeof *kept);
        status = add(s, (size_t)ceil(DROP * (double)s->wanted), err);
    }
    if (status == MS_OK) {
        status = fit(s, DROP_STEPS, 0.8, 0.3, err);
    }
    if (status == MS_OK) {
        status = prune(s, err);
    }
    if (status == MS_OK) {
        status = fit(s, LAST_STEPS, 0.5, 0.05, err);
    }
    if (status == MS_OK) {
        status = settle(s, err);
    }
    if (status == MS_OK) {
        status = mismatch(&after, s, err);
    }
    if (status == MS_OK && after >= before) {
        memcpy(s->ball, kept, count * sizeof *kept);
        s->count = count;
    }
    free(kept);
    return status;
}

/* All stages, for up to n spheres. */
static ms_status solve(solver *s, const ms_run *run, size_t n, ms_error *err)
{
    ms_status status = solver_begin(s, run, n, err);
    if (status == MS_OK && s->count > s->wanted) {
        status = fit(s, START_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = prune(s, err);
    }
    if (status == MS_OK) {
        status = improve(s, LONG_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = improve(s, LAST_STEPS, 0.5, 0.05, err);
    }
    if (status == MS_OK) {
        status = settle(s, err);
    }
    for (int round = 0; round < ROUNDS[(int)option(run, EFFORT)] && status == MS_OK && s->count > 0; round++) {
        status = round_trip(s, err);
    }
    return status;
}

/* The spheres in the frame of the shape, but for those that their bounds leave nothing of. */
static ms_status to_clump(ms_clump *clump, const solver *s, ms_error *err)
{
    const ms_run *run = s->run;
    const double least = fmax(run->stop.radius, 0);
    clump->n_spheres = 0;
    for (size_t b = 0; b < s->count; b++) {
        ms_sphere sphere;
        ms_target_from_voxels(sphere.centre, &sphere.radius, &run->target->grid, s->ball[b].centre, s->ball[b].radius);
        if (fabs(sphere.radius - least) < 1e-12 * least) {
            sphere.radius = least;
        }
        if (!(sphere.radius > 0) || sphere.radius < least) {
            continue;
        }
        ms_status status = ms_clump_add(clump, &sphere, err);
        if (status != MS_OK) {
            return status;
        }
    }
    return MS_OK;
}

/* Why the spheres are enough; MS_STOP_NOT if more are needed. */
static ms_status judge(ms_stop_reason *reason, const ms_clump *clump, size_t asked, const ms_run *run, ms_error *err)
{
    ms_raster raster;
    ms_tally sum = {0};
    ms_status status = ms_raster_alloc(&raster, &run->target->grid, run->target->rule, err);
    for (size_t s = 0; status == MS_OK && s < clump->n_spheres; s++) {
        ms_ball ball;
        ms_target_to_voxels(ball.centre, &ball.radius, &run->target->grid, clump->sphere[s].centre,
                            clump->sphere[s].radius);
        status = ms_raster_add(&raster, &ball, 1, err);
    }
    for (size_t b = 0; status == MS_OK && b < raster.n_balls; b++) {
        ms_tally_add(&sum, &raster.tally[b]);
    }
    if (status == MS_OK) {
        *reason = clump->n_spheres > 0 ? ms_stop_reached(&run->stop, run->target, &sum, clump->n_spheres) : MS_STOP_NOT;
        if (*reason == MS_STOP_NOT && clump->n_spheres < asked) {
            *reason = run->stop.radius > 0 ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
        }
        if (run->progress && clump->n_spheres > 0) {
            run->progress(run->progress_context, clump->n_spheres, ms_score_of(&sum, run->target->voxels).dice);
        }
    }
    ms_raster_free(&raster);
    return status;
}

static ms_status generate_for(ms_clump *clump, ms_stop_reason *reason, size_t n, const ms_run *run, ms_error *err)
{
    solver s;
    ms_status status = solve(&s, run, n, err);
    if (status == MS_OK) {
        status = to_clump(clump, &s, err);
    }
    if (status == MS_OK) {
        status = judge(reason, clump, n, run, err);
    }
    solver_free(&s);
    return status;
}

/* Whether a measure, and not only numbers and radii, has to be reached. */
static int has_measure(const ms_stop *stop)
{
    return stop->eta >= 0 || stop->dice >= 0 || stop->coverage >= 0 || stop->inertia >= 0;
}

static int is_measure(ms_stop_reason reason)
{
    return reason != MS_STOP_SPHERES && reason != MS_STOP_RADIUS && reason != MS_STOP_EXHAUSTED;
}

/* The number of spheres is sought: doubled until enough, then between the last two by halves. Each
 * is a run of its own, since the best n spheres are not among the best n + 1. */
static ms_status search(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const size_t most = run->stop.spheres > 0 ? run->stop.spheres : MS_CLUMP_MAX_SPHERES;
    size_t few = 0, enough = 1;
    ms_status status = generate_for(clump, reason, enough, run, err);
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        few = enough;
        enough = 2 * enough < most ? 2 * enough : most;
        status = generate_for(clump, reason, enough, run, err);
        if (enough == most && *reason == MS_STOP_NOT) {
            *reason = MS_STOP_SPHERES;
        }
    }
    while (status == MS_OK && is_measure(*reason) && enough - few > 1) {
        const size_t middle = few + (enough - few) / 2;
        ms_clump fewer = {0};
        ms_stop_reason why;
        status = generate_for(&fewer, &why, middle, run, err);
        if (status == MS_OK && why == *reason) {
            const ms_clump swap = *clump;
            *clump = fewer;
            fewer = swap;
            enough = middle;
        } else {
            few = middle;
        }
        ms_clump_free(&fewer);
    }
    return status;
}

static ms_status generate(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const size_t most = run->stop.spheres > 0 ? run->stop.spheres : MS_CLUMP_MAX_SPHERES;
    return has_measure(&run->stop) ? search(clump, reason, run, err) : generate_for(clump, reason, most, run, err);
}

const ms_generator ms_generator_variational = {
    .name = "variational",
    .summary = "spheres fitted to the surface where they are exposed, so that the mismatch itself is least",
    .source = "mskit (2026); objective: Buchele et al., MSS eq. 2",
    .nested = 0,
    .options = OPTIONS,
    .generate = generate,
};
