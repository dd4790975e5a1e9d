#include "ms_stability_charts.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chart/ms_chart.h"

/* The runs of one method, and the chart that is being made of them. */
typedef struct album {
    const char *folder;
    const ms_stability_run *runs; /* of all methods */
    size_t n_runs;
    const ms_method *method;
    int number;            /* of the method */
    ms_chart_point *point; /* one for each run */
    ms_chart_series *series;
    size_t n_points, n_series;
} album;

/* NAN if the method gave nothing. */
static double unchanged_dice(const album *a, const ms_stability_run *run)
{
    const ms_stability_run *unchanged = ms_stability_unchanged(a->runs, run);
    return unchanged ? unchanged->metrics.score.dice : (double)NAN;
}

static void begin_series(album *a, const char *name, ms_chart_style style)
{
    a->series[a->n_series++] = (ms_chart_series){.name = name, .style = style, .point = a->point + a->n_points};
}

static void add_point(album *a, double x, double y, const char *label)
{
    ms_chart_point *point = &a->point[a->n_points++];
    *point = (ms_chart_point){.x = x, .y = y};
    snprintf(point->label, sizeof point->label, "%s", label);
    a->series[a->n_series - 1].count++;
}

enum { NAME_SIZE = 128 };

/* Letters, digits and dashes of what the user called the method. */
static void name_chart(char name[NAME_SIZE], int number, const ms_method *method, const char *kind)
{
    snprintf(name, NAME_SIZE, "%d-%.40s-%s", number, ms_stability_label(method).text, kind);
    for (char *at = name; *at; at++) {
        *at = (char)(isalnum((unsigned char)*at) ? *at : '-');
    }
}

static ms_status draw_album_chart(album *a, const char *kind, ms_chart chart, ms_error *err)
{
    char name[NAME_SIZE];
    const size_t size = strlen(a->folder) + sizeof name + 1;
    char *stem = malloc(size);
    if (!stem) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a chart");
    }
    name_chart(name, a->number, a->method, kind);
    snprintf(stem, size, "%s/%s", a->folder, name);
    const ms_label label = ms_stability_label(a->method);
    chart.title = label.text;
    chart.series = a->series;
    chart.n_series = a->n_series;
    ms_status status = MS_OK;
    if (!ms_chart_is_one(&chart)) {
        ms_chart_say(stderr, &chart, stem);
    } else if ((status = ms_chart_write(&chart, stem, err)) == MS_OK) {
        status = ms_chart_draw(stem, err);
    }
    free(stem);
    return status;
}

static int is_of_album(const album *a, const ms_stability_run *run, const ms_change *change)
{
    return run->change == change && ms_stability_gave(run) && run->method == a->method;
}

static ms_status draw_all_changes(album *a, ms_error *err)
{
    static const ms_chart chart = {
        .x_label = "D of the unchanged shape", .y_label = "D of the changed shape", .x_log = 1, .y_log = 1};
    a->n_points = a->n_series = 0;
    for (const ms_change *change = ms_changes; change->name; change++) {
        begin_series(a, change->name, MS_CHART_POINTS);
        for (size_t r = 0; r < a->n_runs; r++) {
            const ms_stability_run *run = &a->runs[r];
            if (is_of_album(a, run, change)) {
                add_point(a, unchanged_dice(a, run), run->metrics.score.dice, change == ms_changes ? run->shape : "");
            }
        }
    }
    return a->n_points ? draw_album_chart(a, "all", chart, err) : MS_OK;
}

static ms_status draw_levels(album *a, const ms_change *change, ms_error *err)
{
    const ms_chart chart = {.x_label = change->axis, .y_label = "D / D of the unchanged shape", .x_log = 1, .y_log = 1};
    const char *shape = NULL;
    a->n_points = a->n_series = 0;
    for (size_t r = 0; r < a->n_runs; r++) {
        const ms_stability_run *run = &a->runs[r];
        if (!is_of_album(a, run, change) || !(unchanged_dice(a, run) > 0)) {
            continue;
        }
        if (!shape || strcmp(shape, run->shape) != 0) {
            shape = run->shape;
            begin_series(a, shape, MS_CHART_CURVE);
        }
        add_point(a, run->level, run->metrics.score.dice / unchanged_dice(a, run), "");
    }
    return a->n_points ? draw_album_chart(a, change->name, chart, err) : MS_OK;
}

/* Without gnuplot all scripts are written nevertheless; the first failure is reported. */
static void keep_first(ms_status *status, ms_error *err, ms_status drawn, const ms_error *why)
{
    if (*status == MS_OK && drawn != MS_OK) {
        *status = drawn;
        ms_fail(err, drawn, "%s", why->text);
    }
}

static ms_status draw_method(album *a, ms_error *err)
{
    ms_error why;
    ms_status status = draw_all_changes(a, err);
    for (const ms_change *change = ms_changes; change->name; change++) {
        const ms_status drawn = change->axis ? draw_levels(a, change, &why) : MS_OK;
        keep_first(&status, err, drawn, &why);
    }
    return status;
}

/* Has a run before this one the same method? */
static int is_known(const ms_stability_run *runs, size_t r)
{
    int known = 0;
    for (size_t q = 0; q < r && !known; q++) {
        known = runs[q].method == runs[r].method;
    }
    return known;
}

static ms_status remove_charts(const char *folder, const ms_methods *methods, ms_error *err)
{
    ms_files files = {0};
    const ms_status status = ms_stability_charts_list(&files, folder, methods, err);
    return ms_files_remove(&files, status, err);
}

ms_status ms_stability_charts(const char *folder, const ms_methods *methods, const ms_stability_run *runs,
                              size_t n_runs, ms_error *err)
{
    album a = {.folder = folder,
               .runs = runs,
               .n_runs = n_runs,
               .point = malloc((n_runs + 1) * sizeof *a.point),
               .series = malloc((n_runs + MS_CHANGE_MOST) * sizeof *a.series)};
    ms_status status = a.point && a.series ? remove_charts(folder, methods, err)
                                           : ms_fail(err, MS_ERR_NOMEM, "no memory for charts of %zu runs", n_runs);
    const size_t count = status == MS_OK ? n_runs : 0;
    for (size_t r = 0; r < count; r++) {
        if (!is_known(runs, r)) {
            ms_error why;
            a.method = runs[r].method;
            a.number++;
            keep_first(&status, err, draw_method(&a, &why), &why);
        }
    }
    free(a.point);
    free(a.series);
    return status;
}

ms_status ms_stability_charts_list(ms_files *files, const char *folder, const ms_methods *methods, ms_error *err)
{
    char name[NAME_SIZE];
    ms_status status = MS_OK;
    for (size_t m = 0; m < methods->count && status == MS_OK; m++) {
        name_chart(name, (int)m + 1, &methods->method[m], "all");
        status = ms_files_add_charts(files, folder, name, MS_CHART_ENDINGS, err);
        for (const ms_change *change = ms_changes; change->name && status == MS_OK; change++) {
            name_chart(name, (int)m + 1, &methods->method[m], change->name);
            status = change->axis ? ms_files_add_charts(files, folder, name, MS_CHART_ENDINGS, err) : MS_OK;
        }
    }
    return status;
}
