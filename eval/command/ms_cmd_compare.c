/* mskit compare SHAPE... */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_file.h"
#include "cli/ms_outputs.h"
#include "cli/ms_paths.h"
#include "cli/ms_report.h"
#include "cli/ms_until.h"
#include "compare/ms_compare.h"
#include "compare/ms_compare_walk.h"
#include "ms_commands.h"

static const ms_flag FLAGS[] = {
    {"generator", 'g', "NAME[:OPTION=VALUE,...]",
     "a method with its options; may be repeated (all but the baselines, by default options)"},
    {"clump", 0, "NAME=FILE",
     "spheres x,y,z,r of another tool; of several shapes a folder or pattern; may be repeated"},
    {"spheres", 'n', "N,N,...", "numbers of spheres (5,10,20,50,100)"},
    MS_MIN_RADIUS_FLAG,
    {"cells", 0, "N,N,...", "resolutions: cells along the shortest side of the shape's box (100)"},
    {"max-voxels", 0, "N", "voxels of a grid at most, as 500k or 20M; coarser where --cells asks for more"},
    MS_INPUT_RULE_FLAG,
    {"repeat", 0, "R", "run each method R times; times are the medians (1)"},
    {"seed", 0, "S", "seed of methods that draw random numbers (1)"},
    {"output", 'o', "FILE", "the results, CSV (compare.csv)"},
    {"resume", 0, NULL, "go on with the results that are in FILE"},
    {"json", 0, NULL, "all rows of FILE as JSON on standard output, too"},
    {"population", 0, "DIR", "mean and spread over all shapes, and who is best on how many: tables, charts"},
    {"charts", 0, "DIR", "draw charts of all results into this folder, by gnuplot"},
    {"report", 0, "FILE", "a page of all results with their charts and clumps in 3-D (.html); takes --charts"},
    {"allow-open", 0, NULL, "take a mesh with holes: majority of the parities along three axes"},
    MS_INPUT_CUT_FLAG,
    MS_INPUT_MENDING_FLAGS,
    MS_INPUT_VOLUME_FLAGS,
    {"max-memory", 0, "SIZE", "refuse grids beyond this, as 500M or 8G (3/4 of the machine's)"},
    {"threads", 'j', "T", "threads (all cores)"},
    {0},
};

typedef struct compare_arguments {
    ms_comparison comparison;
    const char *output;
    int resume, json;
} compare_arguments;

static void insert_number(ms_numbers *list, double value)
{
    size_t at = list->count;
    while (at > 0 && list->value[at - 1] > value) {
        at--;
    }
    if (at > 0 && list->value[at - 1] == value) {
        return;
    }
    memmove(list->value + at + 1, list->value + at, (list->count - at) * sizeof *list->value);
    list->value[at] = value;
    list->count++;
}

static ms_status take_numbers(ms_numbers *list, const char *name, const char *text, double most, ms_error *err)
{
    for (const char *at = text;; at++) {
        char word[32];
        double value;
        const size_t length = strcspn(at, ",");
        if (list->count == MS_NUMBERS_MAX || length >= sizeof word) {
            return ms_fail(err, MS_ERR_ARG, "--%s takes up to %d numbers, separated by commas", name, MS_NUMBERS_MAX);
        }
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        const ms_status status = ms_flags_whole(&value, name, word, 1, most, err);
        if (status != MS_OK) {
            return status;
        }
        insert_number(list, value);
        at += length;
        if (*at == '\0') {
            return MS_OK;
        }
    }
}

static ms_status take_compare_flag(void *context, const char *name, const char *value, ms_error *err)
{
    compare_arguments *a = context;
    ms_comparison *c = &a->comparison;
    int taken;
    if (strcmp(name, "cells") == 0) {
        return take_numbers(&c->cells, name, value, MS_GRID_MAX_EXTENT, err);
    }
    const ms_status status = ms_input_flag(&taken, &c->input, name, value, err);
    if (taken) {
        return status;
    }
    if (strcmp(name, "generator") == 0) {
        return ms_methods_add(&c->methods, value, err);
    }
    if (strcmp(name, "clump") == 0) {
        return ms_methods_add_clump(&c->methods, value, err);
    }
    if (strcmp(name, "spheres") == 0) {
        return take_numbers(&c->asked, name, value, MS_CLUMP_MAX_SPHERES, err);
    }
    if (strcmp(name, "min-radius") == 0) {
        return ms_until_min_radius(&c->min_radius, value, err);
    }
    if (strcmp(name, "repeat") == 0) {
        return ms_flags_whole(&c->repeats, name, value, 1, 1000, err);
    }
    if (strcmp(name, "seed") == 0) {
        return ms_flags_whole(&c->seed, name, value, 0, 9007199254740992.0, err);
    }
    if (strcmp(name, "resume") == 0 || strcmp(name, "json") == 0) {
        *(name[0] == 'r' ? &a->resume : &a->json) = 1;
        return MS_OK;
    }
    if (strcmp(name, "report") == 0) {
        return ms_files_take_page(&c->report, name, value, err);
    }
    const char **const file = strcmp(name, "output") == 0   ? &a->output
                              : strcmp(name, "charts") == 0 ? &c->charts
                                                            : &c->population;
    *file = value;
    return MS_OK;
}

/* What can be known before the work. The folders are there as long as `files` is. */
static ms_status check_files(ms_files *files, const ms_comparison *c, const char *output, ms_error *err)
{
    for (size_t s = 0; s < c->n_shapes; s++) {
        if (access(c->shape[s], R_OK) != 0) {
            return ms_file_fail_open(err, c->shape[s], errno);
        }
    }
    ms_status status = c->charts ? ms_files_add_folder(files, c->charts, err) : MS_OK;
    if (status == MS_OK && c->population) {
        status = ms_files_add_folder(files, c->population, err);
    }
    if (status == MS_OK) {
        status = ms_compare_list_files(files, c, err);
    }
    if (status == MS_OK) {
        status = ms_files_add(files, output, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK && c->report) {
        status = ms_files_add(files, c->report, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(files, err);
    }
    return status;
}

/* What was walked is told, even where each row failed. */
static ms_status walk_and_tell(ms_csv *csv, const compare_arguments *a, ms_error *err)
{
    ms_error cause;
    const ms_status walked = ms_compare_walk(csv, &a->comparison, err);
    const ms_status told =
        a->json ? ms_report_print(stdout, ms_compare_json(csv->row, csv->n_rows), walked == MS_OK ? err : &cause)
                : MS_OK;
    return walked == MS_OK ? told : walked;
}

/* Spheres of another tool are judged as they are. */
static void say_small_clumps(const ms_comparison *c)
{
    for (size_t m = 0; m < c->methods.count; m++) {
        const ms_method *method = &c->methods.method[m];
        size_t small = 0, all = 0;
        for (size_t k = 0; k < method->n_clumps; k++) {
            const ms_clump *clump = &method->clump[k].clump;
            all += clump->n_spheres;
            for (size_t s = 0; s < clump->n_spheres; s++) {
                small += clump->sphere[s].radius < c->min_radius;
            }
        }
        if (small > 0) {
            fprintf(stderr, "%s: %zu of its %zu spheres are below --min-radius %g; they are judged as they are\n",
                    method->name, small, all, c->min_radius);
        }
    }
}

static int execute_compare(const ms_command *command, const compare_arguments *a)
{
    ms_error err;
    ms_csv csv;
    ms_files files = {0};
    char *header = ms_compare_header();
    ms_status status = header ? check_files(&files, &a->comparison, a->output, &err)
                              : ms_fail(&err, MS_ERR_NOMEM, "no memory for the header");
    if (status == MS_OK) {
        say_small_clumps(&a->comparison);
        status = ms_csv_open(&csv, a->output, header, a->resume, &err);
        if (status == MS_OK) {
            status = walk_and_tell(&csv, a, &err);
        }
        ms_csv_close(&csv);
    }
    ms_files_free(&files);
    free(header);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

/* A shape that is there twice, as by a folder and by itself, would count twice. */
static ms_status add_shape(ms_files *files, const char *shape, ms_error *err)
{
    const size_t before = files->count;
    const ms_status status = ms_files_add(files, shape, MS_FILE_READ, err);
    for (size_t f = 0; f < before && files->count > before; f++) {
        if (strcmp(files->file[f].key, files->file[before].key) == 0) {
            return ms_fail(err, MS_ERR_ARG, "%s is there twice, as %s; name each shape once", shape,
                           files->file[f].path);
        }
    }
    return status;
}

/* A shape is read for each resolution. */
static ms_status check_shapes(const ms_comparison *c, ms_error *err)
{
    ms_files files = {0};
    ms_status status = MS_OK;
    for (size_t s = 0; s < c->n_shapes && status == MS_OK; s++) {
        status = ms_file_is_standard(c->shape[s])
                     ? ms_fail(err, MS_ERR_ARG,
                               "compare may read a shape several times, and - once; save it and name the file")
                     : add_shape(&files, c->shape[s], err);
    }
    ms_files_free(&files);
    return status;
}

/* What follows from all flags together. */
static ms_status resolve_compare(ms_comparison *c, ms_error *err)
{
    static const double ASKED[] = {5, 10, 20, 50, 100};
    if (c->asked.count == 0) {
        memcpy(c->asked.value, ASKED, sizeof ASKED);
        c->asked.count = sizeof ASKED / sizeof *ASKED;
    }
    if (c->cells.count == 0) {
        insert_number(&c->cells, 100);
    }
    if (c->population && c->n_shapes < 2) {
        return ms_fail(err, MS_ERR_ARG, "--population takes several shapes, and %s is one", c->shape[0]);
    }
    if (c->input.label) {
        snprintf(c->label, sizeof c->label, "%lu", (unsigned long)c->input.label);
    }
    c->flags = ms_input_flags_text(&c->input);
    ms_input_text_add(&c->flags, "min-radius", c->min_radius);
    ms_status status = check_shapes(c, err);
    if (status == MS_OK) {
        status = ms_methods_check(&c->methods, err);
    }
    return status == MS_OK ? ms_methods_read_clumps(&c->methods, c->shape, c->n_shapes, err) : status;
}

/* Of the files that the words name. */
static int compare_shapes(const ms_command *command, compare_arguments *a, char *const *words, size_t n_words)
{
    ms_error err;
    ms_paths paths = {0};
    ms_status status = MS_OK;
    for (size_t w = 0; w < n_words && status == MS_OK; w++) {
        status = ms_paths_add(&paths, words[w], ms_paths_is_shape, "mesh and no volume", &err);
    }
    if (status != MS_OK) {
        ms_paths_free(&paths);
        return ms_flags_fail(command, &err);
    }
    a->comparison.shape = paths.path;
    a->comparison.n_shapes = paths.count;
    a->comparison.words = a->json ? stderr : stdout;
    status = a->comparison.report && !a->comparison.charts
                 ? ms_fail(&err, MS_ERR_ARG, "--report takes --charts DIR, where the clumps are kept")
                 : resolve_compare(&a->comparison, &err);
    const int code = status == MS_OK ? execute_compare(command, a) : ms_flags_refuse(command, status, &err);
    ms_paths_free(&paths);
    return code;
}

static int run_compare(const ms_command *command, int argc, char **argv)
{
    compare_arguments a = {.comparison = {.repeats = 1, .seed = 1, .argc = argc, .argv = argv},
                           .output = "compare.csv"};
    int first;
    ms_input_defaults(&a.comparison.input);
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_compare_flag, &a);
    if (code == MS_FLAGS_GO_ON && first >= argc) {
        code = ms_flags_wrong_usage(command, "takes one or more shapes");
    }
    if (code == MS_FLAGS_GO_ON) {
        code = compare_shapes(command, &a, argv + first, (size_t)(argc - first));
    }
    ms_methods_free(&a.comparison.methods);
    return code;
}

const ms_command ms_command_compare = {
    .name = "compare",
    .summary = "methods x shapes x resolutions x numbers of spheres, as CSV and charts",
    .usage = "SHAPE... [-g NAME[:OPTION=VALUE,...]]... [-n N,N,...] [--cells N,N,...] [-o FILE] [--population DIR] "
             "[--charts DIR [--report FILE]] [--json]",
    .example = "mskit compare grain.stl -g mss -g mss:variant=paper -g setcover -n 5,10,20,50 --charts charts",
    .flags = FLAGS,
    .run = run_compare,
};
