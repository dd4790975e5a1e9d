/* Inscribed spheres: the way to the medial axis, and the places that cover most. */
#include "support/variational_samples.h"

#include <omp.h>
#include <string.h>

#include "variational/ms_climb.h"
#include "variational/ms_inscribed.h"

static ms_surface_fit make_fit(ms_signed_distance *field, const ms_target *target)
{
    ms_error err;
    assert_int_equal(ms_signed_distance_open(field, target, 1, &err), MS_OK);
    return (ms_surface_fit){.field = field, .bounds = {.least = 0.5}};
}

/* Between two faces half-way, and no farther: along the sheet there they grow no more. */
static void climbs_to_the_sheet(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "box", "a=4 b=2 c=1");
    make_target(&target, &mesh, 20, MS_VOXEL_HALF);
    for (int t = 0; t < 100; t++) {
        const double half = uniform(-0.49, 0.49);
        const ms_sphere at = {.centre = {uniform(-1.4, 1.4), uniform(-0.4, 0.4), half}, .radius = 0.5};
        const ms_ball from = ms_grid_ball(&target.grid, &at);
        ms_ball ball = from;
        ms_climb(&ball, &target, uniform(0.2, 8));
        assert_true(fabs(ball.radius - from.radius) < 0.01);
        assert_true(fabs(ball.centre[0] - from.centre[0]) < 1e-6 && fabs(ball.centre[1] - from.centre[1]) < 1e-6);
        assert_true(fabs(ball.centre[2] - from.centre[2] + half * 20) < 0.01);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Two in a box of two cubes: both are as large as they can be and apart in one place alone. */
static void two_fill_two_cubes(void **state)
{
    (void)state;
    for (int cells = 20; cells <= 60; cells += 40) { /* counted on every voxel, and on every second one first */
        ms_mesh mesh;
        ms_target target;
        ms_signed_distance field;
        ms_error err;
        make_shape(&mesh, "box", "a=2 b=1 c=1");
        make_target(&target, &mesh, cells, MS_VOXEL_HALF);
        const ms_surface_fit fit = make_fit(&field, &target);
        const ms_sphere bad[2] = {{.centre = {-0.7, 0.1, 0}, .radius = 0.3},
                                  {.centre = {-0.5, -0.2, 0.1}, .radius = 0.3}};
        ms_ball ball[2] = {ms_grid_ball(&target.grid, &bad[0]), ms_grid_ball(&target.grid, &bad[1])};
        assert_true(ms_inscribed_applies(&fit));
        assert_int_equal(ms_inscribed_improve(ball, 2, &fit, &err), MS_OK);
        for (int b = 0; b < 2; b++) {
            const ms_sphere got = ms_grid_sphere(&target.grid, &ball[b]);
            print_message("%d cells: %.4f %.4f %.4f radius %.5f\n", cells, got.centre[0], got.centre[1], got.centre[2],
                          got.radius);
            assert_true(fabs(got.radius - 0.5) < 0.01 / cells);
            assert_true(fabs(fabs(got.centre[0]) - 0.5) < 1.0 / cells);
        }
        assert_true(fabs(fabs(ball[0].centre[0] - ball[1].centre[0]) - cells) < 1.5);
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

/* Of a rough grain more is covered, by as many, all within; to the same bits by any number of threads. */
static void covers_more_and_stays_inscribed(void **state)
{
    (void)state;
    enum { COUNT = 15 };
    ms_mesh mesh;
    ms_target target;
    ms_signed_distance field;
    ms_error err;
    ms_ball first[COUNT], ball[COUNT], again[COUNT];
    make_shape(&mesh, "grain", "noise=0.3 fineness=20");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    const ms_surface_fit fit = make_fit(&field, &target);
    for (int b = 0; b < COUNT; b++) {
        do {
            for (int a = 0; a < 3; a++) {
                first[b].centre[a] = uniform(0, target.grid.n[a]);
            }
            first[b].radius = ms_bounds_most_radius(&fit.bounds, &field, first[b].centre);
        } while (first[b].radius < 1);
    }
    memcpy(ball, first, sizeof ball);
    memcpy(again, first, sizeof again);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    assert_int_equal(ms_inscribed_improve(ball, COUNT, &fit, &err), MS_OK);
    omp_set_num_threads(3);
    assert_int_equal(ms_inscribed_improve(again, COUNT, &fit, &err), MS_OK);
    omp_set_num_threads(threads);
    assert_memory_equal(ball, again, sizeof ball);
    const int64_t before = brute_mismatch(&target.grid, first, COUNT),
                  after = brute_mismatch(&target.grid, ball, COUNT);
    print_message("mismatch %lld before, %lld after\n", (long long)before, (long long)after);
    assert_true(2 * after < before);
    for (int b = 0; b < COUNT; b++) {
        assert_true(ball[b].radius >= fit.bounds.least);
        assert_true(ball[b].radius <= ms_bounds_most_radius(&fit.bounds, &field, ball[b].centre) + 1e-9);
    }
    assert_int_equal(ms_inscribed_improve(again, COUNT, &fit, &err), MS_OK);
    assert_true(brute_mismatch(&target.grid, again, COUNT) <= after);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* What else bounds a sphere, or shares its radius, its place does not say. */
static void other_bounds_are_not_its_own(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_signed_distance field;
    make_shape(&mesh, "cube", "");
    make_target(&target, &mesh, 10, MS_VOXEL_HALF);
    const ms_surface_fit fit = make_fit(&field, &target);
    ms_surface_fit other = fit;
    assert_true(ms_inscribed_applies(&fit));
    other.bounds.equal = 1;
    assert_false(ms_inscribed_applies(&other));
    other = fit;
    other.bounds.protrusion = 0.5;
    assert_false(ms_inscribed_applies(&other));
    other = fit;
    other.mirror.across[1] = 1;
    assert_false(ms_inscribed_applies(&other));
    ms_settings planes = {.n_planes = 1};
    other = fit;
    other.bounds.planes = &planes;
    assert_false(ms_inscribed_applies(&other));
    target.closed = 0;
    assert_false(ms_inscribed_applies(&fit));
    target.closed = 1;
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(climbs_to_the_sheet),
        cmocka_unit_test(two_fill_two_cubes),
        cmocka_unit_test(covers_more_and_stays_inscribed),
        cmocka_unit_test(other_bounds_are_not_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
