/* Clumps of the particle's volume, against balls and lenses of known volume and width. */
#include "clump/ms_equal_volume.h"
#include "support/body_samples.h"
#include "support/clump_samples.h"

static const ms_body UNIT = {.volume = 1, .centroid = {5, 0, 0}};

static void a_ball(void **state)
{
    ms_clump clump = {0};
    ms_equal_volume done;
    (void)state;
    add_sphere(&clump, 7, 0, 0, 2.385);
    assert_int_equal(ms_clump_add_carrier(&clump, &(ms_sphere){{8, 0, 0}, 0.1}, NULL), MS_OK);
    assert_int_equal(ms_clump_alloc_masses(&clump, NULL), MS_OK);
    assert_int_equal(ms_equal_volume_scale(&clump, &done, &UNIT, NULL), MS_OK);
    const double r = cbrt(0.75 / pi);
    expect_close(clump.sphere[0].radius, r, 1e-12);
    expect_close(clump.sphere[0].centre[0], 5 + 2 * r / 2.385, 1e-12);
    expect_close(done.scale, r / 2.385, 1e-12);
    expect_close(done.volume, 1, 1e-12);
    expect_close(done.error, 0, 1e-12);
    expect_close(done.mean_width, 2 * r, 1e-12);
    assert_true(!clump.mass && clump.n_carriers == 0);
    ms_clump_free(&clump);
}

static void two_balls_that_overlap(void **state)
{
    /* Radius 1, centres 1 apart: two balls less two caps of height 1/2. The mean width of two balls is that of one and
     * half the distance: |c.u| is 1/2 on the mean. */
    const double volume = 2 * ball_volume(1) - 2 * pi * 0.25 * (3 - 0.5) / 3;
    ms_clump clump = {0};
    ms_equal_volume done;
    (void)state;
    add_sphere(&clump, 0, 0, 0, 1);
    add_sphere(&clump, 0, 1, 0, 1);
    expect_close(ms_equal_volume_width(&clump), 2.5, 1e-4);
    assert_int_equal(ms_equal_volume_scale(&clump, &done, &UNIT, NULL), MS_OK);
    expect_close(done.scale, cbrt(1 / volume), 1e-12);
    expect_close(clump.sphere[1].centre[1] - clump.sphere[0].centre[1], done.scale, 1e-12);
    expect_close(done.error, 0, 1e-12);
    expect_close(done.mean_width, 2.5 * done.scale, 1e-4);
    ms_clump_free(&clump);
}

/* By a tenth nothing is to be said; a sentence stands behind those that are there, within the room for them. */
static void a_far_scale_is_said(void **state)
{
    static const char SAYS[] = "the spheres held 50 % of the shape's volume; scaled by 1.26 they lie beside it";
    ms_error said = {""};
    (void)state;
    ms_equal_volume_remark(&said, &(ms_equal_volume){.scale = 1.0999});
    ms_equal_volume_remark(&said, &(ms_equal_volume){.scale = 0.9001});
    ms_equal_volume_remark(&said, &(ms_equal_volume){0});
    assert_string_equal(said.text, "");
    ms_equal_volume_remark(&said, &(ms_equal_volume){.scale = cbrt(2)});
    assert_memory_equal(said.text, SAYS, strlen(SAYS));
    const size_t length = strlen(said.text);
    ms_equal_volume_remark(&said, &(ms_equal_volume){.scale = 0.8});
    assert_memory_equal(said.text + length, "; the spheres held 195 %", 24);
    for (int k = 0; k < 10; k++) {
        ms_equal_volume_remark(&said, &(ms_equal_volume){.scale = 2});
    }
    assert_int_equal(strlen(said.text), sizeof said.text - 1);
}

static void what_has_no_volume(void **state)
{
    ms_clump clump = {0};
    ms_equal_volume done;
    ms_error err = {{0}};
    (void)state;
    assert_int_equal(ms_equal_volume_scale(&clump, &done, &UNIT, &err), MS_ERR_ARG);
    add_sphere(&clump, 0, 0, 0, 1);
    assert_int_equal(ms_equal_volume_scale(&clump, &done, &(ms_body){0}, &err), MS_ERR_ARG);
    assert_true(done.scale == 0 && clump.sphere[0].radius == 1);
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball),
        cmocka_unit_test(two_balls_that_overlap),
        cmocka_unit_test(a_far_scale_is_said),
        cmocka_unit_test(what_has_no_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
