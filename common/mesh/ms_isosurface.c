#include "ms_isosurface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An edge runs from its lower point to the one that differs from it by a direction: bits 0, 1, 2 are x, y, z. */
enum { DIRECTIONS = 7 };

/* Nearest that a corner comes to a point of the lattice, in edges. */
static const double LEAST = 1.0 / 64;

/* The mesh as it grows. */
typedef struct growth {
    const ms_isosurface *field;
    ms_mesh mesh;
    size_t vertices, triangles; /* room for them */
    uint32_t *corner[2];        /* of two layers of points in turn: the vertex on each edge */
} growth;

static size_t index_of(const ms_isosurface *f, const int at[3])
{
    return (size_t)at[0] + (size_t)f->n[0] * ((size_t)at[1] + (size_t)f->n[1] * (size_t)at[2]);
}

/* Doubles the room of an array; it stays as it is without memory. */
static ms_status double_room(void **array, size_t *room, size_t size, ms_error *err)
{
    const size_t more = 2 * *room + 1024;
    void *grown = more < UINT32_MAX ? realloc(*array, more * size) : NULL;
    if (!grown) {
        return more < UINT32_MAX ? ms_fail(err, MS_ERR_NOMEM, "no memory for a surface of %zu triangles", more)
                                 : ms_fail(err, MS_ERR_LIMIT, "a surface of this resolution has too many triangles");
    }
    *array = grown;
    *room = more;
    return MS_OK;
}

/* Where the surface cuts an edge, if it does. */
static ms_status cut_edge(growth *g, const int low[3], int direction, ms_error *err)
{
    const ms_isosurface *f = g->field;
    const int high[3] = {low[0] + (direction & 1), low[1] + (direction >> 1 & 1), low[2] + (direction >> 2)};
    if (high[0] == f->n[0] || high[1] == f->n[1] || high[2] == f->n[2]) {
        return MS_OK;
    }
    const int rises = f->inside[index_of(f, low)] != 0, ends = f->inside[index_of(f, high)] != 0;
    if (rises == ends) {
        return MS_OK;
    }
    if (g->mesh.n_vertices == g->vertices) {
        void *array = g->mesh.vertex;
        const ms_status status = double_room(&array, &g->vertices, sizeof *g->mesh.vertex, err);
        g->mesh.vertex = array;
        if (status != MS_OK) {
            return status;
        }
    }
    const int *from = rises ? low : high, *to = rises ? high : low;
    const double part = f->crossing ? f->crossing(f->context, from, to) : 0.5;
    const double t = fmin(1 - LEAST, fmax(LEAST, part));
    double *vertex = g->mesh.vertex[g->mesh.n_vertices];
    for (int k = 0; k < 3; k++) {
        vertex[k] = f->origin[k] + f->h * (from[k] + t * (to[k] - from[k]));
    }
    g->corner[low[2] % 2][((size_t)low[1] * (size_t)f->n[0] + (size_t)low[0]) * DIRECTIONS + (size_t)direction - 1] =
        (uint32_t)g->mesh.n_vertices++;
    return MS_OK;
}

static ms_status add_layer(growth *g, int k, ms_error *err)
{
    ms_status status = MS_OK;
    for (int j = 0; j < g->field->n[1]; j++) {
        for (int i = 0; i < g->field->n[0]; i++) {
            for (int direction = 1; direction <= DIRECTIONS && status == MS_OK; direction++) {
                status = cut_edge(g, (int[3]){i, j, k}, direction, err);
            }
        }
    }
    return status;
}

/* The vertex between two corners of the cube at a point, of which one has the bits of the other and more. */
static uint32_t find_vertex(const growth *g, const int cube[3], int a, int b)
{
    const int low = a & b, direction = a ^ b;
    const size_t row = (size_t)(cube[1] + (low >> 1 & 1)) * (size_t)g->field->n[0];
    const size_t at = row + (size_t)(cube[0] + (low & 1));
    return g->corner[(cube[2] + (low >> 2)) % 2][at * DIRECTIONS + (size_t)direction - 1];
}

static ms_status put_cut_triangle(growth *g, uint32_t a, uint32_t b, uint32_t c, int turned, ms_error *err)
{
    if (g->mesh.n_triangles == g->triangles) {
        void *array = g->mesh.triangle;
        const ms_status status = double_room(&array, &g->triangles, sizeof *g->mesh.triangle, err);
        g->mesh.triangle = array;
        if (status != MS_OK) {
            return status;
        }
    }
    uint32_t *corner = g->mesh.triangle[g->mesh.n_triangles++];
    corner[0] = a;
    corner[1] = turned ? c : b;
    corner[2] = turned ? b : c;
    return MS_OK;
}

/*
 * Even permutations of a tetrahedron's corners with those inside first (of three, the one outside first), by the mask
 * of those inside. In a right-handed one, the triangle across the edges from the first corner to the others then looks
 * away from it, and so does the quadrangle ac, ad, bd, bc from a and b.
 */
static const int ORDER[16][4] = {{0},          {0, 1, 2, 3}, {1, 0, 3, 2}, {0, 1, 2, 3}, {2, 3, 0, 1}, {0, 2, 3, 1},
                                 {1, 2, 0, 3}, {3, 2, 1, 0}, {3, 2, 1, 0}, {0, 3, 1, 2}, {1, 3, 2, 0}, {2, 3, 0, 1},
                                 {2, 3, 0, 1}, {1, 0, 3, 2}, {0, 1, 2, 3}, {0}};

/* @param corner of the cube @param turned nonzero: left-handed */
static ms_status cut_tetrahedron(growth *g, const int cube[3], const int corner[4], int mask, int turned, ms_error *err)
{
    const int *order = ORDER[mask], count = (mask & 1) + (mask >> 1 & 1) + (mask >> 2 & 1) + (mask >> 3);
    const int a = corner[order[0]], b = corner[order[1]], c = corner[order[2]], d = corner[order[3]];
    if (count == 0 || count == 4) {
        return MS_OK;
    }
    if (count != 2) {
        return put_cut_triangle(g, find_vertex(g, cube, a, b), find_vertex(g, cube, a, c), find_vertex(g, cube, a, d),
                                turned ^ (count == 3), err);
    }
    const uint32_t ac = find_vertex(g, cube, a, c), ad = find_vertex(g, cube, a, d);
    const uint32_t bd = find_vertex(g, cube, b, d), bc = find_vertex(g, cube, b, c);
    const ms_status status = put_cut_triangle(g, ac, ad, bd, turned, err);
    return status == MS_OK ? put_cut_triangle(g, ac, bd, bc, turned, err) : status;
}

/* A tetrahedron goes from corner 0 to corner 7 along the three axes in one of their six orders. */
static ms_status cut_cube(growth *g, const int cube[3], ms_error *err)
{
    static const int AXES[6][2] = {{0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}; /* odd orders from 3 on */
    ms_status status = MS_OK;
    int inside = 0;
    for (int corner = 0; corner < 8; corner++) {
        const int at[3] = {cube[0] + (corner & 1), cube[1] + (corner >> 1 & 1), cube[2] + (corner >> 2)};
        inside |= (g->field->inside[index_of(g->field, at)] != 0) << corner;
    }
    for (int way = 0; way < 6 && inside > 0 && inside < 255 && status == MS_OK; way++) {
        const int first = 1 << AXES[way][0], second = first | 1 << AXES[way][1];
        const int corner[4] = {0, first, second, 7};
        int mask = 0;
        for (int c = 0; c < 4; c++) {
            mask |= (inside >> corner[c] & 1) << c;
        }
        status = cut_tetrahedron(g, cube, corner, mask, way >= 3, err);
    }
    return status;
}

static ms_status build_layers(growth *g, ms_error *err)
{
    const int *n = g->field->n;
    ms_status status = add_layer(g, 0, err);
    for (int k = 0; k < n[2] - 1 && status == MS_OK; k++) {
        status = add_layer(g, k + 1, err);
        for (int j = 0; j < n[1] - 1; j++) {
            for (int i = 0; i < n[0] - 1 && status == MS_OK; i++) {
                status = cut_cube(g, (int[3]){i, j, k}, err);
            }
        }
    }
    return status;
}

ms_status ms_isosurface_build(ms_mesh *mesh, const ms_isosurface *field, ms_error *err)
{
    const size_t layer = (size_t)field->n[0] * (size_t)field->n[1] * DIRECTIONS * sizeof(uint32_t);
    growth g = {.field = field, .corner = {malloc(layer), malloc(layer)}};
    ms_status status =
        g.corner[0] && g.corner[1] ? build_layers(&g, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for a surface");
    if (status == MS_OK && g.mesh.n_triangles == 0) {
        status = ms_fail(err, MS_ERR_SHAPE, "no point of the lattice is inside; it takes smaller cells");
    }
    free(g.corner[0]);
    free(g.corner[1]);
    if (status != MS_OK) {
        ms_mesh_free(&g.mesh);
    }
    *mesh = g.mesh;
    return status;
}
