/* Convex hulls: bodies whose hull is known, points that have none. */
#include "mesh/ms_hull.h"
#include "mesh/ms_inertia.h"
#include "support/test_support.h"

/* The volume of the hull of points, which is closed and wound outward as it comes. */
static double hull_volume(ms_mesh *hull, const double (*point)[3], size_t count)
{
    ms_mesh_report report;
    ms_body body;
    ms_error err;
    if (ms_hull_build(hull, point, count, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    assert_int_equal(ms_mesh_repair(hull, &report, &err), MS_OK);
    assert_true(report.closed);
    assert_int_equal(report.flipped + report.dropped_degenerate + report.dropped_duplicate, 0);
    assert_int_equal(report.shells, 1);
    assert_int_equal(ms_inertia_mesh(&body, hull, &err), MS_OK);
    return body.volume;
}

/* A box of corners, and points on its faces, on its edges and inside: the eight corners remain. */
static void points_of_a_box(void **state)
{
    double point[125][3];
    ms_mesh hull;
    (void)state;
    for (int p = 0; p < 125; p++) {
        point[p][0] = 3.0 * (p % 5) / 4 + 1000;
        point[p][1] = 2.0 * (p / 5 % 5) / 4 - 7;
        point[p][2] = 0.5 * (p / 25) / 4;
    }
    assert_close(hull_volume(&hull, (const double(*)[3])point, 125), 3, 1e-9);
    assert_in_range(hull.n_vertices, 8, 98); /* all inner points are gone */
    ms_mesh_free(&hull);
}

/* A convex body is its own hull; that of a ring is the disc that fills it. */
static void bodies(void **state)
{
    ms_mesh mesh, hull;
    ms_body body;
    ms_error err;
    (void)state;
    make_shape(&mesh, "ellipsoid", "fineness=12");
    assert_int_equal(ms_inertia_mesh(&body, &mesh, &err), MS_OK);
    assert_close(hull_volume(&hull, (const double(*)[3])mesh.vertex, mesh.n_vertices), body.volume, 1e-9 * body.volume);
    assert_int_equal(hull.n_vertices, mesh.n_vertices);
    ms_mesh_free(&hull);
    ms_mesh_free(&mesh);
    make_shape(&mesh, "torus", "R=3 r=1 fineness=40"); /* a disc of radius R, thickness 2 r, with a round rim */
    const double pi = acos(-1), disc = pi * (2 * 9 + pi * 3 + 4.0 / 3);
    assert_close(hull_volume(&hull, (const double(*)[3])mesh.vertex, mesh.n_vertices), disc, 0.01 * disc);
    ms_mesh_free(&hull);
    ms_mesh_free(&mesh);
}

static void refuse(const double (*point)[3], size_t count, const char *message)
{
    ms_mesh hull;
    ms_error err;
    assert_int_equal(ms_hull_build(&hull, point, count, &err), MS_ERR_SHAPE);
    assert_non_null(strstr(err.text, message));
    assert_int_equal(hull.n_vertices + hull.n_triangles, 0);
    assert_null(hull.vertex);
    assert_int_equal(ms_hull_build(&hull, point, count, NULL), MS_ERR_SHAPE);
}

static void points_without_a_hull(void **state)
{
    const double flat[6][3] = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 5, 1}, {-3, 2, 1}};
    const double bad[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, (double)NAN}};
    (void)state;
    refuse(flat, 6, "span no volume");
    refuse(flat, 3, "it takes four");
    refuse(NULL, 0, "it takes four");
    refuse(bad, 4, "point 4 is not finite");
}

static void without_qhull_it_says_so(void **state)
{
    const double point[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    ms_mesh hull;
    ms_error err;
    (void)state;
    assert_int_equal(ms_hull_build(&hull, point, 4, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "libqhull-dev"));
    assert_null(hull.vertex);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_of_a_box),
        cmocka_unit_test(bodies),
        cmocka_unit_test(points_without_a_hull),
    };
    const struct CMUnitTest without[] = {cmocka_unit_test(without_qhull_it_says_so)};
    return ms_hull_is_built() ? cmocka_run_group_tests(tests, NULL, NULL) : cmocka_run_group_tests(without, NULL, NULL);
}
