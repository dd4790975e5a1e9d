#include "ms_library_charts.h"

#include <stdlib.h>
#include <string.h>

#include "chart/ms_chart.h"

static int compare_points(const void *a, const void *b)
{
    const double x = ((const ms_chart_point *)a)->x, y = ((const ms_chart_point *)b)->x;
    return (x > y) - (x < y);
}

/* The share of grains of at most each value, as a staircase: y in, not summed yet; room for twice as many. */
static size_t make_stairs(ms_chart_point *point, size_t count)
{
    double all = 0, sum = 0;
    qsort(point, count, sizeof *point, compare_points);
    for (size_t i = 0; i < count; i++) {
        all += point[i].y;
    }
    memmove(point + count, point, count * sizeof *point);
    for (size_t i = 0; i < count; i++) {
        const ms_chart_point step = point[count + i];
        point[2 * i] = (ms_chart_point){.x = step.x, .y = sum / all};
        sum += step.y;
        point[2 * i + 1] = (ms_chart_point){.x = step.x, .y = sum / all};
    }
    return 2 * count;
}

static void write_stem(char *out, size_t size, const char *folder, int descriptor)
{
    snprintf(out, size, "%s/distribution-%s", folder, ms_library_descriptors[descriptor]);
}

static ms_status write_chart(const ms_library *l, int d, const char *folder, ms_chart_point *all, ms_chart_point *few,
                             ms_error *err)
{
    char stem[4096];
    const ms_library_table *table = l->table;
    for (size_t i = 0; i < table->count; i++) {
        const double size = table->grain[i].shape[MS_LIBRARY_SIZE];
        all[i] = (ms_chart_point){.x = table->grain[i].shape[d], .y = l->goal.by_mass ? size * size * size : 1};
    }
    for (size_t j = 0; j < l->choice.k; j++) {
        few[j] = (ms_chart_point){.x = table->grain[l->choice.grain[j]].shape[d], .y = l->choice.weight[j]};
    }
    const ms_chart_series series[] = {
        {.name = "all grains", .style = MS_CHART_LINE, .count = make_stairs(all, table->count), .point = all},
        {.name = "library", .style = MS_CHART_CURVE, .count = make_stairs(few, l->choice.k), .point = few}};
    const ms_chart chart = {.title = "",
                            .x_label = ms_library_descriptors[d],
                            .y_label = l->goal.by_mass ? "share of the mass" : "share of the grains",
                            .n_series = 2,
                            .series = series};
    write_stem(stem, sizeof stem, folder, d);
    return ms_chart_write(&chart, stem, err);
}

ms_status ms_library_charts_write(const ms_library *l, const char *folder, ms_error *err)
{
    ms_chart_point *all = malloc(2 * l->table->count * sizeof *all), *few = malloc(2 * l->choice.k * sizeof *few);
    ms_status status = all && few ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for charts of a library");
    for (int d = l->first; d < MS_LIBRARY_DESCRIPTORS && status == MS_OK; d++) {
        status = write_chart(l, d, folder, all, few, err);
    }
    free(all);
    free(few);
    return status;
}

ms_status ms_library_charts_draw(const ms_library *l, const char *folder, ms_error *err)
{
    char stem[4096];
    ms_status status = MS_OK;
    for (int d = l->first; d < MS_LIBRARY_DESCRIPTORS && status == MS_OK; d++) {
        write_stem(stem, sizeof stem, folder, d);
        status = ms_chart_draw(stem, err);
    }
    return status;
}
