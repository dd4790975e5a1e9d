#include "ms_scene_choose.h"

#include <math.h>
#include <stdlib.h>

/* `each` spheres for every particle, or as many as the largest template of its shape has. */
static ms_allocation sum_even(const ms_scene *scene, const ms_share *share, size_t *n, size_t each)
{
    for (size_t s = 0; s < scene->count; s++) {
        n[s] = each < share[s].most ? each : share[s].most;
    }
    return ms_allocate_sum(share, n, scene->count);
}

/* As many spheres as the templates chosen take, the same number for every particle; what does not go into that is one
 * more for the same part of the particles of each shape, so that the mean D is between those of both numbers. */
static void spread_evenly(ms_scene *scene, const ms_share *share, size_t *n)
{
    const uint64_t spheres = scene->sum.spheres;
    size_t each = 1;
    ms_allocation few = sum_even(scene, share, n, each), more = sum_even(scene, share, n, each + 1);
    while (more.spheres <= spheres && more.spheres > few.spheres) {
        each++;
        few = more;
        more = sum_even(scene, share, n, each + 1);
    }
    const uint64_t step = more.spheres - few.spheres;
    const double part = step > 0 ? (double)(spheres - few.spheres) / (double)step : 0;
    scene->even = few;
    scene->even.spheres = step > 0 ? spheres : few.spheres;
    scene->even.error += part * (more.error - few.error);
    scene->even_each = (double)each + part;
}

/* Of a search, which knows one template smaller than the one chosen of each shape. */
static double least_gain_of(const ms_scene *scene)
{
    double least = (double)NAN;
    for (size_t s = 0; s < scene->count; s++) {
        least = fmin(least, ms_scene_gain(&scene->shape[s]));
    }
    return isnan(least) ? 0 : least;
}

static ms_status choose_together(ms_scene *scene, const ms_share *share, size_t *n, const ms_goal *goal, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; s < scene->count; s++) {
        n[s] = scene->shape[s].chosen;
    }
    if (goal->kind == MS_GOAL_BUDGET) {
        status = ms_allocate_budget(n, &scene->sum, share, scene->count, (uint64_t)goal->value, err);
    } else if (goal->kind == MS_GOAL_MEAN) {
        status = ms_allocate_error(n, &scene->sum, share, scene->count, goal->value, err);
    } else {
        scene->sum = ms_allocate_sum(share, n, scene->count);
    }
    for (size_t s = 0; s < scene->count; s++) {
        scene->shape[s].chosen = n[s];
    }
    return status;
}

/* The template chosen of each row in its size. */
static ms_status size_templates(ms_scene *scene, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; s < scene->count && status == MS_OK; s++) {
        ms_scene_shape *shape = &scene->shape[s];
        status = ms_clump_scale(&shape->sized, &shape->templates.clump[shape->chosen - 1], shape->factor, err);
    }
    return status;
}

ms_status ms_scene_choose(ms_scene *scene, const ms_goal *goal, ms_error *err)
{
    size_t *n = malloc(scene->count * sizeof *n);
    ms_share *share = malloc(scene->count * sizeof *share);
    ms_status status = n && share ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu shapes", scene->count);
    for (size_t s = 0; s < scene->count && status == MS_OK; s++) {
        share[s] = ms_scene_share(&scene->shape[s]);
    }
    if (status == MS_OK) {
        status = choose_together(scene, share, n, goal, err);
    }
    if (status == MS_OK) {
        status = size_templates(scene, err);
    }
    if (status == MS_OK) {
        scene->sum.spheres = 0; /* a clump may have fewer than were asked for */
        for (size_t s = 0; s < scene->count; s++) {
            scene->sum.spheres += share[s].particles * ms_scene_clump(&scene->shape[s])->n_spheres;
        }
        if (scene->is_searched) {
            scene->least_gain = least_gain_of(scene);
        } else {
            scene->least_gain = ms_allocate_gain(share, n, scene->count);
            spread_evenly(scene, share, n);
        }
    }
    free(n);
    free(share);
    return status;
}
