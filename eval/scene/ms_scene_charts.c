#include "ms_scene_charts.h"

#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "chart/ms_chart.h"

enum { NAME_SIZE = 320 };

static const ms_measure *find_measure(const ms_goal *goal)
{
    return goal->kind == MS_GOAL_TOLERANCE ? goal->measure : &ms_measures[MS_MEASURE_DICE];
}

static void name_chart(char name[NAME_SIZE], const ms_manifest_row *row, size_t number, const ms_goal *goal)
{
    size_t length;
    const char *stem = ms_file_stem(&length, row->path);
    snprintf(name, NAME_SIZE, "%zu-%.*s-%s", number, (int)(length < 250 ? length : 250), stem,
             find_measure(goal)->name);
    ms_escape_file_name(name);
}

static ms_chart_point make_point(const ms_scene_shape *shape, size_t n, const ms_measure *measure)
{
    return (ms_chart_point){.x = (double)shape->templates.clump[n - 1].n_spheres,
                            .y = measure->of_score(&shape->templates.score[n - 1])};
}

/* @param point room for all templates */
static ms_status draw_shape(const ms_scene_shape *shape, const ms_goal *goal, const char *stem, ms_chart_point *point,
                            FILE *words, ms_error *err)
{
    char title[NAME_SIZE];
    const ms_measure *measure = find_measure(goal);
    const char *label = measure->axis ? measure->axis : measure->label;
    ms_chart_point chosen = make_point(shape, shape->chosen, measure);
    const ms_chart_point tolerance = {.y = shape->tolerance};
    size_t count = 0;
    for (size_t n = 1; n <= shape->templates.most; n++) {
        if (shape->templates.clump[n - 1].n_spheres > 0) { /* else it was not run */
            point[count++] = make_point(shape, n, measure);
        }
    }
    snprintf(chosen.label, sizeof chosen.label, "%g", chosen.x);
    const ms_chart_series series[] = {{.name = "templates", .style = MS_CHART_CURVE, .count = count, .point = point},
                                      {.name = "chosen", .style = MS_CHART_CURVE, .count = 1, .point = &chosen},
                                      {.name = "tolerance", .style = MS_CHART_LEVEL, .count = 1, .point = &tolerance}};
    snprintf(title, sizeof title, "%.220s: %.60s by number of spheres", ms_manifest_name_row(shape->row).text, label);
    const ms_chart chart = {.title = title,
                            .x_label = "number of spheres",
                            .y_label = label,
                            .x_log = 1,
                            .y_log = measure->better == MS_BETTER_LESS,
                            .y_least = measure->better == MS_BETTER_LESS ? 1e-6 : 0,
                            .n_series = goal->kind == MS_GOAL_TOLERANCE ? 3 : 2,
                            .series = series};
    return ms_chart_make(&chart, stem, words, err);
}

/* Those of a run before. */
static ms_status remove_charts(const ms_scene *scene, const ms_goal *goal, const char *folder, ms_error *err)
{
    ms_files files = {0};
    ms_status status = ms_files_make_folder(folder, err);
    for (size_t s = 0; s < scene->count && status == MS_OK; s++) {
        status = ms_scene_charts_list(&files, folder, scene->shape[s].row, s + 1, goal, err);
    }
    return ms_files_remove(&files, status, err);
}

ms_status ms_scene_charts_draw(const ms_scene *scene, const ms_goal *goal, const char *folder, FILE *words,
                               ms_error *err)
{
    char name[NAME_SIZE];
    const size_t room = strlen(folder) + NAME_SIZE + 2;
    char *stem = malloc(room);
    ms_chart_point *point = malloc(MS_SCENE_MAX_SPHERES * sizeof *point);
    ms_status status = stem && point ? remove_charts(scene, goal, folder, err)
                                     : ms_fail(err, MS_ERR_NOMEM, "no memory for charts of %zu shapes", scene->count);
    const size_t count = status == MS_OK ? scene->count : 0;
    for (size_t s = 0; s < count; s++) {
        ms_error why;
        name_chart(name, scene->shape[s].row, s + 1, goal);
        snprintf(stem, room, "%s/%s", folder, name);
        const ms_status drawn = draw_shape(&scene->shape[s], goal, stem, point, words, &why);
        if (status == MS_OK && drawn != MS_OK) {
            status = drawn;
            ms_fail(err, drawn, "%s", why.text);
        }
    }
    free(stem);
    free(point);
    return status;
}

ms_status ms_scene_charts_list(ms_files *files, const char *folder, const ms_manifest_row *row, size_t number,
                               const ms_goal *goal, ms_error *err)
{
    char name[NAME_SIZE];
    name_chart(name, row, number, goal);
    return ms_files_add_charts(files, folder, name, MS_CHART_ENDINGS, err);
}
