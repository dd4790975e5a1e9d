#include "ms_grain_report.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/ms_file.h"
#include "clump/formats/ms_read.h"
#include "view/ms_view_page.h"
#include "view/ms_view_report.h"
#include "view/ms_view_scene.h"
#include "volume/ms_components.h"

enum { MOST_COLUMNS = 64 + MS_MEASURES };

/* What of a row is shown. */
static const char *const SHOWN[] = {"grain",          "source",  "label",         "generator", "options",
                                    "status",         "n",       "dice",          "coverage",  "pieces",
                                    "protrusion_max", "gap_max", "inertia_union", "volume",    "equivalent_diameter",
                                    "seconds",        "cause"};

enum { N_SHOWN = sizeof SHOWN / sizeof *SHOWN };

/* A row with a clump. */
typedef struct shown_grain {
    size_t row;
    double dice;
} shown_grain;

/* The page in the making. */
typedef struct grains_page {
    const ms_grains *g;
    const ms_csv *csv;
    shown_grain *grain; /* in the order of the rows */
    size_t count;
    long *scene; /* of each row; -1: none */
} grains_page;

/* The first format of the run that can be read back, in the frame of the grain. */
static const ms_format *find_format(const ms_grains *g, ms_error *err)
{
    for (size_t f = 0; f < g->n_formats; f++) {
        if (g->format[f]->read && g->format[f]->need == MS_NEED_SPHERES) {
            return g->format[f];
        }
    }
    ms_fail(
        err, MS_ERR_ARG,
        "--report reads the clumps back as they lie in their grains, which %s cannot give; give --format csv beside "
        "it",
        g->format[0]->name);
    return NULL;
}

ms_status ms_grain_report_check(const ms_grains *g, ms_error *err)
{
    return find_format(g, err) ? MS_OK : MS_ERR_ARG;
}

static ms_status find_clumps(grains_page *w, ms_error *err)
{
    const char *dice = ms_measure_column(&ms_measures[MS_MEASURE_DICE], ms_measures[MS_MEASURE_DICE].in_compare);
    ms_status status = MS_OK;
    for (size_t r = 0; r < w->csv->n_rows && status == MS_OK; r++) {
        ms_grain_found found;
        status = ms_grain_row_find(&found, w->csv->row[r], err);
        if (status == MS_OK && found.status == MS_GRAIN_OK) {
            shown_grain *grain = &w->grain[w->count++];
            grain->row = r;
            status = ms_grain_row_number(&grain->dice, dice, w->csv->row[r], err);
        }
    }
    return status;
}

/* Largest D first; of equal ones the first row. */
static int compare_dice(const void *a, const void *b)
{
    const shown_grain *x = a, *y = b;
    return x->dice != y->dice ? (x->dice < y->dice) - (x->dice > y->dice) : (x->row > y->row) - (x->row < y->row);
}

static int compare_rows(const void *a, const void *b)
{
    const shown_grain *x = a, *y = b;
    return (x->row > y->row) - (x->row < y->row);
}

/* Leaves as many as a page takes, and numbers them. */
static void choose_clumps(grains_page *w)
{
    if (w->count > MS_GRAIN_REPORT_MOST) {
        qsort(w->grain, w->count, sizeof *w->grain, compare_dice);
        w->count = MS_GRAIN_REPORT_MOST;
        qsort(w->grain, w->count, sizeof *w->grain, compare_rows);
    }
    for (size_t r = 0; r < w->csv->n_rows; r++) {
        w->scene[r] = -1;
    }
    for (size_t k = 0; k < w->count; k++) {
        w->scene[w->grain[k].row] = (long)k;
    }
}

static ms_status begin_page(FILE *stream, const grains_page *w, int argc, char *const *argv, ms_error *err)
{
    char *column[MOST_COLUMNS], *header = ms_grain_row_line(NULL);
    size_t shown[N_SHOWN];
    if (!header) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    }
    ms_view_report report = {.title = "clumps of grains",
                             .argc = argc,
                             .argv = argv,
                             .column = (const char *const *)column,
                             .shown = shown,
                             .n_columns = ms_csv_split(column, MOST_COLUMNS, header),
                             .csv = w->csv,
                             .scene = w->scene};
    report.n_shown = ms_view_report_columns(shown, SHOWN, N_SHOWN, report.column, report.n_columns);
    const ms_status status = ms_view_report_begin(stream, &report, err);
    free(header);
    return status;
}

static ms_status read_clump(ms_clump *clump, const ms_grain_found *found, const ms_grains *g, ms_error *err)
{
    char path[4096];
    ms_particle ignored;
    const ms_format *format = find_format(g, err);
    if (!format) {
        return MS_ERR_ARG;
    }
    char *stem = ms_grain_row_stem(found, g->format[0]->ending);
    if (!stem) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a clump");
    }
    snprintf(path, sizeof path, "%s/%s.%s", g->folder, stem, format->ending);
    free(stem);
    return ms_read_clump(clump, &ignored, path, err);
}

/* The grain as it was made a clump of. */
static ms_status read_grain(ms_input *input, ms_target *target, const ms_grain *grain, const ms_grains *g,
                            ms_error *err)
{
    const ms_input_flags *flags = &grain->how->input;
    ms_status status = ms_grain_source_read(grain->source, input, grain->label, flags, NULL, err);
    if (status == MS_OK && g->largest_piece && input->is_volume) {
        size_t ignored;
        status = ms_components_keep_largest(&input->volume, &ignored, flags->scan.connectivity, err);
    }
    return status == MS_OK ? ms_input_show(target, input, grain->label, err) : status;
}

static ms_status put_clump(FILE *stream, const grains_page *w, const ms_grain_found *found, ms_error *err)
{
    const ms_grain *grain = &w->g->list->grain[(size_t)found->number - 1];
    const ms_recipe *recipe = &grain->how->recipe;
    char name[512];
    ms_input input = {0};
    ms_target target;
    ms_clump clump = {0};
    ms_status status = read_clump(&clump, found, w->g, err);
    if (status == MS_OK) {
        status = read_grain(&input, &target, grain, w->g, err);
    }
    if (status == MS_OK) {
        snprintf(name, sizeof name, "grain %.0f, %.300s, %.40s, %zu spheres", found->number, grain->name,
                 recipe->generator->name, clump.n_spheres);
        const ms_view_scene scene = {.name = name,
                                     .clump = &clump,
                                     .target = &target,
                                     .ordered = ms_generator_is_nested(recipe->generator, &recipe->settings),
                                     .most_triangles = ms_view_report_triangles(w->count)};
        status = ms_view_scene_write(stream, &scene, err);
    }
    ms_clump_free(&clump);
    ms_input_free(&input);
    return status;
}

static ms_status write_page(FILE *stream, grains_page *w, int argc, char *const *argv, ms_error *err)
{
    ms_status status = find_clumps(w, err);
    if (status == MS_OK) {
        choose_clumps(w);
        status = begin_page(stream, w, argc, argv, err);
    }
    for (size_t k = 0; k < w->count && status == MS_OK; k++) {
        ms_grain_found found;
        fputs(k > 0 ? "," : "", stream);
        status = ms_grain_row_find(&found, w->csv->row[w->grain[k].row], err);
        status = status == MS_OK ? put_clump(stream, w, &found, err) : status;
    }
    ms_view_page_end(stream);
    return status;
}

ms_status ms_grain_report_write(const char *path, const ms_csv *csv, const ms_grains *grains, int argc,
                                char *const *argv, ms_error *err)
{
    ms_output output;
    grains_page w = {.g = grains,
                     .csv = csv,
                     .grain = calloc(csv->n_rows + 1, sizeof *w.grain),
                     .scene = calloc(csv->n_rows + 1, sizeof *w.scene)};
    ms_status status = w.grain && w.scene ? ms_output_open(&output, path, err)
                                          : ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    if (status == MS_OK) {
        status = ms_output_close(&output, write_page(output.stream, &w, argc, argv, err), err);
    }
    free(w.grain);
    free(w.scene);
    return status;
}
