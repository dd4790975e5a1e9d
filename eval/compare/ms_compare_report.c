#include "ms_compare_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "clump/formats/ms_read.h"
#include "ms_compare.h"
#include "ms_compare_charts.h"
#include "ms_compare_sheet.h"
#include "view/ms_view_page.h"
#include "view/ms_view_report.h"
#include "view/ms_view_scene.h"

static const size_t SHOWN[] = {MS_COLUMN_SHAPE,
                               MS_COLUMN_GENERATOR,
                               MS_COLUMN_OPTIONS,
                               MS_COLUMN_CELLS,
                               MS_COLUMN_SPHERES,
                               MS_COLUMN_DICE,
                               MS_COLUMN_EXPECTED,
                               MS_COLUMN_MEASURES + MS_MEASURE_COVERAGE,
                               MS_COLUMN_MEASURES + MS_MEASURE_PROTRUSION,
                               MS_COLUMN_MEASURES + MS_MEASURE_GAP,
                               MS_COLUMN_MEASURES + MS_MEASURE_NORMAL_MEDIAN,
                               MS_COLUMN_MEASURES + MS_MEASURE_PIECES,
                               MS_COLUMN_MEASURES + MS_MEASURE_INERTIA,
                               MS_COLUMN_WORK,
                               MS_COLUMN_GENERATE,
                               MS_COLUMN_CAUSE};

/* What a row is about. */
typedef struct row_subject {
    size_t shape, method;
    double asked;
    char *clump;           /* path of the clump kept; NULL: there is none */
    const ms_clump *given; /* that of another tool; borrowed; NULL likewise */
} row_subject;

typedef struct report_work {
    const ms_comparison *a;
    const ms_csv *csv;
    row_subject *subject; /* of each row */
    long *scene;          /* likewise; -1: none */
    size_t triangles;     /* of a shape in one scene */
} report_work;

/* Is a field of a row this text, as it was escaped? */
static int is_text(const char *field, const char *text, ms_error *err, ms_status *status)
{
    char *escaped = NULL, *word;
    size_t size;
    FILE *stream = open_memstream(&escaped, &size);
    int same = 0;
    if (stream) {
        ms_escape_csv_path(stream, text);
        if (fclose(stream) == 0 && escaped) {
            same = ms_csv_split(&word, 1, escaped) == 1 && strcmp(word, field) == 0;
        }
    }
    if (!escaped) {
        *status = ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    }
    free(escaped);
    return same;
}

/* As in the row: of another tool the file of this shape. */
static const char *find_options(const report_work *w, const row_subject *subject)
{
    const ms_method *method = &w->a->methods.method[subject->method];
    return method->generator ? method->options : ms_file_name(method->clump[subject->shape].file);
}

static ms_compare_sheet sheet_of(const report_work *w, size_t shape, char name[256])
{
    const ms_comparison *a = w->a;
    ms_compare_name(name, 256, a->shape[shape], a->label);
    return (ms_compare_sheet){
        .folder = a->charts, .shape = name, .methods = &a->methods, .asked = a->asked.value, .n_asked = a->asked.count};
}

/* Clumps were kept of the finest resolution; those of other tools are the methods' own. A run that failed kept none:
 * what stands there is of a run before. */
static ms_status find_subject(report_work *w, size_t r, char **field, ms_error *err)
{
    const ms_comparison *a = w->a;
    row_subject *subject = &w->subject[r];
    const double cells = ms_csv_number(field[MS_COLUMN_CELLS]);
    ms_status status = MS_OK;
    char name[256];
    while (subject->shape < a->n_shapes && !is_text(field[MS_COLUMN_SHAPE], a->shape[subject->shape], err, &status)) {
        subject->shape++;
    }
    while (subject->shape < a->n_shapes && subject->method < a->methods.count &&
           !(strcmp(field[MS_COLUMN_GENERATOR], a->methods.method[subject->method].name) == 0 &&
             is_text(field[MS_COLUMN_OPTIONS], find_options(w, subject), err, &status))) {
        subject->method++;
    }
    if (status != MS_OK || subject->shape == a->n_shapes || subject->method == a->methods.count ||
        cells < a->cells.value[a->cells.count - 1] || !field[MS_COLUMN_SPHERES][0]) {
        return status;
    }
    subject->asked = ms_csv_number(field[MS_COLUMN_ASKED]);
    const ms_method *method = &a->methods.method[subject->method];
    if (!method->generator) {
        subject->given = &method->clump[subject->shape].clump;
        return MS_OK;
    }
    const ms_compare_sheet sheet = sheet_of(w, subject->shape, name);
    subject->clump = ms_compare_sheet_path(&sheet, method, subject->asked, err);
    return subject->clump ? MS_OK : MS_ERR_NOMEM;
}

static ms_status find_scenes(report_work *w, ms_error *err)
{
    long scenes = 0;
    ms_status status = MS_OK;
    for (size_t r = 0; r < w->csv->n_rows && status == MS_OK; r++) {
        char *field[MS_COLUMNS], *line = strdup(w->csv->row[r]);
        w->scene[r] = -1;
        if (!line) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
        }
        if (ms_csv_split(field, MS_COLUMNS, line) == MS_COLUMNS) {
            status = find_subject(w, r, field, err);
        }
        if (w->subject[r].given || (w->subject[r].clump && access(w->subject[r].clump, R_OK) == 0)) {
            w->scene[r] = scenes++;
        }
        free(line);
    }
    w->triangles = ms_view_report_triangles((size_t)scenes);
    return status;
}

static ms_status put_scene(FILE *stream, const report_work *w, const row_subject *subject, const ms_target *target,
                           ms_error *err)
{
    char name[512];
    ms_clump kept = {0};
    const ms_method *method = &w->a->methods.method[subject->method];
    const char *options = find_options(w, subject);
    const ms_clump *clump = subject->given ? subject->given : &kept;
    ms_status status = subject->given ? MS_OK : ms_read_spheres(&kept, subject->clump, err);
    if (status == MS_OK) {
        snprintf(name, sizeof name, "%.200s, %.80s%s%.120s, %zu spheres", w->a->shape[subject->shape], method->name,
                 options[0] ? ":" : "", options, clump->n_spheres);
        const ms_view_scene scene = {.name = name,
                                     .clump = clump,
                                     .target = target,
                                     .ordered = method->generator &&
                                                ms_generator_is_nested(method->generator, &method->settings),
                                     .most_triangles = w->triangles};
        status = ms_view_scene_write(stream, &scene, err);
    }
    ms_clump_free(&kept);
    return status;
}

/* All of a shape. @param written of all shapes so far */
static ms_status put_shape(FILE *stream, const report_work *w, size_t shape, size_t *written, ms_error *err)
{
    ms_input input;
    ms_target shown;
    ms_status status = ms_input_read(&input, w->a->shape[shape], &w->a->input, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_input_show(&shown, &input, w->a->input.label, err);
    for (size_t r = 0; r < w->csv->n_rows && status == MS_OK; r++) {
        if (w->scene[r] >= 0 && w->subject[r].shape == shape) {
            fputs(*written > 0 ? "," : "", stream);
            status = put_scene(stream, w, &w->subject[r], &shown, err);
            (*written)++;
        }
    }
    ms_input_free(&input);
    return status;
}

/* The charts that there can be, in the order of the shapes. */
static ms_status begin_page(FILE *stream, const report_work *w, ms_error *err)
{
    ms_files files = {0};
    const char *column[MS_COLUMNS], **chart = NULL;
    ms_view_report report = {.title = "comparison of clumps",
                             .argc = w->a->argc,
                             .argv = w->a->argv,
                             .column = column,
                             .shown = SHOWN,
                             .n_columns = MS_COLUMNS,
                             .n_shown = sizeof SHOWN / sizeof *SHOWN,
                             .csv = w->csv,
                             .scene = w->scene};
    ms_status status = MS_OK;
    for (int c = 0; c < MS_COLUMNS; c++) {
        column[c] = ms_compare_column(c);
    }
    for (size_t s = 0; s < w->a->n_shapes && status == MS_OK; s++) {
        char name[256];
        ms_compare_name(name, sizeof name, w->a->shape[s], w->a->label);
        status = ms_compare_charts_list(&files, w->a->charts, name, err);
    }
    if (status == MS_OK) {
        status = ms_files_with_ending(&chart, &report.n_charts, &files, ".svg", err);
    }
    if (status == MS_OK) {
        report.chart = chart;
        status = ms_view_report_begin(stream, &report, err);
    }
    free(chart);
    ms_files_free(&files);
    return status;
}

static ms_status write_page(FILE *stream, report_work *w, ms_error *err)
{
    size_t written = 0;
    ms_status status = find_scenes(w, err);
    if (status == MS_OK) {
        status = begin_page(stream, w, err);
    }
    for (size_t s = 0; s < w->a->n_shapes && status == MS_OK; s++) {
        status = put_shape(stream, w, s, &written, err);
    }
    ms_view_page_end(stream);
    return status;
}

ms_status ms_compare_report_write(const ms_csv *csv, const ms_comparison *comparison, ms_error *err)
{
    ms_output output;
    report_work w = {.a = comparison,
                     .csv = csv,
                     .subject = calloc(csv->n_rows + 1, sizeof *w.subject),
                     .scene = calloc(csv->n_rows + 1, sizeof *w.scene)};
    ms_status status = w.subject && w.scene ? ms_output_open(&output, comparison->report, err)
                                            : ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    if (status == MS_OK) {
        status = ms_output_close(&output, write_page(output.stream, &w, err), err);
    }
    for (size_t r = 0; w.subject && r < csv->n_rows; r++) {
        free(w.subject[r].clump);
    }
    free(w.subject);
    free(w.scene);
    if (status == MS_OK) {
        fprintf(comparison->words, "wrote %s\n", comparison->report);
    }
    return status;
}
