#include "ms_stability_report.h"

#include <stdlib.h>

#include "base/ms_file.h"
#include "ms_stability_charts.h"
#include "view/ms_view_page.h"
#include "view/ms_view_report.h"
#include "view/ms_view_scene.h"

enum { MOST_COLUMNS = 32 + MS_MEASURES };

/* What of a row is shown. */
static const char *const SHOWN[] = {"shape", "generator", "options", "perturbation", "level",         "status", "n",
                                    "dice",  "coverage",  "pieces",  "n_until",      "inertia_error", "cause"};

enum { N_SHOWN = sizeof SHOWN / sizeof *SHOWN };

static int is_same_group(const ms_stability_run *a, const ms_stability_run *b)
{
    return a->shape == b->shape && a->method == b->method;
}

/* Of the runs whose clump is known: that on the unchanged shape, and the worst one of its shape and method. */
static int is_shown(const ms_stability_report *report, size_t at)
{
    const ms_stability_run *run = &report->run[at];
    if (run->clump.n_spheres == 0 || run->change == &ms_changes[0]) {
        return run->clump.n_spheres > 0;
    }
    for (size_t r = 0; r < report->n_runs; r++) {
        const ms_stability_run *other = &report->run[r];
        const double more = other->metrics.score.dice - run->metrics.score.dice;
        if (is_same_group(other, run) && other->clump.n_spheres > 0 && (more > 0 || (more == 0 && r < at))) {
            return 0;
        }
    }
    return 1;
}

static ms_status put_scene(FILE *stream, const ms_stability_run *run, const ms_target *target, size_t triangles,
                           ms_error *err)
{
    char name[512];
    snprintf(name, sizeof name, "%.200s, %.128s, %s %g, %zu spheres", run->shape, ms_stability_label(run->method).text,
             run->change->name, run->level, run->clump.n_spheres);
    const ms_view_scene scene = {.name = name,
                                 .clump = &run->clump,
                                 .target = target,
                                 .ordered = ms_generator_is_nested(run->method->generator, &run->method->settings),
                                 .most_triangles = triangles};
    return ms_view_scene_write(stream, &scene, err);
}

/* Of all rows. */
typedef struct report_scenes {
    long *number; /* -1: none */
    size_t count, written;
} report_scenes;

/* All of a shape, which is read once more; its rows stand together. */
static ms_status put_shape(FILE *stream, const ms_stability_report *report, size_t from, report_scenes *scenes,
                           ms_error *err)
{
    ms_input input;
    ms_input_flags flags = *report->plan->flags;
    ms_status status = ms_stability_read_shape(&input, report->run[from].shape, &flags, err);
    if (status != MS_OK) {
        return status;
    }
    const size_t triangles = ms_view_report_triangles(scenes->count);
    const ms_target target = {.mesh = &input.mesh, .closed = input.report.closed};
    for (size_t r = from; r < report->n_runs && report->run[r].shape == report->run[from].shape && status == MS_OK;
         r++) {
        if (scenes->number[r] >= 0) {
            fputs(scenes->written++ > 0 ? "," : "", stream);
            status = put_scene(stream, &report->run[r], &target, triangles, err);
        }
    }
    ms_input_free(&input);
    return status;
}

/* The table up to its scenes. */
static ms_status begin_page(FILE *stream, const ms_stability_report *report, const long *scene, char *header,
                            ms_error *err)
{
    ms_files files = {0};
    char *column[MOST_COLUMNS];
    const char **chart = NULL;
    size_t shown[N_SHOWN], n_charts = 0;
    const char *const *name = (const char *const *)column;
    const size_t n_columns = ms_csv_split(column, MOST_COLUMNS, header);
    const size_t n_shown = ms_view_report_columns(shown, SHOWN, N_SHOWN, name, n_columns);
    ms_status status =
        report->charts ? ms_stability_charts_list(&files, report->charts, report->plan->methods, err) : MS_OK;
    if (status == MS_OK) {
        status = ms_files_with_ending(&chart, &n_charts, &files, ".svg", err);
    }
    if (status == MS_OK) {
        const ms_view_report page = {.title = "stability of clumps",
                                     .argc = report->argc,
                                     .argv = report->argv,
                                     .column = name,
                                     .shown = shown,
                                     .n_columns = n_columns,
                                     .n_shown = n_shown,
                                     .csv = report->csv,
                                     .scene = scene,
                                     .chart = chart,
                                     .n_charts = n_charts};
        status = ms_view_report_begin(stream, &page, err);
    }
    free(chart);
    ms_files_free(&files);
    return status;
}

static ms_status write_page(FILE *stream, const ms_stability_report *report, long *scene, char *header, ms_error *err)
{
    report_scenes scenes = {.number = scene};
    for (size_t r = 0; r < report->n_runs; r++) {
        scene[r] = is_shown(report, r) ? (long)scenes.count++ : -1;
    }
    ms_status status = begin_page(stream, report, scene, header, err);
    for (size_t r = 0; r < report->n_runs && status == MS_OK; r++) {
        if (r == 0 || report->run[r].shape != report->run[r - 1].shape) {
            status = put_shape(stream, report, r, &scenes, err);
        }
    }
    ms_view_page_end(stream);
    return status;
}

ms_status ms_stability_report_write(const char *path, const ms_stability_report *report, ms_error *err)
{
    ms_output output;
    char *header = ms_stability_line(NULL);
    long *scene = calloc(report->n_runs + 1, sizeof *scene);
    ms_status status =
        header && scene ? ms_output_open(&output, path, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    if (status == MS_OK) {
        status = ms_output_close(&output, write_page(output.stream, report, scene, header, err), err);
    }
    free(header);
    free(scene);
    return status;
}
