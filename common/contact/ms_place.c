#include "ms_place.h"

#include <math.h>
#include <string.h>

#include "base/ms_quaternion.h"

static const double PI = 3.14159265358979323846;

static void draw_direction(double u[3], gsl_rng *random)
{
    const double z = 2 * gsl_rng_uniform(random) - 1, angle = 2 * PI * gsl_rng_uniform(random);
    const double across = sqrt(1 - z * z);
    u[0] = across * cos(angle);
    u[1] = across * sin(angle);
    u[2] = z;
}

/* Shoemake, Uniform random rotations, Graphics Gems III (1992) 124. */
ms_touch_place ms_place_anywhere(gsl_rng *random)
{
    ms_touch_place place = {0};
    const double part = gsl_rng_uniform(random), one = 2 * PI * gsl_rng_uniform(random),
                 other = 2 * PI * gsl_rng_uniform(random);
    place.turn[0] = sqrt(part) * cos(one);
    place.turn[1] = sqrt(1 - part) * sin(other);
    place.turn[2] = sqrt(1 - part) * cos(other);
    place.turn[3] = sqrt(part) * sin(one);
    draw_direction(place.u, random);
    return place;
}

ms_touch_place ms_place_faces(const double one[3], const double other[3], double yaw)
{
    ms_touch_place place = {0};
    double from[3][3], to[3][3], tangent[2][3], axis[3][3] = {{0}};
    memcpy(from[2], other, sizeof from[2]);
    ms_directions_tangents(from[0], from[1], other);
    for (int k = 0; k < 3; k++) {
        to[2][k] = -one[k];
    }
    ms_directions_tangents(tangent[0], tangent[1], to[2]);
    for (int k = 0; k < 3; k++) {
        to[0][k] = cos(yaw) * tangent[0][k] + sin(yaw) * tangent[1][k];
        to[1][k] = cos(yaw) * tangent[1][k] - sin(yaw) * tangent[0][k];
    }
    for (int m = 0; m < 3; m++) { /* where the body's axis m comes to lie */
        for (int k = 0; k < 3; k++) {
            axis[m][k] = from[0][m] * to[0][k] + from[1][m] * to[1][k] + from[2][m] * to[2][k];
        }
    }
    ms_quaternion_from_axes(place.turn, axis);
    memcpy(place.u, one, sizeof place.u);
    return place;
}

const ms_pose *ms_place_pose(const ms_pose *pose, size_t count, gsl_rng *random)
{
    double left = gsl_rng_uniform(random);
    size_t p = 0;
    while (p + 1 < count && left >= pose[p].share) {
        left -= pose[p++].share;
    }
    return &pose[p];
}
