/* Measures of clumps against a second, plain way to count: cell centres on a lattice of its own,
 * shapes by their formulas. Both see the same bodies, so that they agree to the lattice's resolution. */
#include "support/clump_samples.h"

/* Inside a shape, by its formula. Curved ones: of a flat face both lattices make a step of their own. */
typedef int in_shape(double x, double y, double z);

static int in_ellipsoid(double x, double y, double z)
{
    return x * x / 4 + y * y + z * z / 1.44 < 1;
}

static int in_torus(double x, double y, double z)
{
    const double ring = sqrt(x * x + y * y) - 1.5;
    return ring * ring + z * z < 0.36;
}

static int in_clump(const ms_clump *clump, size_t count, double x, double y, double z)
{
    for (size_t s = 0; s < count; s++) {
        const ms_sphere *p = &clump->sphere[s];
        const double dx = x - p->centre[0], dy = y - p->centre[1], dz = z - p->centre[2];
        if (dx * dx + dy * dy + dz * dz <= p->radius * p->radius) {
            return 1;
        }
    }
    return 0;
}

static ms_score judge(in_shape *shape, const ms_clump *clump, size_t count)
{
    const double h = 0.043, reach = 3.2;
    double target = 0, common = 0, all = 0;
    for (double z = -reach + 0.37 * h; z < reach; z += h) {
        for (double y = -reach + 0.61 * h; y < reach; y += h) {
            for (double x = -reach + 0.13 * h; x < reach; x += h) {
                const int s = shape(x, y, z), u = in_clump(clump, count, x, y, z);
                target += s;
                all += u;
                common += s && u;
            }
        }
    }
    return (ms_score){.eta = (target + all - 2 * common) / target,
                      .dice = 1 - 2 * common / (target + all),
                      .coverage = common / target,
                      .overshoot = (all - common) / target,
                      .off_volume = all / target};
}

static void expect_score(const ms_score *got, const ms_score *expected, double tolerance)
{
    expect_close(got->eta, expected->eta, tolerance);
    expect_close(got->dice, expected->dice, tolerance);
    expect_close(got->coverage, expected->coverage, tolerance);
    expect_close(got->overshoot, expected->overshoot, tolerance);
    expect_close(got->off_volume, expected->off_volume, tolerance);
}

/* Random spheres in and around the shape; every prefix is judged. */
static void expect_agreement(const char *kind, const double *value, in_shape *shape, uint64_t seed)
{
    const ms_voxel_rule rules[] = {MS_VOXEL_HALF, MS_VOXEL_CENTRE};
    ms_mesh mesh = make_body(kind, value);
    ms_clump clump = {0};
    for (int s = 0; s < 6; s++) {
        const double x = between(&seed, -1.5, 1.5), y = between(&seed, -1.3, 1.3), z = between(&seed, -0.8, 0.8);
        add_sphere(&clump, x, y, z, between(&seed, 0.2, 1.1));
    }
    for (int r = 0; r < 2; r++) {
        ms_target target = target_of(&mesh, 0.0497, rules[r]);
        ms_score curve[6];
        const ms_metrics m = measure(&target, &clump, curve);
        for (size_t k = 1; k <= 6; k += 5) {
            const ms_score expected = judge(shape, &clump, k);
            expect_score(&curve[k - 1], &expected, 0.006 * (1 + expected.off_volume));
        }
        assert_memory_equal(&curve[5], &m.score, sizeof m.score);
        ms_target_free(&target);
    }
    ms_clump_free(&clump);
    ms_mesh_free(&mesh);
}

static void clumps_in_an_ellipsoid(void **state)
{
    (void)state;
    expect_agreement("ellipsoid", (double[]){2, 1, 1.2, 48}, in_ellipsoid, 31);
    expect_agreement("ellipsoid", (double[]){2, 1, 1.2, 48}, in_ellipsoid, 32);
}

static void clumps_in_a_torus(void **state)
{
    (void)state;
    expect_agreement("torus", (double[]){1.5, 0.6, 40}, in_torus, 33);
}

/* The curve is the scores of the prefixes as clumps of their own. */
static void the_curve_is_made_of_the_scores_of_the_prefixes(void **state)
{
    (void)state;
    uint64_t seed = 35;
    ms_mesh mesh = make_body("torus", (double[]){1.5, 0.6, 20});
    ms_target target = target_of(&mesh, 0.1, MS_VOXEL_HALF);
    ms_clump clump = {0}, prefix = {0};
    ms_score curve[25];
    for (int s = 0; s < 25; s++) {
        const double turn = between(&seed, 0, 2 * pi);
        add_sphere(&clump, 1.5 * cos(turn), 1.5 * sin(turn), between(&seed, -0.1, 0.1), between(&seed, 0.1, 0.8));
    }
    measure(&target, &clump, curve);
    for (size_t k = 0; k < 25; k++) {
        const ms_sphere *s = &clump.sphere[k];
        add_sphere(&prefix, s->centre[0], s->centre[1], s->centre[2], s->radius);
        const ms_metrics m = measure(&target, &prefix, NULL);
        assert_memory_equal(&m.score, &curve[k], offsetof(ms_score, inertia));
        assert_true(m.score.inertia == m.inertia.weighted);
        /* The grid of fewer spheres may begin elsewhere, which turns the last bits of sums over its indices. */
        assert_true(fabs(m.score.inertia - curve[k].inertia) < 1e-12);
        assert_true(k == 0 || curve[k].coverage >= curve[k - 1].coverage);
    }
    ms_clump_free(&clump);
    ms_clump_free(&prefix);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    const int before = omp_get_max_threads();
    uint64_t seed = 36;
    ms_mesh mesh = make_body("ellipsoid", (double[]){2, 1, 1.2, 24});
    ms_clump clump = {0};
    ms_metrics m[3];
    for (int s = 0; s < 30; s++) {
        const double x = between(&seed, -1.5, 1.5), y = between(&seed, -1, 1), z = between(&seed, -1, 1);
        add_sphere(&clump, x, y, z, between(&seed, 0.1, 0.9));
    }
    for (int threads = 1; threads <= 3; threads++) {
        omp_set_num_threads(threads);
        ms_target target = target_of(&mesh, 0.08, MS_VOXEL_HALF);
        m[threads - 1] = measure(&target, &clump, NULL);
        ms_target_free(&target);
    }
    omp_set_num_threads(before);
    assert_memory_equal(&m[0], &m[1], sizeof m[0]);
    assert_memory_equal(&m[0], &m[2], sizeof m[0]);
    ms_clump_free(&clump);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clumps_in_an_ellipsoid),
        cmocka_unit_test(clumps_in_a_torus),
        cmocka_unit_test(the_curve_is_made_of_the_scores_of_the_prefixes),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
