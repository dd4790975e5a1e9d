#include "ms_compare_population_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "base/ms_text.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "ms_compare_charts.h"
#include "ms_compare_population.h"

/* A named field of a table: text, or without one a number, empty (in JSON null) if it is not finite. */
typedef struct table_field {
    const char *name, *text;
    double number;
} table_field;

/* A table in the making, as CSV and as JSON. */
typedef struct twin_table {
    FILE *stream;
    json_t *list;
    int is_begun; /* the header is written */
} twin_table;

/* @param is_told 0: there is nothing to tell; the header is written even so, so that no table is without one */
static void put_row(twin_table *t, const table_field *row, size_t count, int is_told)
{
    for (size_t f = 0; f < count && !t->is_begun; f++) {
        fprintf(t->stream, "%s%s", f ? "," : "", row[f].name);
    }
    fputs(t->is_begun ? "" : "\n", t->stream);
    t->is_begun = 1;
    if (!is_told) {
        return;
    }
    json_t *object = json_object();
    for (size_t f = 0; f < count; f++) {
        fputs(f ? "," : "", t->stream);
        if (row[f].text) {
            ms_escape_csv(t->stream, row[f].text);
        } else if (isfinite(row[f].number)) {
            fputs(ms_text_of_number(row[f].number).text, t->stream);
        }
        ms_json_object_set(&object, row[f].name,
                           row[f].text ? ms_report_text(row[f].text) : ms_report_number(row[f].number));
    }
    putc('\n', t->stream);
    ms_json_object_append(&t->list, object);
}

/* What is written of a population. */
typedef struct writer {
    const ms_compare_population *p;
    double *room; /* n_shapes values */
    ms_compare_standing *standing;
    twin_table spread, best;
} writer;

/* Options of a method; those of another tool's clumps are their files, which are many. */
static const char *find_options(const ms_compare_record *method)
{
    return ms_compare_record_is_clump(method) ? "" : method->field[MS_COLUMN_OPTIONS];
}

/* @param over what values are put over; 1 for none */
static void put_spread(writer *w, size_t n, size_t m, const char *name, ms_column column, double over)
{
    const ms_compare_record *method = w->p->method[m];
    const ms_compare_spread s = ms_compare_population_spread(w->p, n, m, column, w->room);
    const table_field row[] = {{"cells", NULL, ms_compare_record_number(method, MS_COLUMN_CELLS)},
                               {"generator", method->field[MS_COLUMN_GENERATOR], 0},
                               {"options", find_options(method), 0},
                               {"n_asked", NULL, w->p->number[n]},
                               {"quantity", name, 0},
                               {"shapes", NULL, (double)s.count},
                               {"mean", NULL, s.mean / over},
                               {"lower_quartile", NULL, s.lower / over},
                               {"median", NULL, s.median / over},
                               {"upper_quartile", NULL, s.upper / over}};
    put_row(&w->spread, row, sizeof row / sizeof *row, s.count > 0);
}

static void put_spreads(writer *w)
{
    const double time = ms_compare_population_time(w->p, w->room);
    for (size_t m = 0; m < w->p->n_methods; m++) {
        for (size_t n = 0; n < w->p->n_numbers; n++) {
            put_spread(w, n, m, "n", MS_COLUMN_SPHERES, 1);
            for (int k = 0; k < MS_MEASURES; k++) {
                const ms_measure *measure = &ms_measures[k];
                put_spread(w, n, m, ms_measure_column(measure, measure->in_compare),
                           (ms_column)(MS_COLUMN_MEASURES + k), 1);
            }
            put_spread(w, n, m, "inertia_corrected", MS_COLUMN_CORRECTED, 1);
            put_spread(w, n, m, "seconds_generate", MS_COLUMN_GENERATE, 1);
            if (isfinite(time)) {
                put_spread(w, n, m, "time_normalised", MS_COLUMN_GENERATE, time);
            }
        }
    }
}

static ms_status put_standings(writer *w, size_t n, const char *by, ms_column column, ms_error *err)
{
    const ms_status status = ms_compare_population_judge(w->standing, w->p, n, column, err);
    for (size_t m = 0; m < w->p->n_methods && status == MS_OK; m++) {
        const ms_compare_record *method = w->p->method[m];
        const ms_compare_standing *s = &w->standing[m];
        const table_field row[] = {{"cells", NULL, ms_compare_record_number(method, MS_COLUMN_CELLS)},
                                   {"n_asked", NULL, w->p->number[n]},
                                   {"by", by, 0},
                                   {"generator", method->field[MS_COLUMN_GENERATOR], 0},
                                   {"options", find_options(method), 0},
                                   {"shapes", NULL, (double)s->shapes},
                                   {"best", NULL, (double)s->best},
                                   {"factor", NULL, s->factor},
                                   {"factor_low", NULL, s->low},
                                   {"factor_high", NULL, s->high}};
        put_row(&w->best, row, sizeof row / sizeof *row, s->shapes > 0);
    }
    return status;
}

/* Adds the rows of one resolution to both tables. */
static ms_status put_population(twin_table *spread, twin_table *best, const ms_compare_population *p, ms_error *err)
{
    writer w = {.p = p, .spread = *spread, .best = *best};
    ms_status status = MS_OK;
    w.room = malloc((p->n_shapes + 1) * sizeof *w.room);
    w.standing = calloc(p->n_methods + 1, sizeof *w.standing);
    if (!w.room || !w.standing) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the tables of %zu shapes", p->n_shapes);
    } else {
        put_spreads(&w);
    }
    for (size_t n = 0; n < p->n_numbers && status == MS_OK; n++) {
        status = put_standings(&w, n, "dice", MS_COLUMN_DICE, err);
        if (status == MS_OK) {
            status = put_standings(&w, n, "seconds_generate", MS_COLUMN_GENERATE, err);
        }
    }
    free(w.room);
    free(w.standing);
    *spread = w.spread;
    *best = w.best;
    return status;
}

static int is_first_of_cells(const ms_compare_records *all, size_t at)
{
    for (size_t r = at; r-- > 0;) {
        if (ms_compare_records_agree(&all->record[r], &all->record[at], MS_COLUMN_CELLS)) {
            return 0;
        }
    }
    return 1;
}

static ms_status put_tables(twin_table *spread, twin_table *best, const ms_compare_records *all, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t r = 0; r < all->count && status == MS_OK; r++) {
        ms_compare_population p;
        if (is_first_of_cells(all, r)) {
            status = ms_compare_population_make(&p, all, all->record[r].field[MS_COLUMN_CELLS], err);
            if (status == MS_OK) {
                status = put_population(spread, best, &p, err);
                ms_compare_population_free(&p);
            }
        }
    }
    return status;
}

static char *make_path(const char *folder, const char *name, ms_error *err)
{
    const size_t room = strlen(folder) + strlen(name) + 2;
    char *path = malloc(room);
    if (path) {
        snprintf(path, room, "%s/%s", folder, name);
    } else {
        ms_fail(err, MS_ERR_NOMEM, "no memory for the name of %s", name);
    }
    return path;
}

/* Opens FOLDER/NAME. */
static ms_status open_file(ms_output *output, const char *folder, const char *name, ms_error *err)
{
    char *path = make_path(folder, name, err);
    const ms_status status = path ? ms_output_open(output, path, err) : MS_ERR_NOMEM;
    free(path);
    return status;
}

/* Both tables as one object; they are given up. */
static ms_status write_json(json_t *spread, json_t *best, const char *folder, ms_error *err)
{
    ms_output output;
    json_t *whole = json_object();
    ms_json_object_set(&whole, "population", spread);
    ms_json_object_set(&whole, "best", best);
    ms_status status = open_file(&output, folder, "population.json", err);
    if (status != MS_OK) {
        json_decref(whole);
        return status;
    }
    return ms_output_close(&output, ms_report_print(output.stream, whole, err), err);
}

static ms_status write_tables(const ms_compare_records *all, const char *folder, ms_error *err)
{
    ms_output of_spread, of_best;
    ms_status status = open_file(&of_spread, folder, "population.csv", err);
    if (status != MS_OK) {
        return status;
    }
    status = open_file(&of_best, folder, "best.csv", err);
    if (status != MS_OK) {
        return ms_output_close(&of_spread, status, err);
    }
    twin_table spread = {.stream = of_spread.stream, .list = json_array()};
    twin_table best = {.stream = of_best.stream, .list = json_array()};
    status = put_tables(&spread, &best, all, err);
    status = ms_output_close(&of_spread, status, err);
    status = ms_output_close(&of_best, status, err);
    if (status == MS_OK) {
        return write_json(spread.list, best.list, folder, err);
    }
    json_decref(spread.list);
    json_decref(best.list);
    return status;
}

/* What a chart is made of: for each method a band and a curve. */
typedef struct curves {
    ms_chart_series *series;
    ms_chart_point *point;
    char **name;
    double *room;
    char timing[256]; /* how times were measured */
} curves;

static void fill_curves(curves *d, const ms_compare_population *p, ms_column column, double over)
{
    for (size_t m = 0; m < p->n_methods; m++) {
        ms_chart_point *band = d->point + 2 * m * p->n_numbers, *curve = band + p->n_numbers;
        for (size_t n = 0; n < p->n_numbers; n++) {
            const ms_compare_spread s = ms_compare_population_spread(p, n, m, column, d->room);
            band[n] = (ms_chart_point){.x = p->number[n], .y = s.lower / over, .top = s.upper / over};
            curve[n] = (ms_chart_point){.x = p->number[n], .y = s.mean / over};
        }
        const ms_chart_look look = ms_compare_record_look(p->method[m]);
        d->series[2 * m] = (ms_chart_series){d->name[m], MS_CHART_BAND, p->n_numbers, band, look};
        d->series[2 * m + 1] = (ms_chart_series){d->name[m], MS_CHART_CURVE, p->n_numbers, curve, look};
    }
    ms_chart_part_looks(d->series, 2 * p->n_methods);
}

static ms_status draw_population(const ms_compare_population *p, curves *d, const char *stem, const char *label,
                                 ms_column column, FILE *words, ms_error *err)
{
    char title[120];
    const double over = column == MS_COLUMN_GENERATE ? ms_compare_population_time(p, d->room) : 1;
    snprintf(title, sizeof title, "%zu shapes: mean, and a band from quartile to quartile", p->n_shapes);
    fill_curves(d, p, column, over);
    const ms_chart chart = {.title = title,
                            .x_label = "number of spheres",
                            .y_label = label,
                            .note = column == MS_COLUMN_GENERATE ? d->timing : NULL,
                            .y_log = 1,
                            .y_least = 1e-6,
                            .n_series = 2 * p->n_methods,
                            .series = d->series};
    return ms_chart_make(&chart, stem, words, err);
}

static void free_curves(curves *d, const ms_compare_population *p)
{
    for (size_t m = 0; d->name && m < p->n_methods; m++) {
        free(d->name[m]);
    }
    free(d->name);
    free(d->series);
    free(d->point);
    free(d->room);
}

static ms_status begin_curves(curves *d, const ms_compare_population *p, ms_error *err)
{
    *d = (curves){.series = calloc(2 * p->n_methods + 1, sizeof *d->series),
                  .point = calloc(2 * p->n_methods * p->n_numbers + 1, sizeof *d->point),
                  .name = calloc(p->n_methods + 1, sizeof *d->name),
                  .room = malloc((p->n_shapes + 1) * sizeof *d->room)};
    int failed = !d->series || !d->point || !d->name || !d->room;
    for (size_t m = 0; m < p->n_methods && !failed; m++) {
        d->name[m] = ms_compare_record_method(p->method[m]);
        failed = !d->name[m];
    }
    return failed ? ms_fail(err, MS_ERR_NOMEM, "no memory for the charts of %zu shapes", p->n_shapes) : MS_OK;
}

/* The kinds of charts: measures, whose label is NULL if they have none, and time. Zero behind the last. */
static int describe_kind(int kind, const char **name, const char **label, ms_column *column)
{
    if (kind == MS_MEASURES) {
        *name = "time";
        *label = "time over that of the first method";
        *column = MS_COLUMN_GENERATE;
    } else if (kind < MS_MEASURES) {
        *name = ms_measures[kind].name;
        *label = ms_measures[kind].axis;
        *column = (ms_column)(MS_COLUMN_MEASURES + kind);
    }
    return kind <= MS_MEASURES;
}

static ms_status list_charts(ms_files *files, const char *folder, ms_error *err)
{
    const char *name, *label;
    ms_column column;
    ms_status status = MS_OK;
    for (int k = 0; describe_kind(k, &name, &label, &column) && status == MS_OK; k++) {
        char file[64];
        snprintf(file, sizeof file, "population-%s", name);
        status = label ? ms_files_add_charts(files, folder, file, MS_CHART_ENDINGS, err) : MS_OK;
    }
    return status;
}

/* Those of a run before: this one may draw fewer. */
static ms_status remove_charts(const char *folder, ms_error *err)
{
    ms_files files = {0};
    const ms_status status = list_charts(&files, folder, err);
    return ms_files_remove(&files, status, err);
}

/* All charts; without gnuplot their scripts are written nevertheless, and the first failure is reported. */
static ms_status draw_charts(const ms_compare_population *p, const ms_compare_records *all, const char *folder,
                             FILE *words, ms_error *err)
{
    const char *name, *label;
    ms_column column;
    curves d;
    ms_error why;
    ms_status status = begin_curves(&d, p, err);
    ms_compare_charts_timing(d.timing, sizeof d.timing, all->record, all->count, NULL);
    for (int k = 0; status != MS_ERR_NOMEM && describe_kind(k, &name, &label, &column); k++) {
        char file[64];
        snprintf(file, sizeof file, "population-%s", name);
        char *stem = label ? make_path(folder, file, err) : NULL;
        const ms_status drawn = stem ? draw_population(p, &d, stem, label, column, words, &why) : MS_OK;
        if (label && !stem) {
            status = MS_ERR_NOMEM;
        } else if (status == MS_OK && drawn != MS_OK) {
            status = drawn;
            *err = why;
        }
        free(stem);
    }
    free_curves(&d, p);
    return status;
}

ms_status ms_compare_population_write(const ms_compare_records *all, const char *folder, FILE *words, ms_error *err)
{
    ms_compare_population p;
    ms_status status = write_tables(all, folder, err);
    if (status != MS_OK || all->count == 0) {
        return status;
    }
    fprintf(words, "wrote %s/population.csv, best.csv, population.json\n", folder);
    status = remove_charts(folder, err);
    if (status == MS_OK) {
        status = ms_compare_population_make(&p, all, all->record[all->count - 1].field[MS_COLUMN_CELLS], err);
    }
    if (status == MS_OK) {
        status = draw_charts(&p, all, folder, words, err);
        ms_compare_population_free(&p);
    }
    return status;
}

ms_status ms_compare_population_list(ms_files *files, const char *folder, ms_error *err)
{
    static const char *const TABLES[] = {"population.csv", "best.csv", "population.json", NULL};
    const ms_status status = ms_files_add_charts(files, folder, "", TABLES, err);
    return status == MS_OK ? list_charts(files, folder, err) : status;
}
