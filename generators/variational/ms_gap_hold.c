#include "ms_gap_hold.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

/* Of fits with places added, of the steps of each, and of growing after them. */
enum { FITS = 8, STEPS = 12, GROWTHS = 30 };

/* By which radii grow beyond what is left, so that it is not approached for ever; voxels. */
static const double BEYOND = 1e-3;

/* All that is too far, of a sphere and its images: of each the farthest place. */
typedef struct shortfall {
    size_t count;
    ms_ball *all;
    ms_gap_far *far;
    double largest;
} shortfall;

static ms_status find_excess(shortfall *e, const ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err)
{
    e->count = ms_mirror_expand(e->all, ball, count, &fit->mirror);
    return ms_gap_largest(&e->largest, e->far, fit->field->target, e->all, e->count, fit->gap->bound, err);
}

static int is_held(const shortfall *e, const ms_gap *gap)
{
    return !(e->largest > gap->bound);
}

static ms_status fit_to_excess(const shortfall *e, ms_ball *ball, size_t count, ms_surface_fit *fit, ms_error *err)
{
    static const double DAMPING[2] = {0.5, 0.1};
    ms_gap *gap = fit->gap;
    ms_status status = MS_OK;
    for (size_t b = 0; b < e->count && status == MS_OK; b++) {
        if (e->far[b].away > 0) {
            status = ms_gap_add(gap, e->far[b].place, &fit->mirror, err);
        }
    }
    gap->aim -= 0.5 * fmin(e->largest - gap->bound, 1);
    if (status == MS_OK) {
        status = ms_surface_fit_steps(fit, ball, count, STEPS, DAMPING, err);
    }
    ms_bounds_confine(&fit->bounds, fit->field, ball, count);
    return status;
}

/* The nearest sphere above the planes of symmetry, where it is nearer than its images. */
static size_t find_nearest_above(const ms_ball *ball, size_t count, const double place[3], const ms_mirror *m)
{
    ms_ball at = {.centre = {place[0], place[1], place[2]}};
    double least = HUGE_VAL;
    size_t nearest = 0;
    ms_mirror_fold(&at, m, 0);
    for (size_t b = 0; b < count; b++) {
        const double away = sqrt(ms_squared_distance(at.centre, ball[b].centre)) - ball[b].radius;
        if (away < least) {
            least = away;
            nearest = b;
        }
    }
    return nearest;
}

static void grow_nearest(const shortfall *e, ms_ball *ball, size_t count, const ms_surface_fit *fit)
{
    for (size_t i = 0; i < e->count; i++) {
        if (e->far[i].away > 0) {
            ms_ball *one = &ball[find_nearest_above(ball, count, e->far[i].place, &fit->mirror)];
            const double needed = sqrt(ms_squared_distance(e->all[i].centre, e->far[i].place)) - fit->gap->bound;
            one->radius = fmax(one->radius, needed + BEYOND);
        }
    }
    for (size_t b = 0; b < count && fit->bounds.equal; b++) {
        for (size_t o = 0; o < count; o++) {
            ball[b].radius = fmax(ball[b].radius, ball[o].radius);
        }
    }
    ms_bounds_confine(&fit->bounds, fit->field, ball, count);
}

ms_status ms_gap_hold(ms_ball *ball, size_t count, ms_surface_fit *fit, ms_error *err)
{
    shortfall e = {.all = malloc((8 * count + 1) * sizeof *e.all), .far = malloc((8 * count + 1) * sizeof *e.far)};
    ms_status status = e.all && e.far ? find_excess(&e, ball, count, fit, err)
                                      : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    for (int f = 0; f < FITS && status == MS_OK && !is_held(&e, fit->gap); f++) {
        status = fit_to_excess(&e, ball, count, fit, err);
        if (status == MS_OK) {
            status = find_excess(&e, ball, count, fit, err);
        }
    }
    for (int g = 0; g < GROWTHS && status == MS_OK && !is_held(&e, fit->gap); g++) {
        grow_nearest(&e, ball, count, fit);
        status = find_excess(&e, ball, count, fit, err);
    }
    fit->gap->aim = fit->gap->bound;
    free(e.all);
    free(e.far);
    return status;
}
