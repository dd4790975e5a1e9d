/* Meshes of fewer triangles: how few, and that what is left lies on the mesh. */
#include "mesh/ms_mesh_decimate.h"

#include "mesh/ms_inertia.h"
#include "support/test_support.h"

static void ball(void **state)
{
    (void)state;
    ms_mesh mesh, few;
    ms_error err;
    make_shape(&mesh, "ball", "r=2.385");
    for (size_t most = mesh.n_triangles / 2; most > 200; most /= 3) {
        assert_int_equal(ms_mesh_decimate(&few, &mesh, most, &err), MS_OK);
        assert_true(few.n_triangles <= most && few.n_triangles > most / 4);
        for (size_t v = 0; v < few.n_vertices; v++) {
            const double *p = few.vertex[v];
            assert_close(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), 2.385, 1e-6);
        }
        for (size_t t = 0; t < few.n_triangles; t++) {
            assert_true(few.triangle[t][0] < few.n_vertices && few.triangle[t][0] != few.triangle[t][1]);
        }
        assert_close(ms_mesh_area(&few), 4 * acos(-1.0) * 2.385 * 2.385, 0.1 * ms_mesh_area(&mesh));
        ms_mesh_free(&few);
    }
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ball)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
