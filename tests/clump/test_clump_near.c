/* A few spheres of many: by those that are looked at the answer is that of all. */
#include "clump/ms_clump_near.h"

#include "support/clump_samples.h"

/* Distance to the union by all spheres. */
static double distance_by_all(const ms_clump *clump, const double place[3])
{
    double least = HUGE_VAL;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        const double x = place[0] - c[0], y = place[1] - c[1], z = place[2] - c[2];
        least = fmin(least, sqrt(x * x + y * y + z * z) - clump->sphere[s].radius);
    }
    return fmax(0, least);
}

/* Whether any other sphere holds a point of sphere s, or an earlier one has it on its surface. */
static int hidden_by_all(const ms_clump *clump, const double point[3], size_t s)
{
    for (size_t o = 0; o < clump->n_spheres; o++) {
        const double *c = clump->sphere[o].centre, r = clump->sphere[o].radius;
        const double x = point[0] - c[0], y = point[1] - c[1], z = point[2] - c[2];
        const double beyond = x * x + y * y + z * z - r * r;
        if (o != s && (beyond < -1e-11 || (o < s && beyond < 1e-11))) {
            return 1;
        }
    }
    return 0;
}

static void expect_same_as_all(const ms_clump *clump, const ms_mesh *mesh)
{
    uint64_t seed = 5;
    ms_clump_near near;
    double lo[3], hi[3];
    size_t hidden = 0, asked = 0;
    ms_clump_box(lo, hi, clump);
    assert_int_equal(ms_clump_near_build(&near, clump, mesh, NULL), MS_OK);
    for (int k = 0; k < 4000; k++) { /* a part of them beyond the box */
        double place[3];
        for (int a = 0; a < 3; a++) {
            place[a] = between(&seed, 1.2 * lo[a] - 0.2 * hi[a], 1.2 * hi[a] - 0.2 * lo[a]);
        }
        expect_close(ms_clump_near_distance(&near, place), distance_by_all(clump, place), 1e-13);
    }
    for (size_t s = 0; s < clump->n_spheres; s += clump->n_spheres / 200 + 1) {
        for (int k = 0; k < 20; k++, asked++) {
            const double z = between(&seed, -1, 1), turn = between(&seed, 0, 2 * pi), r = clump->sphere[s].radius;
            const double *c = clump->sphere[s].centre, ring = r * sqrt(1 - z * z);
            const double point[3] = {c[0] + ring * cos(turn), c[1] + ring * sin(turn), c[2] + r * z};
            const int hides = hidden_by_all(clump, point, s);
            hidden += (size_t)hides;
            assert_int_equal(ms_clump_near_hides(&near, point, s), hides);
        }
    }
    assert_true(clump->n_spheres <= 30 || (hidden > 0 && hidden < asked)); /* both were seen */
    ms_clump_near_free(&near);
    assert_null(near.cell);
}

/* From one sphere to thousands, of sizes that differ by a factor of thirty. */
static void a_few_of_many(void **state)
{
    (void)state;
    static const int NUMBERS[] = {1, 2, 30, 700, 3000};
    for (size_t n = 0; n < sizeof NUMBERS / sizeof *NUMBERS; n++) {
        ms_clump clump = {0};
        uint64_t seed = 17;
        for (int s = 0; s < NUMBERS[n]; s++) {
            const double r = 0.3 * exp(between(&seed, -3.4, 0)) / cbrt(NUMBERS[n]);
            add_sphere(&clump, between(&seed, 7, 8), between(&seed, -1, 1), between(&seed, 0, 1), r);
        }
        expect_same_as_all(&clump, NULL);
        ms_clump_free(&clump);
    }
}

/* More spheres about one place than a cell lists, some of them twice; with others apart from them. */
static void too_many_for_a_cell(void **state)
{
    (void)state;
    ms_clump clump = {0};
    for (int s = 0; s < 700; s++) {
        add_sphere(&clump, 1e-3 * (s % 40), 0, 0, 1);
    }
    expect_same_as_all(&clump, NULL);
    for (int s = 0; s < 20; s++) {
        add_sphere(&clump, 1.5 * s, 0, 0, 0.7);
    }
    expect_same_as_all(&clump, NULL);
    ms_clump_free(&clump);
}

/* The box of a mesh around the clump is in cells, too. */
static void beside_a_mesh(void **state)
{
    (void)state;
    ms_clump clump = {0};
    ms_mesh mesh = cuboid(-2, 3, -1, 1, 0, 4);
    uint64_t seed = 3;
    for (int s = 0; s < 100; s++) {
        add_sphere(&clump, between(&seed, 0, 1), between(&seed, -0.5, 0.5), between(&seed, 1, 2), 0.1);
    }
    expect_same_as_all(&clump, &mesh);
    ms_mesh_free(&mesh);
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_few_of_many), cmocka_unit_test(too_many_for_a_cell),
                                       cmocka_unit_test(beside_a_mesh)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
