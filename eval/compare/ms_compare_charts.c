#include "ms_compare_charts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_compare.h"
#include "ms_compare_records.h"

/* All that the charts are made of. */
typedef struct records {
    size_t count;
    ms_compare_record *record; /* borrowed */
    const char *folder;
    FILE *words;
} records;

/* One kind of chart. */
typedef struct chart_kind {
    const char *name;
    const char *what; /* NULL: the label of y by that of x */
    const char *x_label, *y_label;
    ms_column x, y;
    ms_column fixed; /* rows with the largest value in this column alone */
    int front;       /* with the Pareto front, and labels */
} chart_kind;

/* What is drawn beside the measures by number of spheres. */
static const chart_kind KINDS[] = {
    {"time", "speed and accuracy, labelled by number of spheres", "time, s", "mismatch D", MS_COLUMN_GENERATE,
     MS_COLUMN_DICE, MS_COLUMN_CELLS, 1},
    {"work", "accuracy and work in a simulation, labelled by number of spheres", "work, n r_eq / r_min", "mismatch D",
     MS_COLUMN_WORK, MS_COLUMN_DICE, MS_COLUMN_CELLS, 1},
    {"corrected", "inertia with corrected masses", "number of spheres", "error of the moments", MS_COLUMN_SPHERES,
     MS_COLUMN_CORRECTED, MS_COLUMN_CELLS, 0},
    {"resolution", "mismatch by resolution", "cells along the shortest side", "mismatch D", MS_COLUMN_CELLS,
     MS_COLUMN_DICE, MS_COLUMN_ASKED, 0},
};

/* A measure by number of spheres. */
static chart_kind describe_measure(ms_measure_code code)
{
    const ms_measure *measure = &ms_measures[code];
    return (chart_kind){.name = measure->name,
                        .x_label = "number of spheres",
                        .y_label = measure->axis,
                        .x = MS_COLUMN_SPHERES,
                        .y = (ms_column)(MS_COLUMN_MEASURES + code),
                        .fixed = MS_COLUMN_CELLS};
}

/* Greatest value of a column among the rows of a shape; NAN without any. */
static double greatest(const records *all, const ms_compare_record *shape, ms_column column)
{
    double value = (double)NAN;
    for (size_t r = 0; r < all->count; r++) {
        if (ms_compare_records_same_shape(&all->record[r], shape)) {
            value = fmax(value, ms_compare_record_number(&all->record[r], column));
        }
    }
    return value;
}

static int several(const records *all, const ms_compare_record *shape, ms_column column)
{
    int found = 0;
    for (size_t r = 0; r < all->count; r++) {
        found |= ms_compare_records_same_shape(&all->record[r], shape) &&
                 !ms_compare_records_agree(&all->record[r], shape, column);
    }
    return found;
}

/* Nonzero for the first row of a shape, or, with `method`, of a method within its shape. */
static int is_first(const records *all, size_t at, int method)
{
    for (size_t r = 0; r < at; r++) {
        if (ms_compare_records_same_shape(&all->record[r], &all->record[at]) &&
            (!method || ms_compare_records_same_method(&all->record[r], &all->record[at]))) {
            return 0;
        }
    }
    return 1;
}

static ms_chart_point make_point(const ms_compare_record *row, const chart_kind *k)
{
    ms_chart_point point = {.x = ms_compare_record_number(row, k->x), .y = ms_compare_record_number(row, k->y)};
    if (k->front) {
        snprintf(point.label, MS_CHART_LABEL, "%s", row->field[MS_COLUMN_SPHERES]);
    }
    if (k->x == MS_COLUMN_GENERATE && ms_compare_record_number(row, MS_COLUMN_REPEATS) > 1) {
        point.low = ms_compare_record_number(row, MS_COLUMN_FASTEST);
        point.high = ms_compare_record_number(row, MS_COLUMN_SLOWEST);
    }
    return point;
}

/* The points of a method; a clump of another tool has no number that it was asked for. */
static size_t collect(ms_chart_point *point, const records *all, const ms_compare_record *first, const chart_kind *k)
{
    const double fixed = greatest(all, first, k->fixed);
    size_t count = 0;
    for (size_t r = 0; r < all->count; r++) {
        const ms_compare_record *one = &all->record[r];
        const double value = ms_compare_record_number(one, k->fixed);
        if (ms_compare_records_same_shape(one, first) && ms_compare_records_same_method(one, first) &&
            (value == fixed || isnan(value))) {
            point[count++] = make_point(one, k);
        }
    }
    return count;
}

/* What is expected, by number of spheres, each once. */
static size_t collect_expected(ms_chart_point *point, const records *all, const ms_compare_record *shape)
{
    size_t count = 0;
    for (size_t r = 0; r < all->count; r++) {
        const ms_compare_record *one = &all->record[r];
        if (ms_compare_records_same_shape(one, shape)) {
            const ms_chart_point next = {.x = ms_compare_record_number(one, MS_COLUMN_SPHERES),
                                         .y = ms_compare_record_number(one, MS_COLUMN_EXPECTED)};
            size_t at = count;
            while (at > 0 && point[at - 1].x > next.x) {
                at--;
            }
            if (isfinite(next.x) && isfinite(next.y) && !(at > 0 && point[at - 1].x == next.x)) {
                memmove(point + at + 1, point + at, (count - at) * sizeof *point);
                point[at] = next;
                count++;
            }
        }
    }
    return count;
}

/* What a chart is made of; one point each for the front or what is expected and for the method is the most a row can
 * give. */
typedef struct draft {
    ms_chart_series *series;
    ms_chart_point *point;
    size_t n_series, n_points;
    char **name;
} draft;

static void free_draft(draft *d)
{
    for (size_t s = 0; d->name && s < d->n_series; s++) {
        free(d->name[s]);
    }
    free(d->name);
    free(d->series);
    free(d->point);
}

/* A clump of another tool, of which it is not known how long it took. */
static int is_timeless(const ms_compare_record *row, const chart_kind *k)
{
    return k->x == MS_COLUMN_GENERATE && ms_compare_record_is_clump(row);
}

/* The caller frees it; NULL without memory. */
static char *name_series(const ms_compare_record *row, const chart_kind *k)
{
    char *method = ms_compare_record_method(row), *name = NULL;
    if (!method || !is_timeless(row, k)) {
        return method;
    }
    const size_t room = strlen(method) + strlen(row->field[MS_COLUMN_SPHERES]) + 32;
    if ((name = malloc(room))) {
        snprintf(name, room, "%s, %s spheres, no time", method, row->field[MS_COLUMN_SPHERES]);
    }
    free(method);
    return name;
}

/* The front, or what is expected, comes first, so that it is drawn behind the others. */
static ms_status fill_draft(draft *d, const records *all, const ms_compare_record *shape, const chart_kind *k,
                            ms_error *err)
{
    d->series = calloc(all->count + 1, sizeof *d->series);
    d->name = calloc(all->count + 1, sizeof *d->name);
    d->point = calloc(2 * all->count + 1, sizeof *d->point);
    if (!d->series || !d->name || !d->point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a chart of %zu rows", all->count);
    }
    const int expected = k->y == MS_COLUMN_DICE && k->x == MS_COLUMN_SPHERES;
    d->n_series = k->front || expected ? 1 : 0;
    for (size_t r = 0; r < all->count; r++) {
        if (ms_compare_records_same_shape(&all->record[r], shape) && is_first(all, r, 1)) {
            ms_chart_point *point = d->point + d->n_points;
            const size_t count = collect(point, all, &all->record[r], k);
            char *name = d->name[d->n_series] = name_series(&all->record[r], k);
            if (!name) {
                return ms_fail(err, MS_ERR_NOMEM, "no memory for a chart of %zu rows", all->count);
            }
            d->series[d->n_series++] =
                (ms_chart_series){name, is_timeless(&all->record[r], k) ? MS_CHART_LEVEL : MS_CHART_CURVE, count, point,
                                  ms_compare_record_look(&all->record[r])};
            d->n_points += count;
        }
    }
    ms_chart_part_looks(d->series, d->n_series);
    if (k->front) {
        ms_chart_point *front = d->point + d->n_points;
        const size_t count = ms_chart_pareto(front, d->point, d->n_points);
        for (size_t p = 0; p < count; p++) {
            front[p] = (ms_chart_point){.x = front[p].x, .y = front[p].y};
        }
        d->series[0] =
            (ms_chart_series){.name = "Pareto front", .style = MS_CHART_FRONT, .count = count, .point = front};
    } else if (expected) {
        ms_chart_point *line = d->point + d->n_points;
        d->series[0] = (ms_chart_series){.name = "expected least",
                                         .style = MS_CHART_LINE,
                                         .count = collect_expected(line, all, shape),
                                         .point = line};
    }
    return MS_OK;
}

static void name_shape(char *out, size_t size, const ms_compare_record *shape)
{
    ms_compare_name(out, size, shape->field[MS_COLUMN_SHAPE], shape->field[MS_COLUMN_LABEL]);
}

/* The value of a column where all timed rows of the shape have the same; NULL where they differ or there is none. */
static const char *find_common(const ms_compare_record *row, size_t count, const ms_compare_record *shape,
                               ms_column column)
{
    const char *found = NULL;
    for (size_t r = 0; r < count; r++) {
        if (row[r].field[MS_COLUMN_GENERATE][0] && (!shape || ms_compare_records_same_shape(&row[r], shape))) {
            if (found && strcmp(found, row[r].field[column]) != 0) {
                return NULL;
            }
            found = row[r].field[column];
        }
    }
    return found;
}

void ms_compare_charts_timing(char *out, size_t size, const ms_compare_record *row, size_t count,
                              const ms_compare_record *shape)
{
    const char *machine = find_common(row, count, shape, MS_COLUMN_MACHINE);
    const char *threads = find_common(row, count, shape, MS_COLUMN_THREADS);
    const char *repeats = find_common(row, count, shape, MS_COLUMN_REPEATS);
    const char *beside = find_common(row, count, shape, MS_COLUMN_BESIDE);
    char runs[48] = "medians of different numbers of runs";
    if (repeats) {
        snprintf(runs, sizeof runs, strcmp(repeats, "1") == 0 ? "single runs" : "medians of %.8s runs", repeats);
    }
    snprintf(out, size, "%s; threads: %s; %s%s", machine ? machine : "several machines", threads ? threads : "several",
             runs, beside && strcmp(beside, "0") == 0 ? "" : "; others beside them");
}

/* What the bars are. The median of a method lies between the least and the most of n runs with a probability of
 * 1 - 2^(1-n) (order statistics: David and Nagaraja 2003, section 7.1). */
static void add_bars(char *out, size_t size, const records *all, const ms_compare_record *shape)
{
    const char *repeats = find_common(all->record, all->count, shape, MS_COLUMN_REPEATS);
    const double n = repeats ? strtod(repeats, NULL) : 1;
    const size_t length = strlen(out);
    if (n > 1) {
        snprintf(out + length, size - length, "; bars: least to most, %.3g %% confidence", 100 * (1 - pow(2, 1 - n)));
    }
}

static ms_status draw_compare_chart(const records *all, const ms_compare_record *shape, const chart_kind *k,
                                    ms_error *err)
{
    char name[256], title[512], at[64], note[256] = "";
    draft d = {0};
    const double fixed = greatest(all, shape, k->fixed);
    const size_t room = strlen(all->folder) + sizeof name + 32;
    char *stem = malloc(room);
    name_shape(name, sizeof name, shape);
    snprintf(at, sizeof at, k->fixed == MS_COLUMN_CELLS ? " (%g cells)" : " (up to %g spheres)", fixed);
    snprintf(title, sizeof title, "%s: %s%s%s%s", name, k->what ? k->what : k->y_label, k->what ? "" : " by ",
             k->what ? "" : k->x_label, isnan(fixed) ? "" : at);
    if (k->x == MS_COLUMN_GENERATE) {
        ms_compare_charts_timing(note, sizeof note, all->record, all->count, shape);
        add_bars(note, sizeof note, all, shape);
    }
    ms_status status = stem ? fill_draft(&d, all, shape, k, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for a chart");
    if (status == MS_OK) {
        const ms_chart chart = {.title = title,
                                .x_label = k->x_label,
                                .y_label = k->y_label,
                                .note = k->x == MS_COLUMN_GENERATE ? note : NULL,
                                .x_log = 1,
                                .y_log = 1,
                                .y_least = 1e-6,
                                .n_series = d.n_series,
                                .series = d.series};
        snprintf(stem, room, "%s/%s-%s", all->folder, name, k->name);
        status = ms_chart_make(&chart, stem, all->words, err);
    }
    free_draft(&d);
    free(stem);
    return status;
}

/* One chart of a shape; a failure is kept if it is the first. */
static void draw_kind(ms_status *status, const records *all, const ms_compare_record *shape, const chart_kind *k,
                      ms_error *err)
{
    ms_error why;
    if (k->x == MS_COLUMN_CELLS && !several(all, shape, MS_COLUMN_CELLS)) {
        return;
    }
    const ms_status drawn = draw_compare_chart(all, shape, k, &why);
    if (*status == MS_OK && drawn != MS_OK) {
        *status = drawn;
        *err = why;
    }
}

/* Those of a run before: this one may draw fewer. */
static ms_status remove_charts(const records *all, ms_error *err)
{
    char name[256];
    ms_files files = {0};
    ms_status status = MS_OK;
    for (size_t r = 0; r < all->count && status == MS_OK; r++) {
        if (is_first(all, r, 0)) {
            name_shape(name, sizeof name, &all->record[r]);
            status = ms_compare_charts_list(&files, all->folder, name, err);
        }
    }
    return ms_files_remove(&files, status, err);
}

/* Without gnuplot all scripts are written nevertheless; the first failure is reported. */
static ms_status draw_compare_charts(const records *all, ms_error *err)
{
    ms_status status = remove_charts(all, err);
    for (size_t r = 0; r < all->count; r++) {
        const ms_compare_record *shape = &all->record[r];
        for (int m = 0; is_first(all, r, 0) && m < MS_MEASURES; m++) {
            const chart_kind kind = describe_measure((ms_measure_code)m);
            if (kind.y_label) {
                draw_kind(&status, all, shape, &kind, err);
            }
        }
        for (size_t k = 0; is_first(all, r, 0) && k < sizeof KINDS / sizeof *KINDS; k++) {
            draw_kind(&status, all, shape, &KINDS[k], err);
        }
    }
    return status;
}

ms_status ms_compare_charts_list(ms_files *files, const char *folder, const char *shape, ms_error *err)
{
    char name[512];
    ms_status status = MS_OK;
    for (size_t k = 0; k < MS_MEASURES + sizeof KINDS / sizeof *KINDS && status == MS_OK; k++) {
        const chart_kind kind = k < MS_MEASURES ? describe_measure((ms_measure_code)k) : KINDS[k - MS_MEASURES];
        snprintf(name, sizeof name, "%s-%s", shape, kind.name);
        status = kind.y_label ? ms_files_add_charts(files, folder, name, MS_CHART_ENDINGS, err) : MS_OK;
    }
    return status;
}

ms_status ms_compare_charts(const ms_compare_records *all, const char *folder, FILE *words, ms_error *err)
{
    const records drawn = {.count = all->count, .record = all->record, .folder = folder, .words = words};
    return draw_compare_charts(&drawn, err);
}
