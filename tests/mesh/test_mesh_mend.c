/* Mending: seams, holes, surfaces that stand twice, crumbs. */
#include "mesh/ms_mesh_edges.h"
#include "mesh/ms_mesh_weld.h"
#include "support/body_samples.h"

static const double small_ball[] = {1, 6};

static ms_mesh_report mend_body(ms_mesh *mesh, const ms_mesh_mending *how)
{
    ms_mesh_report report;
    ms_error err = {{0}};
    if (ms_mesh_mend(mesh, &report, how, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return report;
}

/* Every triangle with corners of its own, each coordinate moved by at most `by`. */
static ms_mesh make_soup(const ms_mesh *from, double by, uint64_t seed)
{
    ms_mesh soup;
    assert_int_equal(ms_mesh_alloc(&soup, 3 * from->n_triangles, from->n_triangles, NULL), MS_OK);
    for (uint32_t c = 0; c < 3 * from->n_triangles; c++) {
        for (int k = 0; k < 3; k++) {
            soup.vertex[c][k] = from->vertex[from->triangle[c / 3][c % 3]][k] + by * (2 * next_uniform(&seed) - 1);
        }
        soup.triangle[c / 3][c % 3] = c;
    }
    return soup;
}

/* Of a ball of diameter 2 each coordinate differs by 4e-8 at most, 2e-8 of its length. */
static void seams_of_rounding_close(void **state)
{
    (void)state;
    ms_mesh sound = make_body("ball", small_ball);
    for (uint64_t seed = 1; seed < 6; seed++) {
        ms_mesh mesh = make_soup(&sound, 2e-8, seed);
        ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.weld = MS_MESH_WELD});
        expect_report(&r, 1, 0, 0);
        assert_int_equal(r.joined, 3 * sound.n_triangles - sound.n_vertices);
        assert_int_equal(mesh.n_vertices, sound.n_vertices);
        assert_int_equal(mesh.n_triangles, sound.n_triangles);
        expect_close(volume_of(&mesh), volume_of(&sound), 2e-8 * 4 * pi); /* at most as far as its surface moves */
        ms_mesh_free(&mesh);
        mesh = make_soup(&sound, 2e-8, seed);
        r = mend_body(&mesh, &(ms_mesh_mending){.weld = 0});
        assert_int_equal(r.open_edges, 3 * sound.n_triangles);
        assert_int_equal(r.joined, 0);
        ms_mesh_free(&mesh);
    }
    ms_mesh_free(&sound);
}

/* However fine it is beside the tolerance: an edge of it is 0.1 long, its walls are 1e-9 apart. */
static void a_closed_mesh_stays_to_the_last_bit(void **state)
{
    (void)state;
    for (int thin = 0; thin < 2; thin++) {
        ms_mesh mesh = make_body("ball", small_ball);
        for (size_t v = 0; v < mesh.n_vertices; v++) {
            mesh.vertex[v][2] *= thin ? 1e-9 : 1;
        }
        const size_t nv = mesh.n_vertices, nt = mesh.n_triangles;
        ms_mesh same = {.n_vertices = 0};
        assert_int_equal(ms_mesh_alloc(&same, nv, nt, NULL), MS_OK);
        memcpy(same.vertex, mesh.vertex, nv * sizeof *same.vertex);
        memcpy(same.triangle, mesh.triangle, nt * sizeof *same.triangle);
        ms_mesh_report r =
            mend_body(&mesh, &(ms_mesh_mending){.weld = MS_MESH_MOST_WELD, .fill_holes = 99, .drop_bodies = 1});
        expect_report(&r, 1, 0, 0);
        assert_int_equal(r.joined + r.filled + r.dropped_bodies + r.holes, 0);
        assert_int_equal(mesh.n_vertices, nv);
        assert_int_equal(mesh.n_triangles, nt);
        assert_memory_equal(mesh.vertex, same.vertex, nv * sizeof *same.vertex);
        assert_memory_equal(mesh.triangle, same.triangle, nt * sizeof *same.triangle);
        ms_mesh_free(&mesh);
        ms_mesh_free(&same);
    }
}

static double gap_of(const double a[3], const double b[3])
{
    return fmax(fabs(a[0] - b[0]), fmax(fabs(a[1] - b[1]), fabs(a[2] - b[2])));
}

/* Triangles of random corners, so many that chains of near ones go through all of them. */
static ms_mesh make_cloud(size_t n, double side, uint64_t seed)
{
    ms_mesh mesh;
    assert_int_equal(ms_mesh_alloc(&mesh, 3 * n, n, NULL), MS_OK);
    for (uint32_t c = 0; c < 3 * n; c++) {
        for (int k = 0; k < 3; k++) {
            mesh.vertex[c][k] = side * next_uniform(&seed) - side / 3;
        }
        mesh.triangle[c / 3][c % 3] = c;
    }
    return mesh;
}

/* Whether all that became vertex `a` may be one with all that became `b`: near, and of no common triangle. */
static int may_be_one(const ms_mesh *mesh, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < mesh->n_vertices; i++) {
        for (uint32_t j = 0; j < mesh->n_vertices; j++) {
            if (mesh->triangle[i / 3][i % 3] == a && mesh->triangle[j / 3][j % 3] == b &&
                (gap_of(mesh->vertex[i], mesh->vertex[j]) > 1 || (i != j && i / 3 == j / 3))) {
                return 0;
            }
        }
    }
    return 1;
}

/* By brute force: no chains, no triangle collapses, and what may still be joined is. */
static void joined_are_those_that_are_all_near_each_other(void **state)
{
    (void)state;
    size_t all = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        ms_mesh mesh = make_cloud(12, 3, seed);
        ms_edges edges;
        size_t joined, roots = 0;
        assert_int_equal(ms_edges_build(&edges, &mesh, NULL), MS_OK);
        assert_int_equal(ms_mesh_weld(&mesh, &joined, &edges, 1, NULL), MS_OK);
        for (uint32_t a = 0; a < 36; a++) {
            if (mesh.triangle[a / 3][a % 3] != a) {
                assert_true(mesh.triangle[a / 3][a % 3] < a);
                continue;
            }
            roots++;
            assert_true(may_be_one(&mesh, a, a));
            for (uint32_t b = 0; b < a; b++) {
                assert_true(mesh.triangle[b / 3][b % 3] != b || !may_be_one(&mesh, a, b));
            }
        }
        assert_int_equal(joined, 36 - roots);
        all += joined;
        ms_mesh_edges_free(&edges);
        ms_mesh_free(&mesh);
    }
    assert_true(all > 100);
}

/* A fan whose rim has corners every 0.6 of the tolerance: a chain of it would fall into one point. */
static void a_fine_rim_does_not_fall_into_itself(void **state)
{
    (void)state;
    enum { N = 1000 };
    const double pace = 0.6 * MS_MESH_WELD;
    ms_mesh mesh = {.n_vertices = 0};
    const uint32_t tip = add_vertex(&mesh, 0, 1, 0);
    for (uint32_t k = 0; k <= N; k++) {
        add_vertex(&mesh, k * pace, 0, 0);
        if (k > 0) {
            add_triangle(&mesh, tip, k, k + 1);
        }
    }
    ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.weld = MS_MESH_WELD});
    assert_int_equal(r.joined, 0);
    assert_int_equal(mesh.n_triangles, N);
    ms_mesh_free(&mesh);
}

static void far_too_large_a_tolerance_is_refused(void **state)
{
    (void)state;
    ms_mesh mesh = make_cloud(5000, 1, 1);
    ms_mesh_report r;
    ms_error err;
    add_triangle(&mesh, add_vertex(&mesh, 0, 0, 20), add_vertex(&mesh, 0, 1, 20), add_vertex(&mesh, 1, 0, 20));
    assert_int_equal(ms_mesh_mend(&mesh, &r, &(ms_mesh_mending){.weld = 0.1}, &err), MS_ERR_LIMIT);
    expect_message(&err, "pairs of corners at open edges lie within");
    ms_mesh_free(&mesh);
}

/* A column of height 2 over a star of n points, of radius 1 and in turn 0.4; its sides alone. */
static ms_mesh make_tube(uint32_t n)
{
    ms_mesh mesh = {.n_vertices = 0};
    for (uint32_t k = 0; k < 2 * n; k++) {
        const double radius = k % 4 < 2 ? 1 : 0.4, angle = 2 * pi * (k / 2) / n;
        add_vertex(&mesh, radius * cos(angle), radius * sin(angle), k % 2 ? 2 : 0);
    }
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t a = 2 * k, b = (2 * k + 2) % (2 * n);
        add_triangle(&mesh, a, b, b + 1);
        add_triangle(&mesh, a, b + 1, a + 1);
    }
    return mesh;
}

/* n is even: n triangles with the sides 1 and 0.4 from the axis. */
static double tube_volume(uint32_t n)
{
    return 2 * n * 0.5 * 1 * 0.4 * sin(2 * pi / n);
}

static void holes_are_filled_within_their_outline(void **state)
{
    (void)state;
    for (uint32_t n = 4; n <= 60; n += 2) {
        for (uint64_t turned = 0; turned < 3; turned++) {
            ms_mesh mesh = make_tube(n);
            size_t flipped = turned ? reverse_some(&mesh, turned) : 0;
            ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.fill_holes = n - 1});
            assert_false(r.closed);
            assert_int_equal(r.holes, 2);
            assert_int_equal(r.largest_hole, n);
            assert_int_equal(r.filled, 0);
            assert_int_equal(mesh.n_triangles, 2 * n);
            r = mend_body(&mesh, &(ms_mesh_mending){.fill_holes = n});
            assert_true(r.closed);
            assert_int_equal(r.filled, 2);
            assert_int_equal(r.holes + r.largest_hole, 0);
            assert_true(turned || r.flipped == flipped);
            assert_int_equal(mesh.n_triangles, 2 * n + 2 * (n - 2));
            expect_close(volume_of(&mesh), tube_volume(n), 1e-13);
            ms_mesh_free(&mesh);
        }
    }
}

/* Of a cube go two triangles that have one corner in common: two holes of three edges, not one of six. */
static void holes_that_meet_in_a_corner_are_two(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    size_t other = 0;
    for (size_t t = 1; t < 12; t++) {
        int common = 0;
        for (int k = 0; k < 9; k++) {
            common += mesh.triangle[0][k / 3] == mesh.triangle[t][k % 3];
        }
        other = common == 1 && !other ? t : other;
    }
    memcpy(mesh.triangle[other], mesh.triangle[10], sizeof *mesh.triangle);
    memcpy(mesh.triangle[0], mesh.triangle[11], sizeof *mesh.triangle);
    mesh.n_triangles = 10;
    assert_in_range(other, 1, 9);
    ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.fill_holes = 3});
    expect_report(&r, 1, 0, 0);
    assert_int_equal(r.filled, 2);
    expect_close(volume_of(&mesh), 1, 1e-15);
    ms_mesh_free(&mesh);
}

/* A lone triangle is a hole around itself: filled, it encloses nothing and goes. */
static void a_lone_triangle_goes_where_holes_are_filled(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    add_triangle(&mesh, add_vertex(&mesh, 5, 0, 0), add_vertex(&mesh, 5, 1, 0), add_vertex(&mesh, 5, 0, 1));
    ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.fill_holes = 3});
    expect_report(&r, 1, 0, 0);
    assert_int_equal(r.filled, 1);
    assert_int_equal(r.dropped_duplicate, 2);
    assert_int_equal(mesh.n_triangles, 12);
    ms_mesh_free(&mesh);
}

static void a_surface_that_stands_twice_is_one(void **state)
{
    (void)state;
    for (int opposite = 0; opposite < 2; opposite++) {
        for (size_t n_twice = 1; n_twice <= 12; n_twice++) {
            ms_mesh mesh = unit_cube();
            for (size_t t = 0; t < n_twice; t++) {
                const uint32_t *c = mesh.triangle[t];
                add_triangle(&mesh, c[opposite], c[!opposite], c[2]);
            }
            ms_mesh_report r = repair_body(&mesh);
            assert_true(r.closed);
            assert_int_equal(r.dropped_duplicate, n_twice);
            assert_int_equal(mesh.n_triangles, 12);
            expect_close(volume_of(&mesh), 1, 1e-15);
            ms_mesh_free(&mesh);
        }
    }
}

/* Drawn from both sides a sheet is no surface of a body. */
static void a_sheet_from_both_sides_is_refused(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube(), both = {.n_vertices = 0};
    ms_mesh_report r;
    ms_error err;
    mesh.n_triangles = 10; /* without one face */
    add_part(&both, mesh);
    for (size_t t = 0; t < 10; t++) {
        add_triangle(&both, both.triangle[t][1], both.triangle[t][0], both.triangle[t][2]);
    }
    assert_int_equal(ms_mesh_repair(&both, &r, &err), MS_ERR_SHAPE);
    expect_message(&err, "no triangle is left: all 20 are degenerate or cancel in pairs");
    ms_mesh_free(&both);
}

static ms_mesh cube_of(double side, double x)
{
    ms_mesh mesh = unit_cube();
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            mesh.vertex[v][k] *= side;
        }
    }
    move_body(&mesh, x, x, x);
    return mesh;
}

/* A cube of 8 with a pore of 0.001, one of 1/64 beside it, five of 0.001; a scrap in a box of 0.0005. */
static ms_mesh make_crumbs(int with_scrap)
{
    ms_mesh mesh = cube_of(2, 0);
    add_part(&mesh, cube_of(0.1, 0.5));
    add_part(&mesh, cube_of(0.25, 4));
    for (int k = 0; k < 5; k++) {
        add_part(&mesh, cube_of(0.1, 5 + k));
    }
    if (with_scrap) {
        ms_mesh scrap = cube_of(0.1, 20);
        scrap.n_triangles = 8;
        add_part(&mesh, scrap);
    }
    return mesh;
}

static void crumbs_go(void **state)
{
    static const struct {
        double share;
        size_t dropped, bodies, cavities;
        double volume, left;
    } cases[] = {
        {0.000124, 0, 7, 1, 0, 8 - 0.001 + 1. / 64 + 0.005}, /* 0.001 / 8 is 0.000125 */
        {0.000126, 6, 2, 0, 0.006, 8 + 1. / 64},
        {0.0019, 6, 2, 0, 0.006, 8 + 1. / 64}, /* 1 / 64 / 8 is 0.00195 */
        {0.002, 7, 1, 0, 0.006 + 1. / 64, 8},
        {1, 7, 1, 0, 0.006 + 1. / 64, 8},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ms_mesh mesh = make_crumbs(0);
        reverse_some(&mesh, i);
        ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.drop_bodies = cases[i].share});
        assert_true(r.closed);
        assert_int_equal(r.dropped_bodies, cases[i].dropped);
        expect_close(r.dropped_volume, cases[i].volume, 1e-12);
        assert_int_equal(r.bodies, cases[i].bodies);
        assert_int_equal(r.cavities, cases[i].cavities);
        expect_close(volume_of(&mesh), cases[i].left, 1e-12);
        assert_int_equal(mesh.n_vertices, 8 * (r.bodies + r.cavities));
        ms_mesh_free(&mesh);
    }
}

/* What is open holds at most its box. */
static void open_scraps_go_with_the_crumbs(void **state)
{
    (void)state;
    ms_mesh mesh = make_crumbs(1);
    ms_mesh_report r = mend_body(&mesh, &(ms_mesh_mending){.drop_bodies = 0});
    assert_false(r.closed);
    assert_true(r.holes > 0);
    r = mend_body(&mesh, &(ms_mesh_mending){.drop_bodies = 0.000126});
    assert_true(r.closed);
    assert_int_equal(r.dropped_bodies, 7);
    assert_int_equal(r.holes + r.odd_edges, 0);
    expect_close(r.dropped_volume, 0.006, 1e-12);
    expect_close(volume_of(&mesh), 8 + 1. / 64, 1e-12);
    ms_mesh_free(&mesh);
}

static void what_cannot_be_asked_is_refused(void **state)
{
    static const ms_mesh_mending wrong[] = {{.weld = 0.11},
                                            {.weld = 1e-14},
                                            {.weld = -1e-7},
                                            {.weld = (double)NAN},
                                            {.drop_bodies = -1e-9},
                                            {.drop_bodies = 1.01},
                                            {.drop_bodies = (double)NAN}};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        ms_mesh mesh = unit_cube();
        ms_mesh_report r;
        ms_error err;
        assert_int_equal(ms_mesh_mend(&mesh, &r, &wrong[i], &err), MS_ERR_ARG);
        expect_message(&err, i < 4 ? "corners cannot be joined within" : "is no share of the largest");
        assert_int_equal(mesh.n_triangles, 12);
        ms_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(seams_of_rounding_close),
        cmocka_unit_test(a_closed_mesh_stays_to_the_last_bit),
        cmocka_unit_test(joined_are_those_that_are_all_near_each_other),
        cmocka_unit_test(a_fine_rim_does_not_fall_into_itself),
        cmocka_unit_test(far_too_large_a_tolerance_is_refused),
        cmocka_unit_test(holes_are_filled_within_their_outline),
        cmocka_unit_test(holes_that_meet_in_a_corner_are_two),
        cmocka_unit_test(a_lone_triangle_goes_where_holes_are_filled),
        cmocka_unit_test(a_surface_that_stands_twice_is_one),
        cmocka_unit_test(a_sheet_from_both_sides_is_refused),
        cmocka_unit_test(crumbs_go),
        cmocka_unit_test(open_scraps_go_with_the_crumbs),
        cmocka_unit_test(what_cannot_be_asked_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
