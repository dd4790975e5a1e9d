/* mskit stability [SHAPE...] */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "chart/ms_csv.h"
#include "cli/ms_methods.h"
#include "cli/ms_outputs.h"
#include "cli/ms_report.h"
#include "cli/ms_until.h"
#include "ms_commands.h"
#include "stability/ms_hard_shapes.h"
#include "stability/ms_stability_charts.h"
#include "stability/ms_stability_report.h"
#include "stability/ms_stability_walk.h"
#include "stability/ms_statistics.h"

enum { DEFAULT_SPHERES = 20, DEFAULT_RUNS = 5, MOST_RUNS = 1000 };

static const ms_flag FLAGS[] = {
    {"generator", 'g', "NAME[:OPTION=VALUE,...]", "a method, with options; may be repeated (all but the baselines)"},
    {"spheres", 'n', "N", "spheres asked for in every run (20)"},
    {"until-dice", 0, "V", "also seek the number of spheres with which the method meets D = V, up to 10 N"},
    MS_MIN_RADIUS_FLAG,
    {"perturb", 0, "KIND",
     "axes, rotation, shift, lattice, resolution, noise, refine, decimate, seed, order or threads; may be repeated "
     "(all)"},
    {"runs", 0, "R", "runs of each perturbation (5)"},
    {"seed", 0, "S", "seed of the methods and of the perturbations (1)"},
    {"output", 'o', "FILE", "a row for each run as CSV, written as they come; - for standard output (stability.csv)"},
    {"resume", 0, NULL, "go on with the rows that are in FILE"},
    {"charts", 0, "DIR", "charts of D into this folder, as SVG and PNG; takes gnuplot"},
    {"report", 0, "FILE", "a page of all rows with the charts, if any, and clumps in 3-D (.html)"},
    {"json", 0, NULL, "the summary as JSON on standard output"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct stability_arguments {
    ms_input_flags input;
    ms_methods methods;
    double spheres, runs, seed;
    const char *output, *charts, *report;
    int json, resume, argc;
    char *const *argv;
    const char *built_in[MS_HARD_SHAPES_MOST]; /* names */
    ms_stability_plan plan;                    /* what follows */
} stability_arguments;

static ms_status take_change(stability_arguments *a, const char *name, ms_error *err)
{
    const ms_change *change = ms_change_find(name, err);
    if (!change) {
        return MS_ERR_ARG;
    }
    a->plan.wanted[change - ms_changes] = 1;
    return MS_OK;
}

static ms_status take_stability_flag(void *context, const char *name, const char *value, ms_error *err)
{
    stability_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (taken) {
        return status;
    }
    if (strcmp(name, "generator") == 0) {
        return ms_methods_add(&a->methods, value, err);
    }
    if (strcmp(name, "spheres") == 0) {
        return ms_flags_whole(&a->spheres, name, value, 1, MS_CLUMP_MAX_SPHERES, err);
    }
    if (strcmp(name, "until-dice") == 0) {
        return ms_flags_number(&a->plan.until_dice, name, value, 1e-9, 1, err);
    }
    if (strcmp(name, "min-radius") == 0) {
        return ms_until_min_radius(&a->plan.min_radius, value, err);
    }
    if (strcmp(name, "perturb") == 0) {
        return take_change(a, value, err);
    }
    if (strcmp(name, "runs") == 0) {
        return ms_flags_whole(&a->runs, name, value, 1, MOST_RUNS, err);
    }
    if (strcmp(name, "seed") == 0) {
        return ms_flags_whole(&a->seed, name, value, 0, 9007199254740992.0, err);
    }
    if (strcmp(name, "report") == 0) {
        return ms_files_take_page(&a->report, name, value, err);
    }
    if (strcmp(name, "json") == 0) {
        a->json = 1;
    } else if (strcmp(name, "resume") == 0) {
        a->resume = 1;
    } else {
        *(name[0] == 'c' ? &a->charts : &a->output) = value;
    }
    return MS_OK;
}

static ms_input_text say_flags(const stability_arguments *a)
{
    ms_input_text said = ms_input_flags_text(&a->input);
    ms_input_text_add(&said, "min-radius", a->plan.min_radius);
    ms_input_text_add(&said, "until-dice", a->plan.until_dice);
    return said;
}

/* What follows from all flags together. */
static ms_status resolve_stability(stability_arguments *a, const char *const *shape, size_t n_shapes, ms_error *err)
{
    int any = 0;
    for (const ms_hard_shape *h = ms_hard_shapes; h->name; h++) {
        a->built_in[h - ms_hard_shapes] = h->name;
        a->plan.n_shapes++;
    }
    a->plan.shape = a->built_in;
    if (n_shapes > 0) {
        a->plan.shape = shape;
        a->plan.n_shapes = n_shapes;
    }
    a->plan.methods = &a->methods;
    a->plan.spheres = (size_t)a->spheres;
    a->plan.seed = (uint64_t)a->seed;
    a->plan.runs = (int)a->runs;
    a->plan.flags = &a->input;
    a->plan.said = say_flags(a);
    for (int c = 0; ms_changes[c].name; c++) {
        any |= a->plan.wanted[c];
    }
    for (int c = 0; ms_changes[c].name; c++) {
        a->plan.wanted[c] |= !any || c == 0;
    }
    ms_status status = ms_methods_check(&a->methods, err);
    a->input.need = ms_methods_need(&a->methods, a->input.cut);
    for (size_t s = 0; s < n_shapes && status == MS_OK; s++) {
        if (ms_file_is_standard(shape[s])) {
            status = ms_fail(err, MS_ERR_ARG, "stability reads a shape twice, and - once; save it and name the file");
        }
    }
    for (size_t m = 0; m < a->methods.count && status == MS_OK; m++) {
        const ms_settings *settings = &a->methods.method[m].settings;
        if (settings->n_planes || settings->clump.n_spheres) {
            status = ms_fail(err, MS_ERR_ARG, "%s: planes and spheres to start from do not turn with the shape",
                             a->methods.method[m].name);
        }
    }
    a->plan.keeps_clumps = a->report != NULL;
    if (status == MS_OK && a->report && ms_files_is_stream(a->output)) {
        status = ms_fail(err, MS_ERR_ARG, "--report is made of the rows of a file; name one with -o");
    }
    if (status == MS_OK && a->json && strcmp(a->output, "-") == 0) {
        status = ms_fail(err, MS_ERR_ARG, "--json and -o - both write to standard output; choose one of them");
    }
    return status;
}

/* The folder is there as long as `files` is. */
static ms_status check_stability_files(ms_files *files, const stability_arguments *a, ms_error *err)
{
    ms_status status = a->charts ? ms_files_add_folder(files, a->charts, err) : MS_OK;
    for (size_t s = 0; s < a->plan.n_shapes && status == MS_OK; s++) {
        status = ms_files_add(files, a->plan.shape[s], MS_FILE_READ, err); /* a mesh: no data file */
    }
    if (status == MS_OK) {
        status = ms_methods_list_files(files, &a->methods, err);
    }
    if (status == MS_OK && a->charts) {
        status = ms_stability_charts_list(files, a->charts, &a->methods, err);
    }
    if (status == MS_OK) {
        status = ms_files_add(files, a->output, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK && a->report) {
        status = ms_files_add(files, a->report, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(files, err);
    }
    return status;
}

/* A table of which no row has spheres has failed. */
static ms_status check_any_gave(const ms_stability_run *run, size_t count, ms_error *err)
{
    for (size_t r = 0; r < count; r++) {
        if (ms_stability_gave(&run[r])) {
            return MS_OK;
        }
    }
    return ms_fail(err, MS_ERR_SHAPE, "not one of %zu rows succeeded; the first failed because of this: %.700s", count,
                   run[0].cause.text);
}

static ms_status report_stability(const stability_arguments *a, const ms_stability_rows *rows,
                                  const ms_stability_run *run, size_t count, ms_error *err)
{
    ms_statistics_group *groups;
    size_t n_groups;
    ms_status status = ms_statistics_group_runs(&groups, &n_groups, run, count, err);
    if (status == MS_OK && a->json) {
        status = ms_report_print(stdout, ms_statistics_json(groups, n_groups), err);
    } else if (status == MS_OK) {
        FILE *words = rows->stream == stdout ? stderr : stdout;
        ms_statistics_print(words, groups, n_groups, a->plan.until_dice > 0);
    }
    free(groups);
    if (status == MS_OK && a->charts) {
        status = ms_files_make_folder(a->charts, err);
    }
    if (status != MS_OK) {
        return status;
    }
    const ms_status drawn = a->charts ? ms_stability_charts(a->charts, &a->methods, run, count, err) : MS_OK;
    if (a->report) { /* without its charts, too, where gnuplot is not there */
        ms_error cause;
        const ms_stability_report report = {.plan = &a->plan,
                                            .run = run,
                                            .n_runs = count,
                                            .csv = &rows->csv,
                                            .charts = a->charts,
                                            .argc = a->argc,
                                            .argv = a->argv};
        status = ms_stability_report_write(a->report, &report, drawn == MS_OK ? err : &cause);
    }
    status = drawn == MS_OK ? status : drawn;
    return status == MS_OK ? check_any_gave(run, count, err) : status;
}

/* Each row is on the disk as soon as those before are, so that one that is killed leaves those there are. */
static ms_status open_rows(ms_stability_rows *rows, const stability_arguments *a, ms_error *err)
{
    char *header = ms_stability_line(NULL);
    ms_status status = header ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the header");
    if (status == MS_OK && ms_files_is_stream(a->output)) {
        rows->stream = strcmp(a->output, "-") == 0 ? stdout : fopen(a->output, "w");
        if (!rows->stream || fprintf(rows->stream, "%s\n", header) < 0 || fflush(rows->stream) != 0) {
            status =
                ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s; is the disk full?", a->output, strerror(errno));
        }
    } else if (status == MS_OK) {
        status = ms_csv_open(&rows->csv, a->output, header, a->resume, err);
    }
    free(header);
    return status;
}

static ms_status try_all(const stability_arguments *a, ms_error *err)
{
    ms_stability_rows rows = {.csv = {.fd = -1}};
    const size_t count = ms_stability_count(&a->plan);
    ms_stability_run *run = calloc(count, sizeof *run);
    ms_status status = run ? open_rows(&rows, a, err)
                           : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu runs; fewer --runs need less", count);
    if (status == MS_OK) {
        status = ms_stability_walk(run, &a->plan, &rows, err);
    }
    if (status == MS_OK) {
        status = report_stability(a, &rows, run, count, err);
    }
    ms_csv_close(&rows.csv);
    if (rows.stream && rows.stream != stdout) {
        fclose(rows.stream); /* each row was flushed */
    }
    ms_stability_free(run, run ? count : 0);
    free(run);
    return status;
}

static int execute_stability(const ms_command *command, const stability_arguments *a)
{
    ms_error err;
    ms_files files = {0};
    ms_status status = ms_stability_try_shapes(&a->plan, &err);
    if (status == MS_OK) {
        status = check_stability_files(&files, a, &err);
    }
    if (status == MS_OK) {
        status = try_all(a, &err);
    }
    ms_files_free(&files);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

static int run_stability(const ms_command *command, int argc, char **argv)
{
    stability_arguments a = {.spheres = DEFAULT_SPHERES,
                             .runs = DEFAULT_RUNS,
                             .seed = 1,
                             .output = "stability.csv",
                             .argc = argc,
                             .argv = argv};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_stability_flag, &a);
    if (code == MS_FLAGS_GO_ON) {
        const ms_status status = resolve_stability(&a, (const char *const *)argv + first, (size_t)(argc - first), &err);
        code = status == MS_OK ? execute_stability(command, &a) : ms_flags_refuse(command, status, &err);
    }
    ms_methods_free(&a.methods);
    return code;
}

const ms_command ms_command_stability = {
    .name = "stability",
    .summary = "how much results depend on what should not matter",
    .usage = "[SHAPE...] [-g NAME[:OPTION=VALUE,...]]... [-n N] [--perturb KIND]...",
    .example = "mskit stability cube speck -g mss -g fcm -n 5 --runs 2 --perturb rotation --perturb noise -o s.csv",
    .flags = FLAGS,
    .run = run_stability,
};
