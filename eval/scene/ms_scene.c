#include "ms_scene.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/ms_progress.h"
#include "cli/ms_report.h"
#include "ms_scene_search.h"
#include "queue/ms_queue.h"

const ms_clump *ms_scene_clump(const ms_scene_shape *shape)
{
    return &shape->sized;
}

const ms_score *ms_scene_score(const ms_scene_shape *shape)
{
    return &shape->templates.score[shape->chosen - 1];
}

double ms_scene_gain(const ms_scene_shape *shape)
{
    return shape->chosen > 1 ? shape->templates.dice[shape->chosen - 2] - shape->templates.dice[shape->chosen - 1]
                             : (double)NAN;
}

double ms_scene_distance(const ms_scene_shape *shape)
{
    return ms_templates_length(shape->templates.dice[shape->chosen - 1], shape->surface, shape->factor);
}

ms_share ms_scene_share(const ms_scene_shape *shape)
{
    return (ms_share){shape->row->particles, shape->templates.most, shape->templates.dice};
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
                   ms_manifest_name_row(shape->row).text, shape->templates.most,
                   is_length ? "a mean distance of" : goal->measure->name, is_length ? goal->length : shape->tolerance,
                   is_length ? ms_templates_length(best, shape->surface, shape->factor) : best);
}

/* The least number of spheres that reaches a tolerance. */
static ms_status choose_by_tolerance(ms_scene_shape *shape, const ms_goal *goal, ms_error *err)
{
    double best;
    shape->chosen = ms_templates_least(&best, &shape->templates, goal->measure, shape->tolerance);
    return shape->chosen > 0 ? MS_OK : miss_tolerance(shape, goal, best, err);
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
                         shape->row->path, shape->templates.most, goal->value);
}

/* What the goal says of a shape alone. */
static ms_status choose_alone(ms_scene_shape *shape, const ms_goal *goal, ms_error *err)
{
    if (goal->kind == MS_GOAL_TOLERANCE) {
        return choose_by_tolerance(shape, goal, err);
    }
    return goal->kind == MS_GOAL_KNEE ? choose_by_knee(shape, goal, err) : MS_OK;
}

int ms_scene_is_searched(const ms_goal *goal, const ms_recipe *recipe)
{
    return goal->kind == MS_GOAL_TOLERANCE && !ms_generator_is_nested(recipe->generator, &recipe->settings);
}

/* The shape of a row in its size, with the templates of the first row of that shape. */
static void take_row(ms_scene_shape *shape, const ms_scene_shape *first, const ms_target *target, const ms_goal *goal)
{
    const ms_manifest_row *row = shape->row;
    if (shape != first) { /* field by field: what rows are of which shape is read meanwhile, for other shapes */
        shape->templates = first->templates;
        shape->input = json_incref(first->input);
        shape->surface = first->surface;
    }
    shape->factor = isnan(row->size) ? 1 : ms_inertia_factor(&target->body, row->size);
    shape->body = target->body;
    ms_inertia_scale(&shape->body, shape->factor);
    const double asked =
        goal->length > 0 ? ms_templates_dice(goal->length, shape->surface, shape->factor) : goal->value;
    shape->tolerance = isnan(row->tolerance) ? asked : row->tolerance;
}

/* What the goal says of each row of the shape alone. */
static ms_status choose_rows(ms_scene *scene, size_t first, const ms_input *input, const ms_templates_how *how,
                             const ms_goal *goal, ms_error *err)
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
            status = ms_scene_search(shape, input, how, goal, &cause);
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
                                const ms_scene_run *asked, const ms_goal *goal, int beside, ms_error *err)
{
    ms_scene_shape *shape = &scene->shape[first];
    const ms_recipe *recipe = asked->recipe;
    ms_progress_line line = {.name = title, .goal = recipe->generator->nested ? asked->max_spheres : 0};
    ms_error cause;
    ms_run run = {.target = &input->target, .settings = &recipe->settings, .seed = (uint64_t)recipe->seed};
    const ms_templates_how how = {.generator = recipe->generator,
                                  .run = &run,
                                  .equal = recipe->equal_volume ? &input->target.body : NULL,
                                  .max_voxels = ms_input_max_voxels(asked->input)};
    run.stop.spheres = asked->max_spheres;
    run.stop.radius = asked->min_radius;
    if (!beside) { /* else the queue has the line */
        ms_progress_show(&run);
        ms_progress_open(&line);
    }
    shape->input = ms_report_input_json(input);
    ms_status status = goal->length > 0 ? ms_templates_surface(&shape->surface, &input->target, &cause) : MS_OK;
    if (status == MS_OK) {
        status = scene->is_searched ? ms_templates_alloc(&shape->templates, asked->max_spheres, &cause)
                                    : ms_templates_make(&shape->templates, &how, &cause);
    }
    status = status == MS_OK ? choose_rows(scene, first, input, &how, goal, err)
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
        if (shape->templates.remarks[shape->chosen - 1].text[0]) {
            fprintf(stderr, "%s: %s\n", ms_manifest_name_row(shape->row).text,
                    shape->templates.remarks[shape->chosen - 1].text);
        }
    }
}

void ms_scene_free(ms_scene *scene)
{
    for (size_t s = 0; s < scene->count; s++) {
        ms_scene_shape *shape = &scene->shape[s];
        ms_clump_free(&shape->sized);
        json_decref(shape->input);
        if (shape->first == s) {
            ms_templates_free(&shape->templates);
        }
    }
    free(scene->shape);
    *scene = (ms_scene){0};
}
