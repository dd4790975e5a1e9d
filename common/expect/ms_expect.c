#include "ms_expect.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/ms_inertia.h"
#include "ms_expect_points.h"
#include "ms_expect_price.h"
#include "ms_expect_surface.h"

/* Parts of the body that are lost: a thin wall is hopeless; nothing to speak of. */
static const double GIVEN_UP = 0.1, WHOLE = 0.02;
static const double MOST_SPHERES = 1e9;

/* closest: of the mesh, or NULL. spheres: a number about which alone the curve of free spheres is wanted; 0: all. */
static ms_status compute(ms_expect *expect, const ms_mesh *mesh, const ms_closest *closest, double spheres,
                         ms_error *err)
{
    ms_body body;
    *expect = (ms_expect){0};
    ms_status status = ms_inertia_mesh(&body, mesh, err);
    if (status != MS_OK) {
        return status;
    }
    ms_expect_points *points = malloc(sizeof *points);
    if (!points) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %d points of the surface", MS_EXPECT_POINTS);
    }
    status = ms_expect_points_spread(points, spheres > 0 ? ms_expect_price_step(spheres) : 1, mesh, err);
    if (status == MS_OK) {
        status = ms_expect_points_inscribe(points, mesh, closest, err);
    }
    if (status == MS_OK) {
        status = spheres > 0 ? ms_expect_price_near(&expect->curve[MS_EXPECT_FREE], points, body.volume, spheres, err)
                             : ms_expect_price_curves(expect, points, body.volume, err);
    }
    if (status != MS_OK) {
        *expect = (ms_expect){0};
    }
    free(points);
    return status;
}

static ms_status compute_grid(ms_expect *expect, const ms_grid *grid, double spheres, ms_error *err)
{
    ms_mesh mesh;
    *expect = (ms_expect){0};
    ms_status status = ms_expect_surface(&mesh, grid, err);
    if (status == MS_OK) {
        status = compute(expect, &mesh, NULL, spheres, err);
        ms_mesh_free(&mesh);
    }
    return status;
}

ms_status ms_expect_mesh(ms_expect *expect, const ms_mesh *mesh, ms_error *err)
{
    return compute(expect, mesh, NULL, 0, err);
}

ms_status ms_expect_grid(ms_expect *expect, const ms_grid *grid, ms_error *err)
{
    return compute_grid(expect, grid, 0, err);
}

ms_status ms_expect_near(ms_expect *expect, const ms_target *target, double spheres, ms_error *err)
{
    return target->mesh ? compute(expect, target->mesh, target->closest, spheres, err)
                        : compute_grid(expect, &target->grid, spheres, err);
}

/* |S xor U| / (|S| + |U|): what the union lacks is what is lost, since the rest is as much outside as inside. */
static double dice_of(const ms_expect_pair *pair)
{
    return pair->error / (2 - pair->lost);
}

/* Between a pair and the next one, both sums are in proportion: some spheres as of the one, some as of the other. */
static ms_expect_pair blend(const ms_expect_pair *a, double spheres)
{
    const ms_expect_pair *b = a + 1;
    const double part = (spheres - a->spheres) / (b->spheres - a->spheres);
    return (ms_expect_pair){spheres, a->error + part * (b->error - a->error), a->lost + part * (b->lost - a->lost)};
}

/* By how much ln D falls with ln n over the last quarter of the numbers computed, or that part of it where next to
 * nothing is lost; where that is too short to tell, as for a thin wall, that of a sheet. */
static double last_slope(const ms_expect_curve *curve)
{
    static const double OF_SHEET = 1, SHORT = 1.5;
    const ms_expect_pair *last = &curve->pair[curve->count - 1], *before = last;
    while (before > curve->pair && before[-1].lost < WHOLE && 4 * before->spheres > last->spheres) {
        before--;
    }
    return before->spheres * SHORT < last->spheres && dice_of(last) > 0
               ? log(dice_of(before) / dice_of(last)) / log(last->spheres / before->spheres)
               : OF_SHEET;
}

double ms_expect_dice(const ms_expect *expect, ms_expect_kind kind, double spheres)
{
    const ms_expect_curve *curve = &expect->curve[kind];
    for (int i = 0; i + 1 < curve->count; i++) {
        if (curve->pair[i + 1].spheres >= spheres) {
            const ms_expect_pair pair = blend(&curve->pair[i], spheres);
            return dice_of(&pair);
        }
    }
    const ms_expect_pair *last = &curve->pair[curve->count - 1];
    return dice_of(last) * pow(last->spheres / spheres, last_slope(curve));
}

double ms_expect_spheres(const ms_expect *expect, ms_expect_kind kind, double dice)
{
    enum { HALVINGS = 60 };
    double lo = 1, hi = MOST_SPHERES;
    if (ms_expect_dice(expect, kind, hi) > dice) {
        return HUGE_VAL;
    }
    for (int i = 0; i < HALVINGS && ms_expect_dice(expect, kind, lo) > dice; i++) {
        const double middle = sqrt(lo * hi);
        *(ms_expect_dice(expect, kind, middle) > dice ? &lo : &hi) = middle;
    }
    return ms_expect_dice(expect, kind, 1) <= dice ? 1 : hi;
}

double ms_expect_least_spheres(const ms_expect *expect, ms_expect_kind kind)
{
    const ms_expect_curve *curve = &expect->curve[kind];
    for (int i = 0; i + 1 < curve->count; i++) {
        const ms_expect_pair *a = &curve->pair[i], *b = a + 1;
        if (b->lost <= GIVEN_UP) {
            const double part = (a->lost - GIVEN_UP) / (a->lost - b->lost);
            return fmax(1, a->spheres + part * (b->spheres - a->spheres));
        }
    }
    return curve->pair[curve->count - 1].spheres;
}

double ms_expect_round(double spheres)
{
    const double unit = pow(10, fmax(0, floor(log10(spheres)) - 2));
    return isfinite(spheres) ? ceil(spheres / unit - 1e-9) * unit : spheres;
}
