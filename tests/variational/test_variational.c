/* Runs of the variational generator and its options. */
#include "support/variational_samples.h"

#include <string.h>

#include "mesh/ms_closest.h"
#include "ms_generator_list.h"
#include "variational/ms_surface_tally.h"

/* k balls in a row, each overlapping the one before, as voxels; n = k spheres find them again. */
static void unions_are_recovered(void **state)
{
    (void)state;
    static const size_t K[] = {1, 2, 3, 5, 8};
    enum { SIDE = 176, SEEDS = 2 };
    int found = 0;
    for (size_t c = 0; c < sizeof K / sizeof *K; c++) {
        for (int seed = 0; seed < SEEDS; seed++) {
            ms_ball ball[8];
            uint32_t *label = calloc((size_t)SIDE * SIDE * SIDE, sizeof *label);
            ms_target target;
            ms_error err;
            assert_non_null(label);
            srand((unsigned)(100 * seed) + (unsigned)K[c]);
            for (size_t b = 0; b < K[c]; b++) {
                double length = 0, way[3];
                for (int a = 0; a < 3; a++) {
                    way[a] = uniform(-1, 1);
                    length += way[a] * way[a];
                }
                ball[b].radius = uniform(20, 32);
                for (int a = 0; a < 3; a++) {
                    const double from = b ? ball[b - 1].centre[a] : 88;
                    ball[b].centre[a] = fmin(fmax(from + 32 * way[a] / sqrt(length), 40), 136);
                }
            }
            for (size_t v = 0; v < (size_t)SIDE * SIDE * SIDE; v++) {
                const double p[3] = {(double)(v % SIDE), (double)(v / SIDE % SIDE), (double)(v / SIDE / SIDE)};
                for (size_t b = 0; b < K[c]; b++) {
                    label[v] |= ms_squared_distance(p, ball[b].centre) <= ball[b].radius * ball[b].radius;
                }
            }
            const ms_volume volume = {.n = {SIDE, SIDE, SIDE}, .spacing = 1, .label = label};
            assert_int_equal(ms_target_from_volume(&target, &volume, 0, &err), MS_OK);
            static const char *const OPTIONS[] = {"effort", "1", NULL};
            ms_clump clump = generate(&target, K[c], OPTIONS);
            const double dice = dice_of(&target, &clump);
            print_message("union of %zu balls: D = %.5f\n", K[c], dice);
            found += dice < 0.003;
            ms_clump_free(&clump);
            ms_target_free(&target);
            free(label);
        }
    }
    print_message("%d of 10 unions recovered to D < 0.003\n", found);
    assert_int_equal(found, 10);
}

/* By the exposed surface, below a voxel. */
static void find_worth(ms_surface_worth *worth, const ms_target *target, const ms_clump *clump)
{
    ms_signed_distance field;
    ms_lattice lattice;
    ms_error err;
    ms_ball ball[64];
    assert_true(clump->n_spheres <= 64);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ball[s] = ms_grid_ball(&target->grid, &clump->sphere[s]);
    }
    assert_int_equal(ms_signed_distance_open(&field, target, 1, &err), MS_OK);
    assert_int_equal(ms_lattice_alloc(&lattice, 1024, &err), MS_OK);
    field.cubic = 1;
    const ms_surface_fit fit = {.field = &field, .lattice = &lattice};
    assert_int_equal(ms_surface_tally(worth, NULL, NULL, &fit, ball, clump->n_spheres, &err), MS_OK);
    ms_lattice_free(&lattice);
}

/* Two balls and a neck take few spheres; without any of those given more voxels are amiss, or below a voxel more of the
 * surface. */
static void idle_spheres_are_not_given(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "dumbbell", "");
    make_target(&target, &mesh, 31, MS_VOXEL_CENTRE); /* not 30: 1 % of the centres would lie on the balls' surfaces */
    ms_clump clump = generate(&target, 40, NULL);
    assert_true(clump.n_spheres < 40);
    assert_true(dice_of(&target, &clump) < 0.003);
    ms_surface_worth worth[40];
    find_worth(worth, &target, &clump);
    ms_ball ball[40];
    for (size_t s = 0; s < clump.n_spheres; s++) {
        ball[s] = ms_grid_ball(&target.grid, &clump.sphere[s]);
    }
    const int64_t amiss = brute_mismatch(&target.grid, ball, clump.n_spheres);
    for (size_t gone = 0; gone < clump.n_spheres; gone++) {
        const ms_ball kept = ball[gone];
        ball[gone] = ball[gone ? 0 : clump.n_spheres - 1]; /* another one twice is as none */
        assert_true(brute_mismatch(&target.grid, ball, clump.n_spheres) > amiss || worth[gone].loss > 0);
        ball[gone] = kept;
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void protrusion_is_kept(void **state)
{
    const ms_target *target = *state;
    static const char *const BOUNDS[] = {"0", "1"};
    for (int b = 0; b < 2; b++) {
        const char *const options[] = {"protrusion", BOUNDS[b], NULL};
        ms_clump clump = generate(target, 20, options);
        assert_int_equal(clump.n_spheres, 20);
        for (size_t s = 0; s < clump.n_spheres; s++) {
            const double inside = -ms_closest_signed_distance(target->closest, clump.sphere[s].centre);
            assert_true(clump.sphere[s].radius <= inside + b * target->grid.h + 1e-9);
        }
        assert_true(dice_of(target, &clump) < 0.2);
        ms_clump_free(&clump);
    }
}

static void equal_radii_are_equal(void **state)
{
    const ms_target *target = *state;
    static const char *const OPTIONS[] = {"equal-radius", NULL, NULL};
    ms_clump clump = generate(target, 20, OPTIONS), unlike = generate(target, 20, NULL);
    for (size_t s = 1; s < clump.n_spheres; s++) {
        assert_true(clump.sphere[s].radius == clump.sphere[0].radius);
    }
    assert_true(dice_of(target, &clump) < 4 * dice_of(target, &unlike));
    ms_clump_free(&clump);
    ms_clump_free(&unlike);
}

/* Is there a sphere at the mirror image of each? */
static int is_symmetric(const ms_clump *clump, int axis)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        int found = 0;
        for (size_t t = 0; t < clump->n_spheres && !found; t++) {
            double image[3];
            memcpy(image, clump->sphere[s].centre, sizeof image);
            image[axis] = -image[axis];
            found = sqrt(ms_squared_distance(image, clump->sphere[t].centre)) < 1e-9 &&
                    fabs(clump->sphere[s].radius - clump->sphere[t].radius) < 1e-12;
        }
        if (!found) {
            return 0;
        }
    }
    return 1;
}

/* Shapes about the origin; the score stays near that of free spheres. */
static void symmetry_is_kept(void **state)
{
    (void)state;
    static const char *const SHAPES[] = {"tablet", "cube"};
    static const char *const OPTIONS[][5] = {
        {"symmetry", "x"}, {"symmetry", "xyz"}, {"symmetry", "yz", "protrusion", "0"}};
    static const int ACROSS[][3] = {{1, 0, 0}, {1, 1, 1}, {0, 1, 1}};
    for (size_t c = 0; c < sizeof SHAPES / sizeof *SHAPES; c++) {
        ms_mesh mesh;
        ms_target target;
        make_shape(&mesh, SHAPES[c], "");
        make_target(&target, &mesh, 31, MS_VOXEL_HALF);
        double unlike[2] = {0}; /* D without symmetry, for each number of spheres */
        for (size_t o = 0; o < sizeof OPTIONS / sizeof *OPTIONS; o++) {
            const char *const no_symmetry[3] = {OPTIONS[o][2], OPTIONS[o][3]};
            for (size_t n = 16; n <= 23; n += 7) {
                ms_clump clump = generate(&target, n, OPTIONS[o]);
                assert_true(clump.n_spheres <= n && clump.n_spheres + 3 >= n); /* whole sets of 8 images */
                for (int a = 0; a < 3; a++) {
                    assert_true(!ACROSS[o][a] || is_symmetric(&clump, a));
                }
                if (o == 0 || no_symmetry[0]) { /* else the one before */
                    ms_clump free = generate(&target, n, no_symmetry);
                    unlike[n > 16] = dice_of(&target, &free);
                    ms_clump_free(&free);
                }
                assert_true(dice_of(&target, &clump) < 1.5 * unlike[n > 16]);
                ms_clump_free(&clump);
            }
        }
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

static void planes_are_not_crossed(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    static const char *const OPTIONS[] = {"plane", "1,0,0,0.25", "plane", "0,0,2,0", NULL};
    make_shape(&mesh, "cube", "a=1");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    ms_clump clump = generate(&target, 30, OPTIONS), by_mss = generate_by(&ms_generator_mss, &target, 30, OPTIONS);
    assert_int_equal(clump.n_spheres, 30);
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_sphere *sphere = &clump.sphere[s];
        assert_true(fabs(sphere->centre[0] - 0.25) >= sphere->radius - 1e-12);
        assert_true(fabs(sphere->centre[2]) >= sphere->radius - 1e-12);
    }
    assert_true(dice_of(&target, &clump) < 0.9 * dice_of(&target, &by_mss));
    ms_clump_free(&clump);
    ms_clump_free(&by_mss);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Spheres along a line: those that come to be idle are put where others bear most; none is missing. */
static void row_is_filled(void **state)
{
    (void)state;
    enum { SPHERES = 60 };
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ellipsoid", "a=2 b=1 c=1 fineness=100");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    ms_clump clump = generate(&target, SPHERES, NULL);
    assert_int_equal(clump.n_spheres, SPHERES);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void effort_does_not_hurt(void **state)
{
    const ms_target *target = *state;
    static const char *const OPTIONS[][3] = {{"effort", "0"}, {"effort", "1"}, {"effort", "2"}};
    double before = 1;
    for (int effort = 0; effort < 3; effort++) {
        ms_clump clump = generate(target, 15, OPTIONS[effort]);
        const double dice = dice_of(target, &clump);
        assert_true(dice < before + 5e-4); /* judged by centres, scored by the rule of the target */
        before = dice;
        ms_clump_free(&clump);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unions_are_recovered),   cmocka_unit_test(idle_spheres_are_not_given),
        cmocka_unit_test(protrusion_is_kept),     cmocka_unit_test(equal_radii_are_equal),
        cmocka_unit_test(effort_does_not_hurt),   cmocka_unit_test(symmetry_is_kept),
        cmocka_unit_test(planes_are_not_crossed), cmocka_unit_test(row_is_filled),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
