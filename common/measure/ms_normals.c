#include "ms_normals.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "mesh/ms_mesh_sharp.h"
#include "voxel/ms_voxel_normal.h"

static const double BIN = 180.0 / MS_NORMALS_BINS;

ms_status ms_normals_open(ms_normals_shape *shape, const ms_target *target, double near, ms_error *err)
{
    *shape = (ms_normals_shape){.target = target, .near = near};
    if (!target->mesh) {
        return MS_OK;
    }
    ms_status status = ms_mesh_sharp_edges(&shape->edges, target->mesh, MS_NORMALS_SHARP, err);
    if (status == MS_OK && shape->edges.n_triangles > 0) {
        status = ms_closest_build(&shape->closest, &shape->edges, err);
    }
    if (status != MS_OK) {
        ms_normals_free(shape);
    }
    return status;
}

void ms_normals_free(ms_normals_shape *shape)
{
    ms_closest_free(shape->closest);
    ms_mesh_free(&shape->edges);
    *shape = (ms_normals_shape){0};
}

/* The voxel of the other kind that is nearest to a place, among those a number of steps along the longest axis from the
 * voxel that holds the place. */
typedef struct kind_search {
    const ms_grid *grid;
    const double *place; /* in voxels */
    int centre[3], kind; /* the voxel that holds it */
    double square;       /* of the distance to the nearest so far */
    int nearest[3];
} kind_search;

static void try_voxel(kind_search *s, int i, int j, int k)
{
    const double voxel[3] = {i, j, k}, square = ms_squared_distance(voxel, s->place);
    if (square < s->square && s->grid->inside[ms_grid_index(s->grid, i, j, k)] != s->kind) {
        s->square = square;
        s->nearest[0] = i;
        s->nearest[1] = j;
        s->nearest[2] = k;
    }
}

/* The surface of a cube, what of it is in the grid: whole rows on four of its faces, the ends of rows on the others. */
static void search_shell(kind_search *s, int reach)
{
    int lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = s->centre[a] - reach > 0 ? s->centre[a] - reach : 0;
        hi[a] = s->centre[a] + reach < s->grid->n[a] ? s->centre[a] + reach : s->grid->n[a] - 1;
    }
    for (int k = lo[2]; k <= hi[2]; k++) {
        for (int j = lo[1]; j <= hi[1]; j++) {
            const int whole = abs(k - s->centre[2]) == reach || abs(j - s->centre[1]) == reach;
            for (int i = whole ? lo[0] : s->centre[0] - reach; i <= hi[0]; i += whole ? 1 : 2 * reach) {
                if (i >= lo[0]) {
                    try_voxel(s, i, j, k);
                }
            }
        }
    }
}

/* How far off the other kind is at least, in steps along an axis: by the distance field, or beyond the border. */
static int find_first_reach(const ms_target *target, const kind_search *s)
{
    const ms_grid *grid = &target->grid;
    int reach = 1;
    if (s->kind) {
        const float away = target->distance[ms_grid_index(grid, s->centre[0], s->centre[1], s->centre[2])];
        reach = (int)((double)away / sqrt(3));
    }
    for (int a = 0; a < 3; a++) {
        reach = -s->centre[a] > reach ? -s->centre[a] : reach;
        reach = s->centre[a] - grid->n[a] >= reach ? s->centre[a] - grid->n[a] + 1 : reach;
    }
    return reach > 1 ? reach : 1;
}

/* To where the surface is, known to half a voxel. @param place in voxels, moved @return 0 without a surface */
static int step_to_surface(const ms_target *target, double place[3])
{
    static const double FARTHEST = 1e6; /* in voxels */
    const ms_grid *grid = &target->grid;
    kind_search s = {.grid = grid, .place = place, .square = HUGE_VAL};
    int in_grid = 1, most = 0;
    for (int a = 0; a < 3; a++) {
        if (!(fabs(place[a]) < FARTHEST)) {
            return 0;
        }
        s.centre[a] = (int)rint(place[a]);
        in_grid &= s.centre[a] >= 0 && s.centre[a] < grid->n[a];
        most = (int)fmax(most, fmax(abs(s.centre[a]), abs(s.centre[a] - grid->n[a])));
    }
    s.kind = in_grid && grid->inside[ms_grid_index(grid, s.centre[0], s.centre[1], s.centre[2])];
    for (int reach = find_first_reach(target, &s); reach <= most && s.square > (reach - 0.5) * (reach - 0.5); reach++) {
        search_shell(&s, reach);
    }
    const double away = sqrt(s.square);
    for (int a = 0; a < 3 && isfinite(away); a++) {
        place[a] += (s.nearest[a] - place[a]) * (away - 0.5) / away;
    }
    return isfinite(away);
}

/* Of voxels near a point. @return 0 if there is no surface to be found */
static int find_nearest_normal(double normal[3], const ms_target *target, const double point[3])
{
    double place[3];
    for (int a = 0; a < 3; a++) {
        place[a] = (point[a] - target->grid.origin[a]) / target->grid.h;
    }
    return step_to_surface(target, place) && ms_voxel_normal(normal, &target->grid, place);
}

double ms_normals_add(ms_normals_tally *tally, const ms_normals_shape *shape, const double point[3],
                      const double normal[3], uint64_t area)
{
    double own[3], distance = (double)NAN;
    int known = 1, near = 0;
    if (shape->target->mesh) {
        distance = ms_closest_signed_normal(own, shape->target->closest, point);
        near = shape->closest && ms_closest_distance(NULL, shape->closest, point, shape->near) < shape->near;
    } else {
        known = find_nearest_normal(own, shape->target, point);
    }
    const double length = sqrt(ms_dot(own, own));
    if (known && length > 0) {
        const double angle = MS_VECTOR_DEGREES * acos(fmax(-1, fmin(1, ms_dot(own, normal) / length)));
        const int bin = (int)(angle / BIN);
        tally->area[near][bin < MS_NORMALS_BINS ? bin : MS_NORMALS_BINS - 1] += area;
    }
    return distance;
}

void ms_normals_join(ms_normals_tally *tally, const ms_normals_tally *other)
{
    for (int near = 0; near < 2; near++) {
        for (int bin = 0; bin < MS_NORMALS_BINS; bin++) {
            tally->area[near][bin] += other->area[near][bin];
        }
    }
}

/* Within its bin the area is taken to be spread evenly. */
static double find_quantile(const uint64_t *area, double total, double part)
{
    double below = 0;
    for (int bin = 0; bin < MS_NORMALS_BINS; bin++) {
        const double here = (double)area[bin];
        if (here > 0 && below + here >= part * total) {
            return (bin + (part * total - below) / here) * BIN;
        }
        below += here;
    }
    return (double)NAN;
}

ms_normals ms_normals_read(const ms_normals_tally *tally)
{
    double total[2] = {0};
    for (int near = 0; near < 2; near++) {
        for (int bin = 0; bin < MS_NORMALS_BINS; bin++) {
            total[near] += (double)tally->area[near][bin];
        }
    }
    return (ms_normals){.median = find_quantile(tally->area[0], total[0], 0.5),
                        .most = find_quantile(tally->area[0], total[0], 0.95),
                        .edge_part = total[1] / (total[0] + total[1]),
                        .edge_median = find_quantile(tally->area[1], total[1], 0.5),
                        .edge_most = find_quantile(tally->area[1], total[1], 0.95)};
}
