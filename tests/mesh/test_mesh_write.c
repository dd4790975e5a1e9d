/* Meshes written, read back, and not written. */
#include <unistd.h>

#include "mesh/formats/ms_mesh_read.h"
#include "mesh/formats/ms_mesh_write.h"
#include "support/body_samples.h"

static void expect_read_back(const ms_mesh *mesh, const char *path, int single)
{
    ms_mesh read;
    ms_error err = {{0}};
    if (ms_mesh_read(&read, path, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    assert_int_equal(read.n_vertices, mesh->n_vertices);
    assert_int_equal(read.n_triangles, mesh->n_triangles);
    for (size_t k = 0; k < 9 * mesh->n_triangles; k++) {
        double written = mesh->vertex[mesh->triangle[k / 9][k / 3 % 3]][k % 3];
        double got = read.vertex[read.triangle[k / 9][k / 3 % 3]][k % 3];
        assert_true(got == (single ? (double)(float)written : written));
    }
    ms_mesh_free(&read);
}

static void meshes_are_written_and_read(void **state)
{
    static const char *const ending[] = {"stl", "obj", "ply", "off", "PLY"};
    char folder[64];
    (void)state;
    make_folder(folder);
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        double value[MS_SHAPE_MAX_PARAMETERS];
        default_values(value, kind);
        value[fineness_at(kind)] = 7;
        ms_mesh mesh = make_body(kind->name, value);
        for (size_t k = 0; k < sizeof ending / sizeof *ending; k++) {
            char path[128];
            ms_error err = {{0}};
            snprintf(path, sizeof path, "%s/a.%s", folder, ending[k]);
            if (ms_mesh_write(&mesh, path, &err) != MS_OK) {
                fail_msg("%s", err.text);
            }
            expect_read_back(&mesh, path, k == 0);
            unlink(path);
        }
        ms_mesh_free(&mesh);
    }
    rmdir(folder);
}

static void an_stl_does_not_claim_to_be_text(void **state)
{
    char folder[64], path[128];
    ms_bytes bytes;
    (void)state;
    make_folder(folder);
    snprintf(path, sizeof path, "%s/cube.stl", folder);
    ms_mesh mesh = unit_cube();
    assert_int_equal(ms_mesh_write(&mesh, path, NULL), MS_OK);
    assert_int_equal(ms_file_read(&bytes, path, NULL), MS_OK);
    assert_int_equal(bytes.size, 84 + 50 * 12);
    assert_true(strncmp((const char *)bytes.data, "solid", 5) != 0);
    ms_file_free(&bytes);
    unlink(path);
    rmdir(folder);
    ms_mesh_free(&mesh);
}

static void what_cannot_be_written_is_refused(void **state)
{
    char folder[64], path[128];
    ms_error err = {{0}};
    (void)state;
    ms_mesh mesh = unit_cube();
    assert_int_equal(ms_mesh_write(&mesh, "cube.step", &err), MS_ERR_ARG);
    expect_message(&err, "cube.step: a mesh is written as .stl, .obj, .ply or .off");
    assert_int_equal(ms_mesh_write(&mesh, "cube", &err), MS_ERR_ARG);
    assert_int_equal(ms_mesh_write(&mesh, "none/cube.stl", &err), MS_ERR_IO);
    expect_message(&err, "none/cube.stl");
    make_folder(folder);
    snprintf(path, sizeof path, "%s/cube.stl", folder);
    mesh.vertex[2][1] = 1e39;
    assert_int_equal(ms_mesh_write(&mesh, path, &err), MS_ERR_ARG);
    expect_message(&err, "vertex 2 has the coordinate 1e+39, which STL cannot hold");
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(rmdir(folder), 0); /* nothing is left in it */
    ms_mesh_free(&mesh);
    FILE *full = fopen("/dev/full", "wb");
    if (full) {
        fclose(full);
        static const char *const link_name[] = {"a.stl", "a.obj", "a.ply", "a.off"};
        for (int k = 0; k < 4; k++) {
            make_folder(folder);
            snprintf(path, sizeof path, "%s/%s", folder, link_name[k]);
            assert_int_equal(symlink("/dev/full", path), 0);
            mesh = make_body("ball", (double[]){1, 24});
            assert_int_equal(ms_mesh_write(&mesh, path, &err), MS_ERR_IO);
            expect_message(&err, path);
            ms_mesh_free(&mesh);
            unlink(path);
            rmdir(folder);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_are_written_and_read),
        cmocka_unit_test(an_stl_does_not_claim_to_be_text),
        cmocka_unit_test(what_cannot_be_written_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
