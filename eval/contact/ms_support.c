#include "ms_support.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

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

ms_status ms_support_from_mesh(ms_support *body, const ms_mesh *mesh, const double centre[3], ms_error *err)
{
    const ms_status status = alloc_body(body, mesh->n_vertices, err);
    for (size_t i = 0; i < body->count; i++) {
        put_sphere(&body->sphere[i], mesh->vertex[i], centre, 0);
    }
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
