/* mskit stability [SHAPE...] */
#include <errno.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_choice.h"
#include "base/ms_file.h"
#include "chart/ms_csv.h"
#include "cli/ms_methods.h"
#include "cli/ms_outputs.h"
#include "cli/ms_report.h"
#include "ms_commands.h"
#include "stability/ms_hard_shapes.h"
#include "stability/ms_stability.h"
#include "stability/ms_stability_charts.h"
#include "stability/ms_statistics.h"

enum { DEFAULT_SPHERES = 20, DEFAULT_RUNS = 5, MOST_RUNS = 1000 };

static const ms_flag FLAGS[] = {
    {"generator", 'g', "NAME[:OPTION=VALUE,...]", "a method, with options; may be repeated (all methods)"},
    {"spheres", 'n', "N", "spheres asked for in every run (20)"},
    {"until-dice", 0, "V", "also seek the number of spheres with which the method meets D = V, up to 10 N"},
    {"perturb", 0, "KIND",
     "axes, rotation, shift, resolution, noise, refine, decimate, seed, order or threads; may be repeated (all)"},
    {"runs", 0, "R", "runs of each perturbation (5)"},
    {"seed", 0, "S", "seed of the methods and of the perturbations (1)"},
    {"output", 'o', "FILE", "a row for each run as CSV, written as they come; - for standard output (stability.csv)"},
    {"charts", 0, "DIR", "charts of D into this folder, as SVG and PNG; takes gnuplot"},
    {"json", 0, NULL, "the summary as JSON on standard output"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct stability_arguments {
    ms_input_flags input;
    ms_methods methods;
    int wanted[MS_CHANGE_MOST]; /* of ms_changes */
    double spheres, runs, seed, until_dice;
    const char *output, *charts;
    int json;
    char **shape; /* none: the built-in ones */
    int n_shapes;
} stability_arguments;

/* What has been done so far. */
typedef struct stability_progress {
    FILE *stream; /* standard output, a device or a pipe; NULL: the table */
    ms_csv csv;
    ms_stability_run *run;
    size_t n_runs, planned;
} stability_progress;

static ms_status take_change(stability_arguments *a, const char *name, ms_error *err)
{
    const ms_change *change = ms_change_find(name, err);
    if (!change) {
        return MS_ERR_ARG;
    }
    a->wanted[change - ms_changes] = 1;
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
        return ms_flags_number(&a->until_dice, name, value, 1e-9, 1, err);
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
    if (strcmp(name, "json") == 0) {
        a->json = 1;
    } else {
        *(name[0] == 'c' ? &a->charts : &a->output) = value;
    }
    return MS_OK;
}

/* What follows from all flags together. */
static ms_status resolve_stability(stability_arguments *a, ms_error *err)
{
    int any = 0;
    for (int c = 0; ms_changes[c].name; c++) {
        any |= a->wanted[c];
    }
    for (int c = 0; ms_changes[c].name; c++) {
        a->wanted[c] |= !any || c == 0;
    }
    ms_status status = ms_methods_check(&a->methods, err);
    for (int s = 0; s < a->n_shapes && status == MS_OK; s++) {
        if (ms_file_is_standard(a->shape[s])) {
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
    if (status == MS_OK && a->json && strcmp(a->output, "-") == 0) {
        status = ms_fail(err, MS_ERR_ARG, "--json and -o - both write to standard output; choose one of them");
    }
    return status;
}

static const ms_hard_shape *find_built_in(ms_choice *choice)
{
    for (const ms_hard_shape *shape = ms_hard_shapes; shape->name; shape++) {
        if (ms_choice_offer(choice, shape->name)) {
            return shape;
        }
    }
    return NULL;
}

/* A shape that is a word on the command line; its target is not made yet. */
static ms_status read_shape(ms_input *input, const char *path, const ms_choice *built_in, const ms_input_flags *flags,
                            ms_error *err)
{
    if (built_in->nearest[0] && access(path, F_OK) != 0) {
        return ms_choice_fail(built_in, err, "there is no file and no built-in shape '%s'", path);
    }
    ms_status status = ms_input_read(input, path, flags, err);
    if (status == MS_OK && input->volume.label) {
        ms_input_free(input);
        return ms_fail(err, MS_ERR_ARG, "%s is a volume; perturbations are of meshes", path);
    }
    return status;
}

static ms_status make_input(ms_input *input, const char *name, const ms_input_flags *flags, ms_error *err)
{
    ms_choice choice = {.typed = name};
    const ms_hard_shape *built_in = find_built_in(&choice);
    if (built_in) {
        return ms_hard_shapes_make(input, built_in, flags, err);
    }
    ms_status status = read_shape(input, name, &choice, flags, err);
    if (status == MS_OK) {
        status = ms_input_target(input, flags, err);
        if (status != MS_OK) {
            ms_input_free(input);
        }
    }
    return status;
}

/* Before the work: are all files there? */
static ms_status try_shapes(const stability_arguments *a, ms_error *err)
{
    ms_status status = MS_OK;
    for (int s = 0; s < a->n_shapes && status == MS_OK; s++) {
        ms_input input;
        ms_choice choice = {.typed = a->shape[s]};
        if (!find_built_in(&choice)) {
            status = read_shape(&input, a->shape[s], &choice, &a->input, err);
            if (status == MS_OK) {
                ms_input_free(&input);
            }
        }
    }
    return status;
}

static ms_status check_stability_files(const stability_arguments *a, ms_error *err)
{
    ms_files files = {0};
    ms_status status = a->charts ? ms_outputs_make_folder(a->charts, err) : MS_OK;
    for (int s = 0; s < a->n_shapes && status == MS_OK; s++) {
        status = ms_files_add(&files, a->shape[s], MS_FILE_READ, err); /* a mesh: no data file */
    }
    if (status == MS_OK) {
        status = ms_methods_list_files(&files, &a->methods, err);
    }
    if (status == MS_OK && a->charts) {
        status = ms_stability_charts_list(&files, a->charts, &a->methods, err);
    }
    if (status == MS_OK) {
        status = ms_files_add(&files, a->output, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
    return status;
}

static void show_run(const stability_progress *p, const ms_stability *s, const ms_change *change)
{
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r\033[K%zu of %zu: %s, %s, %s ", p->n_runs + 1, p->planned, s->input->path,
                ms_stability_label(s->method).text, change->name);
    }
}

/* Once for each resolution of a shape: that of its own grid was said when the grid was made. */
static void say_misfit(const stability_progress *p, const ms_stability *s, const ms_stability_run *run)
{
    int said =
        run->voxel_size == s->input->target.grid.h && fabs(ms_target_misfit(&s->input->target)) >= MS_INPUT_MISFIT;
    for (const ms_stability_run *before = p->run; before < run && !said; before++) {
        said = before->shape_checksum == run->shape_checksum && before->voxel_size == run->voxel_size &&
               fabs(before->misfit) >= MS_INPUT_MISFIT;
    }
    if (!said) {
        ms_input_say_misfit(s->input->path, run->misfit, run->voxel_size, &s->input->mesh);
    }
}

/* The row of a run, or the header; the caller frees it; NULL without memory. */
static char *make_line(const ms_stability_run *run)
{
    char *line = NULL;
    size_t size;
    FILE *stream = open_memstream(&line, &size);
    if (!stream) {
        return NULL;
    }
    if (run) {
        ms_stability_row(stream, run);
    } else {
        ms_stability_header(stream);
    }
    return fclose(stream) == 0 ? line : NULL;
}

/* The same into the file, at once. */
static ms_status add_line(stability_progress *p, const ms_stability_run *run, ms_error *err)
{
    char *line = make_line(run);
    ms_status status = MS_OK;
    if (!line) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    }
    if (!p->stream) {
        status = ms_csv_add(&p->csv, line, err);
    } else if (fprintf(p->stream, "%s\n", line) < 0 || fflush(p->stream) != 0) {
        status = ms_fail(err, MS_ERR_IO, "a row could not be written: %s; is the disk full?", strerror(errno));
    }
    free(line);
    return status;
}

static ms_status add_run(stability_progress *p, const ms_stability *s, const ms_change *change, int number,
                         ms_error *err)
{
    ms_stability_run *run = &p->run[p->n_runs];
    show_run(p, s, change);
    ms_stability_try(run, s, change, number);
    say_misfit(p, s, run);
    p->n_runs++;
    return add_line(p, run, err);
}

static ms_status try_shape(stability_progress *p, const stability_arguments *a, const char *name, ms_error *err)
{
    ms_input input;
    ms_status status = make_input(&input, name, &a->input, err);
    if (status != MS_OK) {
        return status;
    }
    input.path = name; /* outlives the input */
    for (size_t m = 0; m < a->methods.count && status == MS_OK; m++) {
        const ms_stability s = {.input = &input,
                                .method = &a->methods.method[m],
                                .spheres = (size_t)a->spheres,
                                .until_dice = a->until_dice,
                                .seed = (uint64_t)a->seed,
                                .runs = (int)a->runs,
                                .threads = omp_get_max_threads(),
                                .flags = &a->input};
        for (int c = 0; ms_changes[c].name && status == MS_OK; c++) {
            const int runs = a->wanted[c] ? ms_change_runs(&ms_changes[c], s.runs) : 0;
            for (int number = 1; number <= runs && status == MS_OK; number++) {
                status = add_run(p, &s, &ms_changes[c], number, err);
            }
        }
    }
    ms_input_free(&input);
    return status;
}

static ms_status try_all(stability_progress *p, const stability_arguments *a, ms_error *err)
{
    ms_status status = MS_OK;
    for (int s = 0; s < a->n_shapes && status == MS_OK; s++) {
        status = try_shape(p, a, a->shape[s], err);
    }
    for (const ms_hard_shape *shape = ms_hard_shapes; !a->n_shapes && shape->name && status == MS_OK; shape++) {
        status = try_shape(p, a, shape->name, err);
    }
    if (isatty(STDERR_FILENO)) {
        fputs("\r\033[K", stderr);
    }
    return status;
}

/* A run of which no row has spheres has failed. */
static ms_status check_any_gave(const stability_progress *p, ms_error *err)
{
    for (size_t r = 0; r < p->n_runs; r++) {
        if (ms_stability_gave(&p->run[r])) {
            return MS_OK;
        }
    }
    return ms_fail(err, MS_ERR_SHAPE, "not one of %zu rows succeeded; the first failed because of this: %.700s",
                   p->n_runs, p->run[0].cause.text);
}

static ms_status report_stability(const stability_arguments *a, const stability_progress *p, ms_error *err)
{
    ms_statistics_group *groups;
    size_t count;
    ms_status status = ms_statistics_group_runs(&groups, &count, p->run, p->n_runs, err);
    if (status == MS_OK && a->json) {
        status = ms_report_print(stdout, ms_statistics_json(groups, count), err);
    } else if (status == MS_OK) {
        FILE *words = p->stream == stdout ? stderr : stdout;
        ms_statistics_print(words, groups, count, a->until_dice > 0);
    }
    free(groups);
    if (status == MS_OK && a->charts) {
        status = ms_stability_charts(a->charts, p->run, p->n_runs, err);
    }
    return status == MS_OK ? check_any_gave(p, err) : status;
}

static size_t count_runs(const stability_arguments *a)
{
    size_t each = 0, shapes = (size_t)a->n_shapes;
    for (int c = 0; ms_changes[c].name; c++) {
        each += a->wanted[c] ? (size_t)ms_change_runs(&ms_changes[c], (int)a->runs) : 0;
    }
    for (const ms_hard_shape *shape = ms_hard_shapes; !a->n_shapes && shape->name; shape++) {
        shapes++;
    }
    return each * shapes * a->methods.count;
}

/* Each row is on the disk before the next run, so that one that is killed leaves those there are. */
static ms_status open_rows(stability_progress *p, const stability_arguments *a, ms_error *err)
{
    p->planned = count_runs(a);
    p->run = malloc(p->planned * sizeof *p->run);
    if (!p->run) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu runs; fewer --runs need less", p->planned);
    }
    if (ms_files_is_stream(a->output)) {
        p->stream = strcmp(a->output, "-") == 0 ? stdout : fopen(a->output, "w");
        return p->stream ? add_line(p, NULL, err)
                         : ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s", a->output, strerror(errno));
    }
    char *header = make_line(NULL);
    const ms_status status = header ? ms_csv_open(&p->csv, a->output, header, 0, err)
                                    : ms_fail(err, MS_ERR_NOMEM, "no memory for the header");
    free(header);
    return status;
}

static int execute_stability(const ms_command *command, const stability_arguments *a)
{
    ms_error err;
    stability_progress p = {.csv = {.fd = -1}};
    ms_status status = try_shapes(a, &err);
    if (status == MS_OK) {
        status = check_stability_files(a, &err);
    }
    if (status != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    status = open_rows(&p, a, &err);
    if (status == MS_OK) {
        status = try_all(&p, a, &err);
    }
    if (status == MS_OK) {
        status = report_stability(a, &p, &err);
    }
    ms_csv_close(&p.csv);
    if (p.stream && p.stream != stdout) {
        fclose(p.stream); /* each row was flushed */
    }
    free(p.run);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

static int run_stability(const ms_command *command, int argc, char **argv)
{
    stability_arguments a = {.spheres = DEFAULT_SPHERES, .runs = DEFAULT_RUNS, .seed = 1, .output = "stability.csv"};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_stability_flag, &a);
    if (code == MS_FLAGS_GO_ON) {
        a.shape = argv + first;
        a.n_shapes = argc - first;
        const ms_status status = resolve_stability(&a, &err);
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
