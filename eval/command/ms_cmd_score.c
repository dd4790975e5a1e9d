/* mskit score CLUMP --target SHAPE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_files.h"
#include "cli/ms_input.h"
#include "cli/ms_report.h"
#include "clump/formats/ms_read.h"
#include "measure/ms_metrics.h"
#include "ms_commands.h"

static const ms_flag FLAGS[] = {
    {"target", 't', "SHAPE", "the mesh or volume that the clump stands for"},
    {"curve", 0, NULL,
     "scores of every prefix as CSV: n" MS_MEASURE_CURVE_NAMES
     "; those of variational are no clumps: see generate --curve"},
    {"json", 0, NULL, "as JSON"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct score_arguments {
    ms_input_flags input;
    const char *target;
    int json, curve;
} score_arguments;

static ms_status take_score_flag(void *context, const char *name, const char *value, ms_error *err)
{
    score_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
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

static ms_status report_score(const score_arguments *a, const ms_input *input, const ms_clump *clump, ms_error *err)
{
    ms_metrics metrics;
    ms_score *curve = malloc((clump->n_spheres + 1) * sizeof *curve);
    if (!curve) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu scores", clump->n_spheres);
    }
    ms_status status = ms_metrics_compute_kinds(&metrics, curve, a->curve ? 0 : MS_METRICS_ALL, &input->target, clump,
                                                ms_input_max_voxels(&a->input), err);
    if (status == MS_OK && a->curve) {
        ms_report_curve(stdout, curve, clump->n_spheres);
    } else if (status == MS_OK && a->json) {
        status = ms_report_print(
            stdout,
            json_pack("{s:o,s:o}", "target", ms_report_input_json(input), "scores", ms_report_metrics_json(&metrics)),
            err);
    } else if (status == MS_OK) {
        ms_report_metrics(stdout, &metrics, &input->target);
    }
    free(curve);
    return status;
}

static int run_score(const ms_command *command, int argc, char **argv)
{
    score_arguments a = {0};
    int first;
    ms_error err;
    ms_input input;
    ms_clump clump;
    ms_particle unused;
    ms_input_defaults(&a.input);
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_score_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1 || !a.target) {
        return ms_flags_wrong_usage(command, "takes one clump file and --target SHAPE");
    }
    if (a.json && a.curve) {
        return ms_flags_wrong_usage(command, "--curve prints CSV and --json JSON; choose one of them");
    }
    const char *const inputs[] = {argv[first], a.target};
    if (ms_files_check_standard(inputs, 2, &err) != MS_OK) {
        return ms_flags_wrong_usage(command, err.text);
    }
    ms_status status = ms_read_clump(&clump, &unused, argv[first], &err);
    if (status != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    status = ms_input_read(&input, a.target, &a.input, &err);
    if (status == MS_OK) {
        status = ms_input_target(&input, &a.input, &err);
        if (status == MS_OK) {
            status = report_score(&a, &input, &clump, &err);
        }
        ms_input_free(&input);
    }
    ms_clump_free(&clump);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

const ms_command ms_command_score = {
    .name = "score",
    .summary = "measure any file of spheres x,y,z,r against a shape",
    .usage = "CLUMP --target SHAPE [...]",
    .example = "mskit score grain.csv --target grain.stl --cells 150",
    .flags = FLAGS,
    .run = run_score,
};
