#include "ms_sled.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "base/ms_vector.h"
#include "ms_place.h"

static const double PI = 3.14159265358979323846;

/* The motion of the second body: along the way, and up as much as keeps the load. */
static double find_slope(const ms_touch_pair *pair, size_t count, const ms_sled_place *place)
{
    double with_way = 0, with_rise = 0;
    for (size_t p = 0; p < count; p++) {
        const double stiffness = sqrt(pair[p].radius * pair[p].overlap), up = ms_dot(pair[p].normal, place->at.u);
        with_way += stiffness * up * ms_dot(pair[p].normal, place->way);
        with_rise += stiffness * up * up;
    }
    return -with_way / with_rise;
}

/* Of length 1: how the second body slides over the first where they touch. */
static void find_sliding(double out[3], const double normal[3], const ms_sled_place *place, double slope)
{
    double motion[3];
    for (int k = 0; k < 3; k++) {
        motion[k] = place->way[k] + slope * place->at.u[k];
    }
    const double along = ms_dot(motion, normal);
    for (int k = 0; k < 3; k++) {
        out[k] = motion[k] - along * normal[k];
    }
    const double length = sqrt(ms_dot(out, out));
    for (int k = 0; k < 3; k++) {
        out[k] = length > 0 ? out[k] / length : 0; /* where it is pressed on and does not slide */
    }
}

double ms_sled_ratio(double *slope, const ms_touch_pair *pair, size_t count, const ms_sled_place *place,
                     double friction)
{
    double drag = 0, load = 0;
    *slope = find_slope(pair, count, place);
    for (size_t p = 0; p < count; p++) {
        const double force = sqrt(pair[p].radius) * pow(pair[p].overlap, 1.5);
        double sliding[3], push[3];
        find_sliding(sliding, pair[p].normal, place, *slope);
        for (int k = 0; k < 3; k++) {
            push[k] = force * (pair[p].normal[k] - friction * sliding[k]);
        }
        load += ms_dot(push, place->at.u);
        drag -= ms_dot(push, place->way);
    }
    return load > 0 ? drag / load : (double)INFINITY;
}

/* What one thread works with. */
typedef struct dragging {
    const ms_support *body;
    double r_eq, overlap;
    ms_sphere *turned;
    ms_touch_pair *pair;
    size_t room;
} dragging;

/* Those that touch, for which room is made. @return how many, SIZE_MAX without memory */
static size_t find_dragged_pairs(dragging *d, const ms_sled_place *place)
{
    if (!d->turned && !(d->turned = malloc(d->body->count * sizeof *d->turned))) {
        return SIZE_MAX;
    }
    for (;;) {
        const size_t count =
            ms_touch_second(d->pair, d->room, d->turned, d->body, &place->at, d->r_eq, d->overlap).count;
        if (count <= d->room) {
            return count;
        }
        ms_touch_pair *more = realloc(d->pair, 2 * count * sizeof *more);
        if (!more) {
            return SIZE_MAX;
        }
        d->pair = more;
        d->room = 2 * count;
    }
}

static ms_sled_place draw_place(const double face[3], double r_eq, gsl_rng *random)
{
    const double yaw = 2 * PI * gsl_rng_uniform(random), way = 2 * PI * gsl_rng_uniform(random),
                 bearing = 2 * PI * gsl_rng_uniform(random), away = r_eq / 2 * sqrt(gsl_rng_uniform(random));
    ms_sled_place place = {.at = ms_place_faces(face, face, yaw)};
    double one[3], other[3];
    ms_directions_tangents(one, other, face);
    for (int k = 0; k < 3; k++) {
        place.way[k] = cos(way) * one[k] + sin(way) * other[k];
        place.at.aside[k] = away * (cos(bearing) * one[k] + sin(bearing) * other[k]);
    }
    return place;
}

/* Of one place and friction: T/N and the slope; NAN where nothing touches. */
typedef struct outcome {
    double ratio, slope;
} outcome;

/* In the order of the places. */
static void sum_up_sled(ms_sled *sled, const outcome *found, size_t step, size_t places)
{
    double slid = 0;
    sled->largest = sled->slope_largest = (double)NAN; /* which fmax passes over */
    for (size_t i = 0; i < places; i++) {
        const double ratio = found[i * step].ratio, slope = found[i * step].slope, mu = sled->friction;
        if (isnan(ratio)) {
            sled->missed++;
        } else if (isinf(ratio) || mu * slope >= 1) {
            sled->jammed++;
        } else {
            const double single = (mu + slope) / (1 - mu * slope);
            slid++;
            sled->mean += ratio;
            sled->slope_mean += single;
            sled->largest = fmax(sled->largest, ratio);
            sled->slope_largest = fmax(sled->slope_largest, single);
        }
    }
    sled->missed /= (double)places;
    sled->jammed /= (double)places;
    sled->mean /= slid;
    sled->slope_mean /= slid;
}

/* @return 0 without memory */
static int drag_all(outcome *found, const ms_sled_place *place, size_t places, const dragging *how,
                    const double *friction, size_t n_frictions)
{
    int failed = 0;
#pragma omp parallel
    {
        dragging own = *how;
#pragma omp for schedule(dynamic, 16)
        for (size_t i = 0; i < places; i++) {
            const size_t count = find_dragged_pairs(&own, &place[i]);
            if (count == SIZE_MAX) {
#pragma omp atomic write
                failed = 1;
                continue;
            }
            for (size_t f = 0; f < n_frictions; f++) {
                outcome *o = &found[i * n_frictions + f];
                o->ratio = (double)NAN;
                if (count) {
                    o->ratio = ms_sled_ratio(&o->slope, own.pair, count, &place[i], friction[f]);
                }
            }
        }
        free(own.turned);
        free(own.pair);
    }
    return !failed;
}

ms_status ms_sled_drag(ms_sled *sled, const double *friction, size_t n_frictions, const ms_support *body,
                       const double face[3], double r_eq, double overlap, size_t places, unsigned long seed,
                       ms_error *err)
{
    const dragging how = {.body = body, .r_eq = r_eq, .overlap = overlap};
    gsl_rng *random = ms_random_new(seed);
    ms_sled_place *place = malloc(places * sizeof *place);
    outcome *found = malloc(places * n_frictions * sizeof *found);
    int done = random && place && found;
    for (size_t i = 0; done && i < places; i++) {
        place[i] = draw_place(face, r_eq, random);
    }
    done = done && drag_all(found, place, places, &how, friction, n_frictions);
    for (size_t f = 0; f < n_frictions; f++) {
        sled[f] = (ms_sled){.friction = friction[f]};
        if (done) {
            sum_up_sled(&sled[f], found + f, n_frictions, places);
        }
    }
    ms_random_free(random);
    free(place);
    free(found);
    return done ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to drag a clump of %zu spheres", body->count);
}
