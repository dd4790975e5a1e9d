#include "ms_expect_points.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "mesh/ms_inertia.h"

/* Triangles that bend by less belong to one smooth surface: cosine of 30 degrees. */
static const double CREASE = 0.8660254037844387;
/* A ball may stick out by this part of its radius. From 0.05 to 0.3 the figures are the same. */
static const double TOLERANCE = 0.2;

/* A triangle by where it stands on the curve. */
typedef struct curve_place {
    uint64_t key;
    uint32_t triangle;
} curve_place;

static int compare_cells(const void *a, const void *b)
{
    const curve_place *p = a, *q = b;
    return p->key != q->key ? (p->key > q->key) - (p->key < q->key)
                            : (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* Twenty bits with two zeros behind each. */
static uint64_t spread_bits(uint64_t bits)
{
    bits = (bits | bits << 32) & 0x1f00000000ffffU;
    bits = (bits | bits << 16) & 0x1f0000ff0000ffU;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fU;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3U;
    return (bits | bits << 2) & 0x1249249249249249U;
}

/* Triangles in Morton's order of their centres. */
static void order_triangles(curve_place *order, const ms_mesh *mesh)
{
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    const double size = fmax(hi[0] - lo[0], fmax(hi[1] - lo[1], hi[2] - lo[2]));
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *corner = mesh->triangle[t];
        order[t] = (curve_place){0, (uint32_t)t};
        for (int a = 0; a < 3; a++) {
            const double centre =
                (mesh->vertex[corner[0]][a] + mesh->vertex[corner[1]][a] + mesh->vertex[corner[2]][a]) / 3;
            order[t].key |= spread_bits((uint64_t)(fmax(0, (centre - lo[a]) / size) * 0xfffff)) << a;
        }
    }
    qsort(order, mesh->n_triangles, sizeof *order, compare_cells);
}

/* Twice the area times the outward normal. */
static void cross_triangle(double out[3], const ms_mesh *mesh, size_t triangle)
{
    const uint32_t *corner = mesh->triangle[triangle];
    ms_vector_triangle(out, mesh->vertex[corner[0]], mesh->vertex[corner[1]], mesh->vertex[corner[2]]);
}

/* The triangles at vertex v are triangle[start[v]] to triangle[start[v + 1] - 1]. */
typedef struct fans {
    uint32_t *start, *triangle;
} fans;

static ms_status build_fans(fans *f, const ms_mesh *mesh, ms_error *err)
{
    f->start = calloc(mesh->n_vertices + 2, sizeof *f->start);
    f->triangle = malloc(3 * mesh->n_triangles * sizeof *f->triangle);
    if (!f->start || !f->triangle) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the normals of %zu triangles", mesh->n_triangles);
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int c = 0; c < 3; c++) {
            f->start[mesh->triangle[t][c] + 2]++;
        }
    }
    for (size_t v = 1; v < mesh->n_vertices + 2; v++) {
        f->start[v] += f->start[v - 1];
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int c = 0; c < 3; c++) {
            f->triangle[f->start[mesh->triangle[t][c] + 1]++] = (uint32_t)t;
        }
    }
    return MS_OK;
}

static void normalise(double v[3])
{
    const double length = sqrt(ms_dot(v, v));
    for (int a = 0; a < 3 && length > 0; a++) {
        v[a] /= length;
    }
}

/* The normal of the surface at a corner, as seen from a triangle with the unit normal `face`; weighted with areas. */
static void corner_normal(double out[3], const ms_mesh *mesh, const fans *f, uint32_t vertex, const double face[3])
{
    out[0] = out[1] = out[2] = 0;
    for (uint32_t k = f->start[vertex]; k < f->start[vertex + 1]; k++) {
        double other[3];
        cross_triangle(other, mesh, f->triangle[k]);
        const double bend = ms_dot(other, face);
        if (bend > 0 && bend * bend >= CREASE * CREASE * ms_dot(other, other)) {
            out[0] += other[0];
            out[1] += other[1];
            out[2] += other[2];
        }
    }
    normalise(out);
}

/* The i-th point, in a triangle: places follow an additive recurrence that fills the plane evenly (Roberts 2018). */
static void put_point(ms_expect_points *points, int i, const ms_mesh *mesh, const fans *f, uint32_t triangle)
{
    double part[3], face[3], normal[3] = {0}, corner[3];
    part[1] = fmod(0.5 + 0.7548776662466927 * i, 1);
    part[2] = fmod(0.5 + 0.5698402909980532 * i, 1);
    if (part[1] + part[2] > 1) {
        part[1] = 1 - part[1];
        part[2] = 1 - part[2];
    }
    part[0] = 1 - part[1] - part[2];
    cross_triangle(face, mesh, triangle);
    normalise(face);
    double at[3] = {0};
    for (int c = 0; c < 3; c++) {
        const uint32_t vertex = mesh->triangle[triangle][c];
        corner_normal(corner, mesh, f, vertex, face);
        for (int a = 0; a < 3; a++) {
            at[a] += part[c] * mesh->vertex[vertex][a];
            normal[a] += part[c] * corner[a];
        }
    }
    normalise(normal);
    for (int a = 0; a < 3; a++) {
        points->at[a][i] = at[a];
        points->normal[a][i] = normal[a];
    }
}

ms_status ms_expect_points_spread(ms_expect_points *points, int step, const ms_mesh *mesh, ms_error *err)
{
    fans f = {0};
    curve_place *order = malloc(mesh->n_triangles * sizeof *order);
    ms_status status = order
                           ? build_fans(&f, mesh, err)
                           : ms_fail(err, MS_ERR_NOMEM, "no memory for the order of %zu triangles", mesh->n_triangles);
    if (status == MS_OK) {
        double sum = 0;
        int i = 0;
        order_triangles(order, mesh);
        points->weight = ms_mesh_area(mesh) / MS_EXPECT_POINTS;
        for (size_t t = 0; t < mesh->n_triangles; t++) {
            double cross[3];
            cross_triangle(cross, mesh, order[t].triangle);
            sum += sqrt(ms_dot(cross, cross)) / 2;
            /* the last triangle takes what rounding has left */
            for (; i < MS_EXPECT_POINTS && ((i + 0.5) * points->weight <= sum || t + 1 == mesh->n_triangles);
                 i += step) {
                put_point(points, i, mesh, &f, order[t].triangle);
            }
        }
    }
    free(order);
    free(f.start);
    free(f.triangle);
    return status;
}

static void centre_of(double out[3], const ms_expect_points *points, int i, double radius)
{
    for (int a = 0; a < 3; a++) {
        out[a] = points->at[a][i] - radius * points->normal[a][i];
    }
}

/* The radius of the ball that touches at point i and passes through another; its own radius if there is none. */
static double radius_through(const ms_expect_points *points, int i, const double other[3], double radius)
{
    const double d[3] = {points->at[0][i] - other[0], points->at[1][i] - other[1], points->at[2][i] - other[2]};
    const double n[3] = {points->normal[0][i], points->normal[1][i], points->normal[2][i]};
    const double square = ms_dot(d, d), height = ms_dot(d, n);
    return square < 2 * radius * height ? square / (2 * height) : radius;
}

/* The largest ball at point i that none of the points with balls lies in. Those nearer than half of their distance in
 * the mean say more of the bend from triangle to triangle than of the body's. */
static double radius_among_points(const ms_expect_points *points, int i, double radius)
{
    const double self[3] = {points->at[0][i], points->at[1][i], points->at[2][i]};
    const double near = points->weight * MS_EXPECT_BALL_STEP / 4;
    for (int j = 0; j < MS_EXPECT_POINTS; j += MS_EXPECT_BALL_STEP) {
        const double other[3] = {points->at[0][j], points->at[1][j], points->at[2][j]};
        if (ms_squared_distance(self, other) >= near) {
            radius = radius_through(points, i, other, radius);
        }
    }
    return radius;
}

static double shrink_ball(const ms_expect_points *points, int i, const ms_closest *closest, double radius)
{
    enum { MOST_STEPS = 60 };
    const double allowed = 1 - TOLERANCE;
    for (int step = 0; step < MOST_STEPS; step++) {
        double centre[3], nearest[3];
        centre_of(centre, points, i, radius);
        if (ms_closest_distance(nearest, closest, centre, allowed * radius) >= allowed * radius) {
            break;
        }
        const double smaller = radius_through(points, i, nearest, radius);
        radius =
            smaller < radius ? smaller : radius / 2; /* it may lie beside the point, where the normal passes over */
    }
    return radius;
}

ms_status ms_expect_points_inscribe(ms_expect_points *points, const ms_mesh *mesh, const ms_closest *closest,
                                    ms_error *err)
{
    ms_closest *own = NULL;
    double lo[3], hi[3];
    const ms_status status = closest ? MS_OK : ms_closest_build(&own, mesh, err);
    if (status != MS_OK) {
        return status;
    }
    ms_mesh_box(lo, hi, mesh);
    const double most = sqrt(ms_squared_distance(lo, hi));
#pragma omp parallel for schedule(dynamic, 16)
    for (int b = 0; b < MS_EXPECT_POINTS / MS_EXPECT_BALL_STEP; b++) {
        const int i = b * MS_EXPECT_BALL_STEP;
        points->radius[b] = shrink_ball(points, i, own ? own : closest, radius_among_points(points, i, most));
    }
    ms_closest_free(own);
    return MS_OK;
}
