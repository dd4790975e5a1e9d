#include "ms_normals.h"

#include <math.h>
#include <string.h>

#include "base/ms_vector.h"
#include "mesh/ms_mesh_sharp.h"
#include "voxel/ms_voxel_normal.h"

static const double DEGREES = 57.295779513082321, BIN = 180.0 / MS_NORMALS_BINS;

ms_status ms_normals_open(ms_normals_shape *shape, const ms_target *target, double near, ms_error *err)
{
    *shape = (ms_normals_shape){.target = target, .near = near};
    if (!target->mesh) {
        return ms_signed_distance_open(&shape->field, target, 1, err);
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

/* Down the slope of the distance, which voxels know to half a voxel. @param place in voxels, moved */
static void step_to_surface(const ms_signed_distance *field, double place[3])
{
    double slope[3], from[3];
    const double phi = ms_signed_distance_at(field, place);
    memcpy(from, place, sizeof from);
    for (int a = 0; a < 3; a++) {
        double beside[3] = {from[0], from[1], from[2]};
        beside[a] = from[a] + 1;
        slope[a] = ms_signed_distance_at(field, beside);
        beside[a] = from[a] - 1;
        slope[a] -= ms_signed_distance_at(field, beside);
    }
    const double length = sqrt(ms_dot(slope, slope));
    for (int a = 0; a < 3 && length > 0; a++) {
        place[a] = from[a] - phi * slope[a] / length;
    }
}

/* Of voxels near a point. @return 0 if there is no surface to be found */
static int find_nearest_normal(double normal[3], const ms_normals_shape *shape, const double point[3])
{
    enum { STEPS = 3 }; /* near ridges of the distance the first goes astray */
    const ms_grid *grid = &shape->target->grid;
    double place[3];
    for (int a = 0; a < 3; a++) {
        place[a] = (point[a] - grid->origin[a]) / grid->h;
    }
    for (int step = 0; step < STEPS; step++) {
        step_to_surface(&shape->field, place);
    }
    return ms_voxel_normal(normal, grid, place);
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
        known = find_nearest_normal(own, shape, point);
    }
    const double length = sqrt(ms_dot(own, own));
    if (known && length > 0) {
        const double angle = DEGREES * acos(fmax(-1, fmin(1, ms_dot(own, normal) / length)));
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
