/* mskit generate SHAPE */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ms_commands.h"
#include "ms_file.h"
#include "ms_generator.h"
#include "ms_input.h"
#include "ms_record.h"
#include "ms_report.h"
#include "ms_text.h"
#include "ms_write.h"

enum { MAX_OUTPUTS = 16, MAX_SETTINGS = 256, DEFAULT_SPHERES = 50 };

static const ms_flag FLAGS[] = {
    {"generator", 'g', "NAME", "the method, mss, setcover, fcm or variational (mss); mskit generators lists them"},
    {"spheres", 'n', "N", "at most N spheres (50, if no --until is given)"},
    {"until", 0, "MEASURE=VALUE",
     "end when eta, dice, coverage or inertia is as good, or spheres would be smaller than radius; may be repeated"},
    {"set", 0, "OPTION=VALUE", "an option of the method (mskit help NAME); --OPTION VALUE does the same"},
    {"seed", 0, "S", "seed of methods that draw random numbers (1)"},
    {"output", 'o', "FILE", "csv, json or vtk by its ending, - for standard output; may be repeated"},
    {"format", 0, "F", "format of the outputs whatever their ending"},
    {"target-grid", 0, "FILE", "also write the voxels of the shape as VTK"},
    {"json", 0, NULL, "scores and settings as JSON on standard output"},
    MS_INPUT_FLAGS,
    {0},
};

/* An option of the generator as it was written. */
typedef struct wish {
    const char *name; /* NULL: `text` is OPTION=VALUE */
    const char *text;
} wish;

typedef struct arguments {
    const char *shape;
    ms_input_flags input;
    const char *generator_name;
    wish wish[MAX_SETTINGS];
    int n_wishes;
    const ms_generator *generator;
    ms_settings settings;
    ms_stop stop;
    double seed;
    const char *output[MAX_OUTPUTS];
    int n_outputs;
    char default_output[MAX_OUTPUTS][512];
    const ms_format *format;
    const char *target_grid;
    int json;
} arguments;

/* Cuts "name=value" in two; `name` has room for 64 characters. */
static ms_status split_assignment(char name[64], const char **value, const char *text, ms_error *err)
{
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : strlen(text);
    if (length == 0 || length >= 64) {
        return ms_fail(err, MS_ERR_ARG, "'%s' is not of the form name=value", text);
    }
    memcpy(name, text, length);
    name[length] = 0;
    *value = equals ? equals + 1 : NULL;
    return MS_OK;
}

static ms_status take_until(arguments *a, const char *text, ms_error *err)
{
    char name[64];
    const char *value = NULL;
    double number;
    ms_status status = split_assignment(name, &value, text, err);
    if (status != MS_OK) {
        return status;
    }
    const ms_word word = {value, value ? strlen(value) : 0};
    ms_stop known = ms_stop_none();
    status = ms_stop_set(&known, name, 0, err); /* is there such a measure? */
    if (status == MS_OK && (word.length == 0 || !ms_word_double(&number, &word))) {
        return ms_fail(err, MS_ERR_ARG, "--until '%s' is not of the form MEASURE=VALUE, as %s=0.05", text, name);
    }
    return status == MS_OK ? ms_stop_set(&a->stop, name, number, err) : status;
}

static ms_status take_output(arguments *a, const char *path, ms_error *err)
{
    if (a->n_outputs == MAX_OUTPUTS) {
        return ms_fail(err, MS_ERR_LIMIT, "more than %d outputs", MAX_OUTPUTS);
    }
    a->output[a->n_outputs++] = path;
    return MS_OK;
}

/* Which options there are is known when all flags are read: the generator may come last. */
static ms_status take_wish(arguments *a, const char *name, const char *text, ms_error *err)
{
    if (a->n_wishes == MAX_SETTINGS) {
        return ms_fail(err, MS_ERR_LIMIT, "more than %d options of the generator", MAX_SETTINGS);
    }
    a->wish[a->n_wishes++] = (wish){name, text};
    return MS_OK;
}

static ms_status take_flag(void *context, const char *name, const char *value, ms_error *err)
{
    arguments *a = context;
    double number;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (taken) {
        return status;
    }
    if (strcmp(name, "generator") == 0) {
        a->generator_name = value;
        return MS_OK;
    }
    if (strcmp(name, "spheres") == 0) {
        status = ms_flag_whole(&number, name, value, 1, MS_CLUMP_MAX_SPHERES, err);
        a->stop.spheres = status == MS_OK ? (size_t)number : 0;
        return status;
    }
    if (strcmp(name, "seed") == 0) {
        return ms_flag_whole(&a->seed, name, value, 0, 9007199254740992.0, err);
    }
    if (strcmp(name, "format") == 0) {
        a->format = ms_format_find(value, err);
        return a->format ? MS_OK : MS_ERR_ARG;
    }
    if (strcmp(name, "target-grid") == 0) {
        a->target_grid = value;
        return MS_OK;
    }
    if (strcmp(name, "json") == 0) {
        a->json = 1;
        return MS_OK;
    }
    if (strcmp(name, "until") == 0) {
        return take_until(a, value, err);
    }
    if (strcmp(name, "output") == 0) {
        return take_output(a, value, err);
    }
    return take_wish(a, strcmp(name, "set") == 0 ? NULL : name, value, err);
}

/* Finds the generator and gives it its options. */
static ms_status settle_generator(arguments *a, ms_error *err)
{
    a->generator = ms_generator_find(a->generator_name, err);
    ms_status status = a->generator ? ms_settings_init(&a->settings, a->generator->options, err) : MS_ERR_ARG;
    for (int w = 0; w < a->n_wishes && status == MS_OK; w++) {
        char name[64];
        const char *value = a->wish[w].text;
        if (!a->wish[w].name) {
            status = split_assignment(name, &value, a->wish[w].text, err);
        }
        if (status == MS_OK) {
            status = ms_settings_set(&a->settings, a->wish[w].name ? a->wish[w].name : name, value, err);
        }
    }
    return status;
}

/* The format of an output; NULL with a message. */
static const ms_format *format_of(const arguments *a, const char *path, ms_error *err)
{
    char ending[16];
    ms_error cause;
    if (a->format) {
        return a->format;
    }
    ms_file_ending(ending, path);
    const ms_format *format = ms_format_find(strcmp(path, "-") == 0 ? "csv" : ending, &cause);
    if (!format) {
        ms_fail(err, MS_ERR_ARG, "the ending of --output '%.200s' names no format, and --format is not given: %s",
                path, cause.text);
    }
    return format;
}

/* Without --output: NAME-GENERATOR.csv, .json and .vtk in the working folder. */
static void add_default_outputs(arguments *a)
{
    const char *slash = strrchr(a->shape, '/'), *base = slash ? slash + 1 : a->shape, *dot = strrchr(base, '.');
    const int length = dot && dot > base ? (int)(dot - base) : (int)strlen(base);
    for (const ms_format *f = ms_formats; f->name && a->n_outputs < MAX_OUTPUTS; f++) {
        char *path = a->default_output[a->n_outputs];
        if (!a->format || f == a->format) {
            snprintf(path, sizeof a->default_output[0], "%.*s-%s.%s", length, base, a->generator->name, f->name);
            a->output[a->n_outputs++] = path;
        }
    }
}

/* Checks before the work what can be known of the outputs. */
static ms_status settle_outputs(arguments *a, ms_error *err)
{
    int to_stdout = a->json;
    for (int o = 0; o < a->n_outputs; o++) {
        if (a->output[o][0] == '\0') {
            return ms_fail(err, MS_ERR_ARG, "--output '' names no file; use - for standard output");
        }
        if (!format_of(a, a->output[o], err)) {
            return MS_ERR_ARG;
        }
        to_stdout += strcmp(a->output[o], "-") == 0;
    }
    if (a->n_outputs == 0) {
        add_default_outputs(a);
    }
    to_stdout += a->target_grid && strcmp(a->target_grid, "-") == 0;
    return to_stdout > 1 ? ms_fail(err, MS_ERR_ARG, "--json and each - write to standard output; choose one of them")
                         : MS_OK;
}

/* Are both the same file? */
static int same_file(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

/* Can this file be made? A device or a pipe is not tried, since that would be noticed at its other end. */
static ms_status try_output(const char *shape, const char *path, ms_error *err)
{
    ms_output output;
    struct stat info;
    if (strcmp(path, "-") == 0 || (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))) {
        return MS_OK;
    }
    if (same_file(shape, path)) {
        return ms_fail(err, MS_ERR_ARG, "%s is the shape itself; it is not overwritten", path);
    }
    ms_status status = ms_output_open(&output, path, err);
    if (status == MS_OK) {
        ms_output_close(&output, MS_ERR_IO, NULL); /* removes it */
    }
    return status;
}

static ms_status try_outputs(const arguments *a, ms_error *err)
{
    ms_status status = a->target_grid ? try_output(a->shape, a->target_grid, err) : MS_OK;
    for (int o = 0; o < a->n_outputs && status == MS_OK; o++) {
        status = try_output(a->shape, a->output[o], err);
    }
    return status;
}

/* A line on the terminal, kept up to date. */
typedef struct progress_line {
    const char *name;
    double shown; /* when */
} progress_line;

static void show_progress(void *context, size_t spheres, double dice)
{
    progress_line *line = context;
    const double now = omp_get_wtime();
    if (now - line->shown > 0.1) {
        line->shown = now;
        if (isnan(dice)) {
            fprintf(stderr, "\r%s: %zu spheres to begin with ", line->name, spheres);
        } else {
            fprintf(stderr, "\r\033[K%s: %zu spheres, D %.4f ", line->name, spheres, dice);
        }
    }
}

static ms_status generate(ms_result *r, const arguments *a, const ms_input *input, ms_error *err)
{
    const char *name = a->generator->name;
    const int terminal = isatty(STDERR_FILENO);
    progress_line line = {.name = name};
    const ms_run run = {.target = &input->target, .stop = a->stop, .settings = &a->settings,
                        .seed = (uint64_t)a->seed, .progress = terminal ? show_progress : NULL,
                        .progress_context = &line};
    const double start = omp_get_wtime();
    ms_status status = ms_generator_run(&r->clump, &r->reason, a->generator, &run, err);
    const double generated = omp_get_wtime();
    if (terminal && line.shown > 0) {
        fputs("\r\033[K", stderr); /* clears it */
    }
    if (status == MS_OK && r->reason == MS_STOP_EXHAUSTED) {
        fprintf(stderr,
                "%s: found no place for a further sphere after %zu; more cells may help, or its options (mskit help "
                "%s)\n",
                name, r->clump.n_spheres, name);
    }
    if (status == MS_OK) {
        status = ms_metrics_compute(&r->metrics, NULL, &input->target, &r->clump,
                                    ms_input_max_voxels(&a->input), err);
    }
    r->generate_seconds = generated - start;
    r->score_seconds = omp_get_wtime() - generated;
    return status;
}

static int writes_to_stdout(const arguments *a)
{
    int found = a->json || (a->target_grid && strcmp(a->target_grid, "-") == 0);
    for (int o = 0; o < a->n_outputs; o++) {
        found |= strcmp(a->output[o], "-") == 0;
    }
    return found;
}

static ms_status write_outputs(const arguments *a, const ms_input *input, const ms_result *r, const char *record,
                               ms_error *err)
{
    FILE *words = writes_to_stdout(a) ? stderr : stdout;
    ms_status status = MS_OK;
    for (int o = 0; o < a->n_outputs && status == MS_OK; o++) {
        status = ms_write_clump(&r->clump, a->output[o], a->format, record, err);
        if (strcmp(a->output[o], "-") != 0 && status == MS_OK) {
            fprintf(words, "wrote %s\n", a->output[o]);
        }
    }
    if (status == MS_OK && a->target_grid) {
        status = ms_write_grid(&input->target.grid, a->target_grid, err);
        if (strcmp(a->target_grid, "-") != 0 && status == MS_OK) {
            fprintf(words, "wrote %s\n", a->target_grid);
        }
    }
    return status;
}

static ms_status report(const arguments *a, const ms_input *input, const ms_result *r, ms_error *err)
{
    json_t *json = ms_record_json(a->generator, &a->settings, &a->stop, (uint64_t)a->seed, input, r);
    char *record = json ? json_dumps(json, JSON_COMPACT) : NULL;
    ms_status status;
    if (!record) {
        json_decref(json);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the record of the run");
    }
    if (!a->json) {
        FILE *words = writes_to_stdout(a) ? stderr : stdout;
        fprintf(words, "%s with %s, stopped by %s, %.3g s\n", input->path, a->generator->name,
                ms_stop_name(r->reason), r->generate_seconds);
        ms_report_metrics(words, &r->metrics, &input->target);
    }
    status = write_outputs(a, input, r, record, err);
    free(record);
    if (a->json && status == MS_OK) {
        return ms_report_print(stdout, json, err);
    }
    json_decref(json);
    return status;
}

static int work(const ms_command *command, const arguments *a)
{
    ms_error err;
    ms_input input;
    ms_result r;
    memset(&r, 0, sizeof r);
    ms_status status = ms_input_read(&input, a->shape, &a->input, &err);
    if (status != MS_OK) {
        return ms_fail_command(command, &err);
    }
    status = try_outputs(a, &err);
    if (status == MS_OK) {
        status = ms_input_target(&input, &a->input, &err);
    }
    if (status == MS_OK) {
        status = generate(&r, a, &input, &err);
    }
    if (status == MS_OK) {
        status = report(a, &input, &r, &err);
    }
    ms_clump_free(&r.clump);
    ms_input_free(&input);
    return status == MS_OK ? EXIT_DONE : ms_fail_command(command, &err);
}

/* What follows from all flags together. */
static ms_status settle(arguments *a, ms_error *err)
{
    if (ms_stop_is_none(&a->stop)) {
        a->stop.spheres = DEFAULT_SPHERES;
    }
    ms_status status = settle_generator(a, err);
    return status == MS_OK ? settle_outputs(a, err) : status;
}

static int run(const ms_command *command, int argc, char **argv)
{
    arguments a = {.generator_name = "mss", .stop = ms_stop_none(), .seed = 1};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 1, argc, argv, take_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_wrong_usage(command, "takes one shape");
    }
    a.shape = argv[first];
    code = settle(&a, &err) == MS_OK ? work(command, &a) : ms_wrong_usage(command, err.text);
    ms_settings_free(&a.settings);
    return code;
}

const ms_command ms_command_generate = {
    .name = "generate",
    .summary = "make a clump for a shape, score it and write it",
    .usage = "SHAPE [-g NAME] [-n N] [--until MEASURE=VALUE]... [-o FILE]...",
    .example = "mskit generate grain.stl --generator mss --spheres 50 --cells 100 -o grain.csv -o grain.json",
    .flags = FLAGS,
    .run = run,
};
