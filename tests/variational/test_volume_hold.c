/* Spheres whose union has the volume of the shape: exact volumes, and D beside that of scaling alone. */
#include "support/variational_samples.h"

#include "clump/ms_equal_volume.h"
#include "clump/ms_union.h"

static const char *const HOLD[] = {"hold-volume", "", NULL};

/* Of the union, over that of the shape, less one. */
static double excess_of(const ms_target *target, const ms_clump *clump)
{
    double volume, area;
    assert_int_equal(ms_union_measure(&volume, &area, clump, NULL), MS_OK);
    return volume / target->body.volume - 1;
}

/* D of a run after its clump is scaled to the volume. */
static double scaled_dice(double *excess, const ms_target *target, size_t n, const char *const *options)
{
    ms_equal_volume done;
    ms_clump clump = generate(target, n, options);
    *excess = excess_of(target, &clump);
    assert_int_equal(ms_equal_volume_scale(&clump, &done, &target->body, NULL), MS_OK);
    const double dice = dice_of(target, &clump);
    ms_clump_free(&clump);
    return dice;
}

/* Six large spheres in a grain lack volume; with the constraint they do not, and that costs less than scaling. */
static void of_a_grain(void **state)
{
    double without, with;
    const double scaled = scaled_dice(&without, *state, 6, NULL), held = scaled_dice(&with, *state, 6, HOLD);
    assert_true(fabs(without) > 0.01);
    assert_true(fabs(with) < 2e-3);
    assert_true(held < scaled);
}

/* Spheres of the least D on a thin wall have far more volume; scaled, they leave the wall. */
static void of_a_thin_wall(void **state)
{
    ms_mesh mesh;
    ms_target target;
    double without, with;
    (void)state;
    make_shape(&mesh, "bowl", "");
    make_target(&target, &mesh, 60, MS_VOXEL_CENTRE);
    const double scaled = scaled_dice(&without, &target, 30, NULL), held = scaled_dice(&with, &target, 30, HOLD);
    assert_true(without > 0.3);
    assert_true(fabs(with) < 0.05);
    assert_true(held < 0.8 * scaled);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Images count, too. */
static void with_symmetry(void **state)
{
    ms_mesh mesh;
    ms_target target;
    static const char *const OPTIONS[] = {"hold-volume", "", "symmetry", "xyz", NULL};
    (void)state;
    make_shape(&mesh, "cube", "");
    make_target(&target, &mesh, 40, MS_VOXEL_CENTRE);
    ms_clump clump = generate(&target, 8, OPTIONS);
    assert_int_equal(clump.n_spheres, 8);
    assert_true(fabs(excess_of(&target, &clump)) < 2e-3);
    ms_clump_free(&clump);
    clump = generate(&target, 8, OPTIONS + 2);
    assert_true(fabs(excess_of(&target, &clump)) > 0.01);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* One ball by one sphere: nothing is to be gained, and nothing is lost. */
static void of_a_ball(void **state)
{
    ms_mesh mesh;
    ms_target target;
    (void)state;
    make_shape(&mesh, "ball", "");
    make_target(&target, &mesh, 30, MS_VOXEL_CENTRE);
    ms_clump clump = generate(&target, 1, HOLD);
    assert_int_equal(clump.n_spheres, 1);
    assert_true(fabs(excess_of(&target, &clump)) < 0.02);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Other bounds go first, which is said. */
static void beside_other_bounds(void **state)
{
    static const char *const OTHER[] = {"protrusion=1", "gap=4", "connected", "plane=0,0,1,0"};
    const ms_target *target = *state;
    for (size_t o = 0; o < sizeof OTHER / sizeof *OTHER; o++) {
        char both[64], remark[512] = "";
        ms_clump with,
            without = run_generator(&ms_generator_variational, target, (ms_stop){.spheres = 5}, OTHER[o], NULL);
        ms_stop_reason reason;
        snprintf(both, sizeof both, "%s hold-volume", OTHER[o]);
        assert_int_equal(try_generator(&with, &reason, &ms_generator_variational, target, (ms_stop){.spheres = 5}, both,
                                       keep_remark, remark, NULL),
                         MS_OK);
        assert_non_null(strstr(remark, "does not hold the volume"));
        assert_int_equal(with.n_spheres, without.n_spheres);
        assert_memory_equal(with.sphere, without.sphere, with.n_spheres * sizeof *with.sphere);
        ms_clump_free(&with);
        ms_clump_free(&without);
    }
}

/* What a listener has heard of the volume. */
typedef struct heard {
    size_t stages, most; /* fits, and after how many the run is to end; 0: any number */
} heard;

static int hear_volume(void *context, const char *stage, double share)
{
    heard *h = context;
    (void)share;
    h->stages += strstr(stage, "volume") != NULL;
    return h->most > 0 && h->stages == h->most;
}

/* Before the first of them, and before the last. */
static void its_fits_can_be_interrupted(void **state)
{
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    heard h = {0};
    const ms_run run = {.target = *state, .stop = {.spheres = 5}, .seed = 1, .stage = hear_volume, .stage_context = &h};
    assert_int_equal(try_run(&clump, &reason, &ms_generator_variational, run, "hold-volume", &err), MS_OK);
    assert_true(h.stages >= 6);
    ms_clump_free(&clump);
    for (size_t most = 1; most <= h.stages; most += h.stages - 1) {
        heard early = {.most = most};
        ms_run ended = run;
        ended.stage_context = &early;
        assert_int_equal(try_run(&clump, &reason, &ms_generator_variational, ended, "hold-volume", &err),
                         MS_ERR_INTERRUPTED);
        assert_int_equal(early.stages, most);
        assert_int_equal(clump.n_spheres, 0);
    }
}

/* Counts the remarks, too. */
typedef struct remarks {
    char last[512];
    int count;
} remarks;

static void count_remark(void *context, const char *sentence)
{
    remarks *r = context;
    keep_remark(r->last, sentence);
    r->count++;
}

/* Spheres as the user counts them, with their images; of those that a measure is sought by, the ones that have it; of
 * none there is nothing to say. */
static void what_is_left_is_said(void **state)
{
    ms_mesh mesh;
    ms_target target;
    ms_clump clump;
    ms_stop_reason reason;
    remarks said = {0};
    (void)state;
    make_shape(&mesh, "plate", "");
    make_target(&target, &mesh, 6, MS_VOXEL_CENTRE);
    assert_int_equal(try_generator(&clump, &reason, &ms_generator_variational, &target, (ms_stop){.spheres = 4},
                                   "hold-volume symmetry=xy", count_remark, &said, NULL),
                     MS_OK);
    assert_int_equal(clump.n_spheres, 4);
    assert_int_equal(said.count, 1);
    assert_non_null(strstr(said.last, "leaves 4 spheres"));
    ms_clump_free(&clump);
    said.count = 0;
    assert_int_equal(try_generator(&clump, &reason, &ms_generator_variational, &target,
                                   (ms_stop){.spheres = 3, .dice = 1e-3}, "hold-volume", count_remark, &said, NULL),
                     MS_OK);
    assert_int_equal(clump.n_spheres, 3);
    assert_int_equal(said.count, 1);
    assert_non_null(strstr(said.last, "leaves 3 spheres"));
    ms_clump_free(&clump);
    assert_int_equal(try_generator(&clump, &reason, &ms_generator_variational, &target,
                                   (ms_stop){.spheres = 4, .radius = 100}, "hold-volume", count_remark, &said, NULL),
                     MS_ERR_SHAPE);
    assert_int_equal(said.count, 1);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* What a generator says of itself is true. */
static void the_option_is_there(void **state)
{
    int held = 0;
    (void)state;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if ((*g)->volume_by) {
            const ms_option *flag = ms_option_find((*g)->options, (*g)->volume_by);
            assert_non_null(flag);
            assert_int_equal(flag->type, MS_OPTION_FLAG);
            held++;
        }
    }
    assert_true(held > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_grain),           cmocka_unit_test(of_a_thin_wall),
        cmocka_unit_test(with_symmetry),        cmocka_unit_test(of_a_ball),
        cmocka_unit_test(beside_other_bounds),  cmocka_unit_test(its_fits_can_be_interrupted),
        cmocka_unit_test(what_is_left_is_said), cmocka_unit_test(the_option_is_there),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
