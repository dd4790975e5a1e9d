#include "ms_poses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* No direction leads there yet. */
static const uint32_t NOWHERE = UINT32_MAX;

/* A minimum of the lattice. */
typedef struct basin {
    ms_pose pose;
    uint32_t into; /* itself, or the deeper one that it went to */
    double met;    /* h of the lattice where it first met another one that is deep */
} basin;

/* Where two basins meet that are both deep. */
typedef struct pass {
    uint32_t a, b;
    double height;
} pass;

typedef struct flooding {
    const ms_support *body;
    const ms_directions *directions;
    const double *height;
    double depth, reach, coarse; /* `coarse`: h changes by less from a direction to the nearest of the lattice */
    ms_support near;             /* see gather_near */
    double (*plane)[3];          /* of each of these: value, slopes along x and y */
    uint32_t *order;             /* directions, lowest first */
    uint32_t *basin_of;          /* of each direction */
    basin *basins;
    size_t n_basins;
    pass *passes;
    size_t n_passes;
} flooding;

void ms_poses_heights(double *height, const ms_support *body, const ms_directions *directions)
{
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < directions->count; i++) {
        height[i] = ms_support_height(body, directions->u[i]);
    }
}

double ms_poses_mean_width(const double *height, const ms_directions *directions)
{
    double sum = 0;
    for (size_t i = 0; i < directions->count; i++) {
        sum += 2 * directions->weight[i] * height[i];
    }
    return sum;
}

double ms_poses_rms(const double *a, const double *b, const ms_directions *directions)
{
    double sum = 0;
    for (size_t i = 0; i < directions->count; i++) {
        sum += directions->weight[i] * (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(sum);
}

/* u moved by `step` towards `way`, which is tangential. */
static void move(double out[3], const double u[3], const double way[3], double step)
{
    for (int k = 0; k < 3; k++) {
        out[k] = u[k] + step * way[k];
    }
    const double length = sqrt(ms_dot(out, out));
    for (int k = 0; k < 3; k++) {
        out[k] /= length;
    }
}

/* How fast a sphere's part of h rises away from u at most: its centre's distance from the line along u. */
static double find_steepness(const ms_sphere *sphere, const double u[3])
{
    const double along = ms_dot(sphere->centre, u);
    return sqrt(fmax(0, ms_dot(sphere->centre, sphere->centre) - along * along));
}

/* Those spheres alone that can reach farthest within an angle of u: the farthest one falls no faster than its
 * steepness, others rise no faster than theirs, and what is bent adds less than reach angle^2. */
static void gather_near(flooding *s, const double u[3], double angle)
{
    const double height = ms_support_height(s->body, u);
    double falls = (double)INFINITY;
    for (size_t i = 0; i < s->body->count; i++) {
        const ms_sphere *sphere = &s->body->sphere[i];
        if (ms_dot(sphere->centre, u) + sphere->radius >= height) {
            falls = fmin(falls, find_steepness(sphere, u));
        }
    }
    s->near.count = 0;
    for (size_t i = 0; i < s->body->count; i++) {
        const ms_sphere *sphere = &s->body->sphere[i];
        const double rises = find_steepness(sphere, u);
        if (ms_dot(sphere->centre, u) + sphere->radius >= height - (falls + rises + s->reach * angle) * angle) {
            s->near.sphere[s->near.count++] = *sphere;
        }
    }
}

/* The greatest of the planes at (x, y). @param[out] slope of that one along y */
static double find_greatest(double *slope, const flooding *s, double x, double y)
{
    double greatest = -(double)INFINITY;
    for (size_t i = 0; i < s->near.count; i++) {
        const double value = s->plane[i][0] + x * s->plane[i][1] + y * s->plane[i][2];
        if (value > greatest) {
            greatest = value;
            *slope = s->plane[i][2];
        }
    }
    return greatest;
}

/* The least along y within `half` of 0: by halves, as the greatest of planes is convex. */
static double find_least_along(double *y, const flooding *s, double x, double half)
{
    double low = -half, high = half, slope = 0, least = (double)INFINITY;
    for (int i = 0; i < 42; i++) {
        const double middle = (low + high) / 2, value = find_greatest(&slope, s, x, middle);
        if (value < least) {
            least = value;
            *y = middle;
        }
        *(slope > 0 ? &high : &low) = middle;
    }
    return least;
}

/* The same over both. */
static double find_least(double at[2], const flooding *s, double half)
{
    double low = -half, high = half, least = (double)INFINITY;
    for (int i = 0; i < 60; i++) {
        const double x[2] = {low + (high - low) / 3, high - (high - low) / 3};
        double value[2], y = 0;
        for (int side = 0; side < 2; side++) {
            value[side] = find_least_along(&y, s, x[side], half);
            if (value[side] < least) {
                least = value[side];
                at[0] = x[side];
                at[1] = y;
            }
        }
        *(value[0] < value[1] ? &high : &low) = x[value[0] < value[1]];
    }
    return least;
}

/*
 * Down to the minimum: at each step the least of h within a square in the tangent plane, each sphere's part of it taken
 * as linear there. That is exact but for what the parts bend, and h has its minima where three of them meet, in
 * valleys too narrow to be found by trying. h is below what is linear, so that it falls as expected.
 * @return 0 if the way leads below `floor`
 */
static int descend(ms_pose *pose, flooding *s, double floor)
{
    enum { MOST = 400 };
    double half = s->directions->spacing;
    for (int step = 0; step < MOST && half > 1e-12; step++) {
        double one[3], other[3], at[2] = {0}, u[3];
        const double *from = pose->direction;
        gather_near(s, from, 1.5 * half);
        ms_directions_tangents(one, other, from);
        for (size_t i = 0; i < s->near.count; i++) {
            const ms_sphere *sphere = &s->near.sphere[i];
            s->plane[i][0] = ms_dot(sphere->centre, from) + sphere->radius - pose->height;
            s->plane[i][1] = ms_dot(sphere->centre, one);
            s->plane[i][2] = ms_dot(sphere->centre, other);
        }
        if (find_least(at, s, half) > -1e-14 * s->reach) {
            break;
        }
        const double way[3] = {at[0] * one[0] + at[1] * other[0], at[0] * one[1] + at[1] * other[1],
                               at[0] * one[2] + at[1] * other[2]};
        move(u, from, way, 1);
        const double height = ms_support_height(s->body, u);
        if (!(height < pose->height)) {
            half /= 2;
            continue;
        }
        pose->height = height;
        memcpy(pose->direction, u, sizeof u);
        if (height < floor) {
            return 0;
        }
    }
    return 1;
}

/*
 * The lattice seldom meets the floor of a valley, and so finds passes too high: the least h on the line through the
 * direction v across the way from one side to the other.
 */
static double find_pass(flooding *s, uint32_t v, uint32_t from, uint32_t to)
{
    const double *u = s->directions->u[v], *a = s->directions->u[from], *b = s->directions->u[to];
    const double way[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double across[3], low = -s->directions->spacing, high = s->directions->spacing;
    ms_cross(across, u, way);
    const double length = sqrt(ms_dot(across, across));
    if (!(length > 0)) {
        return s->height[v];
    }
    for (int k = 0; k < 3; k++) {
        across[k] /= length;
    }
    gather_near(s, u, 2 * s->directions->spacing);
    double height[2];
    for (int i = 0; i < 40; i++) {
        const double third = (high - low) / 3;
        for (int side = 0; side < 2; side++) {
            double at[3];
            move(at, u, across, side ? high - third : low + third);
            height[side] = ms_support_height(&s->near, at);
        }
        *(height[0] < height[1] ? &high : &low) += height[0] < height[1] ? -third : third;
    }
    return fmin(s->height[v], fmin(height[0], height[1]));
}

static uint32_t find_basin(const flooding *s, uint32_t b)
{
    while (s->basins[b].into != b) {
        b = s->basins[b].into;
    }
    return b;
}

static uint32_t find_nearest_direction(const flooding *s, const double u[3])
{
    size_t nearest = 0;
    for (size_t i = 1; i < s->directions->count; i++) {
        nearest = ms_dot(s->directions->u[i], u) > ms_dot(s->directions->u[nearest], u) ? i : nearest;
    }
    return (uint32_t)nearest;
}

/*
 * A direction without a lower one beside it: a minimum, or a place in a valley too narrow for the lattice. From there
 * the way leads to what is lower than any direction of the lattice that has no basin yet.
 */
static uint32_t begin_basin(flooding *s, uint32_t v)
{
    basin new = {.pose = {.height = s->height[v], .barrier = (double)INFINITY},
                 .into = (uint32_t)s->n_basins,
                 .met = (double)INFINITY};
    const double same = s->directions->spacing * s->directions->spacing;
    memcpy(new.pose.direction, s->directions->u[v], sizeof new.pose.direction);
    if (!descend(&new.pose, s, s->height[v] - s->coarse)) {
        return s->basin_of[find_nearest_direction(s, new.pose.direction)];
    }
    for (uint32_t b = 0; b < s->n_basins; b++) {
        if (ms_squared_distance(s->basins[b].pose.direction, new.pose.direction) < same) {
            return b;
        }
    }
    s->basins[s->n_basins] = new;
    return (uint32_t)s->n_basins++;
}

/* The basins of two directions meet at v. Far above the place where they first met there is nothing to be learnt. */
static void join_basins(flooding *s, uint32_t v, uint32_t from, uint32_t to)
{
    basin *a = &s->basins[find_basin(s, s->basin_of[from])], *b = &s->basins[find_basin(s, s->basin_of[to])];
    basin *higher = a->pose.height > b->pose.height ? a : b, *lower = higher == a ? b : a;
    if (a == b || (s->height[v] > fmax(a->met, b->met) + s->coarse &&
                   s->height[v] > higher->pose.height + s->depth + s->coarse)) {
        return;
    }
    const double height = find_pass(s, v, from, to);
    if (height - higher->pose.height < s->depth) {
        higher->into = lower->into;
        lower->met = (double)INFINITY;
        return;
    }
    a->met = fmin(a->met, s->height[v]);
    b->met = fmin(b->met, s->height[v]);
    s->passes[s->n_passes++] = (pass){a->into, b->into, height};
}

/* In the order of height, so that what is lower beside a direction has its basin. */
static void flood(flooding *s)
{
    const ms_directions *d = s->directions;
    for (size_t i = 0; i < d->count; i++) {
        const uint32_t v = s->order[i];
        uint32_t lowest = NOWHERE;
        for (uint32_t e = d->start[v]; e < d->start[v + 1]; e++) {
            const uint32_t w = d->next[e];
            if (s->basin_of[w] != NOWHERE && (lowest == NOWHERE || s->height[w] < s->height[lowest])) {
                lowest = w;
            }
        }
        if (lowest == NOWHERE) {
            s->basin_of[v] = begin_basin(s, v);
            continue;
        }
        s->basin_of[v] = s->basin_of[lowest];
        for (uint32_t e = d->start[v]; e < d->start[v + 1]; e++) {
            if (s->basin_of[d->next[e]] != NOWHERE) {
                join_basins(s, v, lowest, d->next[e]);
            }
        }
    }
}

/* What the passes and the directions say of the minima that are left. */
static void sum_up_shares(flooding *s)
{
    for (size_t p = 0; p < s->n_passes; p++) {
        const uint32_t a = find_basin(s, s->passes[p].a), b = find_basin(s, s->passes[p].b);
        if (a != b) {
            ms_pose *one = &s->basins[a].pose, *other = &s->basins[b].pose;
            one->barrier = fmin(one->barrier, s->passes[p].height - one->height);
            other->barrier = fmin(other->barrier, s->passes[p].height - other->height);
        }
    }
    for (size_t i = 0; i < s->directions->count; i++) {
        s->basins[find_basin(s, s->basin_of[i])].pose.share += s->directions->weight[i];
    }
}

static int compare_poses(const void *one, const void *other)
{
    const ms_pose *a = one, *b = other;
    if (a->height != b->height) {
        return a->height < b->height ? -1 : 1;
    }
    for (int k = 0; k < 3; k++) {
        if (a->direction[k] != b->direction[k]) {
            return a->direction[k] < b->direction[k] ? -1 : 1;
        }
    }
    return 0;
}

static ms_status list_poses(ms_pose **pose, size_t *count, const flooding *s, ms_error *err)
{
    *pose = malloc(s->n_basins * sizeof **pose);
    if (!*pose) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu poses", s->n_basins);
    }
    for (uint32_t b = 0; b < s->n_basins; b++) {
        if (s->basins[b].into == b) {
            (*pose)[(*count)++] = s->basins[b].pose;
        }
    }
    qsort(*pose, *count, sizeof **pose, compare_poses);
    return MS_OK;
}

typedef struct ranked {
    double height;
    uint32_t at;
} ranked;

static int compare_heights(const void *one, const void *other)
{
    const ranked *a = one, *b = other;
    if (a->height != b->height) {
        return a->height < b->height ? -1 : 1;
    }
    return (a->at > b->at) - (a->at < b->at);
}

/* @return 0 without memory */
static int sort_directions(flooding *s)
{
    const size_t count = s->directions->count;
    ranked *all = malloc(count * sizeof *all);
    for (size_t i = 0; all && i < count; i++) {
        all[i] = (ranked){s->height[i], (uint32_t)i};
    }
    if (all) {
        qsort(all, count, sizeof *all, compare_heights);
    }
    for (size_t i = 0; all && i < count; i++) {
        s->order[i] = all[i].at;
        s->basin_of[i] = NOWHERE;
    }
    free(all);
    return all != NULL;
}

static double find_body_reach(const ms_support *body)
{
    double reach = 0;
    for (size_t i = 0; i < body->count; i++) {
        const double *c = body->sphere[i].centre;
        reach = fmax(reach, sqrt(ms_dot(c, c)) + body->sphere[i].radius);
    }
    return reach;
}

ms_status ms_poses_find(ms_pose **pose, size_t *count, const ms_support *body, const ms_directions *directions,
                        const double *height, double depth, ms_error *err)
{
    flooding s = {.body = body,
                  .directions = directions,
                  .height = height,
                  .depth = depth,
                  .reach = find_body_reach(body),
                  .near = {0, malloc(body->count * sizeof *s.near.sphere)},
                  .plane = malloc(body->count * sizeof *s.plane),
                  .order = malloc(directions->count * sizeof *s.order),
                  .basin_of = malloc(directions->count * sizeof *s.basin_of),
                  .basins = malloc(directions->count * sizeof *s.basins),
                  .passes = malloc(directions->mesh.n_triangles * 3 / 2 * sizeof *s.passes)}; /* one for each edge */
    ms_status status = MS_OK;
    s.coarse = s.reach * directions->spacing;
    *pose = NULL;
    *count = 0;
    if (!s.near.sphere || !s.plane || !s.order || !s.basin_of || !s.basins || !s.passes || !sort_directions(&s)) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to order %zu directions", directions->count);
    } else {
        flood(&s);
        sum_up_shares(&s);
        status = list_poses(pose, count, &s, err);
    }
    ms_support_free(&s.near);
    free(s.plane);
    free(s.order);
    free(s.basin_of);
    free(s.basins);
    free(s.passes);
    return status;
}
