#include "ms_pattern_search.h"

#include <math.h>
#include <stdlib.h>

#include "ms_coverage_count.h"
#include "ms_inscribed.h"

/* In voxels. What is counted is voxels, so that steps much finer than one gain little. */
static const double FIRST_STEP = 2, LAST_STEP = 0.1;

/* The sphere after one of 8 moves; 0 if there is none such. */
static int try_move(ms_ball *out, const ms_ball *ball, int which, double step, const ms_surface_fit *fit)
{
    const double by = which % 2 ? -step : step;
    *out = *ball;
    if (which < 6 && ms_mirror_holds(&fit->mirror, ball, which / 2)) {
        return 0;
    }
    if (which < 6) {
        out->centre[which / 2] += by;
    } else if (fit->bounds.equal) {
        return 0;
    } else {
        out->radius += by;
    }
    const double most = ms_bounds_most_radius(&fit->bounds, fit->field, out->centre);
    if (fit->bounds.equal) {
        return out->radius <= most;
    }
    if (most < HUGE_VAL && which < 6) {
        const int was_tight = ball->radius > ms_bounds_most_radius(&fit->bounds, fit->field, ball->centre) - step;
        out->radius = was_tight ? most : out->radius;
    }
    out->radius = fmin(out->radius, most);
    return out->radius >= fit->bounds.least;
}

/* Adds a sphere and its images, or takes them away; returns by how much the mismatch shrinks. */
static int64_t change_images(ms_coverage_count *o, const ms_ball *ball, const ms_mirror *m,
                             void (*by)(ms_coverage_count *, const ms_ball *))
{
    ms_ball image[8];
    const int64_t before = o->mismatch;
    const size_t images = ms_mirror_expand(image, ball, 1, m);
    for (size_t i = 0; i < images; i++) {
        by(o, &image[i]);
    }
    return before - o->mismatch;
}

/* By how much the mismatch would shrink with a sphere and its images. */
static int64_t gain_of(ms_coverage_count *o, const ms_ball *ball, const ms_mirror *m)
{
    if (ms_mirror_images(m, ball) == 1) {
        return ms_coverage_count_gain(o, ball);
    }
    const int64_t gain = change_images(o, ball, m, ms_coverage_count_add);
    change_images(o, ball, m, ms_coverage_count_remove);
    return gain;
}

/* The best move of one sphere; 0 if none is better than to stay. */
static int move_one(ms_ball *ball, ms_coverage_count *o, double step, const ms_surface_fit *fit)
{
    ms_ball best = *ball, tried;
    const int64_t before = -change_images(o, ball, &fit->mirror, ms_coverage_count_remove);
    int64_t most = before;
    for (int which = 0; which < 8; which++) {
        const int64_t gain = try_move(&tried, ball, which, step, fit) ? gain_of(o, &tried, &fit->mirror) : before;
        if (gain > most) {
            most = gain;
            best = tried;
        }
    }
    *ball = best;
    change_images(o, ball, &fit->mirror, ms_coverage_count_add);
    return most > before;
}

ms_status ms_pattern_search(ms_ball *ball, size_t count, const ms_grid *grid, const ms_surface_fit *fit, int rounds,
                            ms_error *err)
{
    ms_coverage_count o;
    double step = FIRST_STEP;
    if (ms_inscribed_applies(fit)) {
        return ms_inscribed_improve(ball, count, fit, err);
    }
    ms_ball *all = malloc((8 * count + 1) * sizeof *all);
    if (!all) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    ms_status status = ms_coverage_count_open(&o, grid, all, ms_mirror_expand(all, ball, count, &fit->mirror), err);
    for (int round = 0; status == MS_OK && round < rounds && step > LAST_STEP; round++) {
        size_t moved = 0;
        for (size_t b = 0; b < count; b++) {
            moved += ball[b].radius > 0 && move_one(&ball[b], &o, step, fit);
        }
        if (10 * moved <= count) {
            step /= 2;
        }
    }
    ms_coverage_count_close(&o);
    free(all);
    return status;
}
