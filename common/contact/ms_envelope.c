#include "ms_envelope.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "clump/ms_union.h"
#include "mesh/ms_closest.h"

/* Cells along the longest side of the box; of the coarser lattice, which tells the error, half as many. */
enum { CELLS = 64 };

/* Of pushes away from the body, and of moves along the border. */
enum { PUSHES = 12, MOVES = 3 };

/* How much nearer to the body than the radius a centre may be, in cells. */
static const double SLACK = 1e-3;

/* Places farther than this from the surface of the envelope, in cells, need no better centre. */
static const double FAR = 2;

/* The places of a lattice and, of each, the nearest centre of a ball that was found. */
typedef struct envelope_cells {
    const ms_envelope_body *body;
    double radius, h, origin[3];
    int n[3];
    size_t count;
    double *depth;       /* distance to the body; negative inside */
    double (*centre)[3]; /* of the ball */
    double *reach;       /* distance to it; HUGE_VAL: none */
} envelope_cells;

static double distance_to_clump(double nearest[3], const void *body, const double place[3])
{
    const ms_clump *clump = body;
    double least = HUGE_VAL, length = 1;
    const ms_sphere *sphere = clump->sphere;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double away = sqrt(ms_squared_distance(place, clump->sphere[s].centre));
        if (away - clump->sphere[s].radius < least) {
            least = away - clump->sphere[s].radius;
            length = away;
            sphere = &clump->sphere[s];
        }
    }
    for (int k = 0; k < 3; k++) {
        nearest[k] = sphere->centre[k] + sphere->radius / length * (place[k] - sphere->centre[k]);
    }
    return least;
}

static double distance_to_mesh(double nearest[3], const void *body, const double place[3])
{
    double normal[3];
    const double away = ms_closest_distance(nearest, body, place, HUGE_VAL);
    return ms_closest_side(normal, body, place, away);
}

static void find_cell_centre(double place[3], const envelope_cells *c, size_t cell)
{
    const size_t at[3] = {cell % c->n[0], cell / c->n[0] % c->n[1], cell / c->n[0] / c->n[1]};
    for (int k = 0; k < 3; k++) {
        place[k] = c->origin[k] + c->h * ((double)at[k] + 0.5);
    }
}

/* The place at the radius from two others that is nearest to one. @return 0 if they are too far apart */
static int put_at_radius(double out[3], const double one[3], const double other[3], const double from[3], double radius)
{
    double axis[3], away[3], along = 0;
    const double square = ms_squared_distance(one, other), ring = radius * radius - square / 4;
    for (int k = 0; k < 3; k++) {
        axis[k] = other[k] - one[k];
        away[k] = from[k] - (one[k] + other[k]) / 2;
    }
    if (!(square > 0) || !(ring > 0)) {
        return 0;
    }
    along = ms_dot(away, axis) / square;
    for (int k = 0; k < 3; k++) {
        away[k] -= along * axis[k];
    }
    const double scale = sqrt(ring / ms_dot(away, away)); /* from their line no way is the nearest */
    for (int k = 0; k < 3; k++) {
        out[k] = (one[k] + other[k]) / 2 + scale * away[k];
    }
    return isfinite(out[0] + out[1] + out[2]);
}

/*
 * The centre of a ball that touches the body from outside: as far as the radius from the last two of the body's points
 * that were too near to it, and the nearest to a place; where the ball touches three, which that never gives, the
 * nearest to the centre before. @param[in,out] centre where the search begins @return 0 if none is found
 */
static int push_centre(double centre[3], const double place[3], const envelope_cells *c)
{
    double touched[2][3];
    for (int push = 0; push < PUSHES; push++) {
        double *nearest = touched[push % 2];
        const double away = c->body->distance(nearest, c->body->body, centre);
        if (away >= c->radius - SLACK * c->h) {
            return 1;
        }
        const double *from = push < PUSHES / 2 ? place : centre;
        if (push == 0 || !put_at_radius(centre, nearest, touched[(push + 1) % 2], from, c->radius)) {
            for (int k = 0; k < 3; k++) {
                centre[k] = nearest[k] + c->radius / away * (centre[k] - nearest[k]);
            }
        }
        if (!isfinite(centre[0] + centre[1] + centre[2])) {
            return 0; /* on the surface */
        }
    }
    return 0;
}

static void keep_nearer(envelope_cells *c, size_t cell, const double place[3], const double centre[3])
{
    const double reach = sqrt(ms_squared_distance(place, centre));
    if (reach < c->reach[cell]) {
        c->reach[cell] = reach;
        memcpy(c->centre[cell], centre, sizeof c->centre[cell]);
    }
}

/* A cell that the body fills has nothing between body and envelope. */
static int is_filled(const envelope_cells *c, size_t cell)
{
    return c->depth[cell] < -c->h / 2;
}

static void find_own_centres(envelope_cells *c)
{
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t cell = 0; cell < c->count; cell++) {
        double place[3], centre[3], nearest[3];
        find_cell_centre(place, c, cell);
        c->depth[cell] = c->body->distance(nearest, c->body->body, place);
        c->reach[cell] = HUGE_VAL;
        memcpy(centre, place, sizeof centre);
        if (!is_filled(c, cell) && push_centre(centre, place, c)) {
            keep_nearer(c, cell, place, centre);
        }
    }
}

/* Distance from the envelope's surface, positive inside. Where a ball's centre may be, the body's is told instead: the
 * envelope is a radius or more away, which may be less than a cell. */
static double find_margin(const envelope_cells *c, size_t cell)
{
    return c->depth[cell] < c->radius ? c->reach[cell] - c->radius : -c->depth[cell];
}

/* Tries the centres of the cell's neighbours. @return 1 if one is nearer */
static int try_neighbours(envelope_cells *c, size_t cell)
{
    const double before = c->reach[cell];
    double place[3];
    const size_t at[3] = {cell % c->n[0], cell / c->n[0] % c->n[1], cell / c->n[0] / c->n[1]};
    const size_t stride[3] = {1, (size_t)c->n[0], (size_t)c->n[0] * c->n[1]};
    find_cell_centre(place, c, cell);
    for (int k = 0; k < 3; k++) {
        for (int side = 0; side < 2; side++) {
            if (side ? at[k] + 1 < (size_t)c->n[k] : at[k] > 0) {
                const size_t other = side ? cell + stride[k] : cell - stride[k];
                if (c->reach[other] < HUGE_VAL) {
                    keep_nearer(c, cell, place, c->centre[other]);
                }
            }
        }
    }
    return c->reach[cell] < before;
}

/* To and fro over the lattice until no cell finds a nearer centre at its neighbours. */
static void share_centres(envelope_cells *c)
{
    int changed = 1;
    for (int forth = 1; changed; forth = !forth) {
        changed = 0;
        for (size_t i = 0; i < c->count; i++) {
            const size_t cell = forth ? i : c->count - 1 - i;
            if (!is_filled(c, cell)) {
                changed |= try_neighbours(c, cell);
            }
        }
    }
}

/* Moves centres along the border of where they may be, towards the place; where it matters on which side of the
 * envelope's surface that is. */
static void move_centres(envelope_cells *c)
{
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t cell = 0; cell < c->count; cell++) {
        double place[3], part = 0.5;
        find_cell_centre(place, c, cell);
        if (is_filled(c, cell) || fabs(find_margin(c, cell)) > FAR * c->h ||
            c->reach[cell] + c->depth[cell] <= c->radius + SLACK * c->h) {
            continue;
        }
        for (int move = 0; move < MOVES; move++) {
            const double before = c->reach[cell];
            double centre[3];
            for (int k = 0; k < 3; k++) {
                centre[k] = c->centre[cell][k] + part * (place[k] - c->centre[cell][k]);
            }
            if (push_centre(centre, place, c)) {
                keep_nearer(c, cell, place, centre);
            }
            part = c->reach[cell] < before ? part : part / 2;
        }
    }
}

/* Of a cell, taken as a layer along the normal of both surfaces: what is outside the body and inside the envelope. */
static double find_bridged(const envelope_cells *c, size_t cell)
{
    const double half = c->h / 2, part = fmin(c->depth[cell], half) + fmin(find_margin(c, cell), half);
    return is_filled(c, cell) ? 0 : fmin(fmax(part / c->h, 0), 1);
}

/* Cells about the box, so many along its longest side. */
static ms_status open_cells(envelope_cells *out, const ms_envelope_body *body, double radius, int cells, ms_error *err)
{
    double longest = 0;
    *out = (envelope_cells){.body = body, .radius = radius, .count = 1};
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, body->hi[k] - body->lo[k]);
    }
    out->h = longest / cells;
    for (int k = 0; k < 3; k++) {
        out->n[k] = (int)fmax(ceil((body->hi[k] - body->lo[k]) / out->h - 1e-9), 1);
        out->origin[k] = (body->lo[k] + body->hi[k] - out->n[k] * out->h) / 2;
        out->count *= (size_t)out->n[k];
    }
    out->depth = malloc(out->count * sizeof *out->depth);
    out->centre = malloc(out->count * sizeof *out->centre);
    out->reach = malloc(out->count * sizeof *out->reach);
    return out->depth && out->centre && out->reach ? MS_OK
                                                   : ms_fail(err, MS_ERR_NOMEM, "no memory for the envelope of a body");
}

/* What is between body and envelope. */
static ms_status measure_between(double *volume, const ms_envelope_body *body, double radius, int cells, ms_error *err)
{
    envelope_cells c;
    ms_status status = open_cells(&c, body, radius, cells, err);
    *volume = 0;
    if (status == MS_OK) {
        find_own_centres(&c);
        share_centres(&c);
        move_centres(&c);
        share_centres(&c);
        for (size_t cell = 0; cell < c.count; cell++) {
            *volume += find_bridged(&c, cell) * c.h * c.h * c.h;
        }
    }
    free(c.depth);
    free(c.centre);
    free(c.reach);
    return status;
}

ms_status ms_envelope_compute(ms_envelope *out, const ms_envelope_body *body, double radius, ms_error *err)
{
    double coarse, fine;
    *out = (ms_envelope){0};
    ms_status status = measure_between(&coarse, body, radius, CELLS / 2, err);
    if (status == MS_OK) {
        status = measure_between(&fine, body, radius, CELLS, err);
    }
    if (status == MS_OK) {
        *out = (ms_envelope){body->volume + fine, 2 * fabs(fine - coarse)};
    }
    return status;
}

static ms_status compute_all(ms_envelope *out, const ms_envelope_body *body, const double *radius, size_t count,
                             ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t r = 0; r < count && status == MS_OK; r++) {
        status = ms_envelope_compute(&out[r], body, radius[r], err);
    }
    return status;
}

ms_status ms_envelope_clump(ms_envelope *out, double *volume, const ms_clump *clump, const double *radius, size_t count,
                            ms_error *err)
{
    double area;
    ms_envelope_body body = {.body = clump, .distance = distance_to_clump};
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_ARG, "a clump of no spheres has no envelope");
    }
    ms_clump_box(body.lo, body.hi, clump);
    const ms_status status = ms_union_measure(&body.volume, &area, clump, err);
    *volume = body.volume;
    return status == MS_OK ? compute_all(out, &body, radius, count, err) : status;
}

ms_status ms_envelope_mesh(ms_envelope *out, const ms_mesh *mesh, double volume, const double *radius, size_t count,
                           ms_error *err)
{
    ms_closest *closest;
    ms_status status = ms_closest_build(&closest, mesh, err);
    if (status == MS_OK) {
        ms_envelope_body body = {.body = closest, .volume = volume, .distance = distance_to_mesh};
        ms_mesh_box(body.lo, body.hi, mesh);
        status = compute_all(out, &body, radius, count, err);
        ms_closest_free(closest);
    }
    return status;
}
