/* mskit scene MANIFEST|SHAPE */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "cli/ms_json_object.h"
#include "cli/ms_outputs.h"
#include "cli/ms_record.h"
#include "cli/ms_report.h"
#include "cli/ms_until.h"
#include "ms_commands.h"
#include "scene/ms_scene.h"

enum { DEFAULT_MAX_SPHERES = 100 };

/* So that every number of spheres in a scene is a double. */
static const double MAX_BUDGET = 1e15;

static const ms_flag FLAGS[] = {
    {"budget", 0, "SPHERES", "spheres in the whole scene: the least mean D that they pay for"},
    {"tolerance", 0, "MEASURE=VALUE",
     MS_MEASURE_GOAL_NAMES "one of them, of each shape; the column tolerance of the manifest goes before it"},
    {"mean-tolerance", 0, "dice=VALUE", "mean D over all particles: the fewest spheres in the whole scene"},
    {"knee", 0, "PART", "each shape's number of spheres from which a further one takes away less than this part of D"},
    {"max-spheres", 0, "N", "spheres of the largest template (100)"},
    MS_MIN_RADIUS_FLAG,
    MS_RECIPE_FLAGS,
    {"output", 'o', "DIR", "write the templates into this folder, each by the name of its shape"},
    {"format", 0, "F", "format of the templates: csv, json or vtk (csv)"},
    {"json", 0, NULL, "as JSON"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct scene_arguments {
    const char *source; /* manifest or shape */
    ms_goal goal;
    double max_spheres, min_radius;
    ms_recipe recipe;
    ms_input_flags input;
    const char *folder;
    const ms_format *format;
    int json;
} scene_arguments;

static ms_status set_goal(ms_goal *goal, ms_goal_kind kind, double value, ms_error *err)
{
    if (goal->kind != MS_GOAL_NONE) {
        return ms_fail(err, MS_ERR_ARG,
                       "--budget, --tolerance, --mean-tolerance and --knee exclude one another; give one, once");
    }
    goal->kind = kind;
    goal->value = value;
    return MS_OK;
}

static ms_status take_tolerance(ms_goal *goal, const char *flag, const char *text, ms_error *err)
{
    char name[64];
    const char *value = NULL;
    double number;
    const int mean = strcmp(flag, "mean-tolerance") == 0;
    ms_status status = ms_recipe_assignment(name, &value, flag, text, err);
    const ms_measure *measure = status == MS_OK ? ms_measure_find_goal(name, err) : NULL;
    if (!measure) {
        return MS_ERR_ARG;
    }
    if (mean && measure != &ms_measures[MS_MEASURE_DICE]) {
        return ms_fail(err, MS_ERR_ARG, "--mean-tolerance takes dice=VALUE alone, not %s", name);
    }
    status = ms_flags_number(&number, flag, value ? value : "", 0, 1, err);
    if (status == MS_OK) {
        status = set_goal(goal, mean ? MS_GOAL_MEAN : MS_GOAL_TOLERANCE, number, err);
        goal->measure = measure;
    }
    return status;
}

static ms_status take_goal(int *taken, ms_goal *goal, const char *name, const char *value, ms_error *err)
{
    double number;
    ms_status status;
    *taken = 1;
    if (strcmp(name, "budget") == 0) {
        status = ms_flags_whole(&number, name, value, 1, MAX_BUDGET, err);
        return status == MS_OK ? set_goal(goal, MS_GOAL_BUDGET, number, err) : status;
    }
    if (strcmp(name, "knee") == 0) {
        status = ms_flags_number(&number, name, value, 1e-9, 1, err);
        return status == MS_OK ? set_goal(goal, MS_GOAL_KNEE, number, err) : status;
    }
    if (strcmp(name, "tolerance") == 0 || strcmp(name, "mean-tolerance") == 0) {
        return take_tolerance(goal, name, value, err);
    }
    *taken = 0;
    return MS_OK;
}

static ms_status take_template_format(scene_arguments *a, const char *name, ms_error *err)
{
    a->format = ms_write_format_find(name, err);
    if (a->format && a->format->need != MS_NEED_SPHERES) {
        return ms_fail(err, MS_ERR_ARG, "a %s template needs the mass of the particle: use mskit correct on each",
                       name);
    }
    return a->format ? MS_OK : MS_ERR_ARG;
}

static ms_status take_scene_flag(void *context, const char *name, const char *value, ms_error *err)
{
    scene_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (!taken) {
        status = take_goal(&taken, &a->goal, name, value, err);
    }
    if (taken) {
        return status;
    }
    if (strcmp(name, "max-spheres") == 0) {
        return ms_flags_whole(&a->max_spheres, name, value, 1, MS_SCENE_MAX_SPHERES, err);
    }
    if (strcmp(name, "min-radius") == 0) {
        return ms_until_min_radius(&a->min_radius, value, err);
    }
    if (strcmp(name, "output") == 0) {
        a->folder = value;
        return value[0] ? MS_OK : ms_fail(err, MS_ERR_ARG, "--output '' names no folder");
    }
    if (strcmp(name, "format") == 0) {
        return take_template_format(a, value, err);
    }
    if (strcmp(name, "json") == 0) {
        a->json = 1;
        return MS_OK;
    }
    return ms_recipe_flag(&taken, &a->recipe, name, value, err);
}

/* What flags and manifest say together. */
static ms_status resolve_goal(ms_goal *goal, const ms_manifest *manifest, const char *source, ms_error *err)
{
    size_t tolerances = 0;
    double particles = 0;
    for (size_t r = 0; r < manifest->count; r++) {
        tolerances += !isnan(manifest->row[r].tolerance);
        particles += (double)manifest->row[r].particles;
    }
    if (goal->kind == MS_GOAL_NONE && tolerances == manifest->count) {
        *goal = (ms_goal){MS_GOAL_TOLERANCE, (double)NAN, &ms_measures[MS_MEASURE_DICE]};
    }
    if (goal->kind == MS_GOAL_NONE) {
        return ms_fail(err, MS_ERR_ARG,
                       "no goal; give --budget, --tolerance, --mean-tolerance or --knee, or a tolerance for each shape "
                       "of %s",
                       source);
    }
    if (goal->kind != MS_GOAL_TOLERANCE && tolerances > 0) {
        return ms_fail(err, MS_ERR_ARG, "the tolerances in %s go with --tolerance or alone; drop that column", source);
    }
    if (goal->kind == MS_GOAL_BUDGET && goal->value < particles) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "%s: a budget of %.0f spheres is less than one for each of %.0f particles; raise it", source,
                       goal->value, particles);
    }
    return MS_OK;
}

/* FOLDER/NAME.ENDING, where NAME is that of the shape without folder and ending. The caller frees it; NULL without
 * memory. */
static char *template_path(const scene_arguments *a, const char *shape)
{
    size_t length;
    const char *stem = ms_files_stem(&length, shape);
    const size_t room = strlen(a->folder) + length + strlen(a->format->ending) + 3;
    char *path = malloc(room);
    if (path) {
        const int start = snprintf(path, room, "%s/", a->folder);
        snprintf(path + start, room - (size_t)start, "%.*s.%s", (int)length, stem, a->format->ending);
        ms_escape_file_name(path + start);
    }
    return path;
}

/* Names the file of each template. Without a folder there are none. */
static ms_status plan_outputs(ms_outputs *outputs, const scene_arguments *a, const ms_manifest *manifest, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t r = 0; a->folder && r < manifest->count && status == MS_OK; r++) {
        const char *shape = manifest->row[r].path;
        char *path = template_path(a, shape);
        if (!path) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of %zu templates", manifest->count);
        }
        outputs[r] = (ms_outputs){.folder = a->folder, .file = {{path, path, a->format}}, .n_files = 1};
        for (size_t before = 0; before < r && status == MS_OK; before++) {
            if (strcmp(outputs[before].file[0].path, path) == 0) {
                status =
                    ms_fail(err, MS_ERR_ARG, "the templates of %s and %s would both be %s; rename one of the shapes",
                            manifest->row[before].path, shape, path);
            }
        }
    }
    return status;
}

static ms_status check_scene_files(const ms_outputs *outputs, const scene_arguments *a, const ms_manifest *manifest,
                                   ms_error *err)
{
    const char *refined = a->recipe.settings.clump_file;
    ms_files files = {0};
    ms_status status = ms_files_add(&files, a->source, MS_FILE_READ, err);
    if (status == MS_OK && refined) {
        status = ms_files_add(&files, refined, MS_FILE_READ, err);
    }
    for (size_t r = 0; r < manifest->count && status == MS_OK; r++) {
        status = ms_files_add_shape(&files, manifest->row[r].path, err);
        if (status == MS_OK) {
            status = ms_outputs_list(&files, &outputs[r], err);
        }
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
    return status;
}

/* How a template came about, for its JSON file. */
static char *record_of(const scene_arguments *a, const ms_scene_shape *shape)
{
    json_t *json = ms_scene_record_json(&a->recipe, (size_t)a->max_spheres, a->min_radius);
    ms_json_object_set(&json, "scores", ms_scene_scores_json(shape));
    ms_json_object_set(&json, "input", json_incref(shape->input));
    char *record = json ? json_dumps(json, JSON_COMPACT) : NULL;
    json_decref(json);
    return record;
}

static ms_status write_templates(const ms_outputs *outputs, const scene_arguments *a, const ms_scene *scene,
                                 ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; a->folder && s < scene->count && status == MS_OK; s++) {
        char *record = record_of(a, &scene->shape[s]);
        const ms_content content = {.clump = ms_scene_clump(&scene->shape[s]), .record = record};
        status = record ? ms_outputs_write(&outputs[s], &content, a->json ? stderr : stdout, err)
                        : ms_fail(err, MS_ERR_NOMEM, "no memory for the record of a template");
        free(record);
    }
    return status;
}

static ms_status report_scene(const scene_arguments *a, const ms_scene *scene, ms_error *err)
{
    if (!a->json) {
        printf("%s with %s: ", a->source, a->recipe.generator->name);
        ms_scene_print(stdout, scene, &a->goal);
        return MS_OK;
    }
    json_t *json = ms_scene_record_json(&a->recipe, (size_t)a->max_spheres, a->min_radius);
    ms_scene_add_json(&json, scene, &a->goal);
    return ms_report_print(stdout, json, err);
}

static ms_status execute_scene(scene_arguments *a, const ms_manifest *manifest, ms_outputs *outputs, ms_error *err)
{
    ms_scene scene;
    const ms_scene_run run = {&a->recipe, &a->input, (size_t)a->max_spheres, a->min_radius};
    ms_status status = plan_outputs(outputs, a, manifest, err);
    if (status == MS_OK && a->folder) {
        status = check_scene_files(outputs, a, manifest, err);
    }
    if (status == MS_OK) {
        status = ms_scene_make(&scene, manifest, &run, &a->goal, err);
    }
    if (status != MS_OK) {
        return status;
    }
    status = ms_scene_choose(&scene, &a->goal, err);
    if (status == MS_OK) {
        ms_scene_say_remarks(&scene);
        status = report_scene(a, &scene, err);
    }
    if (status == MS_OK) {
        status = write_templates(outputs, a, &scene, err);
    }
    ms_scene_free(&scene);
    return status;
}

/* A manifest is known by its ending; any other file is a shape of which there is one. */
static ms_status read_manifest(ms_manifest *manifest, const char *source, ms_error *err)
{
    char ending[16];
    ms_file_ending(ending, source);
    return strcmp(ending, "csv") == 0 ? ms_manifest_read(manifest, source, err)
                                      : ms_manifest_of_shape(manifest, source, err);
}

static int resolve_and_work(const ms_command *command, scene_arguments *a, const ms_manifest *manifest)
{
    ms_error err;
    ms_status status = resolve_goal(&a->goal, manifest, a->source, &err);
    if (status == MS_ERR_ARG) {
        return ms_flags_wrong_usage(command, err.text);
    }
    ms_outputs *outputs = calloc(manifest->count, sizeof *outputs);
    if (!outputs) {
        status = ms_fail(&err, MS_ERR_NOMEM, "no memory for %zu templates", manifest->count);
    }
    if (status == MS_OK) {
        status = execute_scene(a, manifest, outputs, &err);
    }
    for (size_t r = 0; outputs && r < manifest->count; r++) {
        ms_outputs_free(&outputs[r]);
    }
    free(outputs);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

static int read_and_work(const ms_command *command, scene_arguments *a)
{
    ms_manifest manifest;
    ms_error err;
    if (read_manifest(&manifest, a->source, &err) != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    const int code = resolve_and_work(command, a, &manifest);
    ms_manifest_free(&manifest);
    return code;
}

static int run_scene(const ms_command *command, int argc, char **argv)
{
    scene_arguments a = {.max_spheres = DEFAULT_MAX_SPHERES, .recipe = {.name = MS_GENERATOR_DEFAULT, .seed = 1}};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 1, argc, argv, take_scene_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_usage(command, "takes one manifest (.csv: shape,count) or one shape");
    }
    if (a.format && !a.folder) {
        return ms_flags_wrong_usage(command, "--format is that of the templates; give -o DIR beside it");
    }
    a.source = argv[first];
    a.format = a.format ? a.format : ms_write_format_find("csv", &err);
    ms_status status = ms_recipe_resolve(&a.recipe, &err);
    if (status == MS_OK) {
        a.input.cut |= a.goal.measure == &ms_measures[MS_MEASURE_COVERAGE_CUT];
        a.input.need = ms_generator_need(a.recipe.generator, &a.recipe.settings, a.input.cut);
        const char *const inputs[] = {a.source, a.recipe.settings.clump_file};
        status = ms_files_check_standard(inputs, 2, &err);
    }
    code = status == MS_OK ? read_and_work(command, &a) : ms_flags_refuse(command, status, &err);
    ms_recipe_free(&a.recipe);
    return code;
}

const ms_command ms_command_scene = {
    .name = "scene",
    .summary = "how many spheres each shape of a scene needs, and its templates",
    .usage = "MANIFEST|SHAPE --budget N|--tolerance MEASURE=V|--mean-tolerance dice=V|--knee PART [-o DIR]",
    .example = "mskit scene grain.stl --knee 0.1 --max-spheres 20 --cells 50 -o templates",
    .flags = FLAGS,
    .run = run_scene,
};
