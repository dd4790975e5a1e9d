#include <math.h>
#include <string.h>

#include "cli/ms_json_object.h"
#include "cli/ms_record.h"
#include "cli/ms_report.h"
#include "ms_scene.h"

static void print_goal(FILE *stream, const ms_goal *goal)
{
    if (goal->kind == MS_GOAL_BUDGET) {
        fprintf(stream, "a budget of %.0f spheres\n", goal->value);
    } else if (goal->kind == MS_GOAL_MEAN) {
        fprintf(stream, "a mean D of %g\n", goal->value);
    } else if (goal->kind == MS_GOAL_KNEE) {
        fprintf(stream, "the knee where a sphere takes away less than %g of D\n", goal->value);
    } else if (goal->length > 0) {
        fprintf(stream, "a mean distance of %g between the surfaces of template and particle\n", goal->length);
    } else if (isnan(goal->value)) {
        fprintf(stream, "D as tolerated of each shape\n");
    } else {
        fprintf(stream, "%s of %g of each shape\n", goal->measure->name, goal->value);
    }
}

/* What is there of some scenes alone. */
static void print_more(FILE *stream, const ms_scene *scene, const ms_goal *goal, const ms_scene_shape *shape)
{
    if (scene->has_sizes && !shape) {
        fprintf(stream, " %9s", "size");
    } else if (scene->has_sizes && isnan(shape->row->size)) {
        fprintf(stream, " %9s", "its own");
    } else if (scene->has_sizes) {
        fprintf(stream, " %9.4g", shape->row->size);
    }
    if (goal->length > 0 && !shape) {
        fprintf(stream, " %9s", "distance");
    } else if (goal->length > 0) {
        fprintf(stream, " %9.4g", ms_scene_distance(shape));
    }
    fputc('\n', stream);
}

/* A line for each shape. */
static void print_shapes(FILE *stream, const ms_scene *scene, const ms_goal *goal)
{
    int width = 5;
    for (size_t s = 0; s < scene->count; s++) {
        const int length = (int)strlen(scene->shape[s].row->path);
        width = length > width ? length : width;
    }
    fprintf(stream, "  %-*s %11s %8s %8s %9s %8s %11s %9s", width, "shape", "particles", "spheres", "D", "coverage",
            "inertia", "last sphere", "least r");
    print_more(stream, scene, goal, NULL);
    for (size_t s = 0; s < scene->count; s++) {
        const ms_scene_shape *shape = &scene->shape[s];
        const ms_score *score = ms_scene_score(shape);
        const double gain = ms_scene_gain(shape);
        fprintf(stream, "  %-*s %11llu %8zu %8.5f %9.5f %7.2f%% ", width, shape->row->path,
                (unsigned long long)shape->row->particles, ms_scene_clump(shape)->n_spheres, score->dice,
                score->coverage, 100 * score->inertia);
        if (isnan(gain)) {
            fprintf(stream, "%11s", "-");
        } else {
            fprintf(stream, "%+11.5f", -gain);
        }
        fprintf(stream, " %9.4g", ms_clump_smallest_radius(ms_scene_clump(shape)));
        print_more(stream, scene, goal, shape);
    }
}

/* How well whole numbers follow the curve. */
static void print_sieve(FILE *stream, const ms_sieve *sieve)
{
    fprintf(stream, "  %-26s %9s %11s %8s %8s %10s\n", "sieve curve, by mass", "size", "particles", "asked", "have",
            "deviation");
    for (size_t c = 0; c < sieve->count; c++) {
        const ms_sieve_class *of = &sieve->of[c];
        fprintf(stream, "  %-26s %9.4g %11llu %7.3f%% %7.3f%% %+9.3f%%\n", "", of->size, (unsigned long long)of->count,
                100 * of->share, 100 * of->mass, 100 * (of->mass - of->share));
    }
}

/* Where the best choice is not known to be found. */
static void print_slack(FILE *stream, const ms_allocation *sum, ms_goal_kind kind)
{
    if (kind == MS_GOAL_MEAN && sum->slack > 0) {
        fprintf(stream, "  %-26s no more than %.0f spheres above the fewest\n", "search given up", sum->slack);
    } else if (sum->slack > 0) {
        fprintf(stream, "  %-26s mean D no more than %.2g above the least\n", "search given up", sum->slack);
    }
}

void ms_scene_print_sums(FILE *stream, const ms_scene *scene, const ms_goal *goal)
{
    const ms_allocation *sum = &scene->sum;
    const ms_scene_shape *smallest = ms_scene_smallest(scene);
    fprintf(stream, "  %-26s %llu for %llu particles\n", "spheres in the scene", (unsigned long long)sum->spheres,
            (unsigned long long)sum->particles);
    fprintf(stream, "  %-26s %.5f\n", "mean D", sum->error);
    if (scene->count > 1 && !scene->is_searched) {
        fprintf(stream, "  %-26s %.5f with %.4g for each particle, %llu in all\n", "mean D, spread evenly",
                scene->even.error, scene->even_each, (unsigned long long)scene->even.spheres);
    }
    fprintf(stream, "  %-26s takes %.2g off the sum of D over the particles\n", "least useful sphere",
            scene->least_gain);
    print_slack(stream, sum, goal->kind);
    fprintf(stream, "  %-26s %.4g in %s; by convention it limits the time step\n", "smallest radius",
            ms_clump_smallest_radius(ms_scene_clump(smallest)), ms_manifest_name_row(smallest->row).text);
    if (scene->sieve) {
        print_sieve(stream, scene->sieve);
    }
}

void ms_scene_print(FILE *stream, const ms_scene *scene, const ms_goal *goal)
{
    print_goal(stream, goal);
    print_shapes(stream, scene, goal);
    ms_scene_print_sums(stream, scene, goal);
}

json_t *ms_scene_record_json(const ms_recipe *recipe, size_t max_spheres, double min_radius)
{
    return json_pack("{s:s,s:o,s:I,s:I,s:o}", "generator", recipe->generator->name, "options",
                     ms_record_settings_json(&recipe->settings), "seed", (json_int_t)recipe->seed, "max_spheres",
                     (json_int_t)max_spheres, "min_radius", min_radius > 0 ? json_real(min_radius) : json_null());
}

json_t *ms_scene_scores_json(const ms_scene_shape *shape)
{
    return ms_report_score_json(ms_scene_score(shape), ms_scene_clump(shape)->n_spheres);
}

static json_t *goal_json(const ms_goal *goal)
{
    static const char *const NAMES[] = {[MS_GOAL_BUDGET] = "budget",
                                        [MS_GOAL_MEAN] = "mean_dice",
                                        [MS_GOAL_KNEE] = "knee",
                                        [MS_GOAL_TOLERANCE] = "tolerance"};
    json_t *json = goal->length > 0 ? json_pack("{s:f}", "tolerance_length", goal->length)
                                    : json_pack("{s:o}", NAMES[goal->kind], ms_report_number(goal->value));
    if (goal->kind == MS_GOAL_TOLERANCE) {
        ms_json_object_set(&json, "measure", json_string(goal->measure->name));
    }
    return json;
}

static json_t *shape_json(const ms_scene *scene, const ms_goal *goal, const ms_scene_shape *shape)
{
    json_t *curve = json_array();
    for (size_t n = 0; n < shape->templates.most; n++) {
        ms_json_object_append(&curve, ms_report_number(shape->templates.dice[n]));
    }
    json_t *json = json_pack("{s:I,s:o,s:o,s:f,s:o,s:O,s:o}", "particles", (json_int_t)shape->row->particles,
                             "tolerance", ms_report_number(goal->length > 0 ? shape->tolerance : shape->row->tolerance),
                             "gain", ms_report_number(ms_scene_gain(shape)), "smallest_radius",
                             ms_clump_smallest_radius(ms_scene_clump(shape)), "scores", ms_scene_scores_json(shape),
                             "input", shape->input, "curve", curve);
    if (scene->has_sizes) {
        ms_json_object_set(&json, "size", ms_report_number(shape->row->size));
    }
    if (goal->length > 0) {
        ms_json_object_set(&json, "mean_distance", ms_report_number(ms_scene_distance(shape)));
    }
    return json;
}

static json_t *sieve_json(const ms_sieve *sieve)
{
    json_t *classes = json_array();
    for (size_t c = 0; c < sieve->count; c++) {
        const ms_sieve_class *of = &sieve->of[c];
        ms_json_object_append(&classes, json_pack("{s:f,s:I,s:f,s:f}", "size", of->size, "particles",
                                                  (json_int_t)of->count, "asked", of->share, "have", of->mass));
    }
    return classes;
}

static json_t *smallest_json(const ms_scene *scene)
{
    const ms_scene_shape *smallest = ms_scene_smallest(scene);
    json_t *json = json_pack("{s:f,s:o}", "radius", ms_clump_smallest_radius(ms_scene_clump(smallest)), "shape",
                             ms_report_text(smallest->row->path));
    if (scene->has_sizes) {
        ms_json_object_set(&json, "size", ms_report_number(smallest->row->size));
    }
    return json;
}

void ms_scene_add_json(json_t **json, const ms_scene *scene, const ms_goal *goal)
{
    const ms_allocation *sum = &scene->sum, *even = &scene->even;
    const int together = goal->kind == MS_GOAL_BUDGET || goal->kind == MS_GOAL_MEAN;
    json_t *shapes = json_array();
    for (size_t s = 0; s < scene->count; s++) {
        ms_json_object_append(&shapes, shape_json(scene, goal, &scene->shape[s]));
    }
    ms_json_object_set(json, "goal", goal_json(goal));
    ms_json_object_set(json, "particles", json_integer((json_int_t)sum->particles));
    ms_json_object_set(json, "spheres", json_integer((json_int_t)sum->spheres));
    ms_json_object_set(json, "mean_dice", json_real(sum->error));
    ms_json_object_set(json, "least_gain", json_real(scene->least_gain));
    ms_json_object_set(json, "slack", together ? json_real(sum->slack) : json_null());
    ms_json_object_set(json, "even",
                       scene->is_searched ? json_null()
                                          : json_pack("{s:f,s:I,s:f}", "each", scene->even_each, "spheres",
                                                      (json_int_t)even->spheres, "mean_dice", even->error));
    ms_json_object_set(json, "smallest", smallest_json(scene));
    if (scene->sieve) {
        ms_json_object_set(json, "sieve", sieve_json(scene->sieve));
    }
    ms_json_object_set(json, "shapes", shapes);
}
