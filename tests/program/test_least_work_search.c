/* The search for the clump of least work, on laws of which the best clump is known. */
#include "support/test_support.h"

#include "cli/ms_least_work_search.h"

/*
 * A law like that of real clumps: D = a n^-slope (1 + (R / r)^4), where r = reach n^-1/2 is what most spheres are like,
 * and the least sphere has r / 4 where nothing is asked of it.
 */
typedef struct law {
    double a, slope, reach;
    ms_status fails; /* of run `fails_at` */
    int fails_at;
    double largest;   /* no clump of larger spheres; 0: any */
    size_t delivered; /* no more spheres than that; 0: any */
} law;

static double natural_of(const law *l, double n)
{
    return l->reach / sqrt(n);
}

static double dice_of(const law *l, double n, double radius)
{
    return l->a * pow(n, -l->slope) * (1 + pow(radius / natural_of(l, n), 4));
}

static ms_status run_law(void *context, ms_least_work_try *row, int at, ms_error *err)
{
    const law *l = context;
    if (l->fails != MS_OK && at == l->fails_at) {
        return ms_fail(err, l->fails, "run %d", at);
    }
    if (l->largest > 0 && row->radius > l->largest) {
        return MS_OK;
    }
    row->spheres = l->delivered && row->asked > l->delivered ? l->delivered : row->asked;
    row->least = fmax(row->radius, natural_of(l, (double)row->spheres) / 4);
    row->dice = dice_of(l, (double)row->spheres, row->least);
    return MS_OK;
}

static ms_least_work_bounds bounds_of(double dice, double power, size_t first)
{
    return (ms_least_work_bounds){.dice = dice, .power = power, .first = first, .most = 10000, .equivalent = 1};
}

static double work_of(double n, double radius, double power)
{
    return n * pow(1 / radius, power);
}

/* By all numbers and a thousand radii. */
static double least_work(const law *l, double dice, double power)
{
    double least = HUGE_VAL;
    for (int n = 1; n < 3000; n++) {
        const double natural = natural_of(l, n) / 4;
        for (int k = 0; k < 1000; k++) {
            const double radius = natural * (1 + 0.01 * k);
            if (dice_of(l, n, radius) <= dice) {
                least = fmin(least, work_of(n, radius, power));
            }
        }
    }
    return least;
}

/* What every search owes. */
static void check_tries(const ms_least_work_tries *t, const ms_least_work_bounds *b)
{
    int best = -1;
    assert_true(t->count >= 1 && t->count <= MS_LEAST_WORK_MOST_RUNS);
    assert_int_equal(t->row[0].asked, b->first);
    for (int k = 0; k < t->count; k++) {
        const ms_least_work_try *r = &t->row[k];
        assert_true(r->asked >= 1 && r->asked <= b->most && r->radius >= b->radius);
        for (int before = 0; before < k; before++) {
            assert_false(t->row[before].asked == r->asked && t->row[before].radius == r->radius);
        }
        if (r->spheres == 0) {
            assert_true(isnan(r->work));
            continue;
        }
        assert_close(r->work, work_of((double)r->spheres, r->least, b->power), 1e-9 * r->work);
        if (r->dice <= b->dice && (best < 0 || r->work < t->row[best].work)) {
            best = k;
        }
    }
    assert_int_equal(t->kept, best);
}

static ms_least_work_tries search(const law *l, const ms_least_work_bounds *b)
{
    ms_least_work_tries tries;
    law copy = *l;
    assert_int_equal(ms_least_work_search(&tries, b, run_law, &copy, NULL), MS_OK);
    check_tries(&tries, b);
    return tries;
}

static void the_work_is_near_the_least(void **state)
{
    static const double DICE[] = {0.3, 0.1, 0.03, 0.01}, SLOPE[] = {1, 2}, OFF[] = {0.6, 1, 1.6};
    double worst = 1;
    (void)state;
    for (int d = 0; d < 4; d++) {
        for (int s = 0; s < 2; s++) {
            const law l = {.a = 1.7, .slope = SLOPE[s], .reach = 0.9};
            const double best = least_work(&l, DICE[d], 1), n = pow(l.a / DICE[d], 1 / l.slope);
            for (int o = 0; o < 3; o++) {
                const ms_least_work_bounds b = bounds_of(DICE[d], 1, (size_t)ceil(n * OFF[o]));
                const ms_least_work_tries t = search(&l, &b);
                assert_true(t.kept >= 0);
                worst = fmax(worst, t.row[t.kept].work / best);
            }
        }
    }
    assert_true(worst < 1.1);
}

/* With a power of 0 it is the least number that reaches D. */
static void without_a_radius_it_is_the_least_number(void **state)
{
    (void)state;
    for (int k = 0; k < 40; k++) {
        const law l = {.a = 1.7, .slope = k % 2 ? 1 : 2, .reach = 0.9};
        const double dice = 0.3 * pow(0.9, k), n = pow(l.a * (1 + pow(0.25, 4)) / dice, 1 / l.slope);
        for (int off = 0; off < 3; off++) {
            const ms_least_work_bounds b = bounds_of(dice, 0, (size_t)ceil(n * (0.7 + 0.3 * off)));
            const ms_least_work_tries t = search(&l, &b);
            assert_int_equal(t.row[t.kept].spheres, (size_t)ceil(n - 1e-9));
            for (int r = 0; r < t.count; r++) {
                assert_true(t.row[r].radius == 0);
            }
        }
    }
}

static void what_cannot_be_reached_is_not_kept(void **state)
{
    (void)state;
    law l = {.a = 1.7, .slope = 1, .reach = 0.9};
    ms_least_work_bounds b = bounds_of(0.01, 1, 5);
    b.most = 60; /* 171 would do */
    ms_least_work_tries t = search(&l, &b);
    assert_int_equal(t.kept, -1);
    assert_int_equal(t.row[t.count - 1].asked, 60); /* and no run after that */
    l.delivered = 100;
    b.most = 10000;
    t = search(&l, &b);
    assert_int_equal(t.kept, -1);
    assert_int_equal(t.row[t.count - 1].spheres, 100); /* nor after more could not be had */
    assert_true(t.count < 2 || t.row[t.count - 2].asked <= 100);
    b = bounds_of(0.1, 1, 20);
    b.radius = 5;
    l = (law){.a = 1.7, .slope = 1, .reach = 0.9, .largest = 4};
    t = search(&l, &b);
    assert_int_equal(t.kept, -1);
    assert_int_equal(t.row[0].spheres, 0);
}

static void bounds_are_kept_to(void **state)
{
    (void)state;
    const law l = {.a = 1.7, .slope = 1, .reach = 0.9, .largest = 0.12};
    ms_least_work_bounds b = bounds_of(0.1, 1, 20);
    b.radius = 0.09;
    b.most = 25;
    const ms_least_work_tries t = search(&l, &b);
    assert_true(t.kept >= 0 && t.row[t.kept].spheres <= 25);
    assert_true(t.row[t.kept].least >= 0.09 && t.row[t.kept].least <= 0.12);
}

static void a_failure_ends_it(void **state)
{
    (void)state;
    for (int at = 0; at < MS_LEAST_WORK_MOST_RUNS; at++) {
        law l = {.a = 1.7, .slope = 1, .reach = 0.9, .fails = MS_ERR_NOMEM, .fails_at = at};
        const ms_least_work_bounds b = bounds_of(0.02, 1, 30);
        ms_least_work_tries t;
        ms_error err = {{0}};
        assert_int_equal(ms_least_work_search(&t, &b, run_law, &l, &err), MS_ERR_NOMEM);
        assert_int_equal(t.count, at + 1);
        assert_non_null(strstr(err.text, "run"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_work_is_near_the_least),
        cmocka_unit_test(without_a_radius_it_is_the_least_number),
        cmocka_unit_test(what_cannot_be_reached_is_not_kept),
        cmocka_unit_test(bounds_are_kept_to),
        cmocka_unit_test(a_failure_ends_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
