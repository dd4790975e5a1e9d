/** Meshes for tests: the kinds of ms_shape, put together, turned, spoilt. */
#ifndef BODY_SAMPLES_H
#define BODY_SAMPLES_H

#include <math.h>

#include "mesh/ms_inertia.h"
#include "mesh/ms_mesh.h"
#include "reader_samples.h"
#include "shape/ms_shape.h"

static const double pi = 3.14159265358979323846;

static inline void expect_close(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance)) {
        fail_msg("%.17g is not within %g of %.17g", got, tolerance, expected);
    }
}

static inline void default_values(double value[MS_SHAPE_MAX_PARAMETERS], const ms_shape_kind *kind)
{
    for (int k = 0; kind->parameters[k].name; k++) {
        assert_true(k < MS_SHAPE_MAX_PARAMETERS);
        value[k] = kind->parameters[k].fallback;
    }
}

/** Where a kind has its parameter fineness. */
static inline int fineness_at(const ms_shape_kind *kind)
{
    int at = 0;
    while (strcmp(kind->parameters[at].name, "fineness") != 0) {
        at++;
    }
    return at;
}

static inline ms_mesh make_body(const char *name, const double *value)
{
    ms_mesh mesh = {0};
    ms_error err = {{0}};
    const ms_shape_kind *kind = ms_shape_find(name, &err);
    if (!kind || ms_shape_make(&mesh, kind, value, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return mesh;
}

static inline void move_body(ms_mesh *mesh, double x, double y, double z)
{
    const double by[3] = {x, y, z};
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            mesh->vertex[v][k] += by[k];
        }
    }
}

static inline void reverse_triangle(ms_mesh *mesh, size_t t)
{
    uint32_t swap = mesh->triangle[t][0];
    mesh->triangle[t][0] = mesh->triangle[t][1];
    mesh->triangle[t][1] = swap;
}

static inline void reverse_all(ms_mesh *mesh)
{
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        reverse_triangle(mesh, t);
    }
}

/** A repeatable number in 0 to 1. */
static inline double next_uniform(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11) / 9007199254740992.0;
}

/** Reverses about half of the triangles; returns how many. */
static inline size_t reverse_some(ms_mesh *mesh, uint64_t seed)
{
    size_t reversed = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        if (next_uniform(&seed) < 0.5) {
            reverse_triangle(mesh, t);
            reversed++;
        }
    }
    return reversed;
}

/** Puts `part` behind the triangles of `mesh` and frees it. */
static inline void add_part(ms_mesh *mesh, ms_mesh part)
{
    size_t v0 = mesh->n_vertices;
    size_t t0 = mesh->n_triangles;
    ms_mesh whole;
    assert_int_equal(ms_mesh_alloc(&whole, v0 + part.n_vertices, t0 + part.n_triangles, NULL), MS_OK);
    if (t0 > 0) {
        memcpy(whole.vertex, mesh->vertex, v0 * sizeof *whole.vertex);
        memcpy(whole.triangle, mesh->triangle, t0 * sizeof *whole.triangle);
    }
    memcpy(whole.vertex + v0, part.vertex, part.n_vertices * sizeof *whole.vertex);
    for (size_t t = 0; t < part.n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            whole.triangle[t0 + t][k] = part.triangle[t][k] + (uint32_t)v0;
        }
    }
    ms_mesh_free(mesh);
    ms_mesh_free(&part);
    *mesh = whole;
}

static inline void add_triangle(ms_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    mesh->triangle = realloc(mesh->triangle, (mesh->n_triangles + 1) * sizeof *mesh->triangle);
    assert_non_null(mesh->triangle);
    const uint32_t corner[3] = {a, b, c};
    memcpy(mesh->triangle[mesh->n_triangles++], corner, sizeof corner);
}

static inline uint32_t add_vertex(ms_mesh *mesh, double x, double y, double z)
{
    mesh->vertex = realloc(mesh->vertex, (mesh->n_vertices + 1) * sizeof *mesh->vertex);
    assert_non_null(mesh->vertex);
    const double at[3] = {x, y, z};
    memcpy(mesh->vertex[mesh->n_vertices++], at, sizeof at);
    return (uint32_t)(mesh->n_vertices - 1);
}

/** Cube with the corners 0 and 1: vertex 4x + 2y + z, twelve triangles. */
static inline ms_mesh unit_cube(void)
{
    static const uint32_t quad[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                        {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    ms_mesh mesh;
    assert_int_equal(ms_mesh_alloc(&mesh, 8, 12, NULL), MS_OK);
    for (int v = 0; v < 8; v++) {
        mesh.vertex[v][0] = v >> 2;
        mesh.vertex[v][1] = v >> 1 & 1;
        mesh.vertex[v][2] = v & 1;
    }
    for (int t = 0; t < 12; t++) {
        for (int k = 0; k < 3; k++) {
            mesh.triangle[t][k] = quad[t / 2][k == 0 ? 0 : t % 2 + k];
        }
    }
    return mesh;
}

/** Joins vertices of equal coordinates; for small meshes. */
static inline void weld_body(ms_mesh *mesh)
{
    for (size_t k = 0; k < 3 * mesh->n_triangles; k++) {
        uint32_t *corner = &mesh->triangle[k / 3][k % 3];
        uint32_t first = 0;
        while (memcmp(mesh->vertex[first], mesh->vertex[*corner], sizeof *mesh->vertex) != 0) {
            first++;
        }
        *corner = first;
    }
}

static inline ms_mesh_report repair_body(ms_mesh *mesh)
{
    ms_mesh_report report;
    ms_error err = {{0}};
    if (ms_mesh_repair(mesh, &report, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return report;
}

static inline ms_body body_of(const ms_mesh *mesh)
{
    ms_body body;
    ms_error err = {{0}};
    if (ms_inertia_mesh(&body, mesh, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return body;
}

static inline double volume_of(const ms_mesh *mesh)
{
    return body_of(mesh).volume;
}

/** A closed mesh with so many shells, cavities and turned triangles. */
static inline void expect_report(const ms_mesh_report *r, size_t shells, size_t cavities, size_t flipped)
{
    assert_true(r->closed);
    assert_int_equal(r->odd_edges, 0);
    assert_int_equal(r->shells, shells);
    assert_int_equal(r->cavities, cavities);
    assert_int_equal(r->bodies, shells - cavities);
    assert_int_equal(r->flipped, flipped);
}

#endif
