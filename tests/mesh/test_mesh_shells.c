/* Repair of several shells: bodies in bodies, apart, touching. */
#include "support/body_samples.h"

static ms_mesh ball(double r, int fineness)
{
    return make_body("ball", (double[]){r, fineness});
}

static void cavities_are_wound_inward(void **state)
{
    (void)state;
    for (int inner_reversed = 0; inner_reversed < 2; inner_reversed++) {
        ms_mesh mesh = ball(2, 5);
        ms_mesh inner = ball(0.75, 4);
        double expected = volume_of(&mesh) - volume_of(&inner);
        size_t n_inner = inner.n_triangles;
        if (inner_reversed) {
            reverse_all(&inner);
        }
        move_body(&inner, 0.4, -0.3, 0.2);
        add_part(&mesh, inner);
        ms_mesh_report r = repair_body(&mesh);
        expect_report(&r, 2, 1, inner_reversed ? 0 : n_inner);
        expect_close(volume_of(&mesh), expected, 1e-12);
        ms_mesh_free(&mesh);
    }
}

static void nested_shells_alternate(void **state)
{
    (void)state;
    /* A kernel in the cavity of a ball, and a ball apart; the order of the parts is mixed. */
    ms_mesh mesh = {0};
    double expected = 0;
    static const double radius[] = {1, 3, 2, 0.5, 1.5};
    static const double sign[] = {-1, -1, 1, 1, 1};
    for (int k = 0; k < 5; k++) {
        ms_mesh part = ball(radius[k], 6);
        expected += volume_of(&part) * sign[k];
        if (k == 4) {
            move_body(&part, 7.3, 0, 0);
        }
        add_part(&mesh, part);
    }
    ms_mesh outermost = ball(4, 6);
    expected += volume_of(&outermost);
    add_part(&mesh, outermost);
    reverse_some(&mesh, 99);
    ms_mesh_report r = repair_body(&mesh);
    assert_int_equal(r.shells, 6);
    assert_int_equal(r.cavities, 2);
    assert_int_equal(r.bodies, 4);
    expect_close(volume_of(&mesh), expected, 1e-11);
    ms_mesh_free(&mesh);
}

static void many_cavities_are_found(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){24, 16});
    double expected = volume_of(&mesh);
    ms_mesh holes = {0};
    ms_mesh hole = make_body("octahedron", (double[]){0.9, 2});
    size_t n_vertices = hole.n_vertices;
    size_t n_triangles = hole.n_triangles;
    expected -= 1000 * volume_of(&hole);
    ms_mesh_free(&hole);
    assert_int_equal(ms_mesh_alloc(&holes, 1000 * n_vertices, 1000 * n_triangles, NULL), MS_OK);
    for (int k = 0; k < 1000; k++) {
        hole = make_body("octahedron", (double[]){0.9, 2});
        move_body(&hole, 2.1 * (k % 10) - 9.45, 2.1 * (k / 10 % 10) - 9.45, 2.1 * (k / 100) - 9.45);
        memcpy(holes.vertex + (size_t)k * n_vertices, hole.vertex, n_vertices * sizeof *hole.vertex);
        for (size_t t = 0; t < 3 * n_triangles; t++) {
            holes.triangle[(size_t)k * n_triangles + t / 3][t % 3] =
                hole.triangle[t / 3][t % 3] + (uint32_t)((size_t)k * n_vertices);
        }
        ms_mesh_free(&hole);
    }
    add_part(&mesh, holes);
    ms_mesh_report r = repair_body(&mesh);
    expect_report(&r, 1001, 1000, 1000 * n_triangles);
    expect_close(volume_of(&mesh), expected, 1e-8);
    ms_mesh_free(&mesh);
}

static void bodies_that_overlap_are_not_nested(void **state)
{
    (void)state;
    ms_mesh mesh = ball(2, 8);
    ms_mesh part = ball(1, 8);
    double expected = volume_of(&mesh) + volume_of(&part);
    move_body(&part, 1.1, 0.02, 0.03); /* its box lies mostly, not wholly, in the other's */
    add_part(&mesh, part);
    /* In a corner of the box of the large ball, and across its surface. */
    part = ball(0.5, 8);
    expected += volume_of(&part);
    move_body(&part, 1.1, 1.1, 1.1);
    add_part(&mesh, part);
    ms_mesh_report r = repair_body(&mesh);
    expect_report(&r, 3, 0, 0);
    expect_close(volume_of(&mesh), expected, 1e-12);
    ms_mesh_free(&mesh);
}

/* Two cubes with one edge in common, either one or both inside out, or at random. */
static void bodies_that_touch_along_an_edge_stay_two(void **state)
{
    (void)state;
    for (int turned = 0; turned < 12; turned++) {
        ms_mesh mesh = unit_cube();
        ms_mesh other = unit_cube();
        size_t flipped = turned < 4 ? (size_t)(turned % 2 + turned / 2) * 12 : 0;
        move_body(&other, 1, 1, 0);
        if (turned == 1 || turned == 3) {
            reverse_all(&mesh);
        }
        if (turned == 2 || turned == 3) {
            reverse_all(&other);
        }
        add_part(&mesh, other);
        weld_body(&mesh);
        if (turned >= 4) {
            flipped = reverse_some(&mesh, (uint64_t)turned);
        }
        ms_mesh_report r = repair_body(&mesh);
        assert_true(r.closed);
        assert_int_equal(r.nonmanifold_edges, 1);
        assert_int_equal(r.open_edges, 0);
        expect_close(volume_of(&mesh), 2, 1e-15);
        if (turned < 4) {
            expect_report(&r, 2, 0, flipped);
        }
        ms_mesh_free(&mesh);
    }
}

static void bodies_that_touch_in_a_point_or_a_face_are_two(void **state)
{
    (void)state;
    static const double by[2][3] = {{1, 1, 1}, {1, 0.25, 0.25}};
    for (int k = 0; k < 2; k++) {
        ms_mesh mesh = unit_cube();
        ms_mesh other = unit_cube();
        move_body(&other, by[k][0], by[k][1], by[k][2]);
        add_part(&mesh, other);
        weld_body(&mesh);
        ms_mesh_report r = repair_body(&mesh);
        expect_report(&r, 2, 0, 0);
        expect_close(volume_of(&mesh), 2, 1e-15);
        ms_mesh_free(&mesh);
    }
}

/* A cavity whose wall touches the surface from inside, at a vertex on a face. */
static void a_cavity_may_touch_the_surface(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){4, 2});
    ms_mesh hole = make_body("octahedron", (double[]){1, 3});
    move_body(&hole, 0.37, 1, 0.21);
    add_part(&mesh, hole);
    ms_mesh_report r = repair_body(&mesh);
    assert_int_equal(r.cavities, 1);
    expect_close(volume_of(&mesh), 64 - 4.0 / 3, 1e-12);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cavities_are_wound_inward),
        cmocka_unit_test(nested_shells_alternate),
        cmocka_unit_test(many_cavities_are_found),
        cmocka_unit_test(bodies_that_overlap_are_not_nested),
        cmocka_unit_test(bodies_that_touch_along_an_edge_stay_two),
        cmocka_unit_test(bodies_that_touch_in_a_point_or_a_face_are_two),
        cmocka_unit_test(a_cavity_may_touch_the_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
