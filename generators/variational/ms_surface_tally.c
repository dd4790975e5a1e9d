#include "ms_surface_tally.h"

#include <math.h>
#include <stdlib.h>

#include "ms_exposed.h"

static const double FOUR_PI = 12.566370614359172954;

/* Of a cone of radii from..to within the unit ball, per solid angle. */
static double cone_volume(double from, double to)
{
    return to > from ? (to * to * to - from * from * from) / 3 : 0;
}

/* Where the others begin below the surface takes as long as all else: `losses` is 0 where it is not asked for. */
static ms_surface_worth tally_sphere(const ms_surface_fit *fit, const ms_caps_window *window, ms_exposed *exposed,
                                     uint32_t self, int losses)
{
    const ms_ball *ball = &window->ball[self];
    const double r = ball->radius;
    ms_surface_worth sum = {0};
    if (!(r > 0)) {
        return sum;
    }
    ms_exposed_find(exposed, fit->lattice, window, self, 0, fit->lattice->level[0].points);
    for (int p = 0; p < exposed->count; p++) {
        const double *u = exposed->normal[p];
        const double place[3] = {ball->centre[0] + r * u[0], ball->centre[1] + r * u[1], ball->centre[2] + r * u[2]};
        const double phi = ms_signed_distance_at(fit->field, place);
        sum.mismatch += fabs(phi);
        if (losses) {
            const double begin = 1 - ms_exposed_depth(exposed, u), border = fmax(begin, fmin(1, 1 - phi / r));
            sum.loss += (1 + fit->slant) * cone_volume(begin, border) - (1 - fit->slant) * cone_volume(border, 1);
        }
    }
    const double part = FOUR_PI * r * r / exposed->points;
    return (ms_surface_worth){.loss = part * r * sum.loss, .mismatch = part * sum.mismatch};
}

ms_status ms_surface_tally(ms_surface_worth *each, double *mismatch, const uint8_t *which, const ms_surface_fit *fit,
                           const ms_ball *ball, size_t count, ms_error *err)
{
    const int *across = fit->mirror.across;
    const size_t images = (count << (across[0] + across[1] + across[2])) + 1;
    ms_caps_window window;
    ms_surface_worth *own = each ? NULL : malloc((count + 1) * sizeof *own), *worth = each ? each : own;
    int enough = ms_caps_window_alloc(&window, images) && worth;
    if (enough) {
        window.count = ms_mirror_expand(window.ball, ball, count, &fit->mirror);
        ms_caps_sort(&window);
#pragma omp parallel reduction(&& : enough)
        {
            ms_exposed exposed;
            enough = ms_exposed_alloc(&exposed, fit->lattice, window.count);
#pragma omp for schedule(dynamic, 4)
            for (size_t s = 0; s < count; s++) {
                if (exposed.normal && (!which || which[s])) {
                    worth[s] = tally_sphere(fit, &window, &exposed, (uint32_t)s, each != NULL);
                }
            }
            ms_exposed_free(&exposed);
        }
    }
    double sum = 0;
    for (size_t s = 0; enough && mismatch && s < count; s++) {
        sum += (double)ms_mirror_images(&fit->mirror, &ball[s]) * worth[s].mismatch;
    }
    if (mismatch) {
        *mismatch = sum;
    }
    ms_caps_window_free(&window);
    free(own);
    return enough ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to compare %zu spheres", count);
}
