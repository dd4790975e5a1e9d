#include "ms_scene_search.h"

#include <math.h>

#include "cli/ms_expectation.h"
#include "clump/ms_equal_volume.h"

typedef struct scene_search {
    ms_scene_shape *shape;
    const ms_goal *goal;
    const ms_generator *generator;
    ms_run run;
    size_t max_voxels;
    int equal_volume;
} scene_search;

/* The template of n spheres. */
static ms_status run_number(scene_search *s, size_t n, ms_error *err)
{
    ms_scene_shape *shape = s->shape;
    ms_metrics metrics;
    ms_stop_reason reason;
    ms_equal_volume ignored;
    s->run.stop.spheres = n;
    ms_generator_keep_remarks(&s->run, &shape->remarks[n - 1]);
    ms_status status = ms_generator_run(&shape->clump[n - 1], &reason, s->generator, &s->run, err);
    if (status == MS_OK && s->equal_volume) {
        status = ms_equal_volume_scale(&shape->clump[n - 1], &ignored, &s->run.target->body, err);
    }
    if (status == MS_OK) {
        status = ms_metrics_compute_kinds(&metrics, NULL, 0, s->run.target, &shape->clump[n - 1], s->max_voxels, err);
    }
    if (status == MS_OK) {
        shape->score[n - 1] = metrics.score;
        shape->dice[n - 1] = metrics.score.dice;
    }
    return status;
}

/* Another size may have run it. @param[out] reached does it reach the tolerance? */
static ms_status try_number(int *reached, scene_search *s, size_t n, ms_error *err)
{
    const ms_status status = s->shape->clump[n - 1].n_spheres > 0 ? MS_OK : run_number(s, n, err);
    if (status == MS_OK) {
        const double have = s->goal->measure->of_score(&s->shape->score[n - 1]);
        *reached = ms_measure_is_reached(s->goal->measure, have, s->shape->tolerance);
    }
    return status;
}

/* Numbers of which the lower one does not reach the tolerance (0: none is known) and the higher one does, in steps of a
 * fifth from the one that is expected. */
static ms_status bracket_number(size_t *lo, size_t *hi, scene_search *s, size_t first, ms_error *err)
{
    size_t n = first;
    int reached = 0;
    *lo = *hi = 0;
    ms_status status = try_number(&reached, s, n, err);
    const int begins_above = reached;
    while (status == MS_OK && reached == begins_above) {
        *(reached ? hi : lo) = n;
        if (reached ? n == 1 : n == s->shape->most) {
            break;
        }
        const size_t step = 1 + n / 5;
        n = !reached ? n + step : n > step ? n - step : 1;
        n = n < s->shape->most ? n : s->shape->most;
        status = try_number(&reached, s, n, err);
    }
    *(reached ? hi : lo) = n;
    *lo = reached && n == 1 ? 0 : *lo;
    return status;
}

/* Where each number is a run of its own, few are run: those from the expected one on that enclose the tolerance, and
 * halves of what lies between. */
static ms_status search_number(ms_scene_shape *shape, scene_search *s, size_t expected, ms_error *err)
{
    size_t lo, hi;
    const size_t first = expected < 1 ? 1 : expected < shape->most ? expected : shape->most;
    ms_status status = bracket_number(&lo, &hi, s, first, err);
    while (status == MS_OK && hi > 0 && hi - lo > 1) { /* without one that reaches it, choose_alone says so */
        int reached;
        const size_t middle = lo + (hi - lo) / 2;
        status = try_number(&reached, s, middle, err);
        *(status == MS_OK && reached ? &hi : &lo) = middle;
    }
    shape->chosen = hi;
    return status;
}

/* The number of spheres that the tolerance is expected to take; where nothing is expected, a quarter of the most. */
static size_t expect_number(const ms_input *input, const ms_goal *goal, double value, size_t most)
{
    ms_expect expect;
    ms_error ignored;
    double n = (double)most / 4;
    if (goal->measure == &ms_measures[MS_MEASURE_DICE] && value > 0 &&
        ms_expectation_find(&expect, input, &ignored) == MS_OK) {
        n = ceil(ms_expect_spheres(&expect, MS_EXPECT_FREE, value));
    }
    return n < (double)most ? (size_t)n : most;
}

ms_status ms_scene_search(ms_scene_shape *shape, const ms_input *input, const ms_run *run, const ms_scene_run *how,
                          const ms_goal *goal, ms_error *err)
{
    scene_search s = {.shape = shape,
                      .goal = goal,
                      .generator = how->recipe->generator,
                      .run = *run,
                      .max_voxels = ms_input_max_voxels(how->input),
                      .equal_volume = how->recipe->equal_volume};
    return search_number(shape, &s, expect_number(input, goal, shape->tolerance, shape->most), err);
}
