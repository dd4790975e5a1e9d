/* Repair: what is dropped, what is turned, what is counted. */
#include "mesh/formats/ms_mesh_read.h"
#include "support/body_samples.h"

static const double small_ball[] = {1, 4};

static void a_sound_mesh_stays_as_it_is(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    ms_mesh same = unit_cube();
    ms_mesh_report r = repair_body(&mesh);
    expect_report(&r, 1, 0, 0);
    assert_int_equal(r.dropped_degenerate + r.dropped_duplicate + r.open_edges + r.nonmanifold_edges, 0);
    assert_memory_equal(mesh.triangle, same.triangle, 12 * sizeof *mesh.triangle);
    assert_memory_equal(mesh.vertex, same.vertex, 8 * sizeof *mesh.vertex);
    ms_mesh_free(&mesh);
    ms_mesh_free(&same);
    ms_mesh_free(&same);
    ms_mesh_free(NULL);
}

static void windings_are_mended(void **state)
{
    (void)state;
    for (int turned = 0; turned < 4; turned++) {
        ms_mesh mesh = unit_cube();
        size_t flipped = turned == 0 ? 1 : turned == 1 ? 12 : 0;
        if (turned == 0) {
            reverse_triangle(&mesh, 7);
        } else if (turned == 1) {
            reverse_all(&mesh);
        } else {
            flipped = reverse_some(&mesh, (uint64_t)turned);
        }
        ms_mesh_report r = repair_body(&mesh);
        expect_report(&r, 1, 0, flipped);
        expect_close(volume_of(&mesh), 1, 1e-15);
        ms_mesh_free(&mesh);
    }
}

static void an_open_mesh_is_reported_and_left(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    ms_mesh_report r;
    mesh.n_triangles = 10; /* without the side z = 1 */
    reverse_triangle(&mesh, 3);
    reverse_triangle(&mesh, 8);
    uint32_t before[10][3];
    memcpy(before, mesh.triangle, sizeof before);
    r = repair_body(&mesh);
    assert_false(r.closed);
    assert_int_equal(r.open_edges, 4);
    assert_int_equal(r.odd_edges, 4);
    assert_int_equal(r.flipped, 0);
    assert_int_equal(r.shells, 1);
    assert_int_equal(r.bodies, 1);
    assert_memory_equal(mesh.triangle, before, sizeof before);
    ms_mesh_free(&mesh);
}

static void a_one_sided_surface_is_refused(void **state)
{
    /* The projective plane with six vertices: every edge has two triangles. */
    static const uint32_t face[10][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 1, 5},
                                         {1, 2, 4}, {2, 3, 5}, {1, 3, 4}, {2, 4, 5}, {1, 3, 5}};
    ms_mesh mesh;
    ms_mesh_report r;
    ms_error err;
    (void)state;
    assert_int_equal(ms_mesh_alloc(&mesh, 6, 10, NULL), MS_OK);
    for (int v = 0; v < 6; v++) {
        mesh.vertex[v][0] = v;
        mesh.vertex[v][1] = v * v;
        mesh.vertex[v][2] = v * v * v;
    }
    memcpy(mesh.triangle, face, sizeof face);
    assert_int_equal(ms_mesh_repair(&mesh, &r, &err), MS_ERR_SHAPE);
    expect_message(&err, "one-sided");
    assert_false(r.closed);
    assert_int_equal(r.odd_edges, 0);
    assert_int_equal(r.shells, 1);
    ms_mesh_free(&mesh);
}

static void degenerate_and_doubled_triangles_go(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    uint32_t stray = add_vertex(&mesh, 1e9, 0, 0);
    uint32_t in_face = add_vertex(&mesh, 0.5, 0.25, 0.5);
    add_triangle(&mesh, 0, 0, 5);
    add_triangle(&mesh, 3, stray, 3);
    add_triangle(&mesh, 4, 4, 4);
    /* Copies of triangle 0, in other orders of the corners. */
    const uint32_t *t = mesh.triangle[0];
    add_triangle(&mesh, t[1], t[2], t[0]);
    t = mesh.triangle[0];
    add_triangle(&mesh, t[2], t[0], t[1]);
    /* A flap of two opposite triangles, on an edge of the cube. */
    add_triangle(&mesh, 0, 1, in_face);
    add_triangle(&mesh, 1, 0, in_face);
    ms_mesh_report r = repair_body(&mesh);
    expect_report(&r, 1, 0, 0);
    assert_int_equal(r.dropped_degenerate, 3);
    assert_int_equal(r.dropped_duplicate, 4);
    assert_int_equal(r.nonmanifold_edges, 0);
    assert_int_equal(mesh.n_triangles, 12);
    assert_int_equal(mesh.n_vertices, 8);
    expect_close(volume_of(&mesh), 1, 1e-15);
    ms_mesh_free(&mesh);
}

static void a_copy_wound_the_other_way_does_not_open_the_mesh(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    for (size_t k = 3; k < 5; k++) { /* they share an edge */
        const uint32_t *t = mesh.triangle[k];
        add_triangle(&mesh, t[1], t[0], t[2]);
    }
    ms_mesh_report r = repair_body(&mesh);
    assert_true(r.closed);
    assert_int_equal(r.dropped_duplicate, 2);
    assert_int_equal(mesh.n_triangles, 12);
    expect_close(volume_of(&mesh), 1, 1e-15);
    ms_mesh_free(&mesh);
}

static void fins_go_and_needed_slivers_stay(void **state)
{
    (void)state;
    ms_mesh mesh = unit_cube();
    uint32_t out = add_vertex(&mesh, 2, 0.5, 0.5);
    add_triangle(&mesh, 4, 5, out);
    ms_mesh_report r = repair_body(&mesh);
    expect_report(&r, 1, 0, 0);
    assert_int_equal(r.dropped_degenerate, 1);
    /* The edge from 0 to 1 is cut at its middle for one of its triangles alone; a triangle
       without area fills the gap. */
    uint32_t middle = add_vertex(&mesh, 0, 0, 0.5);
    for (size_t t = 0; t < 12; t++) {
        uint32_t *c = mesh.triangle[t];
        for (int k = 0; k < 3; k++) {
            if (c[k] == 0 && c[(k + 1) % 3] == 1) {
                uint32_t opposite = c[(k + 2) % 3];
                c[(k + 1) % 3] = middle;
                add_triangle(&mesh, middle, 1, opposite);
                add_triangle(&mesh, 0, 1, middle);
                t = 12;
                break;
            }
        }
    }
    assert_int_equal(mesh.n_triangles, 14);
    r = repair_body(&mesh);
    expect_report(&r, 1, 0, 0);
    assert_int_equal(r.dropped_degenerate, 0);
    assert_int_equal(mesh.n_triangles, 14);
    expect_close(volume_of(&mesh), 1, 1e-15);
    ms_mesh_free(&mesh);
}

static void what_cannot_be_mended_is_refused(void **state)
{
    ms_mesh mesh = unit_cube();
    ms_mesh_report r;
    ms_error err;
    (void)state;
    for (size_t t = 0; t < 12; t++) {
        mesh.triangle[t][1] = mesh.triangle[t][0];
    }
    assert_int_equal(ms_mesh_repair(&mesh, &r, &err), MS_ERR_SHAPE);
    expect_message(&err, "no triangle is left");
    ms_mesh_free(&mesh);
    mesh = unit_cube();
    mesh.triangle[11][2] = 8;
    assert_int_equal(ms_mesh_repair(&mesh, &r, &err), MS_ERR_ARG);
    expect_message(&err, "triangle 11 has corner 8");
    ms_mesh_free(&mesh);
    mesh = (ms_mesh){0};
    assert_int_equal(ms_mesh_repair(&mesh, &r, &err), MS_ERR_SHAPE);
    assert_int_equal(ms_mesh_repair(&mesh, &r, NULL), MS_ERR_SHAPE);
    assert_int_equal(ms_mesh_alloc(&mesh, 0, 5, &err), MS_ERR_ARG);
    assert_int_equal(ms_mesh_alloc(&mesh, SIZE_MAX / 4, 5, &err), MS_ERR_NOMEM);
    assert_null(mesh.vertex);
}

static void the_box_holds_the_vertices(void **state)
{
    double lo[3], hi[3];
    (void)state;
    ms_mesh mesh = make_body("ellipsoid", (double[]){2.385, 1.7, 0.3, 8});
    move_body(&mesh, 10, 20, 30);
    ms_mesh_box(lo, hi, &mesh);
    expect_close(lo[0], 10 - 2.385, 1e-12);
    expect_close(hi[1], 21.7, 1e-12);
    expect_close(hi[2], 30.3, 1e-12);
    ms_mesh_free(&mesh);
}

typedef struct shared_case {
    const char *file;
    size_t degenerate, duplicate, flipped, bodies, triangles;
    double volume;
} shared_case;

/* data/MANIFEST.md says what is expected of each. */
static const shared_case shared_cases[] = {
    {"bad/09_degenerate_duplicate_tris.stl", 386, 64, 0, 1, 1000, 5.598e5},
    {"bad/10_inverted_normals.stl", 0, 0, 1000, 1, 1000, 5.598e5},
    {"bad/15_two_disjoint_bodies.stl", 0, 0, 0, 2, 2000, 6.298e5},
    {"bad/17_offset_1e9_double.obj", 0, 0, 0, 1, 1000, 5.598e5},
    {"lithic_flake2.ply", 0, 2, 0, 1, 172812, 2.282e4},
    {"torus.stl", 0, 0, 0, 1, 57600, 59.18},
    {"human_femur.stl", 0, 0, 0, 1, 13752, 1.256e5},
};

static void shared_meshes_are_mended(void **state)
{
    char path[512];
    (void)state;
    for (size_t k = 0; k < sizeof shared_cases / sizeof *shared_cases; k++) {
        const shared_case *expected = &shared_cases[k];
        for (int mixed = 0; mixed < 2; mixed++) {
            ms_mesh mesh;
            shared_path(path, expected->file);
            assert_int_equal(ms_mesh_read(&mesh, path, NULL), MS_OK);
            if (mixed && expected->duplicate == 0) {
                reverse_some(&mesh, 5);
            }
            ms_mesh_report r = repair_body(&mesh);
            assert_true(r.closed);
            assert_int_equal(r.bodies, expected->bodies);
            assert_int_equal(mesh.n_triangles, expected->triangles);
            assert_int_equal(r.dropped_degenerate, expected->degenerate);
            assert_int_equal(r.dropped_duplicate, expected->duplicate);
            if (!mixed) {
                assert_int_equal(r.flipped, expected->flipped);
            }
            expect_close(volume_of(&mesh), expected->volume, 5e-4 * expected->volume);
            ms_mesh_free(&mesh);
        }
    }
}

static void a_shared_open_mesh_is_reported(void **state)
{
    char path[512];
    ms_mesh mesh;
    (void)state;
    shared_path(path, "bad/12_open_mesh.stl");
    assert_int_equal(ms_mesh_read(&mesh, path, NULL), MS_OK);
    ms_mesh_report r = repair_body(&mesh);
    assert_false(r.closed);
    assert_int_equal(r.open_edges, 36);
    assert_int_equal(mesh.n_triangles, 800);
    ms_mesh_free(&mesh);
}

static void any_mixture_of_windings_gives_one_result(void **state)
{
    (void)state;
    ms_mesh sound = make_body("ball", small_ball);
    for (uint64_t seed = 0; seed < 50; seed++) {
        ms_mesh mesh = make_body("ball", small_ball);
        size_t reversed = reverse_some(&mesh, seed);
        ms_mesh_report r = repair_body(&mesh);
        expect_report(&r, 1, 0, reversed);
        expect_close(volume_of(&mesh), volume_of(&sound), 1e-15);
        ms_mesh_free(&mesh);
    }
    ms_mesh_free(&sound);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sound_mesh_stays_as_it_is),
        cmocka_unit_test(windings_are_mended),
        cmocka_unit_test(an_open_mesh_is_reported_and_left),
        cmocka_unit_test(a_one_sided_surface_is_refused),
        cmocka_unit_test(degenerate_and_doubled_triangles_go),
        cmocka_unit_test(a_copy_wound_the_other_way_does_not_open_the_mesh),
        cmocka_unit_test(fins_go_and_needed_slivers_stay),
        cmocka_unit_test(what_cannot_be_mended_is_refused),
        cmocka_unit_test(the_box_holds_the_vertices),
        cmocka_unit_test(any_mixture_of_windings_gives_one_result),
        cmocka_unit_test(shared_meshes_are_mended),
        cmocka_unit_test(a_shared_open_mesh_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
