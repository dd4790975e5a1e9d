#include "ms_compare_walk.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_version.h"
#include "ms_compare.h"
#include "ms_compare_charts.h"
#include "ms_compare_sheet.h"
#include "ms_trial.h"

/* Where the comparison stands: shapes, resolutions, methods and numbers follow one another in a fixed order. */
typedef struct compare_walk {
    const ms_comparison *a;
    ms_csv *csv;
    size_t at, failed; /* rows */
    const char *shape;
    ms_input input;
    double cells; /* NAN for a volume */
    int target_made;
    ms_status status; /* of the shape, then of the target */
    ms_error cause;
    char checksum[20], label[20], name[256];
    ms_compare_sheet sheet; /* of the shape, at its last resolution */
    ms_status drawn;        /* of the first chart that failed; the comparison goes on */
    ms_error why_not;
} compare_walk;

static ms_compare_row begin_row(const compare_walk *w, const ms_method *method, double asked)
{
    ms_compare_row row = ms_compare_empty();
    row.text[MS_COLUMN_SHAPE] = w->shape;
    row.text[MS_COLUMN_CHECKSUM] = w->checksum;
    row.text[MS_COLUMN_LABEL] = w->label;
    row.text[MS_COLUMN_GENERATOR] = method->name;
    row.text[MS_COLUMN_OPTIONS] = method->options;
    row.number[MS_COLUMN_CELLS] = w->cells;
    if (method->generator) {
        row.number[MS_COLUMN_SEED] = w->a->seed;
        row.number[MS_COLUMN_ASKED] = asked;
        row.number[MS_COLUMN_REPEATS] = w->a->repeats;
    }
    row.number[MS_COLUMN_THREADS] = omp_get_max_threads();
    row.text[MS_COLUMN_VERSION] = MS_VERSION;
    return row;
}

static void put_input(ms_compare_row *row, const ms_input *input)
{
    row->number[MS_COLUMN_VOXEL] = input->target.grid.h;
    row->number[MS_COLUMN_READ] = input->read_seconds;
    row->number[MS_COLUMN_VOXELIZE] = input->voxelize_seconds;
    row->number[MS_COLUMN_DISTANCE] = input->distance_seconds;
}

/* Nonzero if the next row was there before, which must have been made for the same. */
static int is_there(const compare_walk *w, size_t at, const ms_method *method, double asked, ms_status *status,
                    ms_error *err)
{
    if (at >= w->csv->n_rows) {
        return 0;
    }
    const ms_compare_row row = begin_row(w, method, asked);
    char *key = ms_compare_key(&row);
    if (!key) {
        *status = ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    } else if (strncmp(w->csv->row[at], key, strlen(key)) != 0) {
        *status = ms_fail(err, MS_ERR_ARG,
                          "%s: line %zu is of another comparison; it should begin with '%.300s'; --resume takes the "
                          "shapes, methods and numbers as they were",
                          w->csv->path, at + 2, key);
    }
    free(key);
    return 1;
}

/* The target is made only where a row needs it. */
static void need_target(compare_walk *w)
{
    ms_input_flags flags = w->a->input;
    if (w->target_made || w->status != MS_OK) {
        return;
    }
    flags.cells = isnan(w->cells) ? 0 : w->cells;
    ms_target_free(&w->input.target);
    w->status = ms_input_target(&w->input, &flags, &w->cause);
    w->target_made = 1;
}

static void say_row(const ms_compare_row *row)
{
    printf("%s %s%s%s", row->text[MS_COLUMN_SHAPE], row->text[MS_COLUMN_GENERATOR],
           row->text[MS_COLUMN_OPTIONS][0] ? ":" : "", row->text[MS_COLUMN_OPTIONS]);
    if (isfinite(row->number[MS_COLUMN_CELLS])) {
        printf(", %g cells", row->number[MS_COLUMN_CELLS]);
    }
    const ms_column n = isfinite(row->number[MS_COLUMN_SPHERES]) ? MS_COLUMN_SPHERES : MS_COLUMN_ASKED;
    if (isfinite(row->number[n])) {
        printf(", n %g", row->number[n]);
    }
    if (isfinite(row->number[MS_COLUMN_DICE])) {
        printf(": D %.4f", row->number[MS_COLUMN_DICE]);
    } else if (row->text[MS_COLUMN_CAUSE]) {
        printf(": %s", row->text[MS_COLUMN_CAUSE]);
    }
    if (isfinite(row->number[MS_COLUMN_GENERATE])) {
        printf(", %.3g s", row->number[MS_COLUMN_GENERATE]);
    }
    printf("\n");
    fflush(stdout);
}

static ms_status add_row(compare_walk *w, const ms_compare_row *row, ms_error *err)
{
    char *line = ms_compare_line(row);
    ms_status status = line ? ms_csv_add(w->csv, line, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    free(line);
    if (status == MS_OK) {
        w->at++;
        w->failed += !isfinite(row->number[MS_COLUMN_DICE]);
        say_row(row);
    }
    return status;
}

/* Remembers the first failure of a chart. */
static void note_drawn(compare_walk *w, ms_status status, const ms_error *err)
{
    if (status != MS_OK && w->drawn == MS_OK) {
        w->drawn = status;
        w->why_not = *err;
    }
}

/* For the contact sheet. */
static void keep_clump(compare_walk *w, const ms_method *method, double asked, const ms_clump *clump, size_t n)
{
    ms_error err;
    const ms_clump prefix = {.n_spheres = n, .capacity = n, .sphere = clump->sphere};
    const double finest = w->a->cells.value[w->a->cells.count - 1];
    if (w->a->charts && method->generator && !(w->cells < finest)) {
        note_drawn(w, ms_compare_sheet_keep(&w->sheet, method, asked, &prefix, &err), &err);
    }
}

/* One row, of the first spheres of what a trial or another tool gave, or of why there are none. */
static ms_status make_row(compare_walk *w, const ms_method *method, double asked, const ms_trial *trial, double seconds,
                          ms_status failure, const ms_error *why, ms_error *err)
{
    ms_error cause;
    ms_compare_row row = begin_row(w, method, asked);
    const ms_clump *clump = method->generator ? &trial->clump : &method->clump;
    if (w->status == MS_OK) {
        put_input(&row, &w->input);
    }
    if (failure == MS_OK && method->generator) {
        row.text[MS_COLUMN_STOPPED] = ms_stop_name(asked <= (double)clump->n_spheres ? MS_STOP_SPHERES : trial->reason);
        row.number[MS_COLUMN_GENERATE] = seconds;
        row.number[MS_COLUMN_MEMORY] = trial->memory;
    }
    if (failure == MS_OK) {
        const size_t n = asked < (double)clump->n_spheres ? (size_t)asked : clump->n_spheres;
        keep_clump(w, method, asked, clump, n);
        failure = ms_trial_judge(&row, clump, n, &w->input.target, ms_input_max_voxels(&w->a->input), &cause);
        why = &cause;
    }
    if (failure != MS_OK) {
        row.text[MS_COLUMN_CAUSE] = why->text;
    }
    return add_row(w, &row, err);
}

/* The rows of one run, from `first` on; those before were there. */
static ms_status make_rows(compare_walk *w, const ms_method *method, const double *asked, size_t count, size_t first,
                           ms_error *err)
{
    size_t n[MS_NUMBERS_MAX];
    char title[256];
    ms_trial trial = {0};
    ms_error cause;
    ms_trial_run run = {.generator = method->generator,
                        .settings = &method->settings,
                        .seed = (uint64_t)w->a->seed,
                        .repeats = (int)w->a->repeats,
                        .asked = n,
                        .n_asked = count,
                        .title = title};
    for (size_t k = 0; k < count; k++) {
        n[k] = method->generator ? (size_t)asked[k] : 0;
    }
    snprintf(title, sizeof title, "%.150s %.80s", w->shape, method->name);
    need_target(w);
    ms_status made = w->status;
    cause = w->cause;
    if (made == MS_OK && method->generator) {
        made = ms_trial_make(&trial, &run, &w->input.target, &cause);
    }
    ms_status status = MS_OK;
    for (size_t k = first; k < count && status == MS_OK; k++) {
        status = make_row(w, method, asked[k], &trial, trial.seconds ? trial.seconds[k] : 0, made, &cause, err);
    }
    ms_trial_free(&trial);
    return status;
}

static ms_status compare_method(compare_walk *w, const ms_method *method, ms_error *err)
{
    static const double AS_IT_IS[] = {HUGE_VAL};
    const ms_numbers *list = &w->a->asked;
    const double *asked = method->generator ? list->value : AS_IT_IS;
    const size_t count = method->generator ? list->count : 1;
    const size_t batch = method->generator && ms_generator_is_nested(method->generator, &method->settings) ? count : 1;
    ms_status status = MS_OK;
    for (size_t k = 0; k < count && status == MS_OK; k += batch) {
        size_t there = 0;
        while (status == MS_OK && there < batch && is_there(w, w->at, method, asked[k + there], &status, err)) {
            there++;
            w->at++;
        }
        if (status == MS_OK && there < batch) {
            status = make_rows(w, method, asked + k, batch, there, err);
        }
    }
    return status;
}

static ms_status compare_methods(compare_walk *w, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t m = 0; m < w->a->methods.count && status == MS_OK; m++) {
        status = compare_method(w, &w->a->methods.method[m], err);
    }
    return status;
}

static void draw_sheet(compare_walk *w)
{
    ms_error err;
    need_target(w);
    if (w->status == MS_OK) {
        note_drawn(w, ms_compare_sheet_draw(&w->sheet, &w->input.target, &err), &err);
    }
}

/* The sheet of a shape of that name. */
static ms_compare_sheet plan_sheet(const ms_comparison *a, const char *name)
{
    return (ms_compare_sheet){
        .folder = a->charts, .shape = name, .methods = &a->methods, .asked = a->asked.value, .n_asked = a->asked.count};
}

static ms_status compare_shape(compare_walk *w, const char *shape, ms_error *err)
{
    const ms_numbers *cells = &w->a->cells;
    ms_status status = MS_OK;
    w->shape = shape;
    ms_compare_name(w->name, sizeof w->name, shape, w->label);
    w->sheet = plan_sheet(w->a, w->name);
    const ms_status read = ms_input_read(&w->input, shape, &w->a->input, &w->cause);
    snprintf(w->checksum, sizeof w->checksum, "%016llx", (unsigned long long)w->input.checksum);
    const int is_volume = w->input.volume.label != NULL;
    for (size_t c = 0; c < (is_volume ? 1 : cells->count) && status == MS_OK; c++) {
        w->cells = is_volume ? (double)NAN : cells->value[c];
        w->status = read;
        w->target_made = 0;
        status = compare_methods(w, err);
    }
    if (status == MS_OK && w->a->charts) {
        draw_sheet(w);
    }
    ms_input_free(&w->input);
    return status;
}

static ms_status compare_shapes(compare_walk *w, ms_error *err)
{
    const ms_comparison *a = w->a;
    ms_status status = MS_OK;
    for (size_t s = 0; s < a->n_shapes && status == MS_OK; s++) {
        status = compare_shape(w, a->shape[s], err);
    }
    if (status == MS_OK && w->at < w->csv->n_rows) {
        status = ms_fail(err, MS_ERR_ARG, "%s: holds %zu rows of another comparison behind these; name another file",
                         w->csv->path, w->csv->n_rows - w->at);
    }
    return status;
}

static void print_label(char out[20], const ms_comparison *a)
{
    out[0] = '\0';
    if (a->input.label) {
        snprintf(out, 20, "%lu", (unsigned long)a->input.label);
    }
}

static ms_status list_charts(ms_files *files, const ms_comparison *a, size_t s, ms_error *err)
{
    char name[256], other[256], label[20];
    print_label(label, a);
    ms_compare_name(name, sizeof name, a->shape[s], label);
    for (size_t before = 0; before < s; before++) {
        ms_compare_name(other, sizeof other, a->shape[before], label);
        if (strcmp(name, other) == 0) {
            return ms_fail(err, MS_ERR_ARG, "two shapes are called %s, and so would be their charts; rename one", name);
        }
    }
    const ms_compare_sheet sheet = plan_sheet(a, name);
    const ms_status status = ms_compare_sheet_list(files, &sheet, err);
    return status == MS_OK ? ms_compare_charts_list(files, a->charts, name, err) : status;
}

ms_status ms_compare_list_files(ms_files *files, const ms_comparison *a, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; s < a->n_shapes && status == MS_OK; s++) {
        status = ms_files_add_shape(files, a->shape[s], err);
        if (status == MS_OK && a->charts) {
            status = list_charts(files, a, s, err);
        }
    }
    return status == MS_OK ? ms_methods_list_files(files, &a->methods, err) : status;
}

ms_status ms_compare_walk(ms_csv *csv, const ms_comparison *comparison, ms_error *err)
{
    compare_walk w = {.a = comparison, .csv = csv};
    if (comparison->input.threads) {
        omp_set_num_threads(comparison->input.threads);
    }
    print_label(w.label, comparison);
    const ms_status status = compare_shapes(&w, err);
    if (status != MS_OK) {
        return status;
    }
    printf("wrote %s, %zu rows", csv->path, csv->n_rows);
    printf(w.failed ? "; %zu of the new ones failed, see the column cause\n" : "\n", w.failed);
    if (comparison->charts) {
        ms_error why;
        note_drawn(&w, ms_compare_charts(csv, comparison->charts, &why), &why);
        *err = w.why_not;
    }
    return w.drawn;
}
