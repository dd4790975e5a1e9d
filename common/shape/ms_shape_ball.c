#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "ms_shape_build.h"

/* Rings of the octahedral grid: ring m has 4m points (the pole, m = 0, has one); the northern
   rings run from the pole down to the equator m = n, the southern ones from m = n-1 on. */
static uint32_t ring_start(int n, int m, int south)
{
    uint32_t before = m == 0 ? 0 : (uint32_t)(1 + 2 * m * (m - 1));
    if (!south) {
        return before;
    }
    uint32_t size = m == 0 ? 1 : (uint32_t)(4 * m);
    return (uint32_t)(4 * n * n + 2) - before - size;
}

static uint32_t ring_point(int n, int m, int south, int q)
{
    return ring_start(n, m, south) + (m == 0 ? 0 : (uint32_t)(q % (4 * m)));
}

static void place_ring(ms_mesh *mesh, int n, int m, int south, const double *step)
{
    int points = m == 0 ? 1 : 4 * m;
    for (int q = 0; q < points; q++) {
        int side = m == 0 ? 0 : q / m;
        int along = m == 0 ? 0 : q % m;
        int across = m - along;
        double *v = mesh->vertex[ring_point(n, m, south, q)];
        double x = step[side % 2 ? along : across];
        double y = step[side % 2 ? across : along];
        v[0] = side == 1 || side == 2 ? 0.0 - x : x;
        v[1] = side >= 2 ? 0.0 - y : y;
        v[2] = south ? 0.0 - step[n - m] : step[n - m];
    }
}

static void put_triangle(uint32_t triangle[3], uint32_t a, uint32_t b, uint32_t c, int reversed)
{
    triangle[0] = a;
    triangle[1] = reversed ? c : b;
    triangle[2] = reversed ? b : c;
}

/* The triangles between ring m and the ring m - 1 nearer to its pole. */
static size_t join_rings(ms_mesh *mesh, size_t at, int n, int m, int south)
{
    for (int side = 0; side < 4; side++) {
        for (int along = 0; along < m; along++) {
            int outer = side * m + along;
            int inner = side * (m - 1) + along;
            uint32_t here = ring_point(n, m, south && m < n, outer);
            uint32_t next = ring_point(n, m, south && m < n, outer + 1);
            uint32_t above = ring_point(n, m - 1, south, inner);
            put_triangle(mesh->triangle[at++], here, next, above, south);
            if (along + 1 < m) {
                put_triangle(mesh->triangle[at++], next, ring_point(n, m - 1, south, inner + 1), above, south);
            }
        }
    }
    return at;
}

/*
 * The lattice points with |i| + |j| + |k| = n, each placed at (sign i step[|i|], sign j step[|j|], sign k step[|k|]);
 * 8 n^2 triangles. All 48 symmetries of the cube are exact. `step` has n + 1 values from step[0] = 0 up; on failure the
 * mesh is empty.
 */
static ms_status make_octahedral_grid(ms_mesh *mesh, int n, const double *step, ms_error *err)
{
    size_t squared = (size_t)n * (size_t)n;
    ms_status status = ms_mesh_alloc(mesh, 4 * squared + 2, 8 * squared, err);
    if (status != MS_OK) {
        return status;
    }
    size_t at = 0;
    for (int south = 0; south < 2; south++) {
        for (int m = 0; m <= n - south; m++) {
            place_ring(mesh, n, m, south, step);
        }
        for (int m = 1; m <= n; m++) {
            at = join_rings(mesh, at, n, m, south);
        }
    }
    return MS_OK;
}

/* The squares are added in order of size, so that the sum does not depend on the order of
   the axes and the diagonal mirror planes hold to the bit. */
static double length_of(const double v[3])
{
    double a = v[0] * v[0];
    double b = v[1] * v[1];
    double c = v[2] * v[2];
    double low = fmin(a, fmin(b, c));
    double high = fmax(a, fmax(b, c));
    double middle = fmax(fmin(a, b), fmin(fmax(a, b), c));
    return sqrt(low + middle + high);
}

ms_status ms_shape_unit_ball(ms_mesh *mesh, int n, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double *step = malloc(((size_t)n + 1) * sizeof *step);
    if (!step) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a ball of fineness %d; use a smaller one", n);
    }
    /* Sines instead of equal steps: the lines x = 0, y = 0, z = 0 are then cut evenly and the
       triangles nearly alike in size. */
    for (int i = 0; i <= n; i++) {
        step[i] = sin(M_PI_2 * i / n);
    }
    ms_status status = make_octahedral_grid(mesh, n, step, err);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double length = length_of(mesh->vertex[v]);
        for (int axis = 0; axis < 3; axis++) {
            mesh->vertex[v][axis] /= length;
        }
    }
    free(step);
    return status;
}

void ms_shape_scale(ms_mesh *mesh, double x, double y, double z)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        mesh->vertex[v][0] *= x;
        mesh->vertex[v][1] *= y;
        mesh->vertex[v][2] *= z;
    }
}

/* value: r, fineness */
ms_status ms_shape_ball(ms_mesh *mesh, const double *value, ms_error *err)
{
    ms_status status = ms_shape_unit_ball(mesh, (int)value[1], err);
    ms_shape_scale(mesh, value[0], value[0], value[0]);
    return status;
}

double ms_shape_ball_volume(const double *value)
{
    return 4.0 / 3.0 * M_PI * gsl_pow_3(value[0]);
}

/* value: a, b, c, fineness */
ms_status ms_shape_ellipsoid(ms_mesh *mesh, const double *value, ms_error *err)
{
    ms_status status = ms_shape_unit_ball(mesh, (int)value[3], err);
    ms_shape_scale(mesh, value[0], value[1], value[2]);
    return status;
}

double ms_shape_ellipsoid_volume(const double *value)
{
    return 4.0 / 3.0 * M_PI * value[0] * value[1] * value[2];
}

/* Puts a mesh behind what is in the arrays, which have room for it. */
static void append_mesh(ms_mesh *mesh, const ms_mesh *part, int reversed)
{
    size_t v0 = mesh->n_vertices;
    size_t t0 = mesh->n_triangles;
    for (size_t v = 0; v < part->n_vertices; v++) {
        for (int axis = 0; axis < 3; axis++) {
            mesh->vertex[v0 + v][axis] = part->vertex[v][axis];
        }
    }
    for (size_t t = 0; t < part->n_triangles; t++) {
        const uint32_t *corner = part->triangle[t];
        put_triangle(mesh->triangle[t0 + t], corner[0] + (uint32_t)v0, corner[1] + (uint32_t)v0,
                     corner[2] + (uint32_t)v0, reversed);
    }
    mesh->n_vertices += part->n_vertices;
    mesh->n_triangles += part->n_triangles;
}

/* value: R, r, fineness */
ms_status ms_shape_hollow(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    if (value[1] >= value[0]) {
        return ms_fail(err, MS_ERR_ARG, "the cavity's radius r = %g must be below the ball's radius R = %g", value[1],
                       value[0]);
    }
    ms_mesh ball = {0};
    ms_status status = ms_shape_unit_ball(&ball, (int)value[2], err);
    if (status == MS_OK) {
        status = ms_mesh_alloc(mesh, 2 * ball.n_vertices, 2 * ball.n_triangles, err);
    }
    if (status == MS_OK) {
        mesh->n_vertices = mesh->n_triangles = 0;
        append_mesh(mesh, &ball, 0);
        ms_shape_scale(mesh, value[0], value[0], value[0]);
        ms_shape_scale(&ball, value[1], value[1], value[1]);
        append_mesh(mesh, &ball, 1);
    }
    ms_mesh_free(&ball);
    return status;
}

double ms_shape_hollow_volume(const double *value)
{
    return 4.0 / 3.0 * M_PI * (gsl_pow_3(value[0]) - gsl_pow_3(value[1]));
}

/* value: a, fineness */
ms_status ms_shape_octahedron(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    int n = (int)value[1];
    double *step = malloc(((size_t)n + 1) * sizeof *step);
    if (!step) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for an octahedron of fineness %d; use a smaller one", n);
    }
    for (int i = 0; i <= n; i++) {
        step[i] = value[0] * ((double)i / n);
    }
    ms_status status = make_octahedral_grid(mesh, n, step, err);
    free(step);
    return status;
}

double ms_shape_octahedron_volume(const double *value)
{
    return 4.0 / 3.0 * gsl_pow_3(value[0]);
}
