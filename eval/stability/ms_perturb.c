#include "ms_perturb.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* Must be freed by gsl_rng_free; NULL without memory. */
static gsl_rng *make_random(uint64_t seed, ms_error *err)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    if (random) {
        gsl_rng_set(random, (unsigned long)seed);
    } else {
        ms_fail(err, MS_ERR_NOMEM, "no memory for random numbers");
    }
    return random;
}

ms_motion ms_perturb_motion_none(void)
{
    return (ms_motion){.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

ms_motion ms_perturb_motion_axis_turn(int which)
{
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const int *to = order[which / 4];
    const double parity = which < 12 ? 1 : -1; /* the last three orders swap two axes */
    const double x = which & 1 ? -1 : 1, y = which & 2 ? -1 : 1;
    ms_motion motion = {0};
    motion.turn[0][to[0]] = x;
    motion.turn[1][to[1]] = y;
    motion.turn[2][to[2]] = x * y * parity;
    return motion;
}

ms_status ms_perturb_motion_random_turn(ms_motion *motion, uint64_t seed, ms_error *err)
{
    double q[4];
    gsl_rng *random = make_random(seed, err);
    *motion = ms_perturb_motion_none();
    if (!random) {
        return MS_ERR_NOMEM;
    }
    gsl_ran_dir_nd(random, 4, q);
    gsl_rng_free(random);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(motion->turn, turn, sizeof turn);
    return MS_OK;
}

void ms_perturb_motion_apply(ms_mesh *mesh, const ms_motion *motion)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double *p = mesh->vertex[v], moved[3];
        for (int a = 0; a < 3; a++) {
            moved[a] = ms_dot(motion->turn[a], p) + motion->shift[a];
        }
        memcpy(p, moved, sizeof moved);
    }
}

void ms_perturb_motion_undo(ms_clump *clump, const ms_motion *motion)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        double *p = clump->sphere[s].centre, moved[3];
        for (int a = 0; a < 3; a++) {
            moved[a] = p[a] - motion->shift[a];
        }
        for (int a = 0; a < 3; a++) {
            p[a] = motion->turn[0][a] * moved[0] + motion->turn[1][a] * moved[1] + motion->turn[2][a] * moved[2];
        }
    }
}

ms_status ms_perturb_copy(ms_mesh *out, const ms_mesh *mesh, ms_error *err)
{
    ms_status status = ms_mesh_alloc(out, mesh->n_vertices, mesh->n_triangles, err);
    if (status == MS_OK) {
        memcpy(out->vertex, mesh->vertex, mesh->n_vertices * sizeof *mesh->vertex);
        memcpy(out->triangle, mesh->triangle, mesh->n_triangles * sizeof *mesh->triangle);
    }
    return status;
}

/* Of each vertex the sum of its triangles' normals, each as long as twice the area. */
static void sum_normals(double (*normal)[3], const ms_mesh *mesh)
{
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *corner = mesh->triangle[t];
        double u[3], w[3], n[3];
        for (int a = 0; a < 3; a++) {
            u[a] = mesh->vertex[corner[1]][a] - mesh->vertex[corner[0]][a];
            w[a] = mesh->vertex[corner[2]][a] - mesh->vertex[corner[0]][a];
        }
        ms_cross(n, u, w);
        for (int c = 0; c < 3; c++) {
            for (int a = 0; a < 3; a++) {
                normal[corner[c]][a] += n[a];
            }
        }
    }
}

ms_status ms_perturb_noise(ms_mesh *mesh, double amplitude, uint64_t seed, ms_error *err)
{
    double(*normal)[3] = calloc(mesh->n_vertices, sizeof *normal);
    gsl_rng *random = normal ? make_random(seed, err) : NULL;
    if (!random) {
        free(normal);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the normals of %zu vertices", mesh->n_vertices);
    }
    sum_normals(normal, mesh);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        const double by = amplitude * (2 * gsl_rng_uniform(random) - 1);
        const double length = sqrt(ms_dot(normal[v], normal[v]));
        for (int a = 0; a < 3 && length > 0; a++) {
            mesh->vertex[v][a] += by * (normal[v][a] / length);
        }
    }
    gsl_rng_free(random);
    free(normal);
    return MS_OK;
}

/* A side of a triangle: its ends, the lower first, and where its middle is to be written. */
typedef struct triangle_side {
    uint32_t end[2];
    uint64_t at; /* 3 * triangle + side */
} triangle_side;

static int compare_sides(const void *a, const void *b)
{
    const triangle_side *p = a, *q = b;
    for (int e = 0; e < 2; e++) {
        if (p->end[e] != q->end[e]) {
            return p->end[e] < q->end[e] ? -1 : 1;
        }
    }
    return p->at < q->at ? -1 : p->at > q->at;
}

/* Numbers the edges: middle[3 t + k] is that of the side behind corner k of triangle t. @return how many */
static size_t number_edges(uint32_t *middle, triangle_side *sides, const ms_mesh *mesh)
{
    size_t count = 0;
    const size_t n = 3 * mesh->n_triangles;
    for (size_t s = 0; s < n; s++) {
        const uint32_t a = mesh->triangle[s / 3][s % 3], b = mesh->triangle[s / 3][(s + 1) % 3];
        sides[s] = (triangle_side){{a < b ? a : b, a < b ? b : a}, s};
    }
    qsort(sides, n, sizeof *sides, compare_sides);
    for (size_t s = 0; s < n; s++) {
        count += s == 0 || memcmp(sides[s].end, sides[s - 1].end, sizeof sides[s].end) != 0;
        middle[sides[s].at] = (uint32_t)(count - 1);
    }
    return count;
}

static void cut_in_four(ms_mesh *out, const ms_mesh *mesh, const uint32_t *middle)
{
    const uint32_t first = (uint32_t)mesh->n_vertices;
    memcpy(out->vertex, mesh->vertex, mesh->n_vertices * sizeof *mesh->vertex);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle[t];
        uint32_t m[3];
        for (int k = 0; k < 3; k++) {
            const double *p = mesh->vertex[c[k]], *q = mesh->vertex[c[(k + 1) % 3]];
            m[k] = first + middle[3 * t + k];
            for (int a = 0; a < 3; a++) {
                out->vertex[m[k]][a] = 0.5 * p[a] + 0.5 * q[a];
            }
        }
        const uint32_t four[4][3] = {{c[0], m[0], m[2]}, {c[1], m[1], m[0]}, {c[2], m[2], m[1]}, {m[0], m[1], m[2]}};
        memcpy(out->triangle[4 * t], four, sizeof four);
    }
}

ms_status ms_perturb_refine(ms_mesh *out, const ms_mesh *mesh, ms_error *err)
{
    const size_t n = 3 * mesh->n_triangles;
    *out = (ms_mesh){0};
    if (n > UINT32_MAX - mesh->n_vertices) {
        return ms_fail(err, MS_ERR_LIMIT, "%zu triangles are too many to be cut in four", mesh->n_triangles);
    }
    triangle_side *sides = malloc(n * sizeof *sides);
    uint32_t *middle = malloc(n * sizeof *middle);
    ms_status status = sides && middle
                           ? MS_OK
                           : ms_fail(err, MS_ERR_NOMEM, "no memory for the edges of %zu triangles", mesh->n_triangles);
    if (status == MS_OK) {
        const size_t edges = number_edges(middle, sides, mesh);
        status = ms_mesh_alloc(out, mesh->n_vertices + edges, 4 * mesh->n_triangles, err);
    }
    if (status == MS_OK) {
        cut_in_four(out, mesh, middle);
    }
    free(sides);
    free(middle);
    return status;
}

/* The cell of a vertex. */
typedef struct vertex_cell {
    double cell[3];
    uint32_t vertex;
} vertex_cell;

static int compare_places(const void *a, const void *b)
{
    const vertex_cell *p = a, *q = b;
    for (int k = 0; k < 3; k++) {
        if (p->cell[k] != q->cell[k]) {
            return p->cell[k] < q->cell[k] ? -1 : 1;
        }
    }
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

/* Puts the mean of each cell's vertices in the place of its first one and tells the others where. */
static void join_vertices(ms_mesh *mesh, uint32_t *joined, vertex_cell *places, double cell)
{
    const size_t n = mesh->n_vertices;
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    for (size_t v = 0; v < n; v++) {
        places[v].vertex = (uint32_t)v;
        for (int a = 0; a < 3; a++) {
            places[v].cell[a] = floor((mesh->vertex[v][a] - (lo[a] + 0.5 * (hi[a] - lo[a]))) / cell) + 0.0; /* no -0 */
        }
    }
    qsort(places, n, sizeof *places, compare_places);
    for (size_t from = 0, to; from < n; from = to) {
        double sum[3] = {0};
        for (to = from; to < n && memcmp(places[to].cell, places[from].cell, sizeof places[to].cell) == 0; to++) {
            joined[places[to].vertex] = places[from].vertex;
            for (int a = 0; a < 3; a++) {
                sum[a] += mesh->vertex[places[to].vertex][a];
            }
        }
        for (int a = 0; a < 3; a++) {
            mesh->vertex[places[from].vertex][a] = sum[a] / (double)(to - from);
        }
    }
}

ms_status ms_perturb_decimate(ms_mesh *out, ms_mesh_report *report, const ms_mesh *mesh, double cell, ms_error *err)
{
    *out = (ms_mesh){0};
    *report = (ms_mesh_report){0};
    if (!(cell > 0) || !isfinite(cell)) {
        return ms_fail(err, MS_ERR_ARG, "vertices cannot be put together in cells of %g", cell);
    }
    vertex_cell *places = malloc(mesh->n_vertices * sizeof *places);
    uint32_t *joined = malloc(mesh->n_vertices * sizeof *joined);
    ms_status status = places && joined
                           ? ms_perturb_copy(out, mesh, err)
                           : ms_fail(err, MS_ERR_NOMEM, "no memory for the cells of %zu vertices", mesh->n_vertices);
    if (status == MS_OK) {
        join_vertices(out, joined, places, cell);
        for (size_t k = 0; k < 3 * out->n_triangles; k++) {
            uint32_t *corner = &out->triangle[k / 3][k % 3];
            *corner = joined[*corner];
        }
        status = ms_mesh_repair(out, report, err);
    }
    if (status != MS_OK) {
        ms_mesh_free(out);
    }
    free(places);
    free(joined);
    return status;
}

/* Vertex v moves to to[v]. */
static void reorder_mesh(ms_mesh *out, const ms_mesh *mesh, const uint32_t *to, gsl_rng *random)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        memcpy(out->vertex[to[v]], mesh->vertex[v], sizeof *mesh->vertex);
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const unsigned long first = gsl_rng_uniform_int(random, 3);
        for (unsigned long k = 0; k < 3; k++) {
            out->triangle[t][k] = to[mesh->triangle[t][(first + k) % 3]];
        }
    }
    gsl_ran_shuffle(random, out->triangle, out->n_triangles, sizeof *out->triangle);
}

ms_status ms_perturb_order(ms_mesh *mesh, uint64_t seed, ms_error *err)
{
    ms_mesh out = {0};
    uint32_t *to = malloc(mesh->n_vertices * sizeof *to);
    gsl_rng *random = to ? make_random(seed, err) : NULL;
    ms_status status = random ? ms_mesh_alloc(&out, mesh->n_vertices, mesh->n_triangles, err)
                              : ms_fail(err, MS_ERR_NOMEM, "no memory to reorder %zu vertices", mesh->n_vertices);
    if (status == MS_OK) {
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            to[v] = (uint32_t)v;
        }
        gsl_ran_shuffle(random, to, mesh->n_vertices, sizeof *to);
        reorder_mesh(&out, mesh, to, random);
        ms_mesh_free(mesh);
        *mesh = out;
    }
    if (random) {
        gsl_rng_free(random);
    }
    free(to);
    return status;
}

ms_status ms_perturb_open(ms_mesh *mesh, double part, uint64_t seed, ms_error *err)
{
    gsl_rng *random = make_random(seed, err);
    if (!random) {
        return MS_ERR_NOMEM;
    }
    const double most = (double)mesh->n_triangles - 1;
    const size_t holes = (size_t)fmax(0, fmin(most, fmax(1, round(part * (double)mesh->n_triangles))));
    gsl_ran_shuffle(random, mesh->triangle, mesh->n_triangles, sizeof *mesh->triangle);
    mesh->n_triangles -= holes;
    gsl_rng_free(random);
    return MS_OK;
}
