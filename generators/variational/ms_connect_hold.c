#include "ms_connect_hold.h"

#include <math.h>
#include <stdlib.h>

#include "ms_connect.h"

/* Of fits, of the steps of each, and of growing after them. */
enum { FITS = 8, STEPS = 12, GROWTHS = 10 };

/* By which radii grow beyond what is lacking, voxels. */
static const double BEYOND = 1e-3;

/* How much is apart. */
static ms_status count_ties(size_t *ties, const ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err)
{
    ms_tie *tie;
    const ms_status status = ms_connect_find(&tie, ties, ball, count, &fit->mirror, err);
    free(tie);
    return status;
}

ms_status ms_connect_fit(ms_ball *ball, size_t count, ms_surface_fit *fit, ms_error *err)
{
    static const double DAMPING[2] = {0.5, 0.1};
    size_t ties;
    ms_status status = count_ties(&ties, ball, count, fit, err);
    for (int f = 0; f < FITS && status == MS_OK && ties > 0; f++) {
        status = ms_surface_fit_steps(fit, ball, count, STEPS, DAMPING, err);
        ms_bounds_confine(&fit->bounds, fit->field, ball, count);
        if (status == MS_OK) {
            status = count_ties(&ties, ball, count, fit, err);
        }
    }
    return status;
}

ms_status ms_connect_hold(ms_ball *ball, size_t *count, ms_surface_fit *fit, ms_error *err)
{
    ms_tie *tie = NULL;
    size_t ties = 0;
    ms_status status = ms_connect_find(&tie, &ties, ball, *count, &fit->mirror, err);
    for (int g = 0; g < GROWTHS && status == MS_OK && ties > 0; g++) {
        double largest = 0;
        for (size_t t = 0; t < ties; t++) {
            ball[tie[t].ball].radius += tie[t].away + BEYOND;
        }
        for (size_t b = 0; b < *count; b++) {
            largest = fmax(largest, ball[b].radius);
        }
        for (size_t b = 0; b < *count && fit->bounds.equal; b++) {
            ball[b].radius = largest;
        }
        ms_bounds_confine(&fit->bounds, fit->field, ball, *count);
        free(tie);
        status = ms_connect_find(&tie, &ties, ball, *count, &fit->mirror, err);
    }
    free(tie);
    return status == MS_OK && ties > 0 ? ms_connect_keep_largest(ball, count, err) : status;
}
