/** Private to the charts: where things stand on one. */
#ifndef MS_CHART_PARTS_H
#define MS_CHART_PARTS_H

#include <stdio.h>

#include "ms_chart.h"

/** The picture as SVG, pixels; PNG is half as large again. */
enum { MS_CHART_WIDTH = 800, MS_CHART_HEIGHT = 600 };

/** What an axis spans: a little more than its values. */
typedef struct ms_chart_range {
    double lo, hi;
} ms_chart_range;

/** The axes and the box between them, pixels. */
typedef struct ms_chart_frame {
    ms_chart_range x, y;
    double width, height;
} ms_chart_frame;

/** A label that has found room: of which series, its text, and its middle as parts of the box, upwards. */
typedef struct ms_chart_place {
    size_t series;
    const char *text; /* borrowed */
    double x, y;
} ms_chart_place;

/** A y, or the least that is drawn. */
double ms_chart_parts_lift(const ms_chart *chart, double y);

/** Where a point is drawn: its y, or the least that is drawn. */
double ms_chart_parts_height(const ms_chart *chart, const ms_chart_point *point);

/** Zero for a point that is not finite, or not above 0 on a log axis. */
int ms_chart_parts_has_place(const ms_chart *chart, const ms_chart_series *series, const ms_chart_point *point);

/** How many points of a series have a place. */
size_t ms_chart_parts_count(const ms_chart *chart, const ms_chart_series *series);

/**
 * Puts each label of a point beside it, where it lies on no point, line, bar or other label. One that finds no such
 * place is left out.
 *
 * @param[out] place room for as many as the chart has points
 * @return how many
 * Cost: labels x (points + labels).
 */
size_t ms_chart_labels_place(ms_chart_place *place, const ms_chart_frame *frame, const ms_chart *chart);

/** The script of gnuplot. @param name of the files, without folder and ending */
ms_status ms_chart_script_put(FILE *stream, const ms_chart *chart, const char *name, const ms_chart_range *x,
                              const ms_chart_range *y, ms_error *err);

#endif
