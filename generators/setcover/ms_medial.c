#include "ms_medial.h"

#include <math.h>
#include <string.h>

#include "base/ms_vector.h"

/* The distance counts as rising above this slope: cosine of 26 degrees. */
static const double RISING = 0.9;

enum { MAX_STEPS = 16, MAX_STRIDES = 100 };

/* A place on the way: start + s u. */
typedef struct touching_place {
    double s;
    double centre[3], nearest[3];
    double radius; /* distance to the nearest point of the mesh */
    double slope;  /* of the radius along u */
} touching_place;

/* Looks at start + s u, u pointing away from start.nearest, which is no farther from there than
 * start.radius + s: that bound spares most of the search. */
static touching_place look_along(const ms_closest *closest, const touching_place *start, const double u[3], double s)
{
    touching_place at = *start;
    at.s = s;
    for (int a = 0; a < 3; a++) {
        at.centre[a] = start->centre[a] + s * u[a];
    }
    at.radius = ms_closest_distance(at.nearest, closest, at.centre, start->radius + s);
    at.slope = 0;
    for (int a = 0; a < 3 && at.radius > 0; a++) {
        at.slope += (at.centre[a] - at.nearest[a]) / at.radius * u[a];
    }
    return at;
}

/* Where the radius ceases to rise, between a place where it does and one where it does not:
 * the lines through both meet there, if no third face is nearer. */
static touching_place find_ridge(touching_place rising, touching_place falling, const ms_closest *closest,
                                 const touching_place *start, const double u[3], double tolerance)
{
    for (int step = 0; step < MAX_STEPS && falling.s - rising.s > tolerance; step++) {
        const double s = (falling.radius - falling.slope * falling.s - rising.radius + rising.slope * rising.s) /
                         (rising.slope - falling.slope);
        if (!(s > rising.s && s < falling.s)) {
            break;
        }
        const touching_place at = look_along(closest, start, u, s);
        if (rising.radius + rising.slope * (s - rising.s) - at.radius < tolerance) {
            return at;
        }
        *(at.slope > RISING ? &rising : &falling) = at;
    }
    return rising;
}

double ms_medial_sphere(double centre[3], double radius, const double nearest[3], const ms_closest *closest,
                        double stride, double tolerance)
{
    touching_place here = {.radius = radius, .slope = 1};
    memcpy(here.centre, centre, sizeof here.centre);
    memcpy(here.nearest, nearest, sizeof here.nearest);
    for (int step = 0; step < MAX_STRIDES && here.radius > 0; step++, stride *= 2) {
        double u[3];
        for (int a = 0; a < 3; a++) {
            u[a] = (here.centre[a] - here.nearest[a]) / here.radius;
        }
        here.s = 0;
        here.slope = 1;
        /* No stride leaves the sphere, so that none leaves the mesh. */
        const touching_place end = look_along(closest, &here, u, fmin(stride, here.radius));
        if (!(end.slope > RISING)) {
            here = find_ridge(here, end, closest, &here, u, tolerance);
            break;
        }
        here = end;
    }
    memcpy(centre, here.centre, sizeof here.centre);
    return here.radius;
}
