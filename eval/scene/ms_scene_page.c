#include "ms_scene_page.h"

#include <stdlib.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "ms_scene_charts.h"
#include "view/ms_view_page.h"
#include "view/ms_view_report.h"
#include "view/ms_view_scene.h"

static const char *const COLUMNS[] = {"shape",       "particles",    "n",     "dice", "coverage", "inertia",
                                      "last_sphere", "least_radius", "cause", "size"};

enum { N_COLUMNS = sizeof COLUMNS / sizeof *COLUMNS };

static void print_row(FILE *stream, const ms_scene_shape *shape)
{
    const ms_score *score = ms_scene_score(shape);
    ms_escape_csv_path(stream, shape->row->path);
    ms_csv_put_number(stream, (double)shape->row->particles);
    ms_csv_put_number(stream, (double)ms_scene_clump(shape)->n_spheres);
    ms_csv_put_number(stream, score->dice);
    ms_csv_put_number(stream, score->coverage);
    ms_csv_put_number(stream, score->inertia);
    ms_csv_put_number(stream, -ms_scene_gain(shape));
    ms_csv_put_number(stream, ms_clump_smallest_radius(ms_scene_clump(shape)));
    fputc(',', stream);
    ms_escape_csv(stream, shape->templates.remarks[shape->chosen - 1].text);
    ms_csv_put_number(stream, shape->row->size);
}

/* The caller frees it; NULL without memory. @param shape NULL: the sums */
static char *make_text(const ms_scene_page *page, const ms_scene_shape *shape)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    if (shape) {
        print_row(stream, shape);
    } else {
        ms_scene_print_sums(stream, page->scene, page->goal);
    }
    return fclose(stream) == 0 ? text : NULL;
}

static ms_status list_charts(ms_files *files, const ms_scene_page *page, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; page->charts && s < page->scene->count && status == MS_OK; s++) {
        status = ms_scene_charts_list(files, page->charts, page->scene->shape[s].row, s + 1, page->goal, err);
    }
    return status;
}

/* A scene of the page for each shape, in their order. */
static ms_status begin_page(FILE *stream, const ms_scene_page *page, char **row, long *number, ms_error *err)
{
    ms_files files = {0};
    const char **chart = NULL;
    size_t shown[N_COLUMNS];
    const size_t count = page->scene->count;
    const ms_csv csv = {.n_rows = count, .row = row};
    ms_view_report report = {.title = "templates of a scene",
                             .argc = page->argc,
                             .argv = page->argv,
                             .column = COLUMNS,
                             .shown = shown,
                             .n_columns = N_COLUMNS,
                             .n_shown = page->scene->has_sizes ? N_COLUMNS : N_COLUMNS - 1,
                             .csv = &csv,
                             .scene = number};
    for (size_t c = 0; c < N_COLUMNS; c++) {
        shown[c] = c;
    }
    report.sums = make_text(page, NULL);
    int has_memory = report.sums != NULL;
    for (size_t s = 0; s < count && has_memory; s++) {
        number[s] = (long)s;
        row[s] = make_text(page, &page->scene->shape[s]);
        has_memory = row[s] != NULL;
    }
    ms_status status =
        has_memory ? list_charts(&files, page, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    if (status == MS_OK) {
        status = ms_files_with_ending(&chart, &report.n_charts, &files, ".svg", err);
    }
    if (status == MS_OK) {
        report.chart = chart;
        status = ms_view_report_begin(stream, &report, err);
    }
    ms_files_free(&files);
    free(chart);
    free(report.sums);
    return status;
}

/* The shape in the size of its clump. */
static void size_shown(ms_target *shown, ms_input *input, double factor)
{
    for (size_t v = 0; v < input->mesh.n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            input->mesh.vertex[v][k] *= factor;
        }
    }
    for (int k = 0; k < 3; k++) {
        shown->grid.origin[k] *= factor;
    }
    shown->grid.h *= factor;
}

static ms_status put_shape(FILE *stream, const ms_scene_page *page, const ms_scene_shape *shape, ms_error *err)
{
    char name[512];
    ms_input input;
    ms_target target;
    const ms_recipe *recipe = page->run->recipe;
    ms_status status = ms_input_read(&input, shape->row->path, page->run->input, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_input_show(&target, &input, page->run->input->label, err);
    if (status == MS_OK) {
        snprintf(name, sizeof name, "%.400s, %.40s, %zu spheres", ms_manifest_name_row(shape->row).text,
                 recipe->generator->name, ms_scene_clump(shape)->n_spheres);
        size_shown(&target, &input, shape->factor);
        const ms_view_scene scene = {.name = name,
                                     .clump = ms_scene_clump(shape),
                                     .target = &target,
                                     .ordered = ms_generator_is_nested(recipe->generator, &recipe->settings),
                                     .most_triangles = ms_view_report_triangles(page->scene->count)};
        status = ms_view_scene_write(stream, &scene, err);
    }
    ms_input_free(&input);
    return status;
}

static ms_status write_page(FILE *stream, const ms_scene_page *page, char **row, long *number, ms_error *err)
{
    ms_status status = begin_page(stream, page, row, number, err);
    for (size_t s = 0; s < page->scene->count && status == MS_OK; s++) {
        fputs(s > 0 ? "," : "", stream);
        status = put_shape(stream, page, &page->scene->shape[s], err);
    }
    ms_view_page_end(stream);
    return status;
}

ms_status ms_scene_page_write(const char *path, const ms_scene_page *page, ms_error *err)
{
    ms_output output;
    const size_t count = page->scene->count;
    char **row = calloc(count, sizeof *row);
    long *number = calloc(count, sizeof *number);
    ms_status status =
        row && number ? ms_output_open(&output, path, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    if (status == MS_OK) {
        status = ms_output_close(&output, write_page(output.stream, page, row, number, err), err);
    }
    for (size_t s = 0; row && s < count; s++) {
        free(row[s]);
    }
    free(row);
    free(number);
    return status;
}
