#include "ms_scene.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_expectation.h"
#include "cli/ms_progress.h"
#include "cli/ms_report.h"
#include "clump/ms_equal_volume.h"
#include "ms_curve.h"
#include "queue/ms_queue.h"

const ms_clump *ms_scene_clump(const ms_scene_shape *shape)
{
    return &shape->clump[shape->chosen - 1];
}

const ms_score *ms_scene_score(const ms_scene_shape *shape)
{
    return &shape->score[shape->chosen - 1];
}

double ms_scene_gain(const ms_scene_shape *shape)
{
    return shape->chosen > 1 ? shape->dice[shape->chosen - 2] - shape->dice[shape->chosen - 1] : (double)NAN;
}

ms_share ms_scene_share(const ms_scene_shape *shape)
{
    return (ms_share){shape->row->particles, shape->most, shape->dice};
}

const ms_scene_shape *ms_scene_smallest(const ms_scene *scene)
{
    const ms_scene_shape *smallest = &scene->shape[0];
    for (size_t s = 1; s < scene->count; s++) {
        if (ms_clump_smallest_radius(ms_scene_clump(&scene->shape[s])) <
            ms_clump_smallest_radius(ms_scene_clump(smallest))) {
            smallest = &scene->shape[s];
        }
    }
    return smallest;
}

static double tolerance_of(const ms_scene_shape *shape, const ms_goal *goal)
{
    return isnan(shape->row->tolerance) ? goal->value : shape->row->tolerance;
}

/* The least number of spheres that reaches a tolerance. */
static ms_status choose_by_tolerance(ms_scene_shape *shape, const ms_goal *goal, ms_error *err)
{
    const double value = tolerance_of(shape, goal);
    double best = (double)NAN;
    for (size_t n = 1; n <= shape->most; n++) {
        if (shape->clump[n - 1].n_spheres == 0) { /* not run */
            continue;
        }
        const double have = goal->measure->of_score(&shape->score[n - 1]);
        if (ms_measure_is_reached(goal->measure, have, value)) {
            shape->chosen = n;
            return MS_OK;
        }
        best = goal->measure->better == MS_BETTER_MORE ? fmax(best, have) : fmin(best, have);
    }
    return ms_fail(err, MS_ERR_LIMIT,
                   "%s: no template of up to %zu spheres has %s %.6g, the best has %.6g; raise --max-spheres, use more "
                   "cells or another method, or ease the tolerance",
                   shape->row->path, shape->most, goal->measure->name, value, best);
}

static ms_status choose_by_knee(ms_scene_shape *shape, const ms_goal *goal, ms_error *err)
{
    const ms_share share = ms_scene_share(shape);
    shape->chosen = ms_allocate_knee(&share, goal->value);
    return shape->chosen > 0
               ? MS_OK
               : ms_fail(err, MS_ERR_LIMIT,
                         "%s: up to the last of %zu spheres each takes away %.6g of D or more; raise --max-spheres or "
                         "the part",
                         shape->row->path, shape->most, goal->value);
}

/* What the goal says of a shape alone. */
static ms_status choose_alone(ms_scene_shape *shape, const ms_goal *goal, ms_error *err)
{
    if (goal->kind == MS_GOAL_TOLERANCE) {
        return choose_by_tolerance(shape, goal, err);
    }
    return goal->kind == MS_GOAL_KNEE ? choose_by_knee(shape, goal, err) : MS_OK;
}

/* Where a method gave fewer spheres than asked for, the better of both clumps stands at their number. */
static void choose_numbers(ms_scene_shape *shape)
{
    for (size_t n = shape->most; n >= 1; n--) {
        const size_t have = shape->clump[n - 1].n_spheres;
        if (have < n && shape->score[n - 1].dice < shape->score[have - 1].dice) {
            const ms_clump clump = shape->clump[n - 1];
            const ms_score score = shape->score[n - 1];
            const ms_error remarks = shape->remarks[n - 1];
            shape->clump[n - 1] = shape->clump[have - 1];
            shape->score[n - 1] = shape->score[have - 1];
            shape->remarks[n - 1] = shape->remarks[have - 1];
            shape->clump[have - 1] = clump;
            shape->score[have - 1] = score;
            shape->remarks[have - 1] = remarks;
        }
    }
    for (size_t n = 0; n < shape->most; n++) {
        shape->dice[n] = shape->score[n].dice;
    }
}

static ms_status make_room(ms_scene_shape *shape, size_t count, ms_error *err)
{
    shape->clump = calloc(count, sizeof *shape->clump);
    shape->score = calloc(count, sizeof *shape->score);
    shape->dice = calloc(count, sizeof *shape->dice);
    shape->remarks = calloc(count, sizeof *shape->remarks);
    if (!shape->clump || !shape->score || !shape->dice || !shape->remarks) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu templates", count);
    }
    shape->most = count;
    return MS_OK;
}

/* Scales each template to the volume of the shape, and judges it anew. */
static ms_status scale_templates(ms_scene_shape *shape, const ms_target *target, size_t max_voxels, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t n = 0; n < shape->most && status == MS_OK; n++) {
        ms_equal_volume ignored;
        ms_metrics metrics;
        status = ms_equal_volume_scale(&shape->clump[n], &ignored, &shape->body, err);
        if (status == MS_OK) {
            status = ms_metrics_compute_kinds(&metrics, NULL, 0, target, &shape->clump[n], max_voxels, err);
        }
        if (status == MS_OK) {
            shape->score[n] = metrics.score;
        }
    }
    return status;
}

/* @param remarks on the clump: prefixes of one share them, and other templates have their own */
static ms_status make_curve(ms_scene_shape *shape, const ms_clump *clump, const ms_error *remarks, const ms_run *run,
                            const ms_scene_run *how, ms_error *err)
{
    const ms_generator *generator = how->recipe->generator;
    const size_t max_voxels = ms_input_max_voxels(how->input);
    ms_status status = make_room(shape, clump->n_spheres, err);
    const size_t most = status == MS_OK ? shape->most : 0;
    for (size_t n = ms_generator_is_nested(generator, run->settings) ? 1 : most; n > 0 && n <= most; n++) {
        shape->remarks[n - 1] = *remarks;
    }
    if (status == MS_OK) {
        status = ms_curve_clumps(shape->score, shape->clump, shape->remarks, clump, generator, run, max_voxels, err);
    }
    if (status == MS_OK && how->equal_volume) {
        status = scale_templates(shape, run->target, max_voxels, err);
    }
    if (status == MS_OK) {
        choose_numbers(shape);
    }
    return status;
}

/* A search for the least number of spheres that reaches a tolerance, by runs of their own. */
typedef struct scene_search {
    ms_scene_shape *shape;
    const ms_goal *goal;
    const ms_generator *generator;
    ms_run run;
    size_t max_voxels;
    double value; /* to be reached */
    int equal_volume;
} scene_search;

/* The template of n spheres. @param[out] reached does it reach the tolerance? */
static ms_status try_number(int *reached, scene_search *s, size_t n, ms_error *err)
{
    ms_scene_shape *shape = s->shape;
    ms_metrics metrics;
    ms_stop_reason reason;
    ms_equal_volume ignored;
    s->run.stop.spheres = n;
    ms_generator_keep_remarks(&s->run, &shape->remarks[n - 1]);
    ms_status status = ms_generator_run(&shape->clump[n - 1], &reason, s->generator, &s->run, err);
    if (status == MS_OK && s->equal_volume) {
        status = ms_equal_volume_scale(&shape->clump[n - 1], &ignored, &shape->body, err);
    }
    if (status == MS_OK) {
        status = ms_metrics_compute_kinds(&metrics, NULL, 0, s->run.target, &shape->clump[n - 1], s->max_voxels, err);
    }
    if (status == MS_OK) {
        const double have = s->goal->measure->of_score(&metrics.score);
        shape->score[n - 1] = metrics.score;
        shape->dice[n - 1] = metrics.score.dice;
        *reached = ms_measure_is_reached(s->goal->measure, have, s->value);
    }
    return status;
}

/* Numbers of which the lower one does not reach the tolerance (0: none is known) and the higher one does, in steps of a
 * fifth from the one that is expected. */
static ms_status bracket_number(size_t *lo, size_t *hi, scene_search *s, size_t first, ms_error *err)
{
    size_t n = first;
    int reached = 0;
    *lo = *hi = 0;
    ms_status status = try_number(&reached, s, n, err);
    const int begins_above = reached;
    while (status == MS_OK && reached == begins_above) {
        *(reached ? hi : lo) = n;
        if (reached ? n == 1 : n == s->shape->most) {
            break;
        }
        const size_t step = 1 + n / 5;
        n = !reached ? n + step : n > step ? n - step : 1;
        n = n < s->shape->most ? n : s->shape->most;
        status = try_number(&reached, s, n, err);
    }
    *(reached ? hi : lo) = n;
    *lo = reached && n == 1 ? 0 : *lo;
    return status;
}

/* Where each number is a run of its own, few are run: those from the expected one on that enclose the tolerance, and
 * halves of what lies between. */
static ms_status search_number(ms_scene_shape *shape, scene_search *s, size_t expected, ms_error *err)
{
    size_t lo, hi;
    const size_t first = expected < 1 ? 1 : expected < shape->most ? expected : shape->most;
    ms_status status = bracket_number(&lo, &hi, s, first, err);
    while (status == MS_OK && hi > 0 && hi - lo > 1) { /* without one that reaches it, choose_alone says so */
        int reached;
        const size_t middle = lo + (hi - lo) / 2;
        status = try_number(&reached, s, middle, err);
        *(status == MS_OK && reached ? &hi : &lo) = middle;
    }
    shape->chosen = hi;
    return status;
}

/* The number of spheres that the tolerance is expected to take; where nothing is expected, a quarter of the most. */
static size_t expect_number(const ms_input *input, const ms_goal *goal, double value, size_t most)
{
    ms_expect expect;
    ms_error ignored;
    double n = (double)most / 4;
    if (goal->measure == &ms_measures[MS_MEASURE_DICE] && value > 0 &&
        ms_expectation_find(&expect, input, &ignored) == MS_OK) {
        n = ceil(ms_expect_spheres(&expect, MS_EXPECT_FREE, value));
    }
    return n < (double)most ? (size_t)n : most;
}

static ms_status search_template(ms_scene_shape *shape, const ms_input *input, const ms_run *run,
                                 const ms_scene_run *how, const ms_goal *goal, ms_error *err)
{
    scene_search s = {.shape = shape,
                      .goal = goal,
                      .generator = how->recipe->generator,
                      .run = *run,
                      .max_voxels = ms_input_max_voxels(how->input),
                      .value = tolerance_of(shape, goal),
                      .equal_volume = how->equal_volume};
    const ms_status status = make_room(shape, how->max_spheres, err);
    for (size_t n = 0; status == MS_OK && n < shape->most; n++) {
        shape->dice[n] = (double)NAN;
    }
    return status == MS_OK ? search_number(shape, &s, expect_number(input, goal, s.value, shape->most), err) : status;
}

int ms_scene_is_searched(const ms_goal *goal, const ms_recipe *recipe)
{
    return goal->kind == MS_GOAL_TOLERANCE && !ms_generator_is_nested(recipe->generator, &recipe->settings);
}

/* Those of 1 to the most spheres. */
static ms_status make_all_templates(ms_scene_shape *shape, ms_run *run, const ms_scene_run *how, int beside,
                                    ms_error *err)
{
    const ms_generator *generator = how->recipe->generator;
    ms_stop_reason reason;
    ms_clump clump;
    ms_error remarks = {""};
    ms_generator_keep_remarks(run, &remarks);
    ms_status status = ms_generator_run(&clump, &reason, generator, run, err);
    if (!beside) {
        ms_progress_show(run);
    }
    if (status == MS_OK) {
        status = make_curve(shape, &clump, &remarks, run, how, err);
        ms_clump_free(&clump);
    }
    return status;
}

static ms_status make_templates(ms_scene_shape *shape, const char *title, const ms_input *input,
                                const ms_scene_run *how, const ms_goal *goal, int beside, ms_error *err)
{
    const ms_recipe *recipe = how->recipe;
    ms_progress_line line = {.name = title, .goal = how->recipe->generator->nested ? how->max_spheres : 0};
    ms_error cause;
    ms_run run = {.target = &input->target, .settings = &recipe->settings, .seed = (uint64_t)recipe->seed};
    run.stop.spheres = how->max_spheres;
    run.stop.radius = how->min_radius;
    if (!beside) { /* else the queue has the line */
        ms_progress_show(&run);
        ms_progress_open(&line);
        run.stage = NULL; /* of all runs the first is a small part */
    }
    shape->input = ms_report_input_json(input);
    shape->body = input->target.body;
    ms_status status;
    if (ms_scene_is_searched(goal, recipe)) {
        status = search_template(shape, input, &run, how, goal, &cause);
    } else {
        status = make_all_templates(shape, &run, how, beside, &cause);
    }
    if (!beside) {
        ms_progress_close();
    }
    return status == MS_OK ? MS_OK : ms_fail(err, status, "%s: %s", shape->row->path, cause.text);
}

/* How the making of a shape ended. */
typedef struct scene_outcome {
    ms_status status;
    ms_error cause;
} scene_outcome;

/* The shapes in the making. */
typedef struct scene_work {
    ms_scene *scene;
    const ms_manifest *manifest;
    const ms_scene_run *run;
    const ms_goal *goal;
    scene_outcome *outcome; /* of each shape */
} scene_work;

static ms_status make_shape(const scene_work *w, size_t at, ms_queue_place *place, ms_error *err)
{
    ms_input input;
    ms_input_flags flags = *w->run->input;
    ms_scene_shape *shape = &w->scene->shape[at];
    char title[80];
    shape->row = &w->manifest->row[at];
    snprintf(title, sizeof title, "%.40s (%zu of %zu)", shape->row->path, at + 1, w->scene->count);
    flags.threads = 0; /* those of the queue */
    ms_status status = ms_input_read(&input, shape->row->path, &flags, err);
    if (status != MS_OK) {
        return status;
    }
    ms_queue_need_memory(place, ms_input_bytes(&input, &flags), flags.max_memory);
    status = ms_input_target(&input, &flags, err);
    if (status == MS_OK) {
        status = make_templates(shape, title, &input, w->run, w->goal, ms_queue_beside(place), err);
    }
    ms_input_free(&input);
    return status == MS_OK && shape->chosen == 0 ? choose_alone(shape, w->goal, err) : status;
}

static void work_shape(void *context, size_t at, ms_queue_place *place)
{
    scene_work *w = context;
    w->outcome[at].status = make_shape(w, at, place, &w->outcome[at].cause);
}

/* The first shape that fails ends it all. */
static ms_status take_shape(void *context, size_t at, size_t *failed, ms_error *err)
{
    const scene_work *w = context;
    *err = w->outcome[at].cause;
    *failed += w->outcome[at].status != MS_OK;
    return w->outcome[at].status;
}

ms_status ms_scene_make(ms_scene *scene, const ms_manifest *manifest, const ms_scene_run *run, const ms_goal *goal,
                        ms_error *err)
{
    *scene = (ms_scene){.count = manifest->count, .shape = calloc(manifest->count, sizeof *scene->shape)};
    scene->is_searched = ms_scene_is_searched(goal, run->recipe);
    scene_work work = {scene, manifest, run, goal, calloc(manifest->count, sizeof *work.outcome)};
    const ms_queue queue = {.count = manifest->count,
                            .threads = run->input->threads ? run->input->threads : omp_get_max_threads(),
                            .context = &work,
                            .work = work_shape,
                            .take = take_shape};
    ms_status status = scene->shape && work.outcome
                           ? ms_queue_run(&queue, err)
                           : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu shapes", manifest->count);
    free(work.outcome);
    if (status != MS_OK) {
        scene->count = scene->shape ? scene->count : 0;
        ms_scene_free(scene);
    }
    return status;
}

void ms_scene_say_remarks(const ms_scene *scene)
{
    for (size_t s = 0; s < scene->count; s++) {
        const ms_scene_shape *shape = &scene->shape[s];
        if (shape->remarks[shape->chosen - 1].text[0]) {
            fprintf(stderr, "%s: %s\n", shape->row->path, shape->remarks[shape->chosen - 1].text);
        }
    }
}

void ms_scene_free(ms_scene *scene)
{
    for (size_t s = 0; s < scene->count; s++) {
        ms_scene_shape *shape = &scene->shape[s];
        for (size_t n = 0; shape->clump && n < shape->most; n++) {
            ms_clump_free(&shape->clump[n]);
        }
        free(shape->clump);
        free(shape->score);
        free(shape->dice);
        free(shape->remarks);
        json_decref(shape->input);
    }
    free(scene->shape);
    *scene = (ms_scene){0};
}
