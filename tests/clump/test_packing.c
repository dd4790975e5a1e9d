/* Clumps in their places: turns, overlaps against brute force, shrinking. */
#include "clump/ms_packing.h"

#include "base/ms_quaternion.h"
#include "base/ms_vector.h"
#include "support/clump_samples.h"

/* A rotation about a unit axis by an angle, as a matrix (Rodrigues); rows of `axis` are its columns. */
static void axes_of(double axis[3][3], const double about[3], double angle)
{
    for (int m = 0; m < 3; m++) {
        const double e[3] = {m == 0, m == 1, m == 2};
        double across[3];
        ms_cross(across, about, e);
        for (int k = 0; k < 3; k++) {
            axis[m][k] = cos(angle) * e[k] + sin(angle) * across[k] + (1 - cos(angle)) * ms_dot(about, e) * about[k];
        }
    }
}

static void a_turn_is_that_of_the_axes(void **state)
{
    static const double ABOUT[][3] = {
        {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2.0 / 3, -2.0 / 3, 1.0 / 3}, {-0.48, 0.6, 0.64}};
    (void)state;
    for (size_t a = 0; a < sizeof ABOUT / sizeof *ABOUT; a++) {
        for (int step = -12; step <= 12; step++) {
            const double angle = step * pi / 12;
            double axis[3][3], q[4], out[3], back[3];
            axes_of(axis, ABOUT[a], angle);
            ms_quaternion_from_axes(q, axis);
            expect_close(q[0], fabs(cos(angle / 2)), 1e-15);
            for (int k = 0; k < 3 && q[0] > 1e-9; k++) {
                expect_close(q[k + 1], (cos(angle / 2) < 0 ? -1 : 1) * sin(angle / 2) * ABOUT[a][k], 1e-15);
            }
            for (int m = 0; m < 3; m++) {
                const double e[3] = {m == 0, m == 1, m == 2};
                ms_quaternion_turn(out, q, e);
                ms_quaternion_turn_back(back, q, out);
                for (int k = 0; k < 3; k++) {
                    expect_close(out[k], axis[m][k], 1e-15);
                    expect_close(back[k], e[k], 1e-15);
                }
            }
        }
    }
}

enum { MANY = 400 };

static double next_random(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed / 4294967296.0;
}

/* Clumps of one to four spheres at random places and turns; every hundredth is ten times as large. */
static ms_packing make_packing(size_t count, double side)
{
    ms_packing packing = {.placed = calloc(count, sizeof *packing.placed), .count = count};
    unsigned seed = 12345;
    assert_non_null(packing.placed);
    for (size_t p = 0; p < count; p++) {
        ms_placed *placed = &packing.placed[p];
        const double size = p % 100 == 7 ? 10 : 0.5 + next_random(&seed);
        double axis[3][3], about[3] = {2.0 / 3, -2.0 / 3, 1.0 / 3};
        axes_of(axis, about, 6 * next_random(&seed));
        ms_quaternion_from_axes(placed->turn, axis);
        *placed = (ms_placed){.number = p + 1,
                              .size = size,
                              .scale = 1,
                              .turn = {placed->turn[0], placed->turn[1], placed->turn[2], placed->turn[3]}};
        for (int k = 0; k < 3; k++) {
            placed->centre[k] = side * (next_random(&seed) - 0.5);
        }
        for (size_t s = 0; s < 1 + p % 4; s++) {
            add_sphere(&placed->clump, size * (next_random(&seed) - 0.5), size * next_random(&seed), 0.2 * size,
                       size * (0.2 + 0.5 * next_random(&seed)));
        }
    }
    return packing;
}

/* By all pairs of all spheres. */
static ms_overlap measure_all(const ms_packing *packing, size_t a, size_t b)
{
    ms_overlap overlap = {a, b, -HUGE_VAL, 0, 0};
    for (size_t i = 0; i < packing->placed[a].clump.n_spheres; i++) {
        for (size_t j = 0; j < packing->placed[b].clump.n_spheres; j++) {
            const ms_sphere s = ms_packing_sphere(&packing->placed[a], i),
                            t = ms_packing_sphere(&packing->placed[b], j);
            const double depth = s.radius + t.radius - sqrt(ms_squared_distance(s.centre, t.centre));
            overlap.depth = fmax(overlap.depth, depth);
            overlap.contacts += depth > 0;
        }
    }
    overlap.relative = overlap.depth / fmin(packing->placed[a].size, packing->placed[b].size);
    return overlap;
}

static void overlaps_are_those_of_brute_force(void **state)
{
    (void)state;
    ms_packing packing = make_packing(MANY, 16);
    for (double near = 0; near < 0.4; near += 0.3) {
        ms_overlaps overlaps;
        ms_error err = {{0}};
        size_t at = 0;
        assert_int_equal(ms_packing_overlaps(&overlaps, &packing, near, &err), MS_OK);
        for (size_t a = 0; a < MANY; a++) {
            for (size_t b = a + 1; b < MANY; b++) {
                const ms_overlap truth = measure_all(&packing, a, b);
                if (truth.relative > -near) {
                    assert_true(at < overlaps.count);
                    assert_int_equal(overlaps.pair[at].first, a);
                    assert_int_equal(overlaps.pair[at].second, b);
                    assert_true(overlaps.pair[at].depth == truth.depth && overlaps.pair[at].relative == truth.relative);
                    assert_int_equal(overlaps.pair[at].contacts, truth.contacts);
                    at++;
                }
            }
        }
        assert_int_equal(at, overlaps.count);
        assert_true(at > MANY / 2);
        ms_packing_overlaps_free(&overlaps);
    }
    ms_packing_free(&packing);
}

/* Two unit spheres 1.7 apart, along no axis: 0.3 deep. */
static ms_packing make_two(void)
{
    ms_packing packing = {.placed = calloc(2, sizeof *packing.placed), .count = 2};
    assert_non_null(packing.placed);
    for (size_t p = 0; p < 2; p++) {
        packing.placed[p] =
            (ms_placed){.number = p + 5,
                        .turn = {1, 0, 0, 0},
                        .size = 0.8 + (double)p,
                        .scale = 1,
                        .particle = {.mass = 3},
                        .centre = {1.7 * 2 / 3 * (double)p, 1.7 * 2 / 3 * (double)p, 1.7 / 3 * (double)p}};
        add_sphere(&packing.placed[p].clump, 0, 0, 0, 1);
    }
    return packing;
}

static void two_spheres(void **state)
{
    (void)state;
    ms_packing packing = make_two();
    ms_overlaps overlaps;
    double lo[3], hi[3];
    assert_int_equal(ms_packing_overlaps(&overlaps, &packing, 0, NULL), MS_OK);
    assert_int_equal(overlaps.count, 1);
    expect_close(overlaps.pair[0].depth, 0.3, 1e-15);
    expect_close(overlaps.pair[0].relative, 0.3 / 0.8, 1e-15);
    assert_int_equal(overlaps.pair[0].contacts, 1);
    ms_packing_overlaps_free(&overlaps);
    ms_packing_box(lo, hi, &packing);
    expect_close(lo[0], -1, 0);
    expect_close(hi[2], 1 + 1.7 / 3, 1e-15);

    /* Both shrink by 0.99 a round, until 2 scale - 1.7 is at most 0.05 * 0.8: fourteen times. */
    assert_int_equal(ms_packing_shrink(&packing, 0.05, NULL), MS_OK);
    for (size_t p = 0; p < 2; p++) {
        expect_close(packing.placed[p].scale, pow(0.99, 14), 1e-14);
        expect_close(packing.placed[p].particle.mass, 3, 0);
    }
    ms_packing_free(&packing);
}

static void shrunk_until_below(void **state)
{
    (void)state;
    ms_packing packing = make_packing(MANY, 60);
    ms_overlaps overlaps;
    size_t as_they_were = 0;
    assert_int_equal(ms_packing_shrink(&packing, 0.1, NULL), MS_OK);
    assert_int_equal(ms_packing_overlaps(&overlaps, &packing, 0, NULL), MS_OK);
    for (size_t o = 0; o < overlaps.count; o++) {
        assert_true(overlaps.pair[o].relative <= 0.1);
    }
    for (size_t p = 0; p < MANY; p++) {
        as_they_were += packing.placed[p].scale == 1;
    }
    assert_true(as_they_were > MANY / 4 && as_they_were < MANY);
    ms_packing_overlaps_free(&overlaps);
    ms_packing_free(&packing);
}

static void one_that_is_there_twice(void **state)
{
    (void)state;
    ms_packing packing = make_two();
    ms_error err = {{0}};
    memset(packing.placed[1].centre, 0, sizeof packing.placed[1].centre);
    assert_int_equal(ms_packing_shrink(&packing, 0.05, &err), MS_ERR_LIMIT);
    expect_message(&err, "grain 5");
    ms_packing_free(&packing);
}

static void none_at_all(void **state)
{
    (void)state;
    const ms_packing none = {0};
    ms_overlaps overlaps;
    assert_int_equal(ms_packing_overlaps(&overlaps, &none, 0.1, NULL), MS_OK);
    assert_int_equal(overlaps.count, 0);
    ms_packing_overlaps_free(&overlaps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turn_is_that_of_the_axes),
        cmocka_unit_test(overlaps_are_those_of_brute_force),
        cmocka_unit_test(two_spheres),
        cmocka_unit_test(shrunk_until_below),
        cmocka_unit_test(one_that_is_there_twice),
        cmocka_unit_test(none_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
