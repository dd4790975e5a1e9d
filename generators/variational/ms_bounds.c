#include "ms_bounds.h"

#include <math.h>

#include "mesh/ms_closest.h"

/* Signed distance of a place, exact where there is a mesh: the look-up cuts off the ridges. */
static double find_exact_distance(const ms_signed_distance *field, const double place[3])
{
    const ms_target *target = field->target;
    double p[3];
    if (!target->closest || !target->closed) {
        return ms_signed_distance_at(field, place);
    }
    ms_grid_place(p, &target->grid, place);
    return ms_closest_signed_distance(target->closest, p) / target->grid.h;
}

int ms_bounds_are_set(const ms_bounds *bounds)
{
    return bounds->protrusion < HUGE_VAL || (bounds->planes && bounds->planes->n_planes > 0);
}

double ms_bounds_beyond_planes(const ms_bounds *bounds, const ms_grid *grid, const double centre[3],
                               const double place[3])
{
    double from[3], to[3];
    ms_grid_place(from, grid, centre);
    ms_grid_place(to, grid, place);
    const double beyond = ms_planes_beyond(bounds->planes, from, to) / grid->h;
    return beyond > 0 ? beyond : -HUGE_VAL;
}

double ms_bounds_most_radius(const ms_bounds *bounds, const ms_signed_distance *field, const double centre[3])
{
    const ms_grid *grid = &field->target->grid;
    const double bound = bounds->protrusion;
    double most = bound < HUGE_VAL ? bound - find_exact_distance(field, centre) : HUGE_VAL, place[3];
    if (bounds->planes) {
        ms_grid_place(place, grid, centre);
        most = fmin(most, ms_planes_distance(bounds->planes, place) / grid->h);
    }
    return most;
}

void ms_bounds_confine(const ms_bounds *bounds, const ms_signed_distance *field, ms_ball *ball, size_t count)
{
    double least = HUGE_VAL;
    for (size_t s = 0; s < count; s++) {
        ball[s].radius = fmax(0, fmin(ball[s].radius, ms_bounds_most_radius(bounds, field, ball[s].centre)));
        least = fmin(least, ball[s].radius);
    }
    for (size_t s = 0; s < count && bounds->equal; s++) {
        ball[s].radius = least;
    }
}
