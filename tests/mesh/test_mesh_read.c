/* Mesh files by their paths: the shared shapes, the broken inputs, and what is no mesh file. */
#include <unistd.h>

#include "mesh/formats/ms_mesh_read.h"
#include "support/reader_samples.h"

static void expect_refused(const char *path, ms_status status, const char *message)
{
    ms_mesh mesh;
    ms_error err = {{0}};
    assert_int_equal(ms_mesh_read(&mesh, path, &err), status);
    expect_message(&err, path);
    expect_message(&err, message);
    assert_null(mesh.vertex);
    assert_null(mesh.triangle);
    assert_int_equal(mesh.n_vertices + mesh.n_triangles, 0);
}

static void what_is_no_mesh_file_is_refused(void **state)
{
    char folder[64];
    char path[128];
    (void)state;
    make_folder(folder);
    expect_refused("shape.step", MS_ERR_FORMAT, "meshes are read from .stl, .obj, .ply and .off");
    expect_refused("shape", MS_ERR_FORMAT, "meshes are read from .stl, .obj, .ply and .off");
    expect_refused("none/shape.stl", MS_ERR_IO, "cannot be opened: No such file or directory; check the path");
    write_file(path, folder, "empty.obj", "", 0);
    expect_refused(path, MS_ERR_FORMAT, "is empty (0 bytes)");
    unlink(path);
    snprintf(path, sizeof path, "%s.stl", folder);
    assert_int_equal(rename(folder, path), 0);
    expect_refused(path, MS_ERR_IO, "is a folder");
    rmdir(path);
}

static void a_file_is_read_by_its_ending(void **state)
{
    const char *text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    char folder[64];
    char path[128];
    ms_mesh mesh;
    (void)state;
    make_folder(folder);
    write_file(path, folder, "a.OFF", text, strlen(text));
    assert_int_equal(ms_mesh_read(&mesh, path, NULL), MS_OK);
    assert_int_equal(mesh.n_triangles, 1);
    ms_mesh_free(&mesh);
    unlink(path);
    rmdir(folder);
    assert_true(ms_mesh_read_is_mesh_path("a.Stl") && ms_mesh_read_is_mesh_path("b/a.obj") &&
                ms_mesh_read_is_mesh_path("a.ply"));
    assert_false(ms_mesh_read_is_mesh_path("a.npy") || ms_mesh_read_is_mesh_path("stl") ||
                 ms_mesh_read_is_mesh_path("a.stl/b"));
}

/* Counts of the manifest, found by another program. */
typedef struct known_mesh {
    const char *name;
    size_t n_triangles;
    size_t n_vertices; /* 0 where the manifest does not say */
} known_mesh;

static void shared_meshes_are_read(void **state)
{
    static const known_mesh known[] = {{"asteroid_castalia.obj", 4092, 2048},
                                       {"boulder_SP2B.stl", 1128, 566},
                                       {"bunny.ply", 6966, 3485},
                                       {"ellipsoid_2_1_1.stl", 20480, 10242},
                                       {"human_femur.stl", 13752, 6878},
                                       {"lithic_flake2.ply", 172814, 86409},
                                       {"octahedron.stl", 2048, 1026},
                                       {"pear.stl", 1496, 750},
                                       {"powder_ma165_03636.stl", 20480, 10242},
                                       {"sand_grain.stl", 4000, 2002},
                                       {"torus.stl", 57600, 28800},
                                       {"bad/09_degenerate_duplicate_tris.stl", 1450, 0},
                                       {"bad/10_inverted_normals.stl", 1000, 0},
                                       {"bad/12_open_mesh.stl", 800, 0},
                                       {"bad/15_two_disjoint_bodies.stl", 2000, 0},
                                       {"bad/17_offset_1e9_double.obj", 1000, 0},
                                       {"bad/24_binary_starting_with_solid.stl", 1000, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        char path[512];
        ms_mesh mesh;
        ms_error err = {{0}};
        shared_path(path, known[i].name);
        if (ms_mesh_read(&mesh, path, &err) != MS_OK) {
            fail_msg("%s", err.text);
        }
        assert_int_equal(mesh.n_triangles, known[i].n_triangles);
        if (known[i].n_vertices > 0) {
            assert_int_equal(mesh.n_vertices, known[i].n_vertices);
        }
        ms_mesh_free(&mesh);
    }
}

static void broken_shared_meshes_are_refused(void **state)
{
    static const char *const broken[][2] = {
        {"bad/01_truncated_binary.stl", "cut after 617 of 1000 triangles: its header claims 50084 bytes"},
        {"bad/04_count_4294967295.stl", "cut after 100 of 4294967295 triangles"},
        {"bad/05_ascii_junk.stl", "line 4: a vertex has 'abc' where a number belongs"},
        {"bad/06_nan_inf.stl", "3 of 1000 triangles have a corner that is not finite"},
        {"bad/07_zero_triangles_binary.stl", "has no triangles"},
        {"bad/20_empty.stl", "is empty (0 bytes)"},
        {"bad/21_bad_header.ply", "line 2: the format 'binary_middle_endian'"},
        {"bad/26_points_only.ply", "has no faces (and 5 points)"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        char path[512];
        shared_path(path, broken[i][0]);
        expect_refused(path, MS_ERR_FORMAT, broken[i][1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_mesh_file_is_refused),
        cmocka_unit_test(a_file_is_read_by_its_ending),
        cmocka_unit_test(shared_meshes_are_read),
        cmocka_unit_test(broken_shared_meshes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
