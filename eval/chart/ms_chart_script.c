#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "ms_chart_parts.h"

/* Pixels around the box, so that it is known where in it things stand. */
enum { LEFT = 120, RIGHT = 24, TOP = 44, NOTE = 18, BOTTOM = 68, LEGEND_ROW = 20 };

/* The legend stands below the axis, in as many columns as its names leave room for. */
static int count_legend_rows(const ms_chart *chart)
{
    static const int LETTER = 8, SAMPLE = 70, MOST = 3;
    int entries = 0, longest = 1;
    for (size_t s = 0; s < chart->n_series; s++) {
        if (chart->series[s].style != MS_CHART_BAND && ms_chart_parts_count(chart, &chart->series[s]) > 0) {
            const int length = (int)strlen(chart->series[s].name);
            longest = length > longest ? length : longest;
            entries++;
        }
    }
    const int fit = MS_CHART_WIDTH / (LETTER * longest + SAMPLE), columns = fit < 1 ? 1 : fit > MOST ? MOST : fit;
    return (entries + columns - 1) / columns;
}

static int has_bars(const ms_chart_series *series)
{
    int found = 0;
    for (size_t p = 0; p < series->count; p++) {
        found |= series->point[p].high > 0;
    }
    return found;
}

/* Bars lie behind the points, in their colour. */
static void put_bars(FILE *stream, const ms_chart_series *series, int index, int place, const char *name)
{
    if (has_bars(series)) {
        fputs("  ", stream);
        ms_escape_gnuplot_file(stream, name, ".dat");
        fprintf(stream, " index %d using 1:2:4:5 with xerrorbars pt 0 lw 1.5 lc rgb '%s' notitle, \\\n", index,
                ms_chart_look_colour(series->look, place));
    }
}

static void put_series(FILE *stream, const ms_chart_series *series, int index, int place, const char *name)
{
    const char *colour = ms_chart_look_colour(series->look, place);
    const int type = ms_chart_look_point(series->look, place), dash = ms_chart_look_dash(series->look, place);
    put_bars(stream, series, index, place, name);
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
    } else if (series->style == MS_CHART_LEVEL) {
        fprintf(stream, "with lines dt %d lw 2 lc rgb '%s'", dash, colour);
    } else if (series->style == MS_CHART_POINTS) {
        fprintf(stream, "with points pt %d ps 1.3 lw 2 lc rgb '%s'", type, colour);
    } else {
        fprintf(stream, "with linespoints dt %d pt %d ps 1.3 lw 2 lc rgb '%s'", dash, type, colour);
    }
    fputs(" title ", stream);
    ms_escape_gnuplot(stream, series->name);
}

/* A series without a look goes by its place among those that have points. */
static int count_looks(const ms_chart *chart, size_t before)
{
    int looks = 0;
    for (size_t s = 0; s < before; s++) {
        looks += chart->series[s].style == MS_CHART_CURVE || chart->series[s].style == MS_CHART_POINTS;
    }
    return looks;
}

static void put_plot(FILE *stream, const ms_chart *chart, const char *name)
{
    int index = 0;
    fputs("\nplot \\\n", stream);
    for (size_t s = 0; s < chart->n_series; s++) {
        if (ms_chart_parts_count(chart, &chart->series[s]) > 0) {
            fputs(index ? ", \\\n" : "", stream);
            put_series(stream, &chart->series[s], index++, count_looks(chart, s), name);
        }
    }
}

static void put_axis(FILE *stream, char axis, const char *label, double least, const ms_chart_range *r, int is_log)
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

/* Nonzero if a point is drawn higher than it is. */
static int is_lifted(const ms_chart *chart)
{
    int found = 0;
    for (size_t s = 0; s < chart->n_series; s++) {
        for (size_t p = 0; p < chart->series[s].count; p++) {
            const ms_chart_point *point = &chart->series[s].point[p];
            found |= ms_chart_parts_has_place(chart, &chart->series[s], point) && point->y < chart->y_least;
        }
    }
    return found;
}

/* The box between its margins, and what is in it. */
static void put_frame(FILE *stream, const ms_chart *chart, ms_chart_frame *frame)
{
    const int legend_rows = count_legend_rows(chart);
    const double top = TOP + (chart->note ? NOTE : 0), bottom = BOTTOM + LEGEND_ROW * legend_rows;
    frame->width = MS_CHART_WIDTH - LEFT - RIGHT;
    frame->height = MS_CHART_HEIGHT - top - bottom;
    fprintf(
        stream,
        "set lmargin at screen %.5g\nset rmargin at screen %.5g\nset tmargin at screen %.5g\n"
        "set bmargin at screen %.5g\nset key vertical maxrows %d at screen 0.5,screen 0.01 center bottom noenhanced\n",
        (double)LEFT / MS_CHART_WIDTH, 1 - (double)RIGHT / MS_CHART_WIDTH, 1 - top / MS_CHART_HEIGHT,
        bottom / MS_CHART_HEIGHT, legend_rows);
    put_axis(stream, 'x', chart->x_label, 0, &frame->x, chart->x_log);
    put_axis(stream, 'y', chart->y_label, is_lifted(chart) ? chart->y_least : 0, &frame->y, chart->y_log);
}

static void put_title(FILE *stream, const ms_chart *chart)
{
    fputs("set title ", stream);
    ms_escape_gnuplot(stream, chart->title);
    fprintf(stream, " noenhanced offset 0,%g\nset grid lc rgb '#cccccc' lw 1 dt 1\n", chart->note ? 0.5 : 0);
}

/* Labels in the colours of their points, and the note, numbered so that their size can be changed. */
static ms_status put_labels(size_t *count, FILE *stream, const ms_chart *chart, const ms_chart_frame *frame,
                            ms_error *err)
{
    size_t points = 0;
    for (size_t s = 0; s < chart->n_series; s++) {
        points += chart->series[s].count;
    }
    ms_chart_place *place = malloc((points + 1) * sizeof *place);
    if (!place) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu labels", points);
    }
    *count = ms_chart_labels_place(place, frame, chart);
    for (size_t k = 0; k < *count; k++) {
        const ms_chart_series *series = &chart->series[place[k].series];
        fprintf(stream, "set label %zu ", k + 1);
        ms_escape_gnuplot(stream, place[k].text);
        fprintf(stream, " at graph %.5g,%.5g center font ',11' tc rgb '%s' noenhanced\n", place[k].x, place[k].y,
                ms_chart_look_colour(series->look, count_looks(chart, place[k].series)));
    }
    free(place);
    if (chart->note) {
        fprintf(stream, "set label %zu ", ++*count);
        ms_escape_gnuplot(stream, chart->note);
        fputs(" at graph 0.5,1 center offset 0,0.6 font ',11' noenhanced\n", stream);
    }
    return MS_OK;
}

ms_status ms_chart_script_put(FILE *stream, const ms_chart *chart, const char *name, const ms_chart_range *x,
                              const ms_chart_range *y, ms_error *err)
{
    size_t labels = 0;
    ms_chart_frame frame = {.x = *x, .y = *y};
    fputs("# Draws ", stream);
    ms_escape_comment(stream, name);
    fputs(".svg and .png from its .dat: gnuplot, here, with the name of this file\nset encoding utf8\n", stream);
    put_title(stream, chart);
    put_frame(stream, chart, &frame);
    const ms_status status = put_labels(&labels, stream, chart, &frame, err);
    fprintf(stream,
            "set terminal svg size %d,%d dynamic font 'DejaVu Sans,13' background rgb 'white'\n"
            "set output ",
            MS_CHART_WIDTH, MS_CHART_HEIGHT);
    ms_escape_gnuplot_file(stream, name, ".svg");
    put_plot(stream, chart, name);
    putc('\n', stream);
    for (size_t k = 1; k <= labels; k++) {
        fprintf(stream, "set label %zu font ',15'\n", k);
    }
    fprintf(stream,
            "if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) { set terminal pngcairo size %d,%d font 'DejaVu Sans,19' }\n"
            "if (strstrt(GPVAL_TERMINALS, 'pngcairo') == 0) { set terminal png size %d,%d }\n"
            "set output ",
            MS_CHART_WIDTH * 3 / 2, MS_CHART_HEIGHT * 3 / 2, MS_CHART_WIDTH * 3 / 2, MS_CHART_HEIGHT * 3 / 2);
    ms_escape_gnuplot_file(stream, name, ".png");
    fputs("\nreplot\n", stream);
    return status;
}
