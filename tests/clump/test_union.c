/* Volume and area of unions of spheres: bodies of which both are known, and sampled ones. */
#include "clump/ms_union.h"

#include "support/clump_samples.h"

static void expect_union(const ms_clump *clump, double volume, double area, double tolerance)
{
    double v, a;
    assert_int_equal(ms_union_measure(&v, &a, clump, NULL), MS_OK);
    expect_close(v, volume, tolerance * volume);
    expect_close(a, area, tolerance * area);
}

static double cap_volume(double r, double height)
{
    return pi * height * height * (3 * r - height) / 3;
}

static void nothing_and_one(void **state)
{
    (void)state;
    ms_clump clump = {0};
    double v = 1, a = 1;
    assert_int_equal(ms_union_measure(&v, &a, &clump, NULL), MS_OK);
    assert_true(v == 0 && a == 0);
    add_sphere(&clump, 1e3, -2, 7, 2.385);
    expect_union(&clump, ball_volume(2.385), 4 * pi * 2.385 * 2.385, 1e-13);
    ms_clump_free(&clump);
}

/* Two spheres at every distance, along a direction that is no axis: less the two caps. */
static void two(void **state)
{
    (void)state;
    const double r = 1.3, q = 0.7, u[3] = {2 / 7.0, -3 / 7.0, 6 / 7.0};
    for (double d = 0.05; d < 2.4; d += 0.0385) {
        ms_clump clump = {0};
        double volume = ball_volume(r) + ball_volume(q), area = 4 * pi * (r * r + q * q);
        add_sphere(&clump, 11, 12, 13, r);
        add_sphere(&clump, 11 + d * u[0], 12 + d * u[1], 13 + d * u[2], q);
        if (d <= r - q) {
            volume = ball_volume(r);
            area = 4 * pi * r * r;
        } else if (d < r + q) {
            const double x = (d * d + r * r - q * q) / (2 * d), of_r = r - x, of_q = q - (d - x);
            volume -= cap_volume(r, of_r) + cap_volume(q, of_q);
            area -= 2 * pi * (r * of_r + q * of_q);
        }
        expect_union(&clump, volume, area, 1e-11);
        ms_clump_free(&clump);
    }
}

/* The same sphere again, one inside, one that touches from within and one from without change nothing of the rest. */
static void degenerate(void **state)
{
    (void)state;
    ms_clump clump = {0};
    for (int twice = 0; twice < 2; twice++) {
        add_sphere(&clump, 0, 0, 0, 1);
        add_sphere(&clump, 1, 0, 0, 1);
        add_sphere(&clump, 0.5, 0, 0, 0.5);
        add_sphere(&clump, -0.5, 0, 0, 0.5);
        /* Through the circle of the first two, so that three spheres meet in it. */
        add_sphere(&clump, 0.5, 0, 0, sqrt(0.75));
    }
    expect_union(&clump, 2 * ball_volume(1) - 2 * cap_volume(1, 0.5), 8 * pi - 2 * 2 * pi * 0.5, 1e-11);
    add_sphere(&clump, -3, 0, 0, 2); /* touches the first from without, and no other */
    expect_union(&clump, 2 * ball_volume(1) - 2 * cap_volume(1, 0.5) + ball_volume(2),
                 8 * pi - 2 * 2 * pi * 0.5 + 16 * pi, 1e-11);
    ms_clump_free(&clump);
}

/* A row of equal spheres: a cap off each side of each but the ends. */
static void a_row(void **state)
{
    (void)state;
    ms_clump clump = {0};
    for (int s = 0; s < 9; s++) {
        add_sphere(&clump, 0, 0, 1.5 * ((4 * s) % 9), 1); /* in any order */
    }
    expect_union(&clump, 9 * ball_volume(1) - 16 * cap_volume(1, 0.25), 36 * pi - 16 * 2 * pi * 0.25, 1e-12);
    ms_clump_free(&clump);
}

/* Spheres of radius 1 in the corners, on the edges, ... of a cube of 5 x 5 x 5 around a hole: the caps hide nothing of
 * each other, so that each of the contacts takes two of them; what faces the hole is surface. */
static void a_cavity(void **state)
{
    (void)state;
    ms_clump clump = {0};
    int contacts = 0, count = 0;
    for (int p = 0; p < 125; p++) {
        const int at[3] = {p % 5, p / 5 % 5, p / 25};
        int inner = 1;
        for (int a = 0; a < 3; a++) {
            inner &= at[a] > 0 && at[a] < 4;
        }
        if (!inner) {
            add_sphere(&clump, 1.6 * at[0], 1.6 * at[1], 1.6 * at[2], 1);
            count++;
        }
    }
    for (int s = 0; s < count; s++) {
        for (int o = 0; o < s; o++) {
            double square = 0;
            for (int a = 0; a < 3; a++) {
                square += pow(clump.sphere[s].centre[a] - clump.sphere[o].centre[a], 2);
            }
            contacts += square < 3.9;
        }
    }
    expect_union(&clump, count * ball_volume(1) - 2 * contacts * cap_volume(1, 0.2),
                 4 * pi * count - 2 * contacts * 2 * pi * 0.2, 1e-11);
    ms_clump_free(&clump);
}

static int is_in(const ms_clump *clump, const double at[3], size_t but)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *o = &clump->sphere[s];
        const double x = at[0] - o->centre[0], y = at[1] - o->centre[1], z = at[2] - o->centre[2];
        if (s != but && x * x + y * y + z * z < o->radius * o->radius) {
            return 1;
        }
    }
    return 0;
}

static double sampled_area(const ms_clump *clump)
{
    enum { SAMPLES = 20000 };
    double area = 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *o = &clump->sphere[s];
        int exposed = 0;
        for (int m = 0; m < SAMPLES; m++) {
            const double z = 1 - (2 * m + 1.0) / SAMPLES, ring = sqrt(1 - z * z), turn = pi * (3 - sqrt(5)) * m;
            const double at[3] = {o->centre[0] + o->radius * ring * cos(turn),
                                  o->centre[1] + o->radius * ring * sin(turn), o->centre[2] + o->radius * z};
            exposed += !is_in(clump, at, s);
        }
        area += 4 * pi * o->radius * o->radius * exposed / SAMPLES;
    }
    return area;
}

static double sampled_volume(const ms_clump *clump)
{
    enum { SIDE = 90 };
    double lo[3], hi[3], cell = 1;
    int64_t count = 0;
    ms_clump_box(lo, hi, clump);
    for (int a = 0; a < 3; a++) {
        cell *= (hi[a] - lo[a]) / SIDE;
    }
    for (int p = 0; p < SIDE * SIDE * SIDE; p++) {
        const int i[3] = {p % SIDE, p / SIDE % SIDE, p / SIDE / SIDE};
        double at[3];
        for (int a = 0; a < 3; a++) {
            at[a] = lo[a] + (i[a] + 0.5) * (hi[a] - lo[a]) / SIDE;
        }
        count += is_in(clump, at, SIZE_MAX);
    }
    return cell * (double)count;
}

/* Crowds of every density; caps of more than half a sphere, spheres that several others hide together. */
static void crowds(void **state)
{
    (void)state;
    uint64_t seed = 2385;
    for (int n = 2; n <= 160; n = 2 * n + 1) {
        ms_clump clump = {0};
        for (int s = 0; s < n; s++) {
            add_sphere(&clump, between(&seed, 0, 2), between(&seed, 0, 1), between(&seed, 0, 1),
                       between(&seed, 0.15, 0.5));
        }
        double v, a;
        assert_int_equal(ms_union_measure(&v, &a, &clump, NULL), MS_OK);
        expect_close(v, sampled_volume(&clump), 1e-3 * v);
        expect_close(a, sampled_area(&clump), 1e-3 * a);
        ms_clump_free(&clump);
    }
}

/* The same bits at any number of threads; the same figures in any order and place. */
static void order_and_threads(void **state)
{
    (void)state;
    uint64_t seed = 7;
    ms_clump clump = {0}, turned = {0};
    for (int s = 0; s < 60; s++) {
        add_sphere(&clump, between(&seed, 0, 1), between(&seed, 0, 1), between(&seed, 0, 1), between(&seed, 0.1, 0.4));
    }
    for (int s = 59; s >= 0; s--) {
        const ms_sphere *o = &clump.sphere[s];
        add_sphere(&turned, 50 - o->centre[1], o->centre[2], o->centre[0] - 20, o->radius);
    }
    double v[2], a[2];
    const int threads = omp_get_max_threads();
    for (int t = 0; t < 2; t++) {
        omp_set_num_threads(t ? 5 : 1);
        assert_int_equal(ms_union_measure(&v[t], &a[t], &clump, NULL), MS_OK);
    }
    omp_set_num_threads(threads);
    assert_true(v[0] == v[1] && a[0] == a[1]);
    expect_union(&turned, v[0], a[0], 1e-11);
    ms_clump_free(&clump);
    ms_clump_free(&turned);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_and_one),   cmocka_unit_test(two),
        cmocka_unit_test(degenerate),        cmocka_unit_test(a_row),
        cmocka_unit_test(a_cavity),          cmocka_unit_test(crowds),
        cmocka_unit_test(order_and_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
