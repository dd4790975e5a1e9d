/* Sharp edges: counted and measured where they are known. */
#include "mesh/ms_mesh_sharp.h"

#include "base/ms_vector.h"
#include "mesh/ms_closest.h"
#include "support/body_samples.h"

static ms_mesh sharp_edges_of(const ms_mesh *mesh, double degrees)
{
    ms_mesh edges;
    ms_error err = {{0}};
    if (ms_mesh_sharp_edges(&edges, mesh, degrees, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return edges;
}

/* Their number and length. */
static void expect_edges(const ms_mesh *mesh, double degrees, size_t count, double length)
{
    double sum = 0;
    ms_mesh edges = sharp_edges_of(mesh, degrees);
    assert_int_equal(edges.n_triangles, count);
    for (size_t e = 0; e < edges.n_triangles; e++) {
        const uint32_t *t = edges.triangle[e];
        assert_int_equal(t[1], t[2]);
        sum += sqrt(ms_squared_distance(edges.vertex[t[0]], edges.vertex[t[1]]));
    }
    expect_close(sum, length, 1e-9 * (1 + length));
    ms_mesh_free(&edges);
}

/* The faces of a cube turn by 90 degrees, those of an octahedron by 70.5; a cylinder of 4 f sides turns by 90 / f. */
static void edges_are_sharp_by_the_angle_of_their_faces(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){1.5, 2});
    expect_edges(&mesh, 30, 24, 18); /* of two segments each */
    expect_edges(&mesh, 89.9, 24, 18);
    expect_edges(&mesh, 90.1, 0, 0);
    ms_mesh_free(&mesh);
    mesh = make_body("octahedron", (double[]){1, 2});
    expect_edges(&mesh, 70.4, 24, 12 * sqrt(2));
    expect_edges(&mesh, 70.6, 0, 0);
    ms_mesh_free(&mesh);
    mesh = make_body("cylinder", (double[]){1, 3, 6});
    expect_edges(&mesh, 30, 48, 2 * 24 * 2 * sin(pi / 24));
    ms_mesh edges = sharp_edges_of(&mesh, 14.9); /* the sides, too: 15 degrees */
    assert_true(edges.n_triangles >= 72);
    ms_mesh_free(&edges);
    ms_mesh_free(&mesh);
}

/* What bounds a hole is an edge, whatever its angle. A sliver tells nothing. */
static void holes_have_edges_and_slivers_have_none(void **state)
{
    (void)state;
    static double vertex[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1e-9}};
    static uint32_t triangle[3][3] = {{0, 1, 2}, {0, 2, 3}, {0, 4, 2}};
    ms_mesh mesh = {5, 2, vertex, triangle};
    expect_edges(&mesh, 30, 4, 4);
    mesh.n_triangles = 3; /* beside 0 2, the two new ones are open; 0 2 has three faces */
    expect_edges(&mesh, 30, 7, 4 + sqrt(2) + 2 * sqrt(0.5));
    triangle[1][1] = 4; /* 0 4 3: the sliver between the faces touches the first by 0 2 */
    triangle[1][2] = 3;
    triangle[2][1] = 2;
    triangle[2][2] = 4;
    ms_mesh edges = sharp_edges_of(&mesh, 30);
    for (size_t e = 0; e < edges.n_triangles; e++) {
        const double *a = edges.vertex[edges.triangle[e][0]], *b = edges.vertex[edges.triangle[e][1]];
        assert_false(a[0] == a[1] && b[0] == b[1] && a[0] != 0.5 && b[0] != 0.5); /* not 0 2 */
    }
    ms_mesh_free(&edges);
}

/* ms_closest finds the nearest point of edges as of other triangles. */
static void the_nearest_edge_is_found(void **state)
{
    uint64_t seed = 9;
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){2, 2});
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, &mesh);
    move_body(&mesh, -1 - lo[0], -1 - lo[1], -1 - lo[2]);
    ms_mesh edges = sharp_edges_of(&mesh, 30);
    ms_closest *closest;
    assert_int_equal(ms_closest_build(&closest, &edges, NULL), MS_OK);
    for (int turn = 0; turn < 3000; turn++) {
        double p[3], least = HUGE_VAL;
        for (int a = 0; a < 3; a++) {
            p[a] = 4 * next_uniform(&seed) - 2;
        }
        for (int a = 0; a < 3; a++) { /* the edges along a */
            const double along = fmax(0, fabs(p[a]) - 1), u = fabs(p[(a + 1) % 3]) - 1, v = fabs(p[(a + 2) % 3]) - 1;
            least = fmin(least, sqrt(along * along + u * u + v * v));
        }
        expect_close(ms_closest_distance(NULL, closest, p, HUGE_VAL), least, 1e-12);
        expect_close(ms_closest_distance(NULL, closest, p, 0.4), fmin(least, 0.4), 1e-12);
    }
    ms_closest_free(closest);
    ms_mesh_free(&edges);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_are_sharp_by_the_angle_of_their_faces),
        cmocka_unit_test(holes_have_edges_and_slivers_have_none),
        cmocka_unit_test(the_nearest_edge_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
