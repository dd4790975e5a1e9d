#include "ms_support.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "mesh/ms_hull.h"
#include "voxel/ms_grid_hull.h"

static ms_status alloc_body(ms_support *body, size_t count, ms_error *err)
{
    *body = (ms_support){0};
    if (count == 0) {
        return ms_fail(err, MS_ERR_ARG, "a body of no spheres and no vertices touches nothing");
    }
    body->sphere = malloc(count * sizeof *body->sphere);
    if (!body->sphere) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the %zu spheres of a body", count);
    }
    body->count = count;
    return MS_OK;
}

static void put_sphere(ms_sphere *to, const double at[3], const double centre[3], double radius)
{
    for (int k = 0; k < 3; k++) {
        to->centre[k] = at[k] - centre[k];
    }
    to->radius = radius;
}

ms_status ms_support_from_clump(ms_support *body, const ms_clump *clump, const double centre[3], ms_error *err)
{
    const ms_status status = alloc_body(body, clump->n_spheres, err);
    for (size_t i = 0; i < body->count; i++) {
        put_sphere(&body->sphere[i], clump->sphere[i].centre, centre, clump->sphere[i].radius);
    }
    return status;
}

static ms_status take_vertices(ms_support *body, const ms_mesh *mesh, const double centre[3], ms_error *err)
{
    const ms_status status = alloc_body(body, mesh->n_vertices, err);
    for (size_t i = 0; i < body->count; i++) {
        put_sphere(&body->sphere[i], mesh->vertex[i], centre, 0);
    }
    return status;
}

ms_status ms_support_from_mesh(ms_support *body, const ms_mesh *mesh, const double centre[3], ms_error *err)
{
    ms_mesh hull;
    *body = (ms_support){0};
    if (!ms_hull_is_built() || mesh->n_vertices == 0) {
        return take_vertices(body, mesh, centre, err);
    }
    ms_status status = ms_hull_build(&hull, (const double(*)[3])mesh->vertex, mesh->n_vertices, err);
    if (status == MS_OK) {
        status = take_vertices(body, &hull, centre, err);
    }
    ms_mesh_free(&hull);
    return status;
}

ms_status ms_support_from_grid(ms_support *body, const ms_grid *grid, const double centre[3], ms_error *err)
{
    ms_mesh centres, faces;
    ms_status status = ms_grid_hull_build(&centres, &faces, grid, err);
    status = status == MS_ERR_SHAPE && faces.n_vertices ? MS_OK : status; /* flat: no hull of the centres */
    for (size_t v = 0; status == MS_OK && v < faces.n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            faces.vertex[v][k] = grid->origin[k] + grid->h * faces.vertex[v][k];
        }
    }
    *body = (ms_support){0};
    if (status == MS_OK) {
        status = take_vertices(body, &faces, centre, err);
    }
    ms_mesh_free(&centres);
    ms_mesh_free(&faces);
    return status;
}

double ms_support_height(const ms_support *body, const double u[3])
{
    double height = -(double)INFINITY;
    for (size_t i = 0; i < body->count; i++) {
        height = fmax(height, ms_dot(body->sphere[i].centre, u) + body->sphere[i].radius);
    }
    return height;
}

void ms_support_free(ms_support *body)
{
    if (body) {
        free(body->sphere);
        *body = (ms_support){0};
    }
}
