/* The Euclidean method against brute force, and by hand in a cube. */
#include "ms_generator_list.h"
#include "support/run_samples.h"

/* The square of the distance of a voxel that is left to the nearest that is not; 0 for one that is not. */
static int brute_depth(const ms_grid *grid, const uint8_t *left, int at)
{
    const int voxels = (int)ms_grid_voxels(grid), nx = grid->n[0], ny = grid->n[1];
    int least = INT32_MAX;
    for (int v = 0; v < voxels; v++) {
        const int x = v % nx - at % nx, y = v / nx % ny - at / nx % ny, z = v / nx / ny - at / nx / ny;
        if (!left[v] && x * x + y * y + z * z < least) {
            least = x * x + y * y + z * z;
        }
    }
    return least;
}

/* Every sphere is about the first of the voxels that are farthest from what is outside or was taken out. */
static void check_against_brute_force(const ms_target *target, const char *options, double overlap, double offset)
{
    const ms_grid *grid = &target->grid;
    const int voxels = (int)ms_grid_voxels(grid), nx = grid->n[0], ny = grid->n[1];
    uint8_t *left = malloc((size_t)voxels);
    assert_non_null(left);
    memcpy(left, grid->inside, (size_t)voxels);
    ms_clump clump = run_generator(&ms_generator_euclid, target, (ms_stop){.spheres = 8}, options, NULL);
    assert_int_equal(clump.n_spheres, 8);
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_ball ball = ms_grid_ball(grid, &clump.sphere[s]);
        int best = 0, deepest = 0;
        for (int v = 0; v < voxels; v++) {
            const int depth = brute_depth(grid, left, v);
            best = depth > deepest ? v : best;
            deepest = depth > deepest ? depth : deepest;
        }
        const double c[3] = {best % nx, best / nx % ny, best / nx / ny};
        for (int a = 0; a < 3; a++) {
            assert_close(ball.centre[a], c[a], 1e-9);
        }
        assert_close(ball.radius, sqrt(deepest) + offset, 1e-6);
        for (int v = 0; v < voxels; v++) {
            const double x = v % nx - c[0], y = v / nx % ny - c[1], z = v / nx / ny - c[2];
            left[v] &= sqrt(x * x + y * y + z * z) > (1 - overlap) * sqrt(deepest) * (1 + 1e-7);
        }
    }
    ms_clump_free(&clump);
    free(left);
}

static void spheres_are_those_of_brute_force(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target box, grain;
    make_voxel_box(&box, (int[3]){11, 7, 8});
    check_against_brute_force(&box, "overlap=0.55 radius-offset=0", 0.55, 0);
    make_shape(&mesh, "grain", "fineness=12");
    make_target(&grain, &mesh, 13, MS_VOXEL_HALF);
    check_against_brute_force(&grain, "overlap=0.37 radius-offset=-0.5", 0.37, -0.5);
    ms_target_free(&grain);
    ms_mesh_free(&mesh);
    ms_target_free(&box);
}

/* A cube of 7 voxels: 4 from its middle to the nearest voxel outside. Without overlap each voxel within 4 is out, and
 * the corners are left: sqrt(27) from the middle, 1 from the outside. The run ends when no voxel is left. */
static void a_cube_by_hand(void **state)
{
    (void)state;
    ms_target target;
    ms_stop_reason reason;
    make_voxel_box(&target, (int[3]){7, 7, 7});
    ms_clump clump =
        run_generator(&ms_generator_euclid, &target, (ms_stop){.spheres = 500}, "overlap=0 radius-offset=0", &reason);
    assert_int_equal(reason, MS_STOP_EXHAUSTED);
    assert_close(clump.sphere[0].radius, 4, 1e-12);
    for (size_t s = 1; s < clump.n_spheres; s++) {
        assert_close(clump.sphere[s].radius, 1, 1e-12);
        for (size_t b = 0; b < s; b++) { /* the centre of none is in another */
            const double *c = clump.sphere[s].centre, *p = clump.sphere[b].centre;
            assert_true(hypot(hypot(p[0] - c[0], p[1] - c[1]), p[2] - c[2]) > clump.sphere[b].radius);
        }
    }
    ms_clump_free(&clump);
    clump =
        run_generator(&ms_generator_euclid, &target, (ms_stop){.radius = 1.5}, "overlap=0 radius-offset=0", &reason);
    assert_int_equal(reason, MS_STOP_RADIUS);
    assert_int_equal(clump.n_spheres, 1);
    ms_clump_free(&clump);
    ms_target_free(&target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_are_those_of_brute_force),
        cmocka_unit_test(a_cube_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
