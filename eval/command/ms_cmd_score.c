/* mskit score CLUMP --target SHAPE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_files.h"
#include "cli/ms_input.h"
#include "cli/ms_outputs.h"
#include "cli/ms_report.h"
#include "clump/formats/ms_read.h"
#include "measure/ms_metrics.h"
#include "ms_commands.h"
#include "view/ms_view_formats.h"

static const ms_flag FLAGS[] = {
    {"target", 't', "SHAPE", "the mesh or volume that the clump stands for"},
    {"curve", 0, NULL,
     "scores of every prefix as CSV: n" MS_MEASURE_CURVE_NAMES
     "; those of variational are no clumps: see generate --curve"},
    {"json", 0, NULL, "as JSON"},
    {"output", 'o', "FILE", "also write the clump, as a page (.html), a picture (.png), a surface or any other format"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct score_arguments {
    ms_input_flags input;
    const char *target;
    int json, curve;
    ms_outputs outputs;
    int argc; /* as the command was typed */
    char **argv;
} score_arguments;

static ms_status take_score_flag(void *context, const char *name, const char *value, ms_error *err)
{
    score_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (!taken) {
        status = ms_outputs_flag(&taken, &a->outputs, name, value, err);
    }
    if (taken) {
        return status;
    }
    if (strcmp(name, "target") == 0) {
        a->target = value;
    }
    a->json |= strcmp(name, "json") == 0;
    a->curve |= strcmp(name, "curve") == 0;
    return MS_OK;
}

static int writes_to_stdout(const score_arguments *a)
{
    return a->json || a->curve || ms_outputs_to_stdout(&a->outputs);
}

static ms_status write_shown(const score_arguments *a, const ms_input *input, const ms_clump *clump,
                             const ms_particle *particle, const ms_metrics *metrics, ms_error *err)
{
    const ms_view_about about = {.shape = input->path,
                                 .target = &input->target,
                                 .metrics = a->curve ? NULL : metrics,
                                 .ordered = 1,
                                 .h = input->target.grid.h,
                                 .max_points = ms_input_max_voxels(&a->input),
                                 .argc = a->argc,
                                 .argv = a->argv};
    const ms_content content = {.clump = clump, .particle = particle->mass > 0 ? particle : NULL, .more = &about};
    return ms_outputs_write(&a->outputs, &content, writes_to_stdout(a) ? stderr : stdout, err);
}

static ms_status print_score(const score_arguments *a, const ms_input *input, const ms_metrics *metrics,
                             const ms_score *curve, ms_error *err)
{
    if (a->curve) {
        ms_report_curve(stdout, curve, metrics->spheres);
        return MS_OK;
    }
    if (a->json) {
        return ms_report_print(
            stdout,
            json_pack("{s:o,s:o}", "target", ms_report_input_json(input), "scores", ms_report_metrics_json(metrics)),
            err);
    }
    ms_report_metrics(writes_to_stdout(a) ? stderr : stdout, metrics, &input->target);
    return MS_OK;
}

static ms_status report_score(const score_arguments *a, const ms_input *input, const ms_clump *clump,
                              const ms_particle *particle, ms_error *err)
{
    ms_metrics metrics;
    ms_score *curve = malloc((clump->n_spheres + 1) * sizeof *curve);
    if (!curve) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu scores", clump->n_spheres);
    }
    ms_status status = ms_metrics_compute_kinds(&metrics, curve, a->curve ? 0 : MS_METRICS_ALL, &input->target, clump,
                                                ms_input_max_voxels(&a->input), err);
    if (status == MS_OK) {
        status = print_score(a, input, &metrics, curve, err);
    }
    if (status == MS_OK && a->outputs.n_asked) {
        status = write_shown(a, input, clump, particle, &metrics, err);
    }
    free(curve);
    return status;
}

/* What the file knows of the masses says which formats can be written. */
static ms_status check_score_files(score_arguments *a, const char *path, const ms_clump *clump,
                                   const ms_particle *particle, ms_error *err)
{
    const int known = particle->mass > 0 && particle->density > 0;
    const ms_need need = !known ? MS_NEED_SPHERES : clump->mass ? MS_NEED_MASSES : MS_NEED_PARTICLE;
    const ms_status status = ms_outputs_resolve(&a->outputs, path, "", need, 0, err);
    return status == MS_OK ? ms_outputs_check(&a->outputs, path, NULL, a->target, err) : status;
}

static ms_status execute_score(score_arguments *a, const char *path, ms_error *err)
{
    ms_input input;
    ms_clump clump;
    ms_particle particle;
    ms_status status = ms_read_clump(&clump, &particle, path, err);
    if (status != MS_OK) {
        return status;
    }
    if (a->outputs.n_asked) {
        status = check_score_files(a, path, &clump, &particle, err);
    }
    if (status == MS_OK && (status = ms_input_read(&input, a->target, &a->input, err)) == MS_OK) {
        status = ms_input_target(&input, &a->input, err);
        if (status == MS_OK) {
            status = report_score(a, &input, &clump, &particle, err);
        }
        ms_input_free(&input);
    }
    ms_clump_free(&clump);
    return status;
}

static ms_status resolve_score(score_arguments *a, const char *path, ms_error *err)
{
    const char *const inputs[] = {path, a->target};
    ms_status status = ms_files_check_standard(inputs, 2, err);
    if (status == MS_OK && a->outputs.n_asked) {
        status = ms_outputs_resolve(&a->outputs, path, "", MS_NEED_MASSES, 0, err);
    }
    return status == MS_OK && a->json + a->curve + ms_outputs_to_stdout(&a->outputs) > 1
               ? ms_fail(err, MS_ERR_ARG, "--curve prints CSV, --json JSON and each - a file; choose one of them")
               : status;
}

static int run_score(const ms_command *command, int argc, char **argv)
{
    score_arguments a = {.argc = argc, .argv = argv};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_score_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1 || !a.target) {
        return ms_flags_wrong_words(command, "takes one clump file and --target SHAPE", 1, argc - first, argv + first);
    }
    const ms_status status = resolve_score(&a, argv[first], &err);
    if (status != MS_OK) {
        code = ms_flags_refuse(command, status, &err);
    } else {
        code = execute_score(&a, argv[first], &err) == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
    }
    ms_outputs_free(&a.outputs);
    return code;
}

const ms_command ms_command_score = {
    .name = "score",
    .summary = "measure any file of spheres x,y,z,r against a shape",
    .usage = "CLUMP --target SHAPE [...]",
    .example = "mskit score grain.csv --target grain.stl --cells 150",
    .flags = FLAGS,
    .run = run_score,
};
