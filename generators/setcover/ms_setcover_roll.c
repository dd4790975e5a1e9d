#include "ms_setcover_roll.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "shared/ms_cover_groups.h"

/* All in voxels of the lattice. */
static const double SLACK = 0.6;  /* by as much the field may rise too little before the rolling ends: its own error */
static const double CLOSE = 0.25; /* the end of the way is found within this */
static const double SHORT = 1.2;  /* and by this much it is left out: what the field sees too late */
static const double CELL = 0.35;  /* spheres whose centres are in a cell of this side are as good as one */
static const double LEVEL = 1;    /* side of the smallest cells of those twice as large as others */
static const double BORDER = 0.5; /* the field counts from the voxels outside, the surface is this much nearer */

/* The field between its points. */
static double read_depth(const ms_setcover_field *f, const double q[3])
{
    double part[3], sum = 0;
    size_t low[3];
    for (int a = 0; a < 3; a++) {
        const double inside = fmin(fmax(q[a], 0), f->n[a] - 1.0);
        low[a] = (size_t)fmin(inside, f->n[a] - 2.0);
        part[a] = inside - (double)low[a];
    }
    const size_t row = (size_t)f->n[0], plane = row * (size_t)f->n[1];
    const float *at = f->depth + low[0] + row * low[1] + plane * low[2];
    for (size_t c = 0; c < 4; c++) {
        const float *x = at + (c & 1) * row + (c >> 1) * plane;
        const double weight = (c & 1 ? part[1] : 1 - part[1]) * (c >> 1 ? part[2] : 1 - part[2]);
        sum += weight * ((double)x[0] + part[0] * ((double)x[1] - (double)x[0]));
    }
    return sum;
}

static double depth_along(const ms_setcover_field *f, const double q[3], const double u[3], double s)
{
    const double at[3] = {q[0] + s * u[0], q[1] + s * u[1], q[2] + s * u[2]};
    return read_depth(f, at);
}

/* How far the field rises along u as a distance does that it grows from there: by as much as the way, but for SLACK.
 * What is missing never falls along the way, so that it is halved. */
static double find_end(const ms_setcover_field *f, const double q[3], const double u[3], double depth)
{
    double sure = 0, beyond = 1;
    while (depth + beyond - depth_along(f, q, u, beyond) < SLACK) {
        sure = beyond;
        beyond *= 2;
    }
    while (beyond - sure > CLOSE) {
        const double middle = (sure + beyond) / 2;
        *(depth + middle - depth_along(f, q, u, middle) < SLACK ? &sure : &beyond) = middle;
    }
    return sure;
}

/* The way in, away from the nearest face: a unit vector on the lattice. */
static void choose_way(double u[3], const ms_setcover_field *f, const ms_setcover_start *start)
{
    double away[3];
    for (int a = 0; a < 3; a++) {
        away[a] = (start->from[a] - start->nearest[a]) / start->distance;
    }
    for (int a = 0; a < 3; a++) {
        u[a] = ms_dot(away, f->axis[a]);
    }
}

static void roll_in(ms_setcover_start *start, const ms_setcover_field *f, const ms_closest *closest)
{
    double q[3], from[3], u[3], s = 0;
    for (int a = 0; a < 3; a++) {
        from[a] = start->from[a] - f->origin[a];
    }
    for (int a = 0; a < 3; a++) {
        q[a] = ms_dot(from, f->axis[a]) / f->h;
    }
    start->distance = ms_closest_distance(start->nearest, closest, start->from, HUGE_VAL);
    if (start->distance > 0) {
        choose_way(u, f, start);
        s = fmax(0, find_end(f, q, u, start->distance / f->h + BORDER) - SHORT);
    }
    start->radius = start->distance + s * f->h;
    for (int a = 0; a < 3; a++) {
        start->centre[a] = start->from[a];
        for (int b = 0; b < 3; b++) {
            start->centre[a] += s > 0 ? s * f->h * u[b] * f->axis[b][a] : 0;
        }
    }
}

/* The cell of a place; cells have this side, in voxels of the lattice. Their borders lie on no point of the lattice,
 * where spheres may end: rounding would tell on which side. */
static uint64_t find_end_cell(const ms_setcover_field *f, const double centre[3], double side)
{
    uint64_t cell = 0;
    const double from[3] = {centre[0] - f->origin[0], centre[1] - f->origin[1], centre[2] - f->origin[2]};
    for (int a = 0; a < 3; a++) {
        const double at = floor((ms_dot(from, f->axis[a]) / f->h + CELL / 2) / side);
        cell = cell << 21 | (uint64_t)fmin(fmax(at, 0), 0x1fffff);
    }
    return cell;
}

/* Of n spheres leaves in front the largest of each cell. @return how many they are */
static size_t gather_largest(ms_cover_groups_member *member, size_t n, const ms_setcover_start *start,
                             const ms_setcover_field *f, double side)
{
    size_t found = 0;
    for (size_t e = 0; e < n; e++) {
        member[e].cell = find_end_cell(f, start[member[e].index].centre, side);
    }
    ms_cover_groups_sort(member, n);
    uint64_t last = 0;
    for (size_t e = 0; e < n; e++) {
        const uint64_t cell = member[e].cell;
        if (e == 0 || cell != last) {
            member[found++] = member[e];
        }
        last = cell;
    }
    return found;
}

/* Finds the largest cells of which each is the largest, and drops those that are it of none. */
static void rank_largest(ms_setcover_start *start, size_t *count, ms_cover_groups_member *member,
                         const ms_setcover_field *f)
{
    size_t n = *count, kept = 0;
    for (size_t i = 0; i < n; i++) {
        member[i] = (ms_cover_groups_member){.radius = start[i].radius, .index = i};
        start[i].scale = 0;
    }
    for (double side = CELL; n > 0; side = side < LEVEL ? LEVEL : 2 * side) {
        n = gather_largest(member, n, start, f, side);
        for (size_t e = 0; e < n; e++) {
            start[member[e].index].scale = side * f->h;
        }
        if (n == 1) {
            break;
        }
    }
    for (size_t i = 0; i < *count; i++) {
        if (start[i].scale > 0 && start[i].radius > 0) {
            start[kept++] = start[i];
        }
    }
    *count = kept;
}

ms_status ms_setcover_roll(ms_setcover_start *start, size_t *count, const ms_setcover_field *field,
                           const ms_closest *closest, ms_error *err)
{
    const ptrdiff_t all = (ptrdiff_t)*count;
    ms_cover_groups_member *member = malloc((*count + 1) * sizeof *member);
    if (!member) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu candidate spheres; use a smaller skeleton-deq", *count);
    }
#pragma omp parallel for schedule(dynamic, 64)
    for (ptrdiff_t i = 0; i < all; i++) {
        roll_in(&start[i], field, closest);
    }
    rank_largest(start, count, member, field);
    free(member);
    return MS_OK;
}
