/* Spheres that the variational generator starts from. */
#include "support/variational_samples.h"

#include <string.h>

/* A clump read from a file comes back better, with as many spheres as asked for. */
static void refining_improves(void **state)
{
    const ms_target *target = *state;
    static const char PATH[] = "test_variational_refine.csv";
    ms_clump first = generate(target, 8, NULL);
    for (size_t s = 0; s < first.n_spheres; s++) {
        first.sphere[s].radius *= 0.8;
    }
    write_clump(PATH, &first);
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

static int64_t count_mismatch(const ms_target *target, const ms_clump *clump)
{
    ms_ball ball[16];
    assert_true(clump->n_spheres <= 16);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ball[s] = ms_grid_ball(&target->grid, &clump->sphere[s]);
    }
    return brute_mismatch(&target->grid, ball, clump->n_spheres);
}

/* Whatever the spheres to start from, as many of them have no more voxels amiss, run after run. */
static void objective_never_rises(void **state)
{
    const ms_target *target = *state;
    static const char PATH[] = "test_variational_rises.csv";
    for (int t = 0; t < 2; t++) {
        const char *const options[] = {"refine", PATH, "effort", t % 2 ? "1" : "0", NULL};
        ms_clump clump = {0};
        ms_error err;
        for (int s = 0; s < 8; s++) {
            const double *c = target->body.centroid, r = ms_target_equivalent_radius(target);
            const ms_sphere sphere = {
                .centre = {c[0] + uniform(-0.5, 0.5) * r, c[1] + uniform(-0.5, 0.5) * r, c[2] + uniform(-0.5, 0.5) * r},
                .radius = uniform(0.1, 0.7) * r};
            assert_int_equal(ms_clump_add(&clump, &sphere, &err), MS_OK);
        }
        int64_t before = count_mismatch(target, &clump);
        const int64_t first = before;
        for (int run = 0; run < 3; run++) {
            write_clump(PATH, &clump);
            const size_t n = clump.n_spheres;
            ms_clump_free(&clump);
            clump = generate(target, n, options);
            const int64_t after = count_mismatch(target, &clump);
            assert_true(after <= before);
            before = after;
        }
        assert_true(before < first);
        ms_clump_free(&clump);
    }
    remove(PATH);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refining_improves),
        cmocka_unit_test(objective_never_rises),
        cmocka_unit_test(spheres_outside_are_not_refined),
        cmocka_unit_test(all_formats_of_clumps_are_refined),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
