#include "ms_directions.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "shape/ms_shape.h"

static const double PI = 3.14159265358979323846;

static ms_status make_ball(ms_mesh *mesh, int fineness, ms_error *err)
{
    const ms_shape_kind *ball = ms_shape_find("ball", err);
    const double value[] = {1, fineness}; /* r, fineness */
    return ms_shape_make(mesh, ball, value, err);
}

/* A third of each triangle, as large as it is flat: to the spacing squared. */
static void weigh(ms_directions *d)
{
    double sum = 0;
    for (size_t t = 0; t < d->mesh.n_triangles; t++) {
        const uint32_t *corner = d->mesh.triangle[t];
        double normal[3];
        ms_vector_triangle(normal, d->u[corner[0]], d->u[corner[1]], d->u[corner[2]]);
        const double area = sqrt(ms_dot(normal, normal));
        for (int k = 0; k < 3; k++) {
            d->weight[corner[k]] += area;
        }
        sum += 3 * area;
    }
    for (size_t i = 0; i < d->count; i++) {
        d->weight[i] /= sum;
    }
}

/* Around a vertex of a closed mesh each triangle has one side that leaves it, and so has each neighbour. */
static void link(ms_directions *d)
{
    for (size_t t = 0; t < d->mesh.n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            d->start[d->mesh.triangle[t][k] + 1]++;
        }
    }
    for (size_t i = 0; i < d->count; i++) {
        d->start[i + 1] += d->start[i];
    }
    for (size_t t = d->mesh.n_triangles; t-- > 0;) {
        for (int k = 0; k < 3; k++) {
            d->next[--d->start[d->mesh.triangle[t][k] + 1]] = d->mesh.triangle[t][(k + 1) % 3];
        }
    }
    for (size_t i = 0; i < d->count; i++) { /* each stands at its own beginning now, one place too far */
        d->start[i] = d->start[i + 1];
    }
    d->start[d->count] = (uint32_t)(3 * d->mesh.n_triangles);
}

ms_status ms_directions_make(ms_directions *directions, int fineness, ms_error *err)
{
    ms_directions d = {.spacing = PI / 2 / fineness};
    ms_status status = make_ball(&d.mesh, fineness, err);
    if (status == MS_OK) {
        d.count = d.mesh.n_vertices;
        d.u = d.mesh.vertex;
        d.weight = calloc(d.count, sizeof *d.weight);
        d.start = calloc(d.count + 1, sizeof *d.start);
        d.next = malloc(3 * d.mesh.n_triangles * sizeof *d.next);
        if (!d.weight || !d.start || !d.next) {
            status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu directions", d.count);
        }
    }
    if (status == MS_OK) {
        weigh(&d);
        link(&d);
        *directions = d;
        return MS_OK;
    }
    ms_directions_free(&d);
    *directions = d;
    return status;
}

void ms_directions_free(ms_directions *directions)
{
    if (directions) {
        free(directions->weight);
        free(directions->start);
        free(directions->next);
        ms_mesh_free(&directions->mesh);
        *directions = (ms_directions){0};
    }
}

void ms_directions_tangents(double one[3], double other[3], const double u[3])
{
    const int least = fabs(u[0]) <= fabs(u[1]) && fabs(u[0]) <= fabs(u[2]) ? 0 : fabs(u[1]) <= fabs(u[2]) ? 1 : 2;
    double axis[3] = {0};
    axis[least] = 1;
    ms_cross(one, u, axis);
    const double length = sqrt(ms_dot(one, one));
    for (int k = 0; k < 3; k++) {
        one[k] /= length;
    }
    ms_cross(other, u, one);
}
