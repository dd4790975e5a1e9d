/* mskit grains SOURCE... -o DIR */
#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "base/ms_choice.h"
#include "base/ms_text.h"
#include "cli/ms_outputs.h"
#include "cli/ms_progress.h"
#include "cli/ms_report.h"
#include "cli/ms_until.h"
#include "grains/ms_grain_assembly.h"
#include "grains/ms_grain_files.h"
#include "grains/ms_grain_merge.h"
#include "grains/ms_grain_report.h"
#include "grains/ms_grains.h"
#include "ms_commands.h"
#include "population/ms_library_report.h"

static const ms_flag FLAGS[] = {
    MS_RECIPE_FLAGS,
    MS_UNTIL_FLAGS,
    {"output", 'o', "DIR", "the clumps, a folder for each thousand, and the table grains.csv"},
    {"format", 0, "F", "format of the clumps; may be repeated (csv)"},
    {"equal-volume", 0, NULL, "scale the clump about the centroid of the shape until its union has the shape's volume"},
    MS_MASS_FLAGS,
    {"skip-border", 0, NULL, "leave out grains that the border of their volume cuts"},
    {"least-voxels", 0, "N", "leave out labels of fewer voxels"},
    {"largest-piece", 0, NULL, "of a label in several pieces (--connectivity) take the largest alone"},
    {"assembly", 0, NULL, "the clumps back in their places: overlaps of neighbours, and files of the whole packing"},
    {"most-overlap", 0, "SHARE", "shrink clumps of the assembly until none is deeper in another / equivalent radius"},
    {"report", 0, "FILE", "a page with the rows, and the clumps in their grains in 3-D (.html)"},
    {"resume", 0, NULL, "go on with the table that is in DIR"},
    {"part", 0, "K/N", "make the K-th of N parts alone, of about the same work, with a table of its own"},
    {"merge", 0, NULL, "join the tables of all parts in the folders DIR..., which stand in the place of sources"},
    {"choose", 0, "K",
     "choose K grains with weights that stand for all of the run in the folder DIR, in place of sources"},
    {"by", 0, "WHAT", "distributions that the choice keeps: by number or by mass (number)"},
    {"with-size", 0, NULL, "the choice keeps sizes, too, each grain with its own; otherwise sizes go by classes"},
    {"classes", 0, "C", "classes of size, of equal mass (10)"},
    {"dry-run", 0, NULL, "say what would be done, and how long it would take by three of the grains"},
    {"json", 0, NULL, "the sums as JSON on standard output"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct grains_arguments {
    ms_grain_how how;
    ms_mass_flags mass;
    ms_grains grains;
    const char *folder, *report;
    int resume, merge, dry_run, json, assembly, argc;
    char *const *argv;
    double most_overlap;    /* 0: not given */
    double choose, classes; /* 0: not given */
    const char *by;
    int with_size;
    const char *not_of_choice, *not_of_merge; /* a flag that --choose, or --merge, has no use for; NULL without */
} grains_arguments;

static ms_status take_part(ms_grains *g, const char *text, ms_error *err)
{
    int64_t part = 0, parts = 0;
    const char *slash = strchr(text, '/');
    const ms_word first = {text, slash ? (size_t)(slash - text) : 0},
                  second = {slash ? slash + 1 : text, slash ? strlen(slash + 1) : 0};
    if (!slash || !ms_text_to_integer(&part, &first) || !ms_text_to_integer(&parts, &second) || part < 1 ||
        parts < part || parts > 1000000) {
        return ms_fail(err, MS_ERR_ARG, "--part '%.40s' is not of the form K/N, as 3/16, with K from 1 to N", text);
    }
    g->part = (size_t)part;
    g->parts = (size_t)parts;
    return MS_OK;
}

static ms_status take_format(ms_grains *g, const char *name, ms_error *err)
{
    const ms_format *format = ms_write_format_find(name, err);
    for (size_t f = 0; f < g->n_formats && format; f++) {
        if (g->format[f] == format) {
            return ms_fail(err, MS_ERR_ARG, "--format %s is given twice", name);
        }
    }
    if (format) {
        g->format[g->n_formats++] = format; /* there are fewer formats than room */
    }
    return format ? MS_OK : MS_ERR_ARG;
}

/* Takes a flag without a value if it is one of those of grains. @return 0 if it is not */
static int take_grains_word(grains_arguments *a, const char *name)
{
    const struct {
        const char *name;
        int *is_set;
    } words[] = {{"skip-border", &a->grains.skip_border},
                 {"equal-volume", &a->how.recipe.equal_volume},
                 {"largest-piece", &a->grains.largest_piece},
                 {"resume", &a->resume},
                 {"merge", &a->merge},
                 {"with-size", &a->with_size},
                 {"assembly", &a->assembly},
                 {"dry-run", &a->dry_run},
                 {"json", &a->json}};
    for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
        if (strcmp(name, words[w].name) == 0) {
            *words[w].is_set = 1;
            return 1;
        }
    }
    return 0;
}

/* Takes a flag with a value of its own command. @param[out] taken 0 if it is none */
static ms_status take_grains_value(int *taken, grains_arguments *a, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "output") == 0 || strcmp(name, "by") == 0) {
        *(name[0] == 'b' ? &a->by : &a->folder) = value;
        return MS_OK;
    }
    if (strcmp(name, "report") == 0) {
        return ms_files_take_page(&a->report, name, value, err);
    }
    if (strcmp(name, "choose") == 0) {
        return ms_flags_whole(&a->choose, name, value, 1, MS_POPULATION_MAX_CHOSEN, err);
    }
    if (strcmp(name, "classes") == 0) {
        return ms_flags_whole(&a->classes, name, value, 1, MS_LIBRARY_MAX_CLASSES, err);
    }
    if (strcmp(name, "format") == 0) {
        return take_format(&a->grains, value, err);
    }
    if (strcmp(name, "least-voxels") == 0) {
        return ms_flags_whole(&a->grains.least_voxels, name, value, 1, 9007199254740992.0, err);
    }
    if (strcmp(name, "most-overlap") == 0) {
        return ms_flags_number(&a->most_overlap, name, value, 1e-6, 1, err);
    }
    *taken = strcmp(name, "part") == 0;
    return *taken ? take_part(&a->grains, value, err) : MS_OK;
}

static int is_word_of(const char *const *list, const char *name)
{
    while (*list && strcmp(*list, name) != 0) {
        list++;
    }
    return *list != NULL;
}

/* The clumps are there: how they would be made is not heeded. */
static void note_useless(grains_arguments *a, const char *name)
{
    static const char *const OF_CHOICE[] = {"choose", "by", "with-size", "classes", "seed", "output", "json", NULL},
                             *const OF_MERGE[] = {"merge", "output", NULL};
    a->not_of_choice = is_word_of(OF_CHOICE, name) ? a->not_of_choice : name;
    a->not_of_merge = is_word_of(OF_MERGE, name) ? a->not_of_merge : name;
}

static ms_status take_grains_flag(void *context, const char *name, const char *value, ms_error *err)
{
    grains_arguments *a = context;
    int taken;
    note_useless(a, name);
    ms_grain_how_note(&a->how, name, value);
    ms_status status = ms_mass_flag(&taken, &a->mass, name, value, err);
    if (!taken && take_grains_word(a, name)) {
        return MS_OK;
    }
    if (!taken) {
        status = take_grains_value(&taken, a, name, value, err);
    }
    return taken ? status : ms_grain_how_flag(&taken, &a->how, name, value, err);
}

static ms_status resolve_formats(grains_arguments *a, ms_error *err)
{
    ms_grains *g = &a->grains;
    if (g->n_formats == 0) {
        g->format[g->n_formats++] = ms_write_format_find("csv", err);
    }
    for (size_t f = 0; f < g->n_formats; f++) {
        if (g->format[f]->need != MS_NEED_SPHERES && !g->mass) {
            return ms_fail(err, MS_ERR_ARG, "a %s template takes the mass of the grain: give --density RHO beside it",
                           g->format[f]->name);
        }
        for (size_t before = 0; before < f; before++) {
            if (strcmp(g->format[f]->ending, g->format[before]->ending) == 0) {
                return ms_fail(err, MS_ERR_ARG, "files of %s and %s would have the same names; choose one of them",
                               g->format[f]->name, g->format[before]->name);
            }
        }
    }
    return MS_OK;
}

static ms_status resolve_assembly(const grains_arguments *a, ms_error *err)
{
    if (a->most_overlap > 0 && !a->assembly) {
        return ms_fail(err, MS_ERR_ARG, "--most-overlap is of the assembly: give --assembly beside it");
    }
    if (a->assembly && (a->merge || a->grains.parts > 1)) {
        return ms_fail(err, MS_ERR_ARG,
                       "--assembly is of all grains: after --merge, repeat the command without --part, with --resume "
                       "and --assembly");
    }
    return MS_OK;
}

/* Which of the flags of a choice stand there without one, or against another. */
static ms_status resolve_choice(const grains_arguments *a, ms_error *err)
{
    static const char *const WORDS[] = {"number", "mass"};
    if (a->choose == 0 && (a->by || a->with_size || a->classes > 0)) {
        return ms_fail(err, MS_ERR_ARG, "--by, --with-size and --classes are of a choice: give --choose K beside them");
    }
    if (a->choose > 0 && (a->merge || a->assembly || a->resume || a->dry_run || a->grains.parts > 1)) {
        return ms_fail(err, MS_ERR_ARG,
                       "--choose takes the folder of a run that is complete: not with --merge, --assembly, --resume, "
                       "--dry-run or --part");
    }
    if (a->with_size && a->classes > 0) {
        return ms_fail(err, MS_ERR_ARG,
                       "--with-size keeps the size of each grain, and --classes gives sizes of their "
                       "own: choose one");
    }
    ms_choice choice = {.typed = a->by};
    int known = !a->by;
    for (int w = 0; w < 2 && !known; w++) {
        known = ms_choice_offer(&choice, WORDS[w]);
    }
    if (!known) {
        return ms_choice_fail(&choice, err, "--by '%.40s' is not number or mass", a->by);
    }
    return MS_OK;
}

/* Refuses a flag that would pass without effect. */
static ms_status refuse_useless(const grains_arguments *a, ms_error *err)
{
    if (a->choose > 0 && a->not_of_choice) {
        return ms_fail(err, MS_ERR_ARG, "--choose takes clumps as they were made: --%s has no effect, leave it out",
                       a->not_of_choice);
    }
    if (a->merge && a->not_of_merge) {
        return ms_fail(err, MS_ERR_ARG, "--merge joins tables as they are: --%s has no effect, leave it out",
                       a->not_of_merge);
    }
    if (a->dry_run && (a->json || a->report)) {
        return ms_fail(err, MS_ERR_ARG, "--dry-run makes nothing for --%s; leave it out", a->json ? "json" : "report");
    }
    return MS_OK;
}

/* What follows from all flags together. */
static ms_status resolve_grains(grains_arguments *a, ms_error *err)
{
    if (!a->folder || a->folder[0] == '\0') {
        return ms_fail(err, MS_ERR_ARG, "takes -o DIR, a folder for the clumps and their table");
    }
    if (a->mass.any && !(a->mass.density > 0)) {
        return ms_fail(err, MS_ERR_ARG, "flags about masses take --density RHO beside them, in kg/m^3");
    }
    ms_status status = ms_mass_resolve(&a->mass, err);
    a->grains.mass = a->mass.density > 0 ? &a->mass : NULL;
    a->grains.folder = a->folder;
    a->grains.threads = a->how.input.threads;
    if (status == MS_OK) {
        status = resolve_formats(a, err);
    }
    if (status == MS_OK) {
        status = resolve_assembly(a, err);
    }
    if (status == MS_OK) {
        status = resolve_choice(a, err);
    }
    if (status == MS_OK) {
        status = refuse_useless(a, err);
    }
    return status == MS_OK ? ms_grain_how_resolve(&a->how, err) : status;
}

/* NULL without memory. */
static json_t *assembly_json(const ms_grain_assembly *sum)
{
    return json_pack("{s:I,s:I,s:I,s:I,s:o,s:o,s:o}", "clumps", (json_int_t)sum->clumps, "grains_without",
                     (json_int_t)sum->without, "neighbours", (json_int_t)sum->neighbours, "overlapping",
                     (json_int_t)sum->overlapping, "median_relative_depth", ms_report_number(sum->median),
                     "most_relative_depth", ms_report_number(sum->most), "volume_kept", ms_report_number(sum->volume));
}

static void print_assembly(const ms_grain_assembly *sum, const char *folder)
{
    printf("wrote %s/assembly.csv: %zu clumps in their places, %zu pairs of neighbours", folder, sum->clumps,
           sum->neighbours);
    if (sum->overlapping) {
        printf(", %zu overlap (%.3g %%), by %.3g of the equivalent radius in the median, %.3g at most",
               sum->overlapping, 100 * (double)sum->overlapping / (double)sum->neighbours, sum->median, sum->most);
    }
    if (sum->volume < 1) {
        printf("; shrunk, with %.4g %% of their volume", 100 * sum->volume);
    }
    printf("%s\n", sum->without ? "; grains without a clump are missing" : "");
}

/* @param assembly NULL without */
static ms_status report_sum(const ms_grains_sum *sum, const ms_grain_assembly *assembly, const char *table,
                            const grains_arguments *a, ms_error *err)
{
    if (a->json) {
        return ms_report_print(stdout,
                               json_pack("{s:o,s:I,s:I,s:I,s:I,s:I,s:f,s:o*}", "table", ms_report_text(table), "grains",
                                         (json_int_t)sum->grains, "ok", (json_int_t)sum->ok, "left_out",
                                         (json_int_t)sum->left_out, "failed", (json_int_t)sum->failed, "remarked",
                                         (json_int_t)sum->remarked, "spheres", sum->spheres, "assembly",
                                         assembly ? assembly_json(assembly) : NULL),
                               err);
    }
    printf("wrote %s: %zu grains, %zu with a clump, %.0f spheres in all", table, sum->grains, sum->ok, sum->spheres);
    printf("; %zu left out, %zu failed", sum->left_out, sum->failed);
    if (sum->remarked) {
        printf(", %zu with a remark of the method", sum->remarked);
    }
    puts(sum->failed + sum->left_out + sum->remarked ? ": see the column cause" : "");
    if (assembly) {
        print_assembly(assembly, a->folder);
    }
    if (a->report) {
        printf("wrote %s\n", a->report);
    }
    return MS_OK;
}

static ms_status make_all(const grains_arguments *a, ms_error *err)
{
    char table[4096];
    ms_csv csv = {.fd = -1};
    ms_grains_sum sum;
    ms_grain_assembly assembly;
    char *header = ms_grain_row_line(NULL);
    ms_status status =
        header ? ms_files_make_folder(a->folder, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for the header");
    ms_grains_table(table, sizeof table, &a->grains);
    if (status == MS_OK) {
        status = ms_csv_open(&csv, table, header, a->resume, err);
    }
    free(header);
    if (status == MS_OK) {
        status = ms_grains_make(&sum, &csv, &a->grains, err);
    }
    const int assemble = a->assembly && status == MS_OK && sum.ok > 0;
    if (assemble) {
        status = ms_grain_assembly_write(&assembly, &csv, &a->grains, a->most_overlap, err);
    }
    if (status == MS_OK && a->report) {
        status = ms_grain_report_write(a->report, &csv, &a->grains, a->argc, a->argv, err);
    }
    ms_csv_close(&csv);
    if (status == MS_OK) {
        status = report_sum(&sum, assemble ? &assembly : NULL, table, a, err);
    }
    if (status == MS_OK && sum.ok == 0 && (sum.failed > 0 || a->assembly)) {
        status = ms_fail(err, MS_ERR_SHAPE, "%s: not one grain has a clump; the column cause says why", table);
    }
    return status;
}

static ms_status try_three(const grains_arguments *a, ms_error *err)
{
    double seconds;
    int tried;
    const int threads = a->grains.threads ? a->grains.threads : omp_get_max_threads();
    const ms_status status = ms_grains_try(&seconds, &tried, &a->grains, err);
    if (status == MS_OK) {
        printf("%zu grains of %zu sources into %s, in all about %.3g s of one thread, %.3g s of %d, by three of them "
               "(%d made a clump); nothing is written\n",
               a->grains.list->count, a->grains.list->n_sources, a->folder, seconds, seconds / threads, threads, tried);
    }
    return status;
}

static ms_status report_library(const ms_library *library, const ms_library_written *written, const grains_arguments *a,
                                ms_error *err)
{
    if (!written->charts) {
        fprintf(stderr, "charts are not drawn, their scripts are written: %s\n", written->why_not.text);
    }
    if (a->json) {
        return ms_report_print(stdout, ms_library_report_json(library, written), err);
    }
    ms_library_report_print(stdout, library, written, a->folder);
    return MS_OK;
}

static ms_status choose_grains(const grains_arguments *a, const char *from, ms_error *err)
{
    ms_library_table table;
    ms_library library;
    ms_library_written written;
    const ms_library_goal goal = {.k = (size_t)a->choose,
                                  .by_mass = a->by && strcmp(a->by, "mass") == 0,
                                  .with_size = a->with_size,
                                  .classes = a->classes > 0 ? (size_t)a->classes : 10,
                                  .seed = (uint64_t)a->how.recipe.seed};
    ms_status status = ms_library_table_read(&table, from, err);
    if (status != MS_OK) {
        return status;
    }
    ms_progress_open(&(ms_progress_line){.name = "choosing grains"});
    status = ms_library_make(&library, &table, &goal, err);
    ms_progress_close();
    if (status == MS_OK) {
        status = ms_files_make_folder(a->folder, err);
        if (status == MS_OK) {
            status = ms_library_write(&written, &library, from, a->folder, err);
        }
        if (status == MS_OK) {
            status = report_library(&library, &written, a, err);
        }
        ms_library_free(&library);
    }
    ms_library_table_free(&table);
    return status;
}

static ms_status execute_grains(grains_arguments *a, char *const *words, size_t count, ms_error *err)
{
    ms_grain_list list;
    ms_status status = ms_grain_list_make(&list, words, count, &a->how, err);
    if (status != MS_OK) {
        return status;
    }
    a->grains.list = &list;
    /* Rows of a run with the flag and of one without are no one run. */
    a->grains.run = ms_grain_list_checksum(&list) ^ (uint64_t)a->how.recipe.equal_volume;
    status = a->assembly ? ms_grain_assembly_check(&a->grains, err) : MS_OK;
    if (status == MS_OK && a->report) {
        status = ms_grain_report_check(&a->grains, err);
    }
    if (status == MS_OK && (a->assembly || a->report)) {
        status = ms_grain_files_check(&a->grains, words, count, a->assembly, a->report, err);
    }
    if (status == MS_OK) {
        status = a->dry_run ? try_three(a, err) : make_all(a, err);
    }
    ms_grain_list_free(&list);
    return status;
}

static int run_grains(const ms_command *command, int argc, char **argv)
{
    grains_arguments a = {.how = ms_grain_how_default(), .grains = {.part = 1, .parts = 1}, .argc = argc, .argv = argv};
    int first;
    ms_error err;
    int code = ms_flags_parse(&first, command, 1, argc, argv, take_grains_flag, &a);
    if (code == MS_FLAGS_GO_ON && first >= argc) {
        code = ms_flags_wrong_usage(command, "takes volumes, meshes, folders, patterns or manifests");
    }
    if (code == MS_FLAGS_GO_ON) {
        const size_t count = (size_t)(argc - first);
        ms_status status = resolve_grains(&a, &err);
        if (status == MS_OK && a.choose > 0 && count > 1) {
            status = ms_fail(&err, MS_ERR_ARG, "--choose takes one folder, with a grains.csv in it");
        }
        if (status != MS_OK) {
            code = ms_flags_refuse(command, status, &err);
        } else {
            status = a.choose > 0 ? choose_grains(&a, argv[first], &err)
                     : a.merge    ? ms_grain_merge(a.folder, argv + first, count, &err)
                                  : execute_grains(&a, argv + first, count, &err);
            code = status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
        }
    }
    ms_grain_how_free(&a.how);
    return code;
}

const ms_command ms_command_grains = {
    .name = "grains",
    .summary = "a clump for every grain of volumes, folders or a manifest",
    .usage = "SOURCE... -o DIR [-g NAME] [-n N] [--until MEASURE=VALUE]... [--format F]... [--part K/N] [--resume]",
    .example = "mskit grains '*.stl' -n 20 --cells 50 -o clumps",
    .flags = FLAGS,
    .run = run_grains,
};
