#include "ms_chart_parts.h"

#include <math.h>

double ms_chart_parts_lift(const ms_chart *chart, double y)
{
    return y < chart->y_least ? chart->y_least : y;
}

double ms_chart_parts_height(const ms_chart *chart, const ms_chart_point *point)
{
    return ms_chart_parts_lift(chart, point->y);
}

int ms_chart_parts_has_place(const ms_chart *chart, const ms_chart_series *series, const ms_chart_point *point)
{
    const double x = point->x, y = ms_chart_parts_lift(chart, point->y);
    const int has_x = series->style == MS_CHART_LEVEL || (isfinite(x) && (!chart->x_log || x > 0));
    return has_x && isfinite(y) && (!chart->y_log || y > 0);
}

size_t ms_chart_parts_count(const ms_chart *chart, const ms_chart_series *series)
{
    size_t count = 0;
    for (size_t p = 0; p < series->count; p++) {
        count += ms_chart_parts_has_place(chart, series, &series->point[p]);
    }
    return count;
}
