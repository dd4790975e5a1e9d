#include "ms_scene.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_progress.h"
#include "cli/ms_report.h"
#include "clump/ms_equal_volume.h"
#include "measure/ms_descriptors.h"
#include "ms_curve.h"
#include "ms_scene_search.h"
#include "queue/ms_queue.h"

const ms_clump *ms_scene_clump(const ms_scene_shape *shape)
{
    return &shape->sized;
}

const ms_score *ms_scene_score(const ms_scene_shape *shape)
{
    return &shape->score[shape->chosen - 1];
}

double ms_scene_gain(const ms_scene_shape *shape)
{
    return shape->chosen > 1 ? shape->dice[shape->chosen - 2] - shape->dice[shape->chosen - 1] : (double)NAN;
}

/* Mean distance of surfaces that have this D, 2 V D / A. */
static double length_of_dice(const ms_scene_shape *shape, double dice)
{
    return 2 * dice * shape->factor / shape->surface;
}

double ms_scene_distance(const ms_scene_shape *shape)
{
    return length_of_dice(shape, shape->dice[shape->chosen - 1]);
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

/* No template of a row reaches its tolerance; of a length it is told as one. */
static ms_status miss_tolerance(const ms_scene_shape *shape, const ms_goal *goal, double best, ms_error *err)
{
    const int is_length = goal->length > 0 && isnan(shape->row->tolerance);
    return ms_fail(err, MS_ERR_LIMIT,
                   "%s: no template of up to %zu spheres has %s %.6g, the best has %.6g; raise --max-spheres, use more "
                   "cells or another method, or ease the tolerance",
                   ms_manifest_name_row(shape->row).text, shape->most,
                   is_length ? "a mean distance of" : goal->measure->name, is_length ? goal->length : shape->tolerance,
                   is_length ? length_of_dice(shape, best) : best);
}

/* The least number of spheres that reaches a tolerance. */
static ms_status choose_by_tolerance(ms_scene_shape *shape, const ms_goal *goal, ms_error *err)
{
    const double value = shape->tolerance;
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
    return miss_tolerance(shape, goal, best, err);
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
        status = ms_equal_volume_scale(&shape->clump[n], &ignored, &target->body, err);
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
    if (status == MS_OK && how->recipe->equal_volume) {
        status = scale_templates(shape, run->target, max_voxels, err);
    }
    if (status == MS_OK) {
        choose_numbers(shape);
    }
    return status;
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

/* D that surfaces at a mean distance L make of a shape of volume V and area A: the volume between them, some A L, is
 * that of S xor U, and D = |S xor U| / (|S| + |U|), where the latter is some 2 V. */
static double dice_of_length(const ms_scene_shape *shape, double length)
{
    return length * shape->surface / (2 * shape->factor);
}

static ms_status find_surface(double *surface, const ms_target *target, ms_error *err)
{
    ms_descriptors of_shape;
    const ms_status status = ms_descriptors_of_target(&of_shape, target, err);
    if (status != MS_OK) {
        return status;
    }
    *surface = of_shape.area / of_shape.volume;
    return isnan(*surface) ? ms_fail(err, MS_ERR_SHAPE,
                                     "the area of its surface is not known, so that no length can be tolerated; use "
                                     "more cells, or --tolerance")
                           : MS_OK;
}

/* Field by field: what rows are of which shape is read meanwhile, for other shapes. */
static void share_templates(ms_scene_shape *shape, const ms_scene_shape *first)
{
    shape->most = first->most;
    shape->clump = first->clump;
    shape->score = first->score;
    shape->dice = first->dice;
    shape->remarks = first->remarks;
    shape->input = json_incref(first->input);
    shape->surface = first->surface;
}

/* The shape of a row in its size, with the templates of the first row of that shape. */
static void take_row(ms_scene_shape *shape, const ms_scene_shape *first, const ms_target *target, const ms_goal *goal)
{
    const ms_manifest_row *row = shape->row;
    const double own = cbrt(6 * target->body.volume / acos(-1.0)), f = isnan(row->size) ? 1 : row->size / own;
    if (shape != first) {
        share_templates(shape, first);
    }
    shape->factor = f;
    shape->body.volume = f * f * f * target->body.volume;
    for (int k = 0; k < 3; k++) {
        shape->body.centroid[k] = f * target->body.centroid[k];
        for (int l = 0; l < 3; l++) {
            shape->body.inertia[k][l] = f * f * f * f * f * target->body.inertia[k][l];
        }
    }
    const double asked = goal->length > 0 ? dice_of_length(shape, goal->length) : goal->value;
    shape->tolerance = isnan(row->tolerance) ? asked : row->tolerance;
}

/* What the goal says of each row of the shape alone. */
static ms_status choose_rows(ms_scene *scene, size_t first, const ms_input *input, const ms_run *run,
                             const ms_scene_run *how, const ms_goal *goal, ms_error *err)
{
    ms_status status = MS_OK;
    ms_error cause;
    for (size_t s = first; s < scene->count && status == MS_OK; s++) {
        ms_scene_shape *shape = &scene->shape[s];
        if (shape->first != first) {
            continue;
        }
        take_row(shape, &scene->shape[first], &input->target, goal);
        if (scene->is_searched) {
            status = ms_scene_search(shape, input, run, how, goal, &cause);
        }
        if (status != MS_OK) {
            status = ms_fail(err, status, "%s: %s", shape->row->path, cause.text);
        } else if (shape->chosen == 0) {
            status = choose_alone(shape, goal, err);
        }
    }
    return status;
}

static ms_status make_templates(ms_scene *scene, size_t first, const char *title, const ms_input *input,
                                const ms_scene_run *how, const ms_goal *goal, int beside, ms_error *err)
{
    ms_scene_shape *shape = &scene->shape[first];
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
    ms_status status = goal->length > 0 ? find_surface(&shape->surface, &input->target, &cause) : MS_OK;
    if (status == MS_OK) {
        status = scene->is_searched ? make_room(shape, how->max_spheres, &cause)
                                    : make_all_templates(shape, &run, how, beside, &cause);
    }
    for (size_t n = 0; scene->is_searched && n < shape->most; n++) {
        shape->dice[n] = (double)NAN; /* not run */
    }
    status = status == MS_OK ? choose_rows(scene, first, input, &run, how, goal, err)
                             : ms_fail(err, status, "%s: %s", shape->row->path, cause.text);
    if (!beside) {
        ms_progress_close();
    }
    return status;
}

/* The making of a shape. */
typedef struct scene_outcome {
    size_t first; /* row of it */
    ms_status status;
    ms_error cause;
} scene_outcome;

/* The shapes in the making. */
typedef struct scene_work {
    ms_scene *scene;
    const ms_scene_run *run;
    const ms_goal *goal;
    size_t count; /* of shapes: rows may be sizes of one */
    scene_outcome *outcome;
} scene_work;

static ms_status make_shape(const scene_work *w, size_t at, ms_queue_place *place, ms_error *err)
{
    ms_input input;
    ms_input_flags flags = *w->run->input;
    const size_t first = w->outcome[at].first;
    const char *path = w->scene->shape[first].row->path;
    char title[80];
    snprintf(title, sizeof title, "%.40s (%zu of %zu)", path, at + 1, w->count);
    flags.threads = 0; /* those of the queue */
    ms_status status = ms_input_read(&input, path, &flags, err);
    if (status != MS_OK) {
        return status;
    }
    ms_queue_need_memory(place, ms_input_bytes(&input, &flags), flags.max_memory);
    status = ms_input_target(&input, &flags, err);
    if (status == MS_OK) {
        status = make_templates(w->scene, first, title, &input, w->run, w->goal, ms_queue_beside(place), err);
    }
    ms_input_free(&input);
    return status;
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

/* A shape for each row; those to be made are the first of their path. */
static void list_shapes(scene_work *w, const ms_manifest *manifest)
{
    for (size_t s = 0; s < manifest->count; s++) {
        ms_scene_shape *shape = &w->scene->shape[s];
        shape->row = &manifest->row[s];
        shape->first = ms_manifest_first(manifest, s);
        if (shape->first == s) {
            w->outcome[w->count++].first = s;
        }
    }
}

ms_status ms_scene_make(ms_scene *scene, const ms_manifest *manifest, const ms_scene_run *run, const ms_goal *goal,
                        ms_error *err)
{
    *scene = (ms_scene){.count = manifest->count,
                        .shape = calloc(manifest->count, sizeof *scene->shape),
                        .is_searched = ms_scene_is_searched(goal, run->recipe),
                        .has_sizes = ms_manifest_has_sizes(manifest)};
    scene_work work = {scene, run, goal, 0, calloc(manifest->count, sizeof *work.outcome)};
    ms_status status =
        scene->shape && work.outcome ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu shapes", manifest->count);
    if (status == MS_OK) {
        list_shapes(&work, manifest);
        const ms_queue queue = {.count = work.count,
                                .threads = run->input->threads ? run->input->threads : omp_get_max_threads(),
                                .context = &work,
                                .work = work_shape,
                                .take = take_shape};
        status = ms_queue_run(&queue, err);
    }
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
            fprintf(stderr, "%s: %s\n", ms_manifest_name_row(shape->row).text, shape->remarks[shape->chosen - 1].text);
        }
    }
}

static void free_templates(ms_scene_shape *shape)
{
    for (size_t n = 0; shape->clump && n < shape->most; n++) {
        ms_clump_free(&shape->clump[n]);
    }
    free(shape->clump);
    free(shape->score);
    free(shape->dice);
    free(shape->remarks);
}

void ms_scene_free(ms_scene *scene)
{
    for (size_t s = 0; s < scene->count; s++) {
        ms_scene_shape *shape = &scene->shape[s];
        ms_clump_free(&shape->sized);
        json_decref(shape->input);
        if (shape->first == s) {
            free_templates(shape);
        }
    }
    free(scene->shape);
    *scene = (ms_scene){0};
}
