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

/* Does the radius still rise at the end of a stride, and does the sphere there overlap the one at its start, so that
 * both lie on one side of all faces? */
static int goes_on(const touching_place *start, const touching_place *end)
{
    return end->slope > RISING && end->radius + start->radius > end->s;
}

/* Where on the way the sphere that touches start.nearest has grown to another place of the mesh; NaN if never. */
static double find_touch(const touching_place *start, const double u[3], const double other[3])
{
    const double to[3] = {other[0] - start->centre[0], other[1] - start->centre[1], other[2] - start->centre[2]};
    const double ahead = start->radius + ms_dot(u, to);
    return ahead > 0 ? (ms_dot(to, to) - start->radius * start->radius) / (2 * ahead) : (double)NAN;
}

/* From `end`, where the sphere that touches start.nearest would hold a face, it shrinks to the face that is nearest
 * there, until it holds none. @return nonzero if it did not come to that, since it goes on from where it is */
static int shrink_sphere(touching_place *end, const ms_closest *closest, const touching_place *start, const double u[3],
                         double tolerance)
{
    const double close = fmin(tolerance, start->radius); /* so that the sphere holds start.centre */
    for (int step = 0; step < MAX_STEPS; step++) {
        const double s = find_touch(start, u, end->nearest);
        if (!(s > 0 && s < end->s)) {
            break;
        }
        *end = look_along(closest, start, u, s);
        if (start->radius + s - end->radius < close) {
            return 0;
        }
        if (goes_on(start, end)) {
            return 1;
        }
    }
    *end = *start;
    return 0;
}

double ms_medial_sphere(double centre[3], double radius, const double nearest[3], const ms_closest *closest,
                        double stride, double tolerance)
{
    touching_place here = {.radius = radius};
    int on = radius > 0;
    memcpy(here.centre, centre, sizeof here.centre);
    memcpy(here.nearest, nearest, sizeof here.nearest);
    for (int step = 0; step < MAX_STRIDES && on; step++) {
        double u[3];
        for (int a = 0; a < 3; a++) {
            u[a] = (here.centre[a] - here.nearest[a]) / here.radius;
        }
        here.s = 0;
        touching_place end = look_along(closest, &here, u, stride);
        if (goes_on(&here, &end)) {
            stride *= 2;
        } else {
            const double beyond = end.s;
            on = shrink_sphere(&end, closest, &here, u, tolerance);
            stride = beyond - end.s;
        }
        here = end;
    }
    memcpy(centre, here.centre, sizeof here.centre);
    return here.radius;
}
