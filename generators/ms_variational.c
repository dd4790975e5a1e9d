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
#include "ms_variational_start.h"

enum { POINTS, PROTRUSION, EQUAL_RADIUS };

static const ms_option OPTIONS[] = {
    [POINTS] = {"points", MS_OPTION_INTEGER, 192, 16, 4096, NULL, NULL, "places on each sphere where it is fitted"},
    [PROTRUSION] = {"protrusion", MS_OPTION_REAL, -1, -1, 1e6, NULL, "voxels",
                    "no sphere sticks out of the shape by more; 0: inscribed; below 0: no bound"},
    [EQUAL_RADIUS] = {"equal-radius", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL, "all spheres of one radius"},
    {0},
};

/* Spheres at the start for each one that is asked for. */
static const double SURPLUS = 1.5;

/* Part of the surplus that is dropped at a time. */
static const double DROP = 0.1;

/* Radii that become smaller, in voxels, say nothing about the shape. */
static const double LEAST_RADIUS = 0.5;

/* Coarse voxels per edge of the cube that is a sphere's share of the volume, about. */
static const double RESOLUTION = 6;

enum { MAX_STEP = 4, START_STEPS = 40, DROP_STEPS = 5, COARSE_STEPS = 100, FINE_STEPS = 60 };

/* A run for one number of spheres. */
typedef struct solver {
    const ms_run *run;
    ms_grid coarse;
    int step;
    ms_field field;
    exposed_fit fit;
    size_t count;
    ms_ball *ball; /* in voxels of the target's grid */
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
    memset(s, 0, sizeof *s);
}

/* Begins with a field, a coarse grid, and enough spheres; a finer grid where it gives too few. */
static ms_status begin(solver *s, const ms_run *run, size_t n, ms_error *err)
{
    const double least = run->stop.radius / run->target->grid.h;
    const size_t wanted = (size_t)ceil(SURPLUS * (double)n);
    ms_status status = MS_OK;
    *s = (solver){.run = run, .step = choose_step(run->target, n)};
    for (;; s->step--) {
        status = start_coarsen(&s->coarse, run->target, s->step, err);
        if (status == MS_OK) {
            status = start_cover(&s->ball, &s->count, run->target, &s->coarse, s->step, wanted, fmax(0, least), err);
        }
        if (status != MS_OK || s->count == wanted || s->step == 1) {
            break;
        }
        free(s->ball);
        s->ball = NULL;
        ms_grid_free(&s->coarse);
    }
    if (status == MS_OK) {
        status = ms_field_alloc(&s->field, run->target, s->step, err);
    }
    const double protrusion = option(run, PROTRUSION);
    s->fit = (exposed_fit){.field = &s->field,
                           .bounds = {.least = fmax(least, LEAST_RADIUS),
                                      .protrusion = protrusion < 0 ? HUGE_VAL : protrusion,
                                      .equal = option(run, EQUAL_RADIUS) != 0},
                           .points = (int)option(run, POINTS),
                           .seed = run->seed};
    return status;
}

static ms_status fit(solver *s, int steps, double from, double to, ms_error *err)
{
    const double damping[2] = {from, to};
    return exposed_fit_steps(&s->fit, s->ball, s->count, steps, damping, err);
}

static int overlap(const ms_ball *a, const ms_ball *b)
{
    const double reach = a->radius + b->radius;
    double square = 0;
    for (int c = 0; c < 3; c++) {
        square += (a->centre[c] - b->centre[c]) * (a->centre[c] - b->centre[c]);
    }
    return square < reach * reach;
}

/* The cheapest sphere that overlaps none of those dropped already: their losses have changed. */
static size_t cheapest(const ms_ball *ball, const int64_t *loss, size_t count, const ms_ball *dropped, size_t n_dropped)
{
    size_t best = SIZE_MAX;
    for (size_t b = 0; b < count; b++) {
        int touched = best != SIZE_MAX && loss[b] >= loss[best];
        for (size_t d = 0; d < n_dropped && !touched; d++) {
            touched = overlap(&ball[b], &dropped[d]);
        }
        if (!touched) {
            best = b;
        }
    }
    return best;
}

/* Drops up to `most` spheres, the least useful ones. */
static ms_status drop(solver *s, size_t most, ms_error *err)
{
    ms_ball *coarse = malloc((s->count + 1) * sizeof *coarse), *dropped = malloc((most + 1) * sizeof *dropped);
    int64_t *loss = malloc((s->count + 1) * sizeof *loss), mismatch;
    size_t n_dropped = 0, b;
    ms_status status = MS_OK;
    if (!coarse || !dropped || !loss) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", s->count);
    }
    for (size_t c = 0; status == MS_OK && c < s->count; c++) {
        coarse[c] = s->ball[c];
        for (int a = 0; a < 3; a++) {
            coarse[c].centre[a] /= s->step;
        }
        coarse[c].radius /= s->step;
    }
    if (status == MS_OK) {
        status = overlap_losses(loss, &mismatch, &s->coarse, coarse, s->count, err);
    }
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

static ms_status prune(solver *s, size_t n, ms_error *err)
{
    const size_t surplus = s->count > n ? s->count - n : 0;
    const size_t most = (size_t)ceil(DROP * (double)surplus);
    ms_status status = MS_OK;
    while (status == MS_OK && s->count > n) {
        status = drop(s, s->count - n < most ? s->count - n : most, err);
        if (status == MS_OK) {
            status = fit(s, DROP_STEPS, 0.5, 0.3, err);
        }
    }
    return status;
}

static ms_status solve(solver *s, const ms_run *run, size_t n, ms_error *err)
{
    ms_status status = begin(s, run, n, err);
    if (status == MS_OK) {
        status = fit(s, START_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = prune(s, n, err);
    }
    if (status == MS_OK) {
        status = fit(s, COARSE_STEPS, 0.8, 0.2, err);
    }
    if (status == MS_OK) {
        status = fit(s, FINE_STEPS, 0.5, 0.05, err);
    }
    return status;
}

static ms_status generate(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    solver s;
    ms_status status = solve(&s, run, run->stop.spheres, err);
    for (size_t b = 0; status == MS_OK && b < s.count; b++) {
        ms_sphere sphere;
        ms_target_from_voxels(sphere.centre, &sphere.radius, &run->target->grid, s.ball[b].centre, s.ball[b].radius);
        status = ms_clump_add(clump, &sphere, err);
    }
    *reason = MS_STOP_SPHERES;
    solver_free(&s);
    return status;
}

const ms_generator ms_generator_variational = {
    .name = "variational",
    .summary = "spheres fitted where they are exposed, so that the mismatch itself is least",
    .source = "this project",
    .nested = 0,
    .options = OPTIONS,
    .generate = generate,
};
