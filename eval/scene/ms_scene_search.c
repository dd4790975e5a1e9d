#include "ms_scene_search.h"

#include <math.h>

#include "cli/ms_expectation.h"

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

ms_status ms_scene_search(ms_scene_shape *shape, const ms_input *input, const ms_templates_how *how,
                          const ms_goal *goal, ms_error *err)
{
    const size_t first = expect_number(input, goal, shape->tolerance, shape->templates.most);
    return ms_templates_search(&shape->templates, &shape->chosen, how, goal->measure, shape->tolerance, first, err);
}
