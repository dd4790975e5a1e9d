/* mskit generate SHAPE */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_expectation.h"
#include "cli/ms_input.h"
#include "cli/ms_json_object.h"
#include "cli/ms_least_work.h"
#include "cli/ms_mass.h"
#include "cli/ms_outputs.h"
#include "cli/ms_progress.h"
#include "cli/ms_recipe.h"
#include "cli/ms_record.h"
#include "cli/ms_report.h"
#include "cli/ms_until.h"
#include "ms_commands.h"
#include "ms_curve.h"
#include "view/ms_view_formats.h"

static const ms_flag FLAGS[] = {
    MS_RECIPE_FLAGS,
    MS_UNTIL_FLAGS,
    MS_LEAST_WORK_FLAGS,
    MS_OUTPUT_FLAGS,
    {"equal-volume", 0, NULL, "scale the clump about the centroid of the shape until its union has the shape's volume"},
    {"correct", 0, NULL, "give the spheres masses that sum to the true mass and inertia; takes --density"},
    MS_MASS_FLAGS,
    {"target-grid", 0, "FILE", "also write the voxels of the shape as VTK"},
    {"curve", 0, "FILE",
     "also write the scores of the clumps of 1 to n spheres as CSV; where prefixes are no clumps (variational), each "
     "is a run "
     "of its own"},
    {"json", 0, NULL, "scores and settings as JSON on standard output"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct generate_arguments {
    int argc; /* as the command was typed */
    char **argv;
    const char *shape;
    ms_input_flags input;
    ms_recipe recipe;
    ms_stop stop; /* with --least-work in the end that of the run kept */
    ms_least_work work;
    ms_least_work_tries tries;
    ms_outputs outputs;
    ms_mass_flags mass;
    int correct;
    const char *target_grid, *curve;
    int json;
} generate_arguments;

static ms_status take_generate_flag(void *context, const char *name, const char *value, ms_error *err)
{
    generate_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (!taken) {
        status = ms_mass_flag(&taken, &a->mass, name, value, err);
    }
    if (!taken) {
        status = ms_outputs_flag(&taken, &a->outputs, name, value, err);
    }
    if (!taken) {
        status = ms_until_flag(&taken, &a->stop, name, value, err);
    }
    if (!taken) {
        status = ms_least_work_flag(&taken, &a->work, name, value, err);
    }
    if (taken) {
        return status;
    }
    if (strcmp(name, "target-grid") == 0) {
        a->target_grid = value;
        return MS_OK;
    }
    if (strcmp(name, "curve") == 0) {
        a->curve = value;
        return MS_OK;
    }
    if (strcmp(name, "equal-volume") == 0) {
        a->recipe.equal_volume = 1;
        return MS_OK;
    }
    if (strcmp(name, "json") == 0 || strcmp(name, "correct") == 0) {
        *(name[0] == 'j' ? &a->json : &a->correct) = 1;
        return MS_OK;
    }
    return ms_recipe_flag(&taken, &a->recipe, name, value, err);
}

/* Number of files that go to standard output. */
static int outputs_to_stdout(const generate_arguments *a)
{
    return ms_outputs_to_stdout(&a->outputs) + (a->target_grid && strcmp(a->target_grid, "-") == 0) +
           (a->curve && strcmp(a->curve, "-") == 0);
}

/* Checks before the work what can be known of the outputs. */
static ms_status resolve_outputs(generate_arguments *a, ms_error *err)
{
    char behind[64];
    snprintf(behind, sizeof behind, "-%s", a->recipe.generator->name);
    const ms_need known = a->correct ? MS_NEED_MASSES : MS_NEED_SPHERES;
    ms_status status = ms_outputs_resolve(&a->outputs, a->shape, behind, known, 1, err);
    return status == MS_OK && a->json + outputs_to_stdout(a) > 1
               ? ms_fail(err, MS_ERR_ARG, "--json and each - write to standard output; choose one of them")
               : status;
}

static ms_status resolve_masses(generate_arguments *a, ms_error *err)
{
    if (!a->correct && a->mass.any) {
        return ms_fail(err, MS_ERR_ARG, "flags about masses take --correct beside them");
    }
    if (a->correct && !(a->mass.density > 0)) {
        return ms_fail(err, MS_ERR_ARG, "--correct takes --density RHO, in kg/m^3");
    }
    return ms_mass_resolve(&a->mass, err);
}

/* The file that is written if no masses are found and all outputs take them. */
static ms_status list_spare(ms_files *files, const ms_outputs *outputs, ms_error *err)
{
    for (size_t f = 0; f < outputs->n_files; f++) {
        if (outputs->file[f].format->need == MS_NEED_SPHERES) {
            return MS_OK;
        }
    }
    char *spare = ms_outputs_spare(outputs, err);
    const ms_status status = spare ? ms_files_add(files, spare, MS_FILE_WRITTEN, err) : MS_ERR_NOMEM;
    free(spare);
    return status;
}

static ms_status try_generate_outputs(const generate_arguments *a, ms_error *err)
{
    const struct {
        const char *path;
        ms_file_use use;
    } other[] = {
        {a->recipe.settings.clump_file, MS_FILE_READ}, {a->target_grid, MS_FILE_WRITTEN}, {a->curve, MS_FILE_WRITTEN}};
    ms_files files = {0};
    ms_status status = ms_files_add_shape(&files, a->shape, err);
    for (size_t f = 0; f < sizeof other / sizeof *other && status == MS_OK; f++) {
        status = other[f].path ? ms_files_add(&files, other[f].path, other[f].use, err) : MS_OK;
    }
    if (status == MS_OK) {
        status = ms_outputs_list(&files, &a->outputs, err);
    }
    if (status == MS_OK && a->correct) {
        status = list_spare(&files, &a->outputs, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
    return status;
}

/* What the generators are given. */
static ms_run make_run(const generate_arguments *a, const ms_input *input)
{
    ms_run run = {
        .target = &input->target, .stop = a->stop, .settings = &a->recipe.settings, .seed = (uint64_t)a->recipe.seed};
    ms_progress_show(&run);
    return run;
}

/* Where nothing can be expected. */
static const double FIRST_SPHERES = 50;

/* Numbers of spheres and least radii are tried; from then on the stop rule is that of the run kept. */
static ms_status try_clumps(ms_result *r, generate_arguments *a, const ms_input *input, ms_error *err)
{
    ms_expect expect;
    ms_status status = ms_expectation_try(&expect, input, err);
    if (status != MS_OK) {
        return status;
    }
    ms_progress_line line = {.name = a->recipe.generator->name};
    ms_run run = make_run(a, input);
    const double expected = ms_expectation_spheres(&expect, a->work.dice);
    const double first = isnan(expected) ? FIRST_SPHERES : fmin(expected, MS_CLUMP_MAX_SPHERES);
    ms_progress_say_remarks(&run, &line);
    const double start = omp_get_wtime();
    status = ms_least_work_generate(&r->clump, &a->tries, &a->work, a->recipe.generator, &run, (size_t)first,
                                    ms_input_max_voxels(&a->input), err);
    r->generate_seconds = omp_get_wtime() - start;
    if (status == MS_OK) {
        a->stop = ms_least_work_stop(&a->tries);
        r->reason = a->tries.row[a->tries.kept].reason;
    }
    return status;
}

static ms_status make_clump(ms_result *r, const generate_arguments *a, const ms_input *input, ms_error *err)
{
    const char *name = a->recipe.generator->name;
    ms_progress_line line = {.name = name, .goal = a->recipe.generator->nested ? a->stop.spheres : 0};
    ms_run run = make_run(a, input);
    ms_progress_say_remarks(&run, &line);
    ms_progress_open(&line);
    const double start = omp_get_wtime();
    ms_progress_catch(
        ms_generator_is_nested(a->recipe.generator, run.settings)); /* what others have before their end is no clump */
    ms_status status = ms_generator_run(&r->clump, &r->reason, a->recipe.generator, &run, err);
    ms_progress_catch(0);
    r->generate_seconds = omp_get_wtime() - start;
    ms_progress_close();
    if (status == MS_OK && r->reason == MS_STOP_EXHAUSTED) {
        fprintf(stderr,
                "%s: found no place for a further sphere after %zu; more cells may help, or its options (mskit help "
                "%s)\n",
                name, r->clump.n_spheres, name);
    }
    return status;
}

static ms_status score_clump(ms_result *r, const generate_arguments *a, const ms_input *input, ms_error *err)
{
    const double start = omp_get_wtime();
    const ms_status status =
        ms_metrics_compute(&r->metrics, NULL, &input->target, &r->clump, ms_input_max_voxels(&a->input), err);
    r->score_seconds = omp_get_wtime() - start;
    return status;
}

/* A clump whose masses are not found is written without them; the failure is kept for the end. */
static ms_status add_masses(ms_result *r, const generate_arguments *a, const ms_input *input, ms_error *err)
{
    if (!a->correct) {
        return MS_OK;
    }
    const ms_status status =
        ms_mass_correct(&r->mass, &r->clump, &a->mass, &input->target.body, ms_input_max_voxels(&a->input), err);
    if (status != MS_OK) {
        ms_clump_drop_masses(&r->clump);
    }
    return status;
}

static ms_status write_curve(const generate_arguments *a, const ms_input *input, const ms_clump *clump, ms_error *err)
{
    ms_output output;
    const ms_progress_line line = {.name = a->curve};
    const ms_run run = make_run(a, input);
    ms_score *curve = malloc((clump->n_spheres + 1) * sizeof *curve);
    const size_t max_voxels = ms_input_max_voxels(&a->input);
    ms_progress_open(&line);
    ms_status status = curve ? ms_curve_compute(curve, clump, a->recipe.generator, &run, max_voxels, err)
                             : ms_fail(err, MS_ERR_NOMEM, "no memory for the scores of %zu clumps", clump->n_spheres);
    ms_progress_close();
    if (status == MS_OK && (status = ms_output_open(&output, a->curve, err)) == MS_OK) {
        ms_report_curve(output.stream, curve, clump->n_spheres);
        status = ms_output_close(&output, MS_OK, err);
    }
    free(curve);
    return status;
}

static int writes_to_stdout(const generate_arguments *a)
{
    return a->json || outputs_to_stdout(a) > 0;
}

static void say_written(FILE *words, const char *path)
{
    if (strcmp(path, "-") != 0) {
        fprintf(words, "wrote %s\n", path);
    }
}

static ms_status write_outputs(const generate_arguments *a, const ms_input *input, const ms_result *r,
                               const char *record, ms_error *err)
{
    FILE *words = writes_to_stdout(a) ? stderr : stdout;
    const ms_particle *particle = r->mass.particle.mass > 0 ? &r->mass.particle : NULL; /* with masses or without */
    const ms_view_about about = {.shape = input->path,
                                 .target = &input->target,
                                 .metrics = &r->metrics,
                                 .ordered = ms_generator_is_nested(a->recipe.generator, &a->recipe.settings),
                                 .h = input->target.grid.h,
                                 .max_points = ms_input_max_voxels(&a->input),
                                 .argc = a->argc,
                                 .argv = a->argv};
    const ms_content content = {.clump = &r->clump, .particle = particle, .record = record, .more = &about};
    ms_status status = ms_outputs_write(&a->outputs, &content, words, err);
    if (status == MS_OK && a->target_grid) {
        status = ms_grid_write(&input->target.grid, a->target_grid, err);
        if (status == MS_OK) {
            say_written(words, a->target_grid);
        }
    }
    if (status == MS_OK && a->curve) {
        status = write_curve(a, input, &r->clump, err);
        if (status == MS_OK) {
            say_written(words, a->curve);
        }
    }
    return status;
}

static ms_status report_generate(const generate_arguments *a, const ms_input *input, const ms_result *r,
                                 const ms_expect *expect, ms_error *err)
{
    const ms_recipe *recipe = &a->recipe;
    json_t *json = ms_record_json(recipe->generator, &recipe->settings, &a->stop, (uint64_t)recipe->seed, input, r);
    char *record = json ? json_dumps(json, JSON_COMPACT) : NULL;
    ms_status status;
    if (!record) {
        json_decref(json);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the record of the run");
    }
    if (!a->json) {
        FILE *words = writes_to_stdout(a) ? stderr : stdout;
        fprintf(words, "%s with %s, stopped by %s, %.3g s\n", input->path, recipe->generator->name,
                ms_stop_name(r->reason), r->generate_seconds);
        ms_report_metrics(words, &r->metrics, &input->target);
        ms_expectation_say(words, expect, &r->metrics);
        ms_report_equal_volume(words, &r->volume);
        if (r->mass.corrected) {
            ms_mass_print(words, &r->mass);
        }
    }
    status = write_outputs(a, input, r, record, err);
    free(record);
    if (a->json && status == MS_OK) {
        ms_json_object_set(&json, "expected", ms_expectation_factor_json(expect, &r->metrics));
        if (a->work.dice > 0) {
            ms_json_object_set(&json, "least_work", ms_least_work_json(&a->tries, &a->work));
        }
        return ms_report_print(stdout, json, err);
    }
    json_decref(json);
    return status;
}

/* What is expected of a number of spheres. */
typedef struct outlook {
    size_t spheres; /* 0: of none yet */
    ms_expect expect;
} outlook;

/* Not computed again for the number that it is of. */
static ms_status expect_number(outlook *o, const ms_input *input, size_t spheres, ms_error *err)
{
    if (spheres == o->spheres) {
        return MS_OK;
    }
    o->spheres = spheres;
    return ms_expectation_near(&o->expect, input, spheres, err);
}

/* The clump is written whatever failed; then it is said. */
static ms_status write_and_say(const generate_arguments *a, const ms_input *input, ms_result *r, outlook *o,
                               ms_error *err)
{
    ms_error cause = {""};
    const ms_status masses = add_masses(r, a, input, &cause);
    ms_status status = expect_number(o, input, r->metrics.spheres, err);
    if (status == MS_OK) {
        status = report_generate(a, input, r, &o->expect, err);
    }
    if (status == MS_OK && masses != MS_OK) {
        status = ms_fail(err, masses, "the clump is written without masses, for which this failed: %s", cause.text);
    }
    if (status == MS_OK && r->reason == MS_STOP_INTERRUPTED) {
        status = ms_fail(err, MS_ERR_LIMIT, "interrupted; the %zu spheres so far are written", r->clump.n_spheres);
    }
    return status;
}

/* A word where the spheres asked for are hopeless. */
static ms_status look_ahead(outlook *o, const generate_arguments *a, const ms_input *input, ms_error *err)
{
    const ms_status status = expect_number(o, input, a->stop.spheres, err);
    return status == MS_OK && a->stop.spheres > 0 ? ms_expectation_warn(&o->expect, input, a->stop.spheres, err)
                                                  : status;
}

static int execute_generate(const ms_command *command, generate_arguments *a)
{
    ms_error err;
    ms_input input;
    ms_result r;
    outlook o = {0};
    memset(&r, 0, sizeof r);
    ms_status status = ms_input_read(&input, a->shape, &a->input, &err);
    if (status != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    status = try_generate_outputs(a, &err);
    if (status == MS_OK) {
        status = ms_input_target(&input, &a->input, &err);
    }
    if (status == MS_OK) {
        status = look_ahead(&o, a, &input, &err);
    }
    if (status == MS_OK) {
        status = a->work.dice > 0 ? try_clumps(&r, a, &input, &err) : make_clump(&r, a, &input, &err);
    }
    if (status == MS_OK && a->recipe.equal_volume) {
        status = ms_equal_volume_scale(&r.clump, &r.volume, &input.target.body, &err);
        ms_report_equal_volume_remark(input.path, &r.volume);
    }
    if (status == MS_OK) {
        status = score_clump(&r, a, &input, &err);
    }
    if (status == MS_OK) {
        status = write_and_say(a, &input, &r, &o, &err);
    }
    ms_clump_free(&r.clump);
    ms_input_free(&input);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

/* What follows from all flags together. */
static ms_status resolve_generate(generate_arguments *a, ms_error *err)
{
    const ms_status refused = ms_least_work_resolve(&a->work, &a->stop, err);
    if (refused != MS_OK) {
        return refused;
    }
    if (a->recipe.equal_volume && (a->curve || a->work.dice > 0)) {
        return ms_fail(
            err, MS_ERR_ARG,
            "--equal-volume scales the clump of the end: not with --curve or --least-work, which judge clumps "
            "as they are made");
    }
    if (!(a->work.dice > 0)) {
        ms_until_resolve(&a->stop);
    }
    a->input.cut |= a->stop.coverage_cut > 0;
    ms_status status = ms_recipe_resolve(&a->recipe, err);
    if (status == MS_OK) {
        a->input.need = ms_generator_need(a->recipe.generator, &a->recipe.settings, a->input.cut);
        const char *const inputs[] = {a->shape, a->recipe.settings.clump_file};
        status = ms_files_check_standard(inputs, 2, err);
    }
    if (status == MS_OK) {
        status = resolve_masses(a, err);
    }
    return status == MS_OK ? resolve_outputs(a, err) : status;
}

static int run_generate(const ms_command *command, int argc, char **argv)
{
    generate_arguments a = {
        .argc = argc, .argv = argv, .recipe = {.name = MS_GENERATOR_DEFAULT, .seed = 1}, .work = {.power = 1}};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 1, argc, argv, take_generate_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes one shape", 1, argc - first, argv + first);
    }
    a.shape = argv[first];
    const ms_status status = resolve_generate(&a, &err);
    code = status == MS_OK ? execute_generate(command, &a) : ms_flags_refuse(command, status, &err);
    ms_outputs_free(&a.outputs);
    ms_recipe_free(&a.recipe);
    return code;
}

const ms_command ms_command_generate = {
    .name = "generate",
    .summary = "make a clump for a shape, score it and write it",
    .usage = "SHAPE [-g NAME] [-n N] [--until MEASURE=VALUE]... [-o FILE]...",
    .example = "mskit generate grain.stl --spheres 50 --cells 100 -o grain.csv -o grain.json",
    .flags = FLAGS,
    .run = run_generate,
};
