/* The variational generator and its parts: signed distances, losses, fits, bounds. */
#include "support/test_support.h"

#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "mesh/ms_closest.h"
#include "ms_generator_list.h"
#include "variational/ms_coverage_count.h"
#include "variational/ms_pattern_search.h"
#include "variational/ms_prune.h"
#include "variational/ms_surface_fit.h"

static double uniform(double from, double to)
{
    return from + (to - from) * rand() / RAND_MAX;
}

static ms_clump generate_by(const ms_generator *generator, const ms_target *target, size_t n,
                            const char *const *options)
{
    ms_settings settings;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    assert_int_equal(ms_option_settings_init(&settings, generator->options, &err), MS_OK);
    for (; options && options[0]; options += 2) {
        assert_int_equal(ms_option_settings_set(&settings, options[0], options[1], &err), MS_OK);
    }
    ms_run run = {.target = target, .settings = &settings, .seed = 3};
    run.stop.spheres = n;
    if (ms_generator_run(&clump, &reason, generator, &run, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    ms_option_settings_free(&settings);
    return clump;
}

static ms_clump generate(const ms_target *target, size_t n, const char *const *options)
{
    return generate_by(&ms_generator_variational, target, n, options);
}

static double dice_of(const ms_target *target, const ms_clump *clump)
{
    ms_metrics metrics;
    ms_error err;
    assert_int_equal(ms_metrics_compute(&metrics, NULL, target, clump, 1u << 28, &err), MS_OK);
    return metrics.score.dice;
}

/* |S xor U| by voxels' centres, by brute force. */
static int64_t brute_mismatch(const ms_grid *grid, const ms_ball *ball, size_t count)
{
    int64_t sum = 0;
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                const double p[3] = {i, j, k};
                int covered = 0;
                for (size_t b = 0; b < count; b++) {
                    covered |= ms_squared_distance(p, ball[b].centre) <= ball[b].radius * ball[b].radius;
                }
                sum += covered != grid->inside[ms_grid_index(grid, i, j, k)];
            }
        }
    }
    return sum;
}

/* Exact at the nodes, linear between them, and beyond the lattice never too small. */
static void field_is_the_distance(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_signed_distance field;
    ms_error err;
    make_shape(&mesh, "ball", "r=1 fineness=60");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    const ms_sphere unit = {.radius = 1};
    const ms_ball ball = ms_grid_ball(&target.grid, &unit);
    const double *middle = ball.centre, radius = ball.radius;
    for (int step = 1; step <= 3; step++) {
        assert_int_equal(ms_signed_distance_alloc(&field, &target, step, &err), MS_OK);
        for (int t = 0; t < 300; t++) {
            const double p[3] = {uniform(-3, 37), uniform(-3, 37), uniform(-3, 37)};
            const double truth = sqrt(ms_squared_distance(p, middle)) - radius;
            const double away = fmax(2, sqrt(ms_squared_distance(p, middle)));
            /* Linear: off by up to 3/8 step^2 times the curvature; beyond the lattice by the corner's way. */
            const int beyond = p[0] < 0 || p[1] < 0 || p[2] < 0 || p[0] > 33 || p[1] > 33 || p[2] > 33;
            const double phi = ms_signed_distance_at(&field, p);
            assert_true(phi > truth - 0.4 * step * step / away - 0.05);
            assert_true(phi < truth + 0.8 * step * step / away + 0.05 + 3 * beyond);
        }
        ms_signed_distance_free(&field);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void losses_are_those_of_brute_force(void **state)
{
    (void)state;
    ms_grid grid;
    ms_error err;
    const int n[3] = {13, 11, 9};
    const double origin[3] = {0, 0, 0};
    assert_int_equal(ms_grid_alloc(&grid, n, 1, origin, &err), MS_OK);
    for (int t = 0; t < 100; t++) {
        ms_ball ball[6];
        ms_coverage_count o;
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            grid.inside[v] = rand() % 2 != 0;
        }
        for (int b = 0; b < 6; b++) {
            ball[b] = (ms_ball){{uniform(-3, 16), uniform(-3, 14), uniform(-3, 12)}, uniform(0, 6)};
        }
        assert_int_equal(ms_coverage_count_open(&o, &grid, ball, 5, &err), MS_OK);
        const int64_t all = brute_mismatch(&grid, ball, 5);
        assert_int_equal(o.mismatch, all);
        assert_int_equal(ms_coverage_count_loss(&o, &ball[4]), brute_mismatch(&grid, ball, 4) - all);
        assert_int_equal(ms_coverage_count_gain(&o, &ball[5]), all - brute_mismatch(&grid, ball, 6));
        ms_coverage_count_add(&o, &ball[5]);
        assert_int_equal(o.mismatch, brute_mismatch(&grid, ball, 6));
        ms_coverage_count_remove(&o, &ball[5]);
        ms_coverage_count_remove(&o, &ball[4]);
        assert_int_equal(o.mismatch, brute_mismatch(&grid, ball, 4));
        ms_coverage_count_clear(&grid, ball, 4);
        assert_int_equal(brute_mismatch(&grid, ball, 0), (int64_t)ms_grid_count(&grid));
        for (int b = 0; b < 4; b++) {
            ms_ball alone = ball[b];
            ms_coverage_count empty;
            assert_int_equal(ms_coverage_count_open(&empty, &grid, NULL, 0, &err), MS_OK);
            assert_true(ms_coverage_count_gain(&empty, &alone) <= 0); /* nothing of it is left */
            ms_coverage_count_close(&empty);
        }
        ms_coverage_count_close(&o);
    }
    ms_grid_free(&grid);
}

/* What is left is no worse, and all of it is needed; the cheapest sphere goes first. */
static void spheres_are_dropped_by_their_loss(void **state)
{
    (void)state;
    static const ms_mirror NONE = {.across = {0}};
    ms_grid grid;
    ms_error err;
    const int n[3] = {13, 11, 9};
    const double origin[3] = {0, 0, 0};
    assert_int_equal(ms_grid_alloc(&grid, n, 1, origin, &err), MS_OK);
    for (int t = 0; t < 100; t++) {
        ms_ball ball[8], few[8];
        size_t count = 8;
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            grid.inside[v] = rand() % 3 != 0;
        }
        for (int b = 0; b < 8; b++) {
            ball[b] = (ms_ball){{uniform(0, 12), uniform(0, 10), uniform(0, 8)}, uniform(0, 5)};
        }
        const int64_t before = brute_mismatch(&grid, ball, 8);
        assert_int_equal(ms_prune_idle(ball, &count, &grid, &NONE, &err), MS_OK);
        const int64_t after = brute_mismatch(&grid, ball, count);
        assert_true(after <= before);
        int64_t least = INT64_MAX;
        for (size_t gone = 0; gone < count; gone++) {
            memcpy(few, ball, sizeof few);
            few[gone] = ball[count - 1];
            const int64_t without = brute_mismatch(&grid, few, count - 1);
            assert_true(without > after);
            least = without < least ? without : least;
        }
        if (count > 0) {
            const ms_coarse_view whole = {.step = 1, .grid = grid};
            assert_int_equal(ms_prune_cheapest(ball, &count, 1, &whole, &NONE, &err), MS_OK);
            assert_int_equal(brute_mismatch(&grid, ball, count), least);
        }
    }
    ms_grid_free(&grid);
}

/* Two balls and a neck take few spheres; more would be of no use. */
static void idle_spheres_are_not_given(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "dumbbell", "");
    make_target(&target, &mesh, 31, MS_VOXEL_CENTRE); /* not 30: 1 % of the centres would lie on the balls' surfaces */
    ms_clump clump = generate(&target, 40, NULL);
    const double dice = dice_of(&target, &clump);
    assert_true(clump.n_spheres < 40);
    assert_true(dice < 0.003);
    for (size_t gone = 0; gone < clump.n_spheres; gone++) {
        ms_clump fewer = {0};
        ms_error err;
        for (size_t s = 0; s < clump.n_spheres; s++) {
            if (s != gone) {
                assert_int_equal(ms_clump_add(&fewer, &clump.sphere[s], &err), MS_OK);
            }
        }
        assert_true(dice_of(&target, &fewer) > dice);
        ms_clump_free(&fewer);
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* The mismatch falls along the step of a fit: finite differences of the voxels' count. */
static void step_lowers_the_mismatch(void **state)
{
    const ms_target *target = *state;
    ms_signed_distance field;
    ms_error err;
    int fell = 0, tried = 0;
    assert_int_equal(ms_signed_distance_alloc(&field, target, 1, &err), MS_OK);
    for (int t = 0; t < 40; t++) {
        ms_ball ball[3], before[3];
        const double damping[2] = {0.3, 0.3};
        for (int b = 0; b < 3; b++) {
            do {
                for (int a = 0; a < 3; a++) {
                    ball[b].centre[a] = uniform(0, target->grid.n[a]);
                }
            } while (ms_signed_distance_at(&field, ball[b].centre) > -3);
            ball[b].radius = uniform(0.5, 1.5) * -ms_signed_distance_at(&field, ball[b].centre);
        }
        memcpy(before, ball, sizeof ball);
        ms_surface_fit fit = {
            .field = &field, .bounds = {.least = 0.5, .protrusion = HUGE_VAL}, .points = 256, .seed = 1};
        assert_int_equal(ms_surface_fit_steps(&fit, ball, 3, 1, damping, &err), MS_OK);
        if (memcmp(before, ball, sizeof ball) != 0) {
            tried++;
            fell += brute_mismatch(&target->grid, ball, 3) < brute_mismatch(&target->grid, before, 3);
        }
    }
    assert_true(tried > 30);
    assert_true(fell >= tried - 2); /* a sphere and its neighbour may both fill the same gap */
    ms_signed_distance_free(&field);
}

static void search_never_raises_the_mismatch(void **state)
{
    const ms_target *target = *state;
    ms_signed_distance field;
    ms_error err;
    ms_ball ball[8];
    assert_int_equal(ms_signed_distance_alloc(&field, target, 1, &err), MS_OK);
    ms_surface_fit fit = {.field = &field, .bounds = {.least = 0.5, .protrusion = 1.5}, .points = 64};
    for (int b = 0; b < 8; b++) {
        do {
            for (int a = 0; a < 3; a++) {
                ball[b].centre[a] = uniform(0, target->grid.n[a]);
            }
        } while (ms_signed_distance_at(&field, ball[b].centre) > -2);
        ball[b].radius = 50;
    }
    ms_bounds_confine(&fit.bounds, &field, ball, 8);
    int64_t before = brute_mismatch(&target->grid, ball, 8);
    const int64_t first = before;
    for (int round = 0; round < 6; round++) {
        assert_int_equal(ms_pattern_search(ball, 8, &target->grid, &fit, 1, &err), MS_OK);
        const int64_t after = brute_mismatch(&target->grid, ball, 8);
        assert_true(after <= before);
        before = after;
        for (int b = 0; b < 8; b++) {
            assert_true(ball[b].radius <= ms_bounds_most_radius(&fit.bounds, &field, ball[b].centre) + 1e-9);
        }
    }
    assert_true(before < first);
    ms_signed_distance_free(&field);
}

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

/* A clump read from a file comes back better, with as many spheres as asked for. */
static void refining_improves(void **state)
{
    const ms_target *target = *state;
    static const char PATH[] = "test_variational_refine.csv";
    ms_clump first = generate(target, 8, NULL);
    FILE *file = fopen(PATH, "w");
    assert_non_null(file);
    for (size_t s = 0; s < first.n_spheres; s++) {
        ms_sphere *sphere = &first.sphere[s];
        sphere->radius *= 0.8;
        fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", sphere->centre[0], sphere->centre[1], sphere->centre[2],
                sphere->radius);
    }
    fclose(file);
    const char *const options[] = {"refine", PATH, NULL};
    const double before = dice_of(target, &first);
    for (size_t n = 5; n <= 11; n += 3) {
        ms_clump clump = generate(target, n, options);
        assert_int_equal(clump.n_spheres, n);
        assert_true(dice_of(target, &clump) < 0.8 * before);
        ms_clump_free(&clump);
    }
    remove(PATH);
    ms_clump_free(&first);
}

static void keep_remark(void *context, const char *sentence)
{
    char *kept = context;
    snprintf(kept, 512, "%s", sentence);
}

/* Five spheres from a file. */
static ms_status refine_text(ms_clump *clump, char remark[512], const ms_target *target, const char *path,
                             const char *text, ms_error *err)
{
    ms_settings settings;
    ms_stop_reason reason;
    ms_run run = {.target = target,
                  .settings = &settings,
                  .seed = 3,
                  .stop = {.spheres = 5},
                  .remark = keep_remark,
                  .remark_context = remark};
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    remark[0] = '\0';
    assert_int_equal(ms_option_settings_init(&settings, ms_generator_variational.options, err), MS_OK);
    ms_status status = ms_option_settings_set(&settings, "refine", path, err);
    if (status == MS_OK) {
        status = ms_generator_run(clump, &reason, &ms_generator_variational, &run, err);
    }
    ms_option_settings_free(&settings);
    remove(path);
    return status;
}

static void assert_same_clump(const ms_clump *a, const ms_clump *b)
{
    assert_int_equal(a->n_spheres, b->n_spheres);
    assert_memory_equal(a->sphere, b->sphere, a->n_spheres * sizeof *a->sphere);
}

/* Spheres outside are left out with a word; where all are, that is an error. */
static void spheres_outside_are_not_refined(void **state)
{
    const ms_target *target = *state;
    char remark[512];
    ms_clump clump, other;
    ms_error err = {{0}};
    assert_int_equal(refine_text(&clump, remark, target, "inside.csv", "0,0,0,0.5\n0.2,0,0,0.4\n", &err), MS_OK);
    assert_string_equal(remark, "");
    assert_int_equal(
        refine_text(&other, remark, target, "mixed.csv", "90,0,0,0.5\n0,0,0,0.5\n0,-1e300,0,1\n0.2,0,0,0.4\n", &err),
        MS_OK);
    assert_string_equal(remark, "2 of the 4 spheres of refine lie outside the shape and are left out");
    assert_same_clump(&clump, &other);
    ms_clump_free(&other);
    assert_int_equal(refine_text(&other, remark, target, "outside.csv", "90,0,0,0.5\n0,1e9,0,7\n", &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "refine: none of its 2 spheres reaches the shape"));
    assert_int_equal(other.n_spheres, 0);
    assert_int_equal(refine_text(&other, remark, target, "reaching.csv", "90,0,0,89.5\n", &err), MS_OK);
    ms_clump_free(&other);
    ms_clump_free(&clump);
}

/* The same two spheres as CSV, JSON and a LAMMPS molecule start the same run. */
static void all_formats_of_clumps_are_refined(void **state)
{
    const ms_target *target = *state;
    static const char *const files[][2] = {
        {"start.json", "{\"columns\": [\"x\", \"y\", \"z\", \"r\"], \"spheres\": [[0, 0, 0, 0.5], [0.2, 0, 0, 0.4]]}"},
        {"start.lammps", "t\n2 atoms\n\nCoords\n\n1 0 0 0\n2 0.2 0 0\n\nDiameters\n\n1 1\n2 0.8\n"},
        {"start.yade", "# x y z r clumpId\n0 0 0 0.5 0\n0.2 0 0 0.4 0\n"}};
    char remark[512];
    ms_clump clump, other;
    ms_error err = {{0}};
    assert_int_equal(refine_text(&clump, remark, target, "start.csv", "0,0,0,0.5\n0.2,0,0,0.4\n", &err), MS_OK);
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        if (refine_text(&other, remark, target, files[f][0], files[f][1], &err) != MS_OK) {
            fail_msg("%s", err.text);
        }
        assert_same_clump(&clump, &other);
        ms_clump_free(&other);
    }
    ms_clump_free(&clump);
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
        for (size_t o = 0; o < sizeof OPTIONS / sizeof *OPTIONS; o++) {
            const char *const no_symmetry[3] = {OPTIONS[o][2], OPTIONS[o][3]};
            for (size_t n = 16; n <= 23; n += 7) {
                ms_clump clump = generate(&target, n, OPTIONS[o]), unlike = generate(&target, n, no_symmetry);
                assert_true(clump.n_spheres <= n && clump.n_spheres + 3 >= n); /* whole sets of 8 images */
                for (int a = 0; a < 3; a++) {
                    assert_true(!ACROSS[o][a] || is_symmetric(&clump, a));
                }
                assert_true(dice_of(&target, &clump) < 1.5 * dice_of(&target, &unlike));
                ms_clump_free(&clump);
                ms_clump_free(&unlike);
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

static int set_up(void **state)
{
    static ms_mesh mesh;
    static ms_target target;
    make_shape(&mesh, "grain", "");
    make_target(&target, &mesh, 40, MS_VOXEL_CENTRE);
    *state = &target;
    return 0;
}

static int tear_down(void **state)
{
    ms_target *target = *state;
    ms_mesh mesh = *target->mesh;
    ms_target_free(target);
    ms_mesh_free(&mesh);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(field_is_the_distance),
        cmocka_unit_test(losses_are_those_of_brute_force),
        cmocka_unit_test(step_lowers_the_mismatch),
        cmocka_unit_test(search_never_raises_the_mismatch),
        cmocka_unit_test(unions_are_recovered),
        cmocka_unit_test(protrusion_is_kept),
        cmocka_unit_test(equal_radii_are_equal),
        cmocka_unit_test(effort_does_not_hurt),
        cmocka_unit_test(refining_improves),
        cmocka_unit_test(spheres_outside_are_not_refined),
        cmocka_unit_test(all_formats_of_clumps_are_refined),
        cmocka_unit_test(symmetry_is_kept),
        cmocka_unit_test(planes_are_not_crossed),
        cmocka_unit_test(spheres_are_dropped_by_their_loss),
        cmocka_unit_test(idle_spheres_are_not_given),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
