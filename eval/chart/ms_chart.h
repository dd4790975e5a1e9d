/** Charts, drawn by gnuplot as a program of its own. */
#ifndef MS_CHART_H
#define MS_CHART_H

#include <stddef.h>
#include <stdio.h>

#include "base/ms_error.h"
#include "ms_chart_look.h"

enum { MS_CHART_LABEL = 24 };

typedef struct ms_chart_point {
    double x, y;
    char label[MS_CHART_LABEL]; /* stands beside the point where there is room; "" for none */
    double top;                 /* of a band: it reaches from y to here */
    double low, high;           /* of x: a bar lies from here to there, both above 0; 0: none */
} ms_chart_point;

typedef enum ms_chart_style {
    MS_CHART_CURVE,  /* points joined by a line; line and point types differ from series to series */
    MS_CHART_POINTS, /* points alone */
    MS_CHART_LINE,   /* a grey line without points */
    MS_CHART_LEVEL,  /* a line across the chart at y; x does not count */
    MS_CHART_BAND,   /* pale, in the colour of the next curve and not in the legend */
    MS_CHART_FRONT   /* a broad grey staircase behind the rest: y falls at each x, and holds from there on */
} ms_chart_style;

typedef struct ms_chart_series {
    const char *name; /* in the legend */
    ms_chart_style style;
    size_t count;
    const ms_chart_point *point; /* borrowed */
    ms_chart_look look;
} ms_chart_series;

typedef struct ms_chart {
    const char *title, *x_label, *y_label;
    const char *note; /* below the title, smaller; NULL: none */
    int x_log, y_log;
    double y_least; /* a smaller y is drawn here, and the axis says so: for zeros on a log axis; 0: none */
    size_t n_series;
    const ms_chart_series *series; /* borrowed */
} ms_chart;

/** What ms_chart_write and ms_chart_draw put behind the stem; ends with NULL. */
extern const char *const MS_CHART_ENDINGS[];

/** Series of one chart whose looks are the same by chance get others of the same colour, but those of one name. */
void ms_chart_part_looks(ms_chart_series *series, size_t count);

/**
 * Whether there is anything that a chart shows and a sentence does not: two points, and where curves go by x, a curve
 * of two.
 */
int ms_chart_is_one(const ms_chart *chart);

/** In place of a chart one line: that there is none, and x and y of each point with the name of its series. */
void ms_chart_say(FILE *stream, const ms_chart *chart, const char *stem);

/**
 * Writes STEM.dat and STEM.gp, from which gnuplot makes STEM.svg and STEM.png. A point that has no place (not finite,
 * not above 0 on a log axis) is left out, a series without points stands in neither file.
 *
 * @param stem path without ending; its folder exists
 * @return MS_OK; MS_ERR_ARG if no point is left; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_chart_write(const ms_chart *chart, const char *stem, ms_error *err);

/**
 * Runs gnuplot on STEM.gp, in its folder.
 * @return MS_OK; MS_ERR_IO if gnuplot is not installed, with the name of its package, or fails; the script remains
 */
ms_status ms_chart_draw(const char *stem, ms_error *err);

/**
 * Writes and draws one, and says so. What is no chart (ms_chart_is_one), as a single point, is said in words instead.
 * @return MS_OK; as ms_chart_write and ms_chart_draw
 */
ms_status ms_chart_make(const ms_chart *chart, const char *stem, FILE *words, ms_error *err);

/**
 * The Pareto front: points to which no other is as good in both x and y and better in one; less is better. Of
 * equal points all are on it, points that are not finite never.
 *
 * @param[out] front by ascending x; room for `count` points
 * @return how many
 * Cost: O(count log count).
 */
size_t ms_chart_pareto(ms_chart_point *front, const ms_chart_point *point, size_t count);

#endif
