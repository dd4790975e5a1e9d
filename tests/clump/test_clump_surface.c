/* The surface of a union as a mesh: closed, wound outward, its corners on the spheres, its volume from below. */
#include "clump/ms_clump_surface.h"

#include "clump/ms_union.h"
#include "mesh/ms_inertia.h"
#include "support/clump_samples.h"

static void make_surface(ms_mesh *mesh, const ms_clump *clump, double h)
{
    ms_error err = {""};
    if (ms_clump_surface(mesh, clump, h, MANY_VOXELS, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
}

/* As it is, without being mended. */
static ms_mesh_report expect_closed(ms_mesh *mesh)
{
    ms_mesh_report report;
    const size_t triangles = mesh->n_triangles, vertices = mesh->n_vertices;
    assert_int_equal(ms_mesh_repair(mesh, &report, NULL), MS_OK);
    assert_true(report.closed);
    assert_int_equal(report.flipped + report.open_edges + report.nonmanifold_edges, 0);
    assert_int_equal(mesh->n_triangles, triangles);
    assert_int_equal(mesh->n_vertices, vertices);
    return report;
}

/* How far a point is outside the union; negative inside. */
static double outside(const ms_clump *clump, const double point[3])
{
    double least = HUGE_VAL;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        const double away = sqrt((point[0] - c[0]) * (point[0] - c[0]) + (point[1] - c[1]) * (point[1] - c[1]) +
                                 (point[2] - c[2]) * (point[2] - c[2]));
        least = fmin(least, away - clump->sphere[s].radius);
    }
    return least;
}

/* Corners are on the surface to 1/64 of an edge, of which the longest is the diagonal of a cube. */
static void expect_corners(const ms_mesh *mesh, const ms_clump *clump, double h)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        assert_true(fabs(outside(clump, mesh->vertex[v])) <= sqrt(3) * h / 64 + 1e-12);
    }
}

/* Its volume lacks what is behind the faces, whose circles of radius up to h are at most h^2 / (2 r) deep. */
static void one_ball(void **state)
{
    (void)state;
    const double r = 2.385;
    ms_clump clump = {0};
    add_sphere(&clump, 11, -7, 3, r);
    for (double cells = 10; cells <= 40; cells *= 2) {
        const double h = 2 * r / cells;
        ms_mesh mesh;
        ms_body body;
        make_surface(&mesh, &clump, h);
        const ms_mesh_report report = expect_closed(&mesh);
        assert_int_equal(report.shells, 1);
        assert_int_equal(mesh.n_vertices - mesh.n_triangles / 2, 2); /* Euler */
        expect_corners(&mesh, &clump, h);
        assert_int_equal(ms_inertia_mesh(&body, &mesh, NULL), MS_OK);
        const double lack = 1 - body.volume / ball_volume(r);
        assert_true(lack > 0 && lack < 1.5 * h * h / (r * r));
        for (int k = 0; k < 3; k++) {
            expect_close(body.centroid[k], clump.sphere[0].centre[k], 0.01 * h);
        }
        ms_mesh_free(&mesh);
    }
    ms_clump_free(&clump);
}

/* Spheres at random, some apart, some inside others, one that touches another, one twice. */
static void many(void **state)
{
    (void)state;
    uint32_t seed = 5;
    ms_clump clump = {0};
    ms_mesh mesh;
    ms_body body;
    double volume, area;
    for (int s = 0; s < 60; s++) {
        double x[4];
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            x[k] = seed / 4294967296.0;
        }
        add_sphere(&clump, 4 * x[0], 3 * x[1], 2 * x[2], 0.1 + 0.4 * x[3]);
    }
    const ms_sphere first = clump.sphere[0];
    add_sphere(&clump, first.centre[0], first.centre[1], first.centre[2], first.radius);
    add_sphere(&clump, -3, 0, 0, 1);
    add_sphere(&clump, -4.5, 0, 0, 0.5);
    const double h = 0.04;
    make_surface(&mesh, &clump, h);
    expect_closed(&mesh);
    expect_corners(&mesh, &clump, h);
    assert_int_equal(ms_inertia_mesh(&body, &mesh, NULL), MS_OK);
    assert_int_equal(ms_union_measure(&volume, &area, &clump, NULL), MS_OK);
    expect_close(body.volume, volume, 0.01 * volume);
    ms_mesh_free(&mesh);
    ms_clump_free(&clump);
}

/* Spheres on the corners of a cube with faces of spheres between them leave a cavity in the middle. */
static void cavity(void **state)
{
    (void)state;
    ms_clump clump = {0};
    ms_mesh mesh;
    for (int i = 0; i < 27; i++) {
        if (i != 13) {
            add_sphere(&clump, i % 3, i / 3 % 3, i / 9, 0.75);
        }
    }
    make_surface(&mesh, &clump, 0.05);
    const ms_mesh_report report = expect_closed(&mesh);
    assert_int_equal(report.cavities, 1);
    assert_int_equal(report.bodies, 1);
    ms_mesh_free(&mesh);
    ms_clump_free(&clump);
}

static void refused(void **state)
{
    (void)state;
    ms_clump clump = {0};
    ms_mesh mesh;
    ms_error err;
    assert_int_equal(ms_clump_surface(&mesh, &clump, 1, MANY_VOXELS, &err), MS_ERR_ARG);
    add_sphere(&clump, 0, 0, 0, 1);
    assert_int_equal(ms_clump_surface(&mesh, &clump, 0.01, 1000, &err), MS_ERR_LIMIT);
    assert_int_equal(ms_clump_surface(&mesh, &clump, 1e-9, MANY_VOXELS, &err), MS_ERR_LIMIT);
    assert_int_equal(ms_clump_surface(&mesh, &clump, 100, MANY_VOXELS, &err), MS_ERR_SHAPE);
    assert_null(mesh.vertex);
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_ball),
        cmocka_unit_test(many),
        cmocka_unit_test(cavity),
        cmocka_unit_test(refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
