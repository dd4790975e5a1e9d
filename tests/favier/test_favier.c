/* Favier's spheres: where they are on the axis, and how large, in bodies where both are known. */
#include "ms_generator_list.h"
#include "support/run_samples.h"

/* Is there a sphere about (x, y, z) of that radius? */
static void assert_sphere(const ms_clump *clump, const double centre[3], double radius, double tolerance)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *sphere = &clump->sphere[s];
        double off = fabs(sphere->radius - radius);
        for (int a = 0; a < 3; a++) {
            off = fmax(off, fabs(sphere->centre[a] - centre[a]));
        }
        if (off <= tolerance) {
            return;
        }
    }
    fail_msg("no sphere about (%g, %g, %g) of radius %g", centre[0], centre[1], centre[2], radius);
}

/* 5 x 21 x 5 voxels: seven centres, three voxels apart, half a voxel more than to the nearest voxel of the border. */
static void a_rod_is_cut_into_equal_parts(void **state)
{
    (void)state;
    ms_target target;
    ms_stop_reason reason;
    make_voxel_box(&target, (int[3]){5, 21, 5});
    ms_clump clump = run_generator(&ms_generator_favier, &target, (ms_stop){.spheres = 7}, "", &reason);
    assert_int_equal(reason, MS_STOP_SPHERES);
    assert_int_equal(clump.n_spheres, 7);
    for (int s = 0; s < 7; s++) {
        assert_sphere(&clump, (double[3]){2, 1 + 3 * s, 2}, s == 0 || s == 6 ? 1.5 : 2.5, 1e-9);
    }
    ms_clump_free(&clump);
    ms_stop stop = {.spheres = 7, .radius = 2};
    clump = run_generator(&ms_generator_favier, &target, stop, "", &reason);
    assert_int_equal(reason, MS_STOP_RADIUS);
    assert_int_equal(clump.n_spheres, 5);
    ms_clump_free(&clump);
    ms_target_free(&target);
}

/* The axis of a torus passes through its hole, where there is no place for a centre. */
static void a_hole_holds_no_centre(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "torus", "R=3 r=1 fineness=30");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    ms_clump clump = run_generator(&ms_generator_favier, &target, (ms_stop){.spheres = 2}, "", NULL);
    assert_int_equal(clump.n_spheres, 2);
    for (int side = -1; side <= 1; side += 2) { /* to half a voxel; vertices are sparse */
        assert_sphere(&clump, (double[3]){3.0 * side, 0, 0}, 1, 0.5 * target.grid.h + 0.01);
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* More spheres than the axis has places for end a search that cannot succeed. */
static void a_measure_out_of_reach_ends(void **state)
{
    (void)state;
    ms_target target;
    ms_stop_reason reason;
    make_voxel_box(&target, (int[3]){9, 30, 9});
    ms_clump clump = run_generator(&ms_generator_favier, &target, (ms_stop){.coverage = 0.999}, "", &reason);
    assert_int_equal(reason, MS_STOP_EXHAUSTED);
    assert_in_range(clump.n_spheres, 121, 240);
    ms_clump_free(&clump);
    ms_target_free(&target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rod_is_cut_into_equal_parts),
        cmocka_unit_test(a_hole_holds_no_centre),
        cmocka_unit_test(a_measure_out_of_reach_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
