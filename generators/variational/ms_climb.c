#include "ms_climb.h"

#include <math.h>
#include <string.h>

#include "base/ms_vector.h"
#include "mesh/ms_closest.h"

/* Part of a step by which the radius grows at least: about the medial axis of a rough surface there are many others, of
 * spheres that touch it twice close by. */
static const double GROWTH = 0.5;

/* Of steps that are worth while, voxels, and how many at most. */
static const double LEAST_STEP = 0.005;
enum { STEPS = 40 };

/* Distance to the surface and the direction from there, voxels. @param at_most it is smaller */
static double find_away(double normal[3], const ms_target *target, const double at[3], double at_most)
{
    const double h = target->grid.h;
    double place[3], nearest[3];
    ms_grid_place(place, &target->grid, at);
    memcpy(nearest, place, sizeof nearest);
    const double away = ms_closest_distance(nearest, target->closest, place, at_most * h);
    for (int a = 0; a < 3; a++) {
        normal[a] = away > 0 ? (place[a] - nearest[a]) / away : 0;
    }
    return away / h;
}

double ms_climb(ms_ball *ball, const ms_target *target, double most)
{
    double normal[3];
    const double first = find_away(normal, target, ball->centre, HUGE_VAL);
    ball->radius = first;
    for (int i = 0; i < STEPS; i++) {
        const double step = fmin(most, 0.99 * ball->radius); /* within the sphere, and so inside */
        double to[3], there[3];
        if (step < LEAST_STEP) {
            break;
        }
        for (int a = 0; a < 3; a++) {
            to[a] = ball->centre[a] + step * normal[a];
        }
        const double away = find_away(there, target, to, ball->radius + step + LEAST_STEP);
        if (away > ball->radius + GROWTH * step) {
            memcpy(ball->centre, to, sizeof to);
            memcpy(normal, there, sizeof there);
            ball->radius = away;
        } else { /* past the axis: back to where the radius, which grows by `growth` a step here, began to do so */
            const double growth = fmin(ms_dot(normal, there), GROWTH);
            most = fmin(0.9 * step, (away - ball->radius - growth * step) / (1 - growth));
        }
    }
    return first;
}
