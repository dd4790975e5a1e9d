#include "ms_touch.h"

#include <math.h>

#include "base/ms_quaternion.h"
#include "base/ms_vector.h"

static const double PI = 3.14159265358979323846;

static void add_contact(ms_touch *touch, double ratio)
{
    touch->count++;
    touch->stiffness += sqrt(ratio);
    touch->damping += sqrt(sqrt(ratio));
}

/* How far a sphere reaches along u. */
static double find_sphere_reach(const ms_sphere *sphere, const double u[3])
{
    return ms_dot(sphere->centre, u) + sphere->radius;
}

ms_touch ms_touch_plane(const ms_support *body, const double u[3], double r_eq, double overlap)
{
    ms_touch touch = {0};
    const double plane = ms_support_height(body, u) - overlap;
    for (size_t i = 0; i < body->count; i++) {
        const ms_sphere *s = &body->sphere[i];
        const double own = find_sphere_reach(s, u) - plane;
        if (own > 0) {
            add_contact(&touch, s->radius * own / (r_eq * overlap));
        }
    }
    return touch;
}

/* How far along u the second body is when one of its spheres overlaps `a` so much; `least` if none does farther off. */
static double meet_sphere(const ms_sphere *a, const ms_sphere *turned, size_t count, const double u[3], double overlap,
                          double least)
{
    for (size_t j = 0; j < count; j++) {
        const ms_sphere *b = &turned[j];
        const double d[3] = {a->centre[0] - b->centre[0], a->centre[1] - b->centre[1], a->centre[2] - b->centre[2]};
        const double along = ms_dot(d, u), apart = a->radius + b->radius - overlap;
        if (along + apart <= least) {
            continue;
        }
        const double square = apart * apart - (ms_dot(d, d) - along * along);
        if (square >= 0 && apart > 0) {
            least = fmax(least, along + sqrt(square));
        }
    }
    return least;
}

/* The same of all pairs; -INFINITY if none ever does. The sphere that reaches farthest is the first, as then few others
 * reach far enough. @param reach of the second body against u */
static double find_distance(const ms_support *body, const ms_sphere *turned, const double u[3], double reach,
                            double overlap)
{
    size_t first = 0;
    for (size_t i = 1; i < body->count; i++) {
        first = find_sphere_reach(&body->sphere[i], u) > find_sphere_reach(&body->sphere[first], u) ? i : first;
    }
    double distance = meet_sphere(&body->sphere[first], turned, body->count, u, overlap, -(double)INFINITY);
    for (size_t i = 0; i < body->count; i++) {
        if (find_sphere_reach(&body->sphere[i], u) + reach - overlap > distance) {
            distance = meet_sphere(&body->sphere[i], turned, body->count, u, overlap, distance);
        }
    }
    return distance;
}

/* The pair, if it touches. */
static int take_touching(ms_touch_pair *pair, const ms_sphere *a, const ms_sphere *b, const double moved[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        pair->normal[k] = b->centre[k] + moved[k] - a->centre[k];
        square += pair->normal[k] * pair->normal[k];
    }
    const double sum = a->radius + b->radius;
    if (!(square < sum * sum && square > 0)) {
        return 0;
    }
    const double distance = sqrt(square);
    for (int k = 0; k < 3; k++) {
        pair->normal[k] /= distance;
    }
    pair->overlap = sum - distance;
    pair->radius = a->radius * b->radius / sum;
    return 1;
}

ms_touch ms_touch_second(ms_touch_pair *pair, size_t most, ms_sphere *turned, const ms_support *body,
                         const ms_touch_place *place, double r_eq, double overlap)
{
    ms_touch touch = {0};
    for (size_t j = 0; j < body->count; j++) {
        ms_quaternion_turn(turned[j].centre, place->turn, body->sphere[j].centre);
        turned[j].radius = body->sphere[j].radius;
        for (int k = 0; k < 3; k++) {
            turned[j].centre[k] += place->aside[k];
        }
    }
    const double back[3] = {-place->u[0], -place->u[1], -place->u[2]};
    const double reach = ms_support_height(&(ms_support){body->count, turned}, back);
    const double distance = find_distance(body, turned, place->u, reach, overlap);
    const double moved[3] = {distance * place->u[0], distance * place->u[1], distance * place->u[2]};
    for (size_t i = 0; isfinite(distance) && i < body->count; i++) {
        if (find_sphere_reach(&body->sphere[i], place->u) + reach <= distance) {
            continue;
        }
        for (size_t j = 0; j < body->count; j++) {
            ms_touch_pair one;
            if (take_touching(&one, &body->sphere[i], &turned[j], moved)) {
                if (touch.count < most) {
                    pair[touch.count] = one;
                }
                add_contact(&touch, one.radius * one.overlap / (r_eq / 2 * overlap));
            }
        }
    }
    return touch;
}

double ms_touch_restitution(double single, double n)
{
    const double l = -log(single), b2 = l * l / (PI * PI + l * l);
    return n * b2 < 1 ? exp(-PI * sqrt(n * b2) / sqrt(1 - n * b2)) : 0;
}

double ms_touch_number(const ms_touch *touch)
{
    return touch->damping * touch->damping / touch->stiffness;
}
