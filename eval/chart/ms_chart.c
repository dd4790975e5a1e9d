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

const char *const MS_CHART_ENDINGS[] = {".dat", ".gp", ".svg", ".png", NULL};

static double lift(const ms_chart *chart, double y)
{
    return y < chart->y_least ? chart->y_least : y;
}

static double height(const ms_chart *chart, const ms_chart_point *point)
{
    return lift(chart, point->y);
}

/* The highest place of a point: of a band its upper edge. */
static double find_top(const ms_chart *chart, const ms_chart_series *series, const ms_chart_point *point)
{
    return lift(chart, series->style == MS_CHART_BAND ? point->top : point->y);
}

static int has_place(const ms_chart *chart, const ms_chart_point *point)
{
    const double x = point->x, y = height(chart, point);
    return isfinite(x) && isfinite(y) && (!chart->x_log || x > 0) && (!chart->y_log || y > 0);
}

static size_t count_places(const ms_chart *chart, const ms_chart_series *series)
{
    size_t count = 0;
    for (size_t p = 0; p < series->count; p++) {
        count += has_place(chart, &series->point[p]);
    }
    return count;
}

/* What an axis spans: a little more than its values. */
typedef struct axis_range {
    double lo, hi;
} axis_range;

static void widen_range(axis_range *r, int is_log)
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

/* Nonzero if there is anything to draw. */
static int find_ranges(axis_range *x, axis_range *y, const ms_chart *chart)
{
    *x = *y = (axis_range){HUGE_VAL, -HUGE_VAL};
    for (size_t s = 0; s < chart->n_series; s++) {
        for (size_t p = 0; p < chart->series[s].count; p++) {
            const ms_chart_point *point = &chart->series[s].point[p];
            if (has_place(chart, point)) {
                *x = (axis_range){fmin(x->lo, point->x), fmax(x->hi, point->x)};
                *y = (axis_range){fmin(y->lo, height(chart, point)),
                                  fmax(y->hi, find_top(chart, &chart->series[s], point))};
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

/* Nonzero if a point is drawn higher than it is. */
static int is_lifted(const ms_chart *chart)
{
    int found = 0;
    for (size_t s = 0; s < chart->n_series; s++) {
        for (size_t p = 0; p < chart->series[s].count; p++) {
            const ms_chart_point *point = &chart->series[s].point[p];
            found |= has_place(chart, point) && point->y < chart->y_least;
        }
    }
    return found;
}

/* One block per series, two blank lines between. */
static void put_data(FILE *stream, const ms_chart *chart)
{
    for (size_t s = 0; s < chart->n_series; s++) {
        const ms_chart_series *series = &chart->series[s];
        if (count_places(chart, series) == 0) {
            continue;
        }
        fputs("# x y label: ", stream);
        ms_escape_gnuplot(stream, series->name);
        putc('\n', stream);
        for (size_t p = 0; p < series->count; p++) {
            if (has_place(chart, &series->point[p])) {
                fprintf(stream, "%.9g %.9g ", series->point[p].x, height(chart, &series->point[p]));
                if (series->style == MS_CHART_BAND) {
                    fprintf(stream, "%.9g ", find_top(chart, series, &series->point[p]));
                }
                ms_escape_gnuplot_data(stream, series->point[p].label);
                putc('\n', stream);
            }
        }
        fputs("\n\n", stream);
    }
}

static int has_labels(const ms_chart_series *series)
{
    int found = 0;
    for (size_t p = 0; p < series->count; p++) {
        found |= series->point[p].label[0] != '\0';
    }
    return found;
}

/* Colours that stay apart for the colour blind (Okabe and Ito 2008); dashes and points do it without. */
static void put_series(FILE *stream, const ms_chart_series *series, int index, int look, const char *name)
{
    static const char *const COLOUR[] = {"#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
    static const int POINT[] = {7, 4, 8, 10, 12, 5, 9, 6, 1, 2, 3};
    const char *colour = COLOUR[(size_t)look % (sizeof COLOUR / sizeof *COLOUR)];
    const int type = POINT[(size_t)look % (sizeof POINT / sizeof *POINT)];
    fputs("  ", stream);
    ms_escape_gnuplot_file(stream, name, ".dat");
    if (series->style == MS_CHART_BAND) {
        fprintf(stream,
                " index %d using 1:2:3 with filledcurves fc rgb '%s' fs transparent solid 0.15 noborder notitle", index,
                colour);
        return;
    }
    fprintf(stream, " index %d using 1:2 ", index);
    if (series->style == MS_CHART_FRONT) {
        fputs("with steps lw 6 lc rgb '#bbbbbb'", stream);
    } else if (series->style == MS_CHART_LINE) {
        fputs("with lines lw 4 lc rgb '#999999'", stream);
    } else if (series->style == MS_CHART_POINTS) {
        fprintf(stream, "with points pt %d ps 1.3 lw 2 lc rgb '%s'", type, colour);
    } else {
        fprintf(stream, "with linespoints dt %d pt %d ps 1.3 lw 2 lc rgb '%s'", look % 5 + 1, type, colour);
    }
    fputs(" title ", stream);
    ms_escape_gnuplot(stream, series->name);
    if (has_labels(series)) {
        fputs(", \\\n  ", stream);
        ms_escape_gnuplot_file(stream, name, ".dat");
        fprintf(stream, " index %d using 1:2:3 with labels offset 0,0.8 font small tc rgb '%s' noenhanced notitle",
                index, colour);
    }
}

static void put_axis(FILE *stream, char axis, const char *label, double least, const axis_range *r, int is_log)
{
    char whole[256];
    snprintf(whole, sizeof whole, "%s (%g: that or less)", label, least);
    fprintf(stream, "set %clabel ", axis);
    ms_escape_gnuplot(stream, least > 0 ? whole : label);
    fprintf(stream, " noenhanced\nset %crange [%.9g:%.9g]\n", axis, r->lo, r->hi);
    if (is_log) {
        fprintf(stream, "set logscale %c\nset format %c '%%g'\n", axis, axis);
        if (r->hi / r->lo < 1000) { /* powers of ten alone would be few */
            fprintf(stream, "set %ctics (1e-4", axis);
            for (double tic = 2e-4; tic < 2e4; tic *= 10) {
                fprintf(stream, ", %g, %g, %g", tic, 2.5 * tic, 5 * tic);
            }
            fputs(")\n", stream);
        }
    }
}

static void put_script(FILE *stream, const ms_chart *chart, const char *name, const axis_range *x, const axis_range *y)
{
    int index = 0, look = 0; /* a series looks the same in all charts of a list, with points or without */
    fputs("# Draws ", stream);
    ms_escape_comment(stream, name);
    fputs(".svg and .png from its .dat: gnuplot, here, with the name of this file\nset encoding utf8\nset title ",
          stream);
    ms_escape_gnuplot(stream, chart->title);
    fputs(" noenhanced\nset grid lc rgb '#cccccc' lw 1 dt 1\n"
          "set key outside below height 1 maxcols 3 noenhanced\n",
          stream);
    put_axis(stream, 'x', chart->x_label, 0, x, chart->x_log);
    put_axis(stream, 'y', chart->y_label, is_lifted(chart) ? chart->y_least : 0, y, chart->y_log);
    fputs("small = ',11'\nset terminal svg size 800,600 dynamic font 'DejaVu Sans,13' background rgb 'white'\n"
          "set output ",
          stream);
    ms_escape_gnuplot_file(stream, name, ".svg");
    fputs("\nplot \\\n", stream);
    for (size_t s = 0; s < chart->n_series; s++) {
        if (count_places(chart, &chart->series[s]) > 0) {
            fputs(index ? ", \\\n" : "", stream);
            put_series(stream, &chart->series[s], index++, look, name);
        }
        look += chart->series[s].style == MS_CHART_CURVE || chart->series[s].style == MS_CHART_POINTS;
    }
    fputs("\nsmall = ',15'\n"
          "if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) { set terminal pngcairo size 1200,900 font "
          "'DejaVu Sans,19' }\n"
          "if (strstrt(GPVAL_TERMINALS, 'pngcairo') == 0) { set terminal png size 1200,900 }\n"
          "set output ",
          stream);
    ms_escape_gnuplot_file(stream, name, ".png");
    fputs("\nreplot\n", stream);
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

static const char *name_of(const char *stem)
{
    const char *slash = strrchr(stem, '/');
    return slash ? slash + 1 : stem;
}

ms_status ms_chart_write(const ms_chart *chart, const char *stem, ms_error *err)
{
    axis_range x, y;
    ms_output output;
    if (!find_ranges(&x, &y, chart)) {
        return ms_fail(err, MS_ERR_ARG, "%s: this chart has no points", stem);
    }
    ms_status status = open_file(&output, stem, "dat", err);
    if (status == MS_OK) {
        put_data(output.stream, chart);
        status = ms_output_close(&output, MS_OK, err);
    }
    if (status == MS_OK) {
        status = open_file(&output, stem, "gp", err);
    }
    if (status == MS_OK) {
        put_script(output.stream, chart, name_of(stem), &x, &y);
        status = ms_output_close(&output, MS_OK, err);
    }
    return status;
}

enum { NO_FOLDER = 126, NO_GNUPLOT = 127 };

/* In the child: never returns. */
static void become_gnuplot(const char *stem, char *script)
{
    char program[] = "gnuplot", *words[] = {program, script, NULL};
    const char *name = name_of(stem);
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
    sprintf(script, "./%s.gp", name_of(stem)); /* no flag, however it begins */
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
