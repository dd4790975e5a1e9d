/* Convex hulls of voxels: digitised convex bodies, random voxels by brute force, voxels in a plane. */
#include "voxel/ms_grid_hull.h"

#include "mesh/ms_hull.h"
#include "support/grid_samples.h"
#include "support/test_support.h"

static size_t count_in_hull(const ms_grid *grid)
{
    ms_mesh centres, faces;
    size_t count = 0;
    ms_error err = {{0}};
    if (ms_grid_hull_build(&centres, &faces, grid, &err) != MS_OK ||
        ms_grid_hull_count(&count, &centres, grid, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    ms_mesh_free(&centres);
    ms_mesh_free(&faces);
    return count;
}

/* Of a convex body the hull of the voxels holds them and no other. */
static void convex_bodies(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"ball", "ellipsoid", "cube", "octahedron", "cylinder", "tetrahedron"};
    for (int b = 0; b < 6; b++) {
        for (int cells = 5; cells < 40; cells += 7) {
            ms_mesh mesh;
            ms_target target;
            make_shape(&mesh, KINDS[b], "");
            make_target(&target, &mesh, cells, MS_VOXEL_CENTRE);
            assert_int_equal(count_in_hull(&target.grid), target.voxels);
            ms_target_free(&target);
            ms_mesh_free(&mesh);
        }
    }
}

/* Does a voxel lie on the inner side of each triangle of a hull? */
static int is_in_all(const ms_mesh *hull, const double at[3])
{
    for (size_t t = 0; t < hull->n_triangles; t++) {
        const double *a = hull->vertex[hull->triangle[t][0]], *b = hull->vertex[hull->triangle[t][1]];
        const double *c = hull->vertex[hull->triangle[t][2]];
        double m[3][3];
        for (int x = 0; x < 3; x++) {
            m[0][x] = b[x] - a[x];
            m[1][x] = c[x] - a[x];
            m[2][x] = at[x] - a[x];
        }
        const double volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                              m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                              m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        if (volume > 1e-9) { /* whole numbers */
            return 0;
        }
    }
    return 1;
}

static void random_voxels(void **state)
{
    (void)state;
    uint64_t seed = 77;
    for (int round = 0; round < 60; round++) {
        ms_grid grid = empty_grid(9 + round % 5, 12, 10, 0.25);
        grid.origin[0] = 1e6;
        for (int v = 0; v < 5 + round; v++) {
            grid.inside[ms_grid_index(&grid, 2 + pick(&seed, grid.n[0] - 4), 2 + pick(&seed, 8), 2 + pick(&seed, 6))] =
                1;
        }
        ms_mesh centres, faces;
        assert_int_equal(ms_grid_hull_build(&centres, &faces, &grid, NULL), MS_OK);
        size_t expected = 0, count;
        for (int k = 0; k < grid.n[2]; k++) {
            for (int j = 0; j < grid.n[1]; j++) {
                for (int i = 0; i < grid.n[0]; i++) {
                    const double at[3] = {i, j, k};
                    expected += (size_t)is_in_all(&centres, at);
                }
            }
        }
        assert_int_equal(ms_grid_hull_count(&count, &centres, &grid, NULL), MS_OK);
        assert_int_equal(count, expected);
        ms_mesh_free(&centres);
        ms_mesh_free(&faces);
        ms_grid_free(&grid);
    }
}

/* Of 5 x 4 x 3 voxels: the centres span 4 x 3 x 2, the centres of faces as much as the voxels. */
static void a_box(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(9, 8, 7, 0.1);
    for (int v = 0; v < 60; v++) {
        grid.inside[ms_grid_index(&grid, 2 + v % 5, 2 + v / 5 % 4, 2 + v / 20)] = 1;
    }
    ms_mesh hull[2];
    assert_int_equal(ms_grid_hull_build(&hull[0], &hull[1], &grid, NULL), MS_OK);
    for (int h = 0; h < 2; h++) {
        double lo[3], hi[3];
        ms_mesh_box(lo, hi, &hull[h]);
        for (int a = 0; a < 3; a++) {
            expect_close(lo[a], 2 - 0.5 * h, 0);
            expect_close(hi[a], 6 - a + 0.5 * h, 0);
        }
        ms_mesh_free(&hull[h]);
    }
    ms_grid_free(&grid);
}

static void voxels_in_a_plane(void **state)
{
    (void)state;
    ms_mesh centres, faces;
    ms_error err = {{0}};
    ms_grid grid = empty_grid(9, 9, 9, 1);
    assert_int_equal(ms_grid_hull_build(&centres, &faces, &grid, &err), MS_ERR_SHAPE);
    assert_non_null(strstr(err.text, "no voxel"));
    assert_true(!centres.n_triangles && !faces.n_triangles);
    for (int v = 0; v < 9; v++) {
        grid.inside[ms_grid_index(&grid, 3 + v % 3, 3 + v / 3, 4)] = 1;
        assert_int_equal(ms_grid_hull_build(&centres, &faces, &grid, &err), MS_ERR_SHAPE);
        assert_true(!centres.n_triangles && faces.n_triangles >= 8);
        ms_mesh_free(&faces);
    }
    ms_grid_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(convex_bodies),
        cmocka_unit_test(random_voxels),
        cmocka_unit_test(a_box),
        cmocka_unit_test(voxels_in_a_plane),
    };
    return ms_hull_is_built() ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
