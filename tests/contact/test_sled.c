/* Dragging one body over another: against one pair, a flat, and the work of a way without friction. */
#include "contact/ms_sled.h"

#include "base/ms_vector.h"
#include "support/test_support.h"

enum { SIDE = 9 };

static const double DOWN[3] = {0, 0, -1};

/* One sphere that climbs another, at an angle of 0 to 50 degrees: T/N = (mu + tan t) / (1 - mu tan t). */
static void test_one_pair(void **state)
{
    (void)state;
    for (int degrees = -50; degrees <= 50; degrees += 10) {
        const double t = degrees / MS_VECTOR_DEGREES;
        ms_touch_pair pair = {{0, -sin(t), cos(t)}, 0.35, 0.002};
        const ms_sled_place place = {{{1, 0, 0, 0}, {0, 0, 1}, {0}}, {0, 1, 0}};
        for (double mu = 0; mu < 0.7; mu += 0.3) {
            double slope;
            const double ratio = ms_sled_ratio(&slope, &pair, 1, &place, mu);
            assert_close(slope, tan(t), 1e-12);
            assert_close(ratio, (mu + tan(t)) / (1 - mu * tan(t)), 1e-12);
        }
    }
}

/* Behind tan t = 1 / mu no force moves it. */
static void test_jammed(void **state)
{
    (void)state;
    const ms_touch_pair pair = {{0, -sin(1.3), cos(1.3)}, 0.35, 0.002};
    const ms_sled_place place = {{{1, 0, 0, 0}, {0, 0, 1}, {0}}, {0, 1, 0}};
    double slope;
    assert_true(isinf(ms_sled_ratio(&slope, &pair, 1, &place, 0.3)));
    assert_true(isfinite(ms_sled_ratio(&slope, &pair, 1, &place, 0.27)));
}

/* Between two pairs alike on both sides it lies in a valley: no slope, friction of each along its own sliding. */
static void test_valley(void **state)
{
    (void)state;
    const double t = 0.4;
    const ms_touch_pair pair[] = {{{-sin(t), 0, cos(t)}, 0.35, 0.002}, {{sin(t), 0, cos(t)}, 0.35, 0.002}};
    const ms_sled_place along = {{{1, 0, 0, 0}, {0, 0, 1}, {0}}, {0, 1, 0}};
    double slope;
    assert_close(ms_sled_ratio(&slope, pair, 2, &along, 0.3), 0.3 / cos(t), 1e-12);
    assert_close(slope, 0, 1e-15);
}

/* One great ball on another: a face without bumps but for its curve. Places far from the top climb. */
static void test_balls(void **state)
{
    (void)state;
    ms_sphere ball = {{0}, 1};
    const ms_support body = {1, &ball};
    const double friction[] = {0, 0.3};
    ms_sled sled[2];
    ms_error err;
    assert_int_equal(ms_sled_drag(sled, friction, 2, &body, DOWN, 1, 1e-6, 4000, 7, &err), MS_OK);
    for (int f = 0; f < 2; f++) {
        assert_close(sled[f].missed + sled[f].jammed, 0, 0);
    }
    /* One pair each: without friction T/N is the slope, with it more by 1 / cos t where it leans across the way. */
    assert_close(sled[0].mean, sled[0].slope_mean, 1e-12);
    assert_close(sled[0].largest, sled[0].slope_largest, 1e-12);
    assert_true(sled[1].mean > sled[1].slope_mean && sled[1].mean < sled[1].slope_mean / cos(asin(0.25)));
    /* Offsets up to 1/2 of a sum of radii of 2: sin t = 1/4 at most, as seldom up as down. */
    assert_close(sled[0].mean, 0, 0.006);
    assert_close(sled[0].largest, tan(asin(0.25)), 0.003);
    assert_close(sled[1].mean, 0.3, 0.01);
}

/* A wide square of spheres on its like. */
static void make_square(ms_sphere *sphere, double distance, double radius)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        sphere[i] = (ms_sphere){{distance * (i % SIDE - (SIDE - 1) / 2.0), distance * (i / SIDE - (SIDE - 1) / 2.0), 0},
                                radius};
    }
}

/* The nearer the spheres, the flatter the face: T/N goes to mu. */
static void test_bumps(void **state)
{
    (void)state;
    ms_sphere sphere[SIDE * SIDE];
    const ms_support body = {SIDE * SIDE, sphere};
    const double friction[] = {0, 0.3}, distance[] = {0.05, 0.2, 0.4};
    double last = 0;
    ms_error err;
    for (int d = 0; d < 3; d++) {
        ms_sled sled[2];
        make_square(sphere, distance[d], 0.5);
        assert_int_equal(ms_sled_drag(sled, friction, 2, &body, DOWN, 0.5, 1e-5, 500, 3, &err), MS_OK);
        assert_true(sled[0].largest > last && sled[1].largest > 0.3 + last);
        /* Between four of them the next lies lowest, at half their diagonal from each. */
        assert_true(sled[0].largest <= tan(asin(distance[d] / sqrt(2))) + 1e-6);
        last = sled[0].largest;
    }
}

/* Without friction, along one way over one length of the pattern, the work of T is that of the load: none. */
static void test_no_work_on_a_way(void **state)
{
    (void)state;
    ms_sphere sphere[SIDE * SIDE], turned[SIDE * SIDE];
    const ms_support body = {SIDE * SIDE, sphere};
    enum { STEPS = 4000 };
    double work = 0, uphill = 0;
    make_square(sphere, 0.4, 0.5);
    for (int i = 0; i < STEPS; i++) {
        ms_touch_pair pair[512];
        double slope;
        const ms_sled_place place = {{{1, 0, 0, 0}, {0, 0, 1}, {0.4 * (i + 0.5) / STEPS, 0.07, 0}}, {1, 0, 0}};
        const ms_touch touch = ms_touch_second(pair, 512, turned, &body, &place.at, 0.5, 1e-6);
        assert_in_range(touch.count, 1, 512);
        const double ratio = ms_sled_ratio(&slope, pair, touch.count, &place, 0);
        work += ratio * 0.4 / STEPS;
        uphill += fmax(0, ratio) * 0.4 / STEPS;
    }
    assert_close(work, 0, 1e-4);
    assert_true(uphill > 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_pair), cmocka_unit_test(test_jammed), cmocka_unit_test(test_valley),
        cmocka_unit_test(test_balls),    cmocka_unit_test(test_bumps),  cmocka_unit_test(test_no_work_on_a_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
