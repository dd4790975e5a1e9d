/* MSS with variant=best: the spheres asked for, or a word that there are none; gains and radii by brute force. */
#include <stdlib.h>

#include "mss/ms_mss_coarse.h"
#include "mss/ms_mss_fit.h"
#include "mss/ms_mss_open.h"
#include "support/mss_samples.h"

/* Bodies with few maxima of E get the spheres asked for; the first k of them are the clump of k. */
static void smooth_bodies_get_their_spheres(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"cube", "box", "tablet"};
    for (size_t kind = 0; kind < sizeof KINDS / sizeof *KINDS; kind++) {
        ms_mesh mesh;
        ms_target target;
        make_shape(&mesh, KINDS[kind], "");
        make_target(&target, &mesh, 40, MS_VOXEL_HALF);
        mss_outcome many = run_mss(&target, at_most(60), ""), few = run_mss(&target, at_most(17), "");
        assert_int_equal(many.clump.n_spheres, 60);
        assert_int_equal(few.clump.n_spheres, 17);
        assert_memory_equal(many.clump.sphere, few.clump.sphere, 17 * sizeof *few.clump.sphere);
        ms_clump_free(&many.clump);
        ms_clump_free(&few.clump);
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

/* Whatever step the last sphere falls into: some of a step are seen to gain nothing when they are fitted. */
static void a_clump_of_any_number_begins_a_larger_one(void **state)
{
    enum { MOST = 66 };
    ms_mesh mesh;
    ms_target target;
    (void)state;
    make_shape(&mesh, "grain", "");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    mss_outcome whole = run_mss(&target, at_most(MOST), "");
    assert_int_equal(whole.clump.n_spheres, MOST);
    for (size_t n = 46; n < MOST; n += 4) {
        mss_outcome part = run_mss(&target, at_most(n), "");
        assert_int_equal(part.clump.n_spheres, n);
        assert_memory_equal(part.clump.sphere, whole.clump.sphere, n * sizeof *part.clump.sphere);
        ms_clump_free(&part.clump);
    }
    ms_clump_free(&whole.clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* An ellipsoid by few cells runs out of spheres that lower the mismatch: the limit of the method (docs/methods/mss.md).
 * The run then says that it is exhausted, and its spheres are those of a run that asked for just as many. */
static void smooth_ellipsoid_is_exhausted(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ellipsoid", "");
    make_target(&target, &mesh, 18, MS_VOXEL_HALF);
    mss_outcome all = run_mss(&target, at_most(200), "");
    const size_t n = all.clump.n_spheres;
    assert_int_equal(all.reason, MS_STOP_EXHAUSTED);
    assert_in_range(n, 2, 199);
    mss_outcome same = run_mss(&target, at_most(n), "");
    assert_int_equal(same.reason, MS_STOP_SPHERES);
    assert_memory_equal(all.clump.sphere, same.clump.sphere, n * sizeof *all.clump.sphere);
    ms_clump_free(&all.clump);
    ms_clump_free(&same.clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static long count_difference(const ms_target *target, const ms_clump *clump)
{
    const ms_grid *grid = &target->grid;
    long differ = 0;
    for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
        const double at[3] = {(double)(v % (size_t)grid->n[0]), (double)(v / (size_t)grid->n[0] % (size_t)grid->n[1]),
                              (double)(v / (size_t)grid->n[0] / (size_t)grid->n[1])};
        int covered = 0;
        for (size_t s = 0; s < clump->n_spheres; s++) {
            const ms_ball ball = ms_grid_ball(grid, &clump->sphere[s]);
            double square = 0;
            for (int a = 0; a < 3; a++) {
                square += (at[a] - ball.centre[a]) * (at[a] - ball.centre[a]);
            }
            covered |= square <= ball.radius * ball.radius + 1e-9;
        }
        differ += covered != grid->inside[v];
    }
    return differ;
}

/* Polishing keeps the centres and lowers the mismatch; then no radius alone can be bettered by a voxel or less. */
static void polish_fits_radii(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "grain", "");
    make_target(&target, &mesh, 30, MS_VOXEL_CENTRE);
    mss_outcome plain = run_mss(&target, at_most(30), ""), polished = run_mss(&target, at_most(30), "polish=on");
    assert_int_equal(polished.clump.n_spheres, 30);
    for (size_t s = 0; s < 30; s++) {
        assert_memory_equal(polished.clump.sphere[s].centre, plain.clump.sphere[s].centre, sizeof(double[3]));
    }
    const long before = count_difference(&target, &plain.clump), after = count_difference(&target, &polished.clump);
    assert_true(100 * after < 97 * before);
    ms_settings settings;
    ms_error err;
    assert_int_equal(ms_option_settings_init(&settings, ms_generator_mss.options, &err), MS_OK);
    assert_true(ms_generator_is_nested(&ms_generator_mss, NULL));
    assert_true(ms_generator_is_nested(&ms_generator_mss, &settings));
    assert_int_equal(ms_option_settings_set(&settings, "polish", "on", &err), MS_OK);
    assert_false(ms_generator_is_nested(&ms_generator_mss, &settings));
    ms_option_settings_free(&settings);
    ms_sphere *last = &polished.clump.sphere[29]; /* the last to be fitted: the others have not moved since */
    const double radius = last->radius;
    for (double by = -1; by <= 1; by += 0.125) {
        last->radius = radius + by * target.grid.h;
        assert_true(count_difference(&target, &polished.clump) >= after);
    }
    ms_clump_free(&plain.clump);
    ms_clump_free(&polished.clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Gains by bits against a loop over all voxels, with some covered; rows of more than one word. */
static void gains_are_counted(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_raster raster;
    ms_mss_open open;
    ms_error err;
    make_shape(&mesh, "ellipsoid", "a=2.2 b=1 c=1");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    const ms_grid *grid = &target.grid;
    assert_true(grid->n[0] > 64);
    assert_int_equal(ms_mss_open_init(&open, grid, &err), MS_OK);
    assert_int_equal(ms_raster_alloc(&raster, grid, MS_VOXEL_HALF, &err), MS_OK);
    srand(5);
    for (int round = 0; round < 40; round++) {
        ms_ball ball = {{0, 0, 0}, 0.3 + 14.0 * rand() / RAND_MAX};
        for (int a = 0; a < 3; a++) {
            ball.centre[a] = grid->n[a] * (-0.05 + 1.1 * rand() / RAND_MAX);
        }
        long gain = 0;
        for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
            const double x = (double)(v % (size_t)grid->n[0]) - ball.centre[0],
                         y = (double)(v / (size_t)grid->n[0] % (size_t)grid->n[1]) - ball.centre[1],
                         z = (double)(v / (size_t)grid->n[0] / (size_t)grid->n[1]) - ball.centre[2];
            if (raster.first[v] == MS_RASTER_NONE && x * x + y * y + z * z <= ball.radius * ball.radius) {
                gain += grid->inside[v] ? 1 : -1;
            }
        }
        assert_int_equal(ms_mss_open_gain(&open, &ball), gain);
        if (round % 3 == 0) {
            assert_int_equal(ms_raster_add(&raster, &ball, 1, &err), MS_OK);
            ms_mss_open_cover(&open, &raster, raster.n_balls - 1);
        }
    }
    ms_raster_free(&raster);
    ms_mss_open_free(&open);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* How much of a voxel [i - 1/2, i + 1/2] lies in [lo, hi]. */
static double overlap(int i, double lo, double hi)
{
    return fmax(0, fmin(i + 0.5, hi) - fmax(i - 0.5, lo));
}

/* The part of a coarse voxel that is inside, by a loop over the voxels that it may touch. */
static double share_inside(const ms_mss_coarse *coarse, const ms_grid *fine, const int at[3])
{
    double share = 0, centre[3];
    for (int a = 0; a < 3; a++) {
        centre[a] = (coarse->target.grid.origin[a] + coarse->target.grid.h * at[a] - fine->origin[a]) / fine->h;
    }
    for (int k = 0; k < fine->n[2]; k++) {
        for (int j = 0; j < fine->n[1]; j++) {
            const double yz = overlap(j, centre[1] - 1, centre[1] + 1) * overlap(k, centre[2] - 1, centre[2] + 1);
            for (int i = 0; yz > 0 && i < fine->n[0]; i++) {
                share += fine->inside[ms_grid_index(fine, i, j, k)] * yz * overlap(i, centre[0] - 1, centre[0] + 1) / 8;
            }
        }
    }
    return share;
}

/* More than half of a coarse voxel, for odd and even extents; places go there and back; a hull of background. */
static void coarse_view_halves_the_target(void **state)
{
    (void)state;
    for (int cells = 12; cells <= 13; cells++) {
        ms_mesh mesh;
        ms_target target;
        ms_mss_coarse coarse;
        ms_error err;
        make_shape(&mesh, "grain", "");
        make_target(&target, &mesh, cells, MS_VOXEL_HALF);
        assert_int_equal(ms_mss_coarse_make(&coarse, &target, &err), MS_OK);
        const ms_grid *grid = &coarse.target.grid;
        size_t inside = 0;
        for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
            const int at[3] = {(int)(v % (size_t)grid->n[0]), (int)(v / (size_t)grid->n[0] % (size_t)grid->n[1]),
                               (int)(v / (size_t)grid->n[0] / (size_t)grid->n[1])};
            assert_int_equal(grid->inside[v], share_inside(&coarse, &target.grid, at) > 0.5 + 1e-9);
            inside += grid->inside[v];
            for (int a = 0; a < 3; a++) {
                assert_true(!grid->inside[v] || (at[a] >= MS_GRID_HULL && at[a] < grid->n[a] - MS_GRID_HULL));
            }
        }
        assert_int_equal(coarse.target.voxels, inside);
        const ms_ball ball = {{3.25, 4.5, 5.125}, 2.375}, own = ms_mss_coarse_target_ball(&coarse, &ball);
        const ms_ball back = ms_mss_coarse_ball(&coarse, &own);
        assert_memory_equal(&back, &ball, sizeof ball);
        for (int a = 0; a < 3; a++) {
            const double seen = grid->origin[a] + grid->h * ball.centre[a];
            assert_true(fabs(target.grid.origin[a] + target.grid.h * own.centre[a] - seen) < 1e-12);
        }
        assert_true(fabs(own.radius * target.grid.h - ball.radius * grid->h) < 1e-12);
        ms_mss_coarse_free(&coarse);
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

/* A ball beside the place where it gains most goes there, and its mirror image to the mirror image of that place. */
static void balls_move_where_they_gain(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_mss_open open;
    ms_error err;
    make_shape(&mesh, "ball", "");
    make_target(&target, &mesh, 31, MS_VOXEL_HALF);
    const ms_run run = {.target = &target, .settings = &(ms_settings){.value = (double[16]){0}}};
    ms_mss_run m = {.run = &run};
    assert_int_equal(ms_mss_field_init(&m.field, &target, run.settings, &err), MS_OK);
    assert_int_equal(ms_mss_open_init(&open, &target.grid, &err), MS_OK);
    const double middle = 0.5 * (target.grid.n[0] - 1);
    ms_ball ball = {{middle + 2.3, middle - 1.6, middle + 0.4}, 12};
    const long before = ms_mss_open_gain(&open, &ball), after = ms_mss_fit_place(&ball, &open, &m);
    assert_true(after > before);
    assert_int_equal(after, ms_mss_open_gain(&open, &ball));
    for (int a = 0; a < 3; a++) {
        assert_true(fabs(ball.centre[a] - middle) <= 0.5);
    }
    ms_ball image = {{middle - 2.3, middle - 1.6, middle + 0.4}, 12};
    assert_int_equal(ms_mss_fit_place(&image, &open, &m), after);
    assert_true(fabs(image.centre[0] + ball.centre[0] - 2 * middle) < 1e-9);
    assert_true(fabs(image.centre[1] - ball.centre[1]) + fabs(image.radius - ball.radius) < 1e-9);
    ms_mss_open_free(&open);
    ms_mss_field_free(&m.field);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_bodies_get_their_spheres),
        cmocka_unit_test(a_clump_of_any_number_begins_a_larger_one),
        cmocka_unit_test(smooth_ellipsoid_is_exhausted),
        cmocka_unit_test(polish_fits_radii),
        cmocka_unit_test(gains_are_counted),
        cmocka_unit_test(coarse_view_halves_the_target),
        cmocka_unit_test(balls_move_where_they_gain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
