#include "ms_chart.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "ms_chart_parts.h"

const char *const MS_CHART_ENDINGS[] = {".dat", ".gp", ".svg", ".png", NULL};

/* The highest place of a point: of a band its upper edge. */
static double find_top(const ms_chart *chart, const ms_chart_series *series, const ms_chart_point *point)
{
    return ms_chart_parts_lift(chart, series->style == MS_CHART_BAND ? point->top : point->y);
}

static int is_look_taken(const ms_chart_series *series, size_t s)
{
    const ms_chart_look look = series[s].look;
    int taken = 0;
    for (size_t before = 0; before < s && look.family != 0; before++) {
        taken |= series[before].look.family == look.family && series[before].look.variant == look.variant &&
                 strcmp(series[before].name, series[s].name) != 0;
    }
    return taken;
}

void ms_chart_part_looks(ms_chart_series *series, size_t count)
{
    for (size_t s = 0; s < count; s++) {
        const ms_chart_look own = series[s].look;
        while (is_look_taken(series, s)) {
            series[s].look = ms_chart_look_next(series[s].look);
            if (series[s].look.variant == own.variant) {
                break; /* all are taken */
            }
        }
    }
}

static int has_marks(const ms_chart_series *series)
{
    return series->style == MS_CHART_CURVE || series->style == MS_CHART_POINTS;
}

int ms_chart_is_one(const ms_chart *chart)
{
    size_t all = 0, longest = 0;
    int by_x = 1; /* not with a front, nor of points alone */
    for (size_t s = 0; s < chart->n_series; s++) {
        const ms_chart_series *series = &chart->series[s];
        const size_t count = has_marks(series) ? ms_chart_parts_count(chart, series) : 0;
        all += count;
        longest = count > longest ? count : longest;
        by_x = by_x && series->style != MS_CHART_FRONT && series->style != MS_CHART_POINTS;
    }
    return all > 1 && (!by_x || longest > 1);
}

void ms_chart_say(FILE *stream, const ms_chart *chart, const char *stem)
{
    int said = 0;
    fprintf(stream, "no chart %s", stem);
    for (size_t s = 0; s < chart->n_series; s++) {
        const ms_chart_series *series = &chart->series[s];
        for (size_t p = 0; p < series->count && has_marks(series); p++) {
            if (ms_chart_parts_has_place(chart, series, &series->point[p])) {
                fprintf(stream, "%s%s: %s %.4g, %s %.4g", said++ ? "; " : ", but words: ", series->name, chart->x_label,
                        series->point[p].x, chart->y_label, series->point[p].y);
            }
        }
    }
    fputs(said ? "\n" : ": none of its points has a place on the axes\n", stream);
}

static void widen_range(ms_chart_range *r, int is_log)
{
    if (is_log) {
        r->lo /= 1.25;
        r->hi *= 1.25;
    } else {
        const double margin = r->hi > r->lo ? 0.05 * (r->hi - r->lo) : fmax(0.05 * fabs(r->hi), 1e-300);
        r->lo -= margin;
        r->hi += margin;
    }
}

static void take_x(ms_chart_range *x, double value)
{
    *x = (ms_chart_range){fmin(x->lo, value), fmax(x->hi, value)};
}

/* Nonzero if there is anything to draw. */
static int find_ranges(ms_chart_range *x, ms_chart_range *y, const ms_chart *chart)
{
    *x = *y = (ms_chart_range){HUGE_VAL, -HUGE_VAL};
    for (size_t s = 0; s < chart->n_series; s++) {
        const ms_chart_series *series = &chart->series[s];
        for (size_t p = 0; p < series->count; p++) {
            const ms_chart_point *point = &series->point[p];
            if (!ms_chart_parts_has_place(chart, series, point)) {
                continue;
            }
            y->lo = fmin(y->lo, ms_chart_parts_lift(chart, point->y));
            y->hi = fmax(y->hi, find_top(chart, series, point));
            if (series->style != MS_CHART_LEVEL) {
                take_x(x, point->x);
            }
            if (point->high > 0) {
                take_x(x, point->low);
                take_x(x, point->high);
            }
        }
    }
    if (x->lo > x->hi) {
        return 0;
    }
    widen_range(x, chart->x_log);
    widen_range(y, chart->y_log);
    return 1;
}

static void put_point(FILE *stream, const ms_chart *chart, const ms_chart_series *series, const ms_chart_point *point)
{
    fprintf(stream, "%.9g %.9g ", point->x, ms_chart_parts_lift(chart, point->y));
    if (series->style == MS_CHART_BAND) {
        fprintf(stream, "%.9g ", find_top(chart, series, point));
    }
    ms_escape_gnuplot_data(stream, point->label);
    if (point->high > 0) {
        fprintf(stream, " %.9g %.9g", point->low, point->high);
    }
    putc('\n', stream);
}

/* One block per series, two blank lines between; a level from end to end of the axis. */
static void put_data(FILE *stream, const ms_chart *chart, const ms_chart_range *x)
{
    for (size_t s = 0; s < chart->n_series; s++) {
        const ms_chart_series *series = &chart->series[s];
        if (ms_chart_parts_count(chart, series) == 0) {
            continue;
        }
        fputs("# x y label: ", stream);
        ms_escape_gnuplot(stream, series->name);
        putc('\n', stream);
        for (size_t p = 0; p < series->count; p++) {
            ms_chart_point end = series->point[p];
            if (!ms_chart_parts_has_place(chart, series, &end)) {
                continue;
            }
            if (series->style == MS_CHART_LEVEL) {
                end.x = x->lo;
                put_point(stream, chart, series, &end);
                end.x = x->hi;
            }
            put_point(stream, chart, series, &end);
        }
        fputs("\n\n", stream);
    }
}

/* Opens STEM.ENDING. */
static ms_status open_file(ms_output *output, const char *stem, const char *ending, ms_error *err)
{
    char *path = malloc(strlen(stem) + strlen(ending) + 2);
    if (!path) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the chart", stem);
    }
    sprintf(path, "%s.%s", stem, ending);
    const ms_status status = ms_output_open(output, path, err);
    free(path);
    return status;
}

ms_status ms_chart_write(const ms_chart *chart, const char *stem, ms_error *err)
{
    ms_chart_range x, y;
    ms_output output;
    if (!find_ranges(&x, &y, chart)) {
        return ms_fail(err, MS_ERR_ARG, "%s: this chart has no points", stem);
    }
    ms_status status = open_file(&output, stem, "dat", err);
    if (status == MS_OK) {
        put_data(output.stream, chart, &x);
        status = ms_output_close(&output, MS_OK, err);
    }
    if (status == MS_OK) {
        status = open_file(&output, stem, "gp", err);
    }
    if (status == MS_OK) {
        status = ms_chart_script_put(output.stream, chart, ms_file_base_name(stem), &x, &y, err);
        status = ms_output_close(&output, status, err);
    }
    return status;
}

enum { NO_FOLDER = 126, NO_GNUPLOT = 127 };

/* In the child: never returns. */
static void become_gnuplot(const char *stem, char *script)
{
    char program[] = "gnuplot", *words[] = {program, script, NULL};
    const char *name = ms_file_base_name(stem);
    char *folder = strndup(stem, (size_t)(name - stem));
    if (!folder || (folder[0] && chdir(folder) != 0)) {
        _exit(NO_FOLDER);
    }
    execvp(program, words);
    _exit(errno == ENOENT ? NO_GNUPLOT : NO_FOLDER);
}

ms_status ms_chart_draw(const char *stem, ms_error *err)
{
    int end = 0;
    char *script = malloc(strlen(stem) + 6);
    if (!script) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the chart", stem);
    }
    sprintf(script, "./%s.gp", ms_file_base_name(stem)); /* no flag, however it begins */
    const pid_t child = fork();
    if (child == 0) {
        become_gnuplot(stem, script);
    }
    free(script);
    if (child < 0 || waitpid(child, &end, 0) < 0) {
        return ms_fail(err, MS_ERR_IO, "%s.gp: gnuplot could not be started: %s", stem, strerror(errno));
    }
    if (WIFEXITED(end) && WEXITSTATUS(end) == NO_GNUPLOT) {
        return ms_fail(err, MS_ERR_IO,
                       "gnuplot is not installed (package gnuplot-nox); %s.gp draws the chart when it is", stem);
    }
    if (!WIFEXITED(end) || WEXITSTATUS(end) != 0) {
        return ms_fail(err, MS_ERR_IO, "%s.gp: gnuplot failed; run it by hand in its folder to see why", stem);
    }
    return MS_OK;
}

ms_status ms_chart_make(const ms_chart *chart, const char *stem, FILE *words, ms_error *err)
{
    if (!ms_chart_is_one(chart)) { /* nor where every run failed: the rows say why */
        ms_chart_say(words, chart, stem);
        return MS_OK;
    }
    ms_status status = ms_chart_write(chart, stem, err);
    if (status == MS_OK && (status = ms_chart_draw(stem, err)) == MS_OK) {
        fprintf(words, "drew %s.svg, .png\n", stem);
    }
    return status;
}

static int by_x_then_y(const void *a, const void *b)
{
    const ms_chart_point *p = a, *q = b;
    if (p->x != q->x) {
        return p->x > q->x ? 1 : -1;
    }
    return p->y != q->y ? (p->y > q->y ? 1 : -1) : strcmp(p->label, q->label);
}

size_t ms_chart_pareto(ms_chart_point *front, const ms_chart_point *point, size_t count)
{
    size_t finite = 0, found = 0;
    for (size_t p = 0; p < count; p++) {
        if (isfinite(point[p].x) && isfinite(point[p].y)) {
            front[finite++] = point[p];
        }
    }
    qsort(front, finite, sizeof *front, by_x_then_y);
    for (size_t p = 0; p < finite; p++) {
        const ms_chart_point *last = found ? &front[found - 1] : NULL;
        if (!last || front[p].y < last->y || (front[p].y == last->y && front[p].x == last->x)) {
            front[found++] = front[p];
        }
    }
    return found;
}
