/* mskit scene MANIFEST|SHAPE */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "cli/ms_json_object.h"
#include "cli/ms_record.h"
#include "cli/ms_report.h"
#include "cli/ms_until.h"
#include "clump/formats/ms_json.h"
#include "ms_commands.h"
#include "ms_sieve.h"
#include "scene/ms_scene_charts.h"
#include "scene/ms_scene_choose.h"
#include "scene/ms_scene_engines.h"
#include "scene/ms_scene_files.h"
#include "scene/ms_scene_page.h"

enum { DEFAULT_MAX_SPHERES = 100 };

/* So that every number of spheres in a scene is a double. */
static const double MAX_BUDGET = 1e15;

static const ms_flag FLAGS[] = {
    {"budget", 0, "SPHERES", "spheres in the whole scene: the least mean D that they pay for"},
    {"tolerance", 0, "MEASURE=VALUE",
     MS_MEASURE_GOAL_NAMES "one of them, of each shape; the column tolerance of the manifest goes before it"},
    {"tolerance-length", 0, "L",
     "mean distance of the surfaces of template and particle, in the unit of the shapes: of each the fewest spheres"},
    {"mean-tolerance", 0, "dice=VALUE", "mean D over all particles: the fewest spheres in the whole scene"},
    {"knee", 0, "PART", "each shape's number of spheres from which a further one takes away less than this part of D"},
    {"max-spheres", 0, "N", "spheres of the largest template (100)"},
    MS_MIN_RADIUS_FLAG,
    MS_RECIPE_FLAGS,
    {"output", 'o', "DIR", "write the templates into this folder, each by the name of its shape"},
    {"format", 0, "F", "format of the templates (csv); repeated: of each; liggghts, lammps, yade bring a script, too"},
    {"particles", 0, "N", "how many there are of a shape that is given without a manifest (1)"},
    {"sieve", 0, "FILE", "give the particles sizes by a sieve curve by mass (.csv: size,passing)"},
    {"classes", 0, "K", "cut the sieve curve into so many classes of equal mass (one between each row and the next)"},
    {"equal-volume", 0, NULL,
     "scale each template about the centroid of its shape until its union has the shape's volume"},
    MS_SCENE_ENGINE_FLAGS,
    {"charts", 0, "DIR", "charts of D, or what the tolerance is of, by number of spheres; takes gnuplot"},
    {"report", 0, "FILE", "a page with a row for each shape, the charts, if any, and the templates in 3-D (.html)"},
    {"json", 0, NULL, "as JSON"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct scene_arguments {
    const char *source;     /* manifest or shape */
    const char *sieve_file; /* NULL: none */
    double classes;         /* of it; 0: not given */
    ms_sieve sieve;
    ms_goal goal;
    double max_spheres, min_radius, particles; /* particles 0: not given */
    ms_recipe recipe;
    ms_input_flags input;
    ms_scene_engines engines;
    const char *folder;
    const ms_format *format[MS_OUTPUTS_FORMATS];
    size_t n_formats;
    const char *charts, *report; /* folder; path of the page; NULL: none */
    int json, argc;
    char *const *argv;
} scene_arguments;

static ms_status set_goal(ms_goal *goal, ms_goal_kind kind, double value, ms_error *err)
{
    if (goal->kind != MS_GOAL_NONE) {
        return ms_fail(err, MS_ERR_ARG,
                       "--budget, --tolerance, --tolerance-length, --mean-tolerance and --knee exclude one another; "
                       "give one, once");
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
    if (strcmp(name, "tolerance-length") == 0) {
        status = ms_flags_number(&number, name, value, DBL_MIN, DBL_MAX, err);
        status = status == MS_OK ? set_goal(goal, MS_GOAL_TOLERANCE, (double)NAN, err) : status;
        if (status == MS_OK) {
            goal->length = number;
            goal->measure = &ms_measures[MS_MEASURE_DICE];
        }
        return status;
    }
    *taken = 0;
    return MS_OK;
}

static ms_status take_template_format(scene_arguments *a, const char *name, ms_error *err)
{
    const ms_format *format = ms_write_format_find(name, err);
    for (size_t f = 0; f < a->n_formats && format; f++) {
        if (a->format[f] == format) {
            return ms_fail(err, MS_ERR_ARG, "--format %s is given twice", name);
        }
    }
    if (!format) {
        return MS_ERR_ARG;
    }
    a->format[a->n_formats++] = format; /* there are fewer formats than room */
    return MS_OK;
}

/* What is read and written beside the shapes. */
static ms_status take_scene_file(int *taken, scene_arguments *a, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "sieve") == 0) {
        a->sieve_file = value;
        return MS_OK;
    }
    if (strcmp(name, "output") == 0 || strcmp(name, "charts") == 0) {
        *(name[0] == 'o' ? &a->folder : &a->charts) = value;
        return value[0] ? MS_OK : ms_fail(err, MS_ERR_ARG, "--%s '' names no folder", name);
    }
    if (strcmp(name, "report") == 0) {
        return ms_files_take_page(&a->report, name, value, err);
    }
    if (strcmp(name, "format") == 0) {
        return take_template_format(a, value, err);
    }
    *taken = 0;
    return MS_OK;
}

static ms_status take_scene_flag(void *context, const char *name, const char *value, ms_error *err)
{
    scene_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (!taken) {
        status = take_goal(&taken, &a->goal, name, value, err);
    }
    if (!taken) {
        status = ms_scene_engines_flag(&taken, &a->engines, name, value, err);
    }
    if (!taken) {
        status = take_scene_file(&taken, a, name, value, err);
    }
    if (taken) {
        return status;
    }
    if (strcmp(name, "particles") == 0) {
        return ms_flags_whole(&a->particles, name, value, 1, MS_MANIFEST_MAX_PARTICLES, err);
    }
    if (strcmp(name, "classes") == 0) {
        return ms_flags_whole(&a->classes, name, value, 1, MS_SIEVE_MAX_CLASSES, err);
    }
    if (strcmp(name, "max-spheres") == 0) {
        return ms_flags_whole(&a->max_spheres, name, value, 1, MS_SCENE_MAX_SPHERES, err);
    }
    if (strcmp(name, "min-radius") == 0) {
        return ms_until_min_radius(&a->min_radius, value, err);
    }
    if (strcmp(name, "json") == 0 || strcmp(name, "equal-volume") == 0) {
        *(name[0] == 'j' ? &a->json : &a->recipe.equal_volume) = 1;
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
        *goal = (ms_goal){.kind = MS_GOAL_TOLERANCE, .value = (double)NAN, .measure = &ms_measures[MS_MEASURE_DICE]};
    }
    if (goal->kind == MS_GOAL_NONE) {
        return ms_fail(err, MS_ERR_ARG,
                       "no goal; give --budget, --tolerance, --tolerance-length, --mean-tolerance or --knee, or a "
                       "tolerance for each shape of %s",
                       source);
    }
    if (goal->kind != MS_GOAL_TOLERANCE && tolerances > 0) {
        return ms_fail(err, MS_ERR_ARG,
                       "the tolerances in %s go with --tolerance, --tolerance-length or alone; drop that column",
                       source);
    }
    if (goal->kind == MS_GOAL_BUDGET && goal->value < particles) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "%s: a budget of %.0f spheres is less than one for each of %.0f particles; raise it", source,
                       goal->value, particles);
    }
    return MS_OK;
}

/* How a template came about, for its JSON file. */
static char *record_of(const scene_arguments *a, const ms_scene_shape *shape)
{
    json_t *json = ms_scene_record_json(&a->recipe, (size_t)a->max_spheres, a->min_radius);
    ms_json_object_set(&json, "scores", ms_scene_scores_json(shape));
    ms_json_object_set(&json, "input", json_incref(shape->input));
    if (!isnan(shape->row->size)) {
        ms_json_object_set(&json, "size", json_real(shape->row->size));
    }
    if (shape->mass.corrected) {
        ms_json_object_set(&json, "particle", ms_json_from_particle(&shape->mass.particle));
        ms_json_object_set(&json, "masses", ms_mass_json(&shape->mass));
    }
    char *record = json ? json_dumps(json, JSON_COMPACT) : NULL;
    json_decref(json);
    return record;
}

static ms_status write_templates(const ms_outputs *outputs, const scene_arguments *a, const ms_scene *scene,
                                 ms_error *err)
{
    FILE *words = a->json ? stderr : stdout;
    ms_status status = MS_OK;
    for (size_t s = 0; a->folder && s < scene->count && status == MS_OK; s++) {
        const ms_scene_shape *shape = &scene->shape[s];
        char *record = record_of(a, shape);
        const ms_content content = {.clump = ms_scene_clump(shape),
                                    .particle = shape->mass.corrected ? &shape->mass.particle : NULL,
                                    .record = record};
        status = record ? ms_outputs_write(&outputs[s], &content, words, err)
                        : ms_fail(err, MS_ERR_NOMEM, "no memory for the record of a template");
        free(record);
    }
    return status == MS_OK && a->folder && a->engines.mass.density > 0
               ? ms_scene_engines_write(scene, &a->engines, outputs, a->folder, words, err)
               : status;
}

/* Charts and page; that without its charts, too, where gnuplot is not there. */
static ms_status show_scene(const scene_arguments *a, const ms_scene *scene, const ms_scene_run *run, ms_error *err)
{
    ms_error cause;
    FILE *words = a->json ? stderr : stdout;
    const ms_scene_page page = {scene, &a->goal, run, a->charts, a->argc, a->argv};
    const ms_status drawn = a->charts ? ms_scene_charts_draw(scene, &a->goal, a->charts, words, err) : MS_OK,
                    shown = a->report ? ms_scene_page_write(a->report, &page, drawn == MS_OK ? err : &cause) : MS_OK;
    if (a->report && shown == MS_OK) {
        fprintf(words, "wrote %s\n", a->report);
    }
    return drawn == MS_OK ? shown : drawn;
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

/* The templates are settled, and with masses what engines take. */
static ms_status choose_and_correct(ms_scene *scene, const scene_arguments *a, const ms_outputs *outputs, ms_error *err)
{
    ms_status status = ms_scene_choose(scene, &a->goal, err);
    if (status == MS_OK) {
        status = ms_scene_engines_correct(scene, &a->engines, ms_input_max_voxels(&a->input), err);
    }
    return status == MS_OK && a->engines.mass.density > 0 ? ms_scene_engines_check(scene, &a->engines, outputs, err)
                                                          : status;
}

static ms_status execute_scene(scene_arguments *a, const ms_manifest *manifest, ms_outputs *outputs, ms_error *err)
{
    ms_scene scene;
    const ms_scene_run run = {&a->recipe, &a->input, (size_t)a->max_spheres, a->min_radius};
    const ms_scene_files files = {.read = {a->source, a->recipe.settings.clump_file, a->sieve_file},
                                  .folder = a->folder,
                                  .format = a->format,
                                  .n_formats = a->n_formats,
                                  .charts = a->charts,
                                  .report = a->report,
                                  .goal = &a->goal};
    ms_status status = ms_scene_files_plan(outputs, &files, manifest, err);
    if (status == MS_OK && (a->folder || a->charts || a->report)) {
        status = ms_scene_files_check(outputs, &files, manifest, err);
    }
    if (status == MS_OK) {
        status = ms_scene_make(&scene, manifest, &run, &a->goal, err);
    }
    if (status != MS_OK) {
        return status;
    }
    scene.sieve = a->sieve.count > 0 ? &a->sieve : NULL;
    status = choose_and_correct(&scene, a, outputs, err);
    if (status == MS_OK) {
        ms_scene_say_remarks(&scene);
        status = report_scene(a, &scene, err);
    }
    if (status == MS_OK) {
        status = write_templates(outputs, a, &scene, err);
    }
    if (status == MS_OK) {
        status = show_scene(a, &scene, &run, err);
    }
    ms_scene_free(&scene);
    return status;
}

/* A manifest is known by its ending; any other file is a shape of which there is one. */
static int is_manifest(const char *source)
{
    char ending[16];
    ms_file_ending(ending, source);
    return strcmp(ending, "csv") == 0;
}

static ms_status read_manifest(ms_manifest *manifest, const scene_arguments *a, ms_error *err)
{
    const uint64_t particles = a->particles > 0 ? (uint64_t)a->particles : 1;
    return is_manifest(a->source) ? ms_manifest_read(manifest, a->source, err)
                                  : ms_manifest_of_shape(manifest, a->source, particles, err);
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

static ms_status apply_sieve(ms_manifest *manifest, ms_sieve *sieve, ms_error *err)
{
    ms_manifest made;
    const ms_status status = ms_sieve_apply(&made, sieve, manifest, err);
    if (status == MS_OK) {
        ms_manifest_free(manifest);
        *manifest = made;
    }
    return status;
}

/* Sizes by the sieve curve. */
static ms_status read_sizes(ms_manifest *manifest, scene_arguments *a, ms_error *err)
{
    ms_status status = a->sieve_file ? ms_sieve_read(&a->sieve, a->sieve_file, (size_t)a->classes, err) : MS_OK;
    if (status == MS_OK && a->sieve_file && ms_manifest_has_sizes(manifest)) {
        status =
            ms_fail(err, MS_ERR_ARG, "%s has sizes, and so has --sieve %s; drop one of them", a->source, a->sieve_file);
    } else if (status == MS_OK && a->sieve_file) {
        status = apply_sieve(manifest, &a->sieve, err);
    }
    if (status == MS_OK && a->min_radius > 0 && ms_manifest_has_sizes(manifest)) {
        status = ms_fail(err, MS_ERR_ARG,
                         "--min-radius is of shapes in their own size, since all sizes of a shape share its templates; "
                         "drop it or the sizes");
    }
    return status;
}

static int read_and_work(const ms_command *command, scene_arguments *a)
{
    ms_manifest manifest;
    ms_error err;
    if (read_manifest(&manifest, a, &err) != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    const ms_status status = read_sizes(&manifest, a, &err);
    const int code = status == MS_ERR_ARG ? ms_flags_wrong_usage(command, err.text)
                     : status != MS_OK    ? ms_flags_fail(command, &err)
                                          : resolve_and_work(command, a, &manifest);
    ms_manifest_free(&manifest);
    ms_sieve_free(&a->sieve);
    return code;
}

static int run_scene(const ms_command *command, int argc, char **argv)
{
    scene_arguments a = {.max_spheres = DEFAULT_MAX_SPHERES,
                         .recipe = {.name = MS_GENERATOR_DEFAULT, .seed = 1},
                         .argc = argc,
                         .argv = argv};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 1, argc, argv, take_scene_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes one manifest (.csv: shape,count) or one shape", 1, argc - first,
                                    argv + first);
    }
    if (a.n_formats > 0 && !a.folder) {
        return ms_flags_wrong_usage(command, "--format is that of the templates; give -o DIR beside it");
    }
    if (a.engines.mass.density > 0 && !a.folder) {
        return ms_flags_wrong_usage(command, "--density is for the templates; give -o DIR beside it");
    }
    a.source = argv[first];
    if (a.particles > 0 && is_manifest(a.source)) {
        return ms_flags_wrong_usage(command, "leave --particles out: a manifest has its own counts");
    }
    if (a.classes > 0 && !a.sieve_file) {
        return ms_flags_wrong_usage(command, "--classes are those of a sieve curve; give --sieve FILE beside it");
    }
    if (a.n_formats == 0) {
        a.format[a.n_formats++] = ms_write_format_find("csv", &err);
    }
    ms_status status = ms_scene_engines_resolve(&a.engines, a.format, a.n_formats, &err);
    if (status == MS_OK) {
        status = ms_recipe_resolve(&a.recipe, &err);
    }
    if (status == MS_OK) {
        a.input.cut |= a.goal.measure == &ms_measures[MS_MEASURE_COVERAGE_CUT];
        a.input.need = ms_generator_need(a.recipe.generator, &a.recipe.settings, a.input.cut);
        const char *const inputs[] = {a.source, a.recipe.settings.clump_file, a.sieve_file};
        status = ms_files_check_standard(inputs, 3, &err);
    }
    code = status == MS_OK ? read_and_work(command, &a) : ms_flags_refuse(command, status, &err);
    ms_recipe_free(&a.recipe);
    return code;
}

const ms_command ms_command_scene = {
    .name = "scene",
    .summary = "how many spheres each shape of a scene needs, and its templates",
    .usage = "MANIFEST|SHAPE --budget N|--tolerance MEASURE=V|--tolerance-length L|--mean-tolerance dice=V|--knee PART "
             "[--sieve FILE] [-o DIR [--density RHO --format F]...]",
    .example = "mskit scene grain.stl --knee 0.1 --max-spheres 20 --cells 50 -o templates",
    .flags = FLAGS,
    .run = run_scene,
};
