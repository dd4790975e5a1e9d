/* Masses by linear programme where none give all that is asked for: the centre is missed, or the simplex has no end. */
#include "clump/ms_linear_program.h"
#include "support/density_samples.h"

static void flat_and_lopsided_clumps_miss_the_centre_least(void **state)
{
    ms_clump clump = {0};
    ms_particle particle = {.scale = 1, .mass = 1, .centre = {0, 0, 0.25}};
    const double x[] = {0, 0.5, -0.5, 0.5, -0.5}, y[] = {0, 0.5, -0.5, -0.5, 0.5};
    const double least[] = {0.25, 0.25, 0.25, 0.25, 0.25};
    (void)state;
    for (int k = 0; k < 3; k++) {
        particle.inertia[k][k] = 0.4;
    }
    for (int s = 0; s < 5; s++) { /* a point, a line, a plane below the centre */
        add_sphere(&clump, x[s], y[s], 0, 1);
        const ms_density_report r = solve(&clump, &particle, &NO_TOLERANCE);
        assert_true(r.optimal);
        expect_close(r.centre, least[s] / sqrt(0.6), 1e-9);
        expect_close(r.error_mass, 0, 1e-12);
        assert_true(r.error_centre > r.centre - 1e-9 && r.error_centre < r.centre * sqrt(3) + 1e-9);
    }
    add_sphere(&clump, 0, 0, 0.2, 1);
    const ms_density_report r = solve(&clump, &particle, &NO_TOLERANCE);
    /* All but the bounds of the others sits on the top sphere: 0.995 * 0.2 of 0.25, over the radius of gyration. */
    expect_close(r.centre, (0.25 - 0.995 * 0.2) / sqrt(0.6), 1e-9);
    assert_true(r.error_centre > r.centre - 1e-9 && r.error_centre < r.centre * sqrt(3) + 1e-9);
    expect_close(r.error_mass, 0, 1e-12);
    add_sphere(&clump, 0, 0, 0.4, 1);
    assert_true(solve(&clump, &particle, &NO_TOLERANCE).centre == 0); /* now it is met */
    ms_clump_free(&clump);
}

/* Spheres on a line, the true centre beside it by what a mesh, a grid, a poor clump are off. */
static void a_centre_beside_the_line_is_a_number(void **state)
{
    uint64_t seed = 17;
    (void)state;
    for (int power = -13; power <= 0; power++) {
        for (size_t n = 1; n <= 5; n++) {
            const double off = 0.7 * pow(10, power);
            ms_particle particle = {.scale = 1, .mass = 2, .centre = {n == 1 ? -0.5 : 0, 0, off}};
            ms_clump clump = {0};
            for (int k = 0; k < 3; k++) {
                particle.inertia[k][k] = 0.5 + 0.3 * k;
            }
            for (size_t s = 0; s < n; s++) { /* on either side */
                add_sphere(&clump, (s % 2 ? 1 : -1) * between(&seed, 0.5, 1) * (n > 1) - 0.5 * (n == 1), 0, 0, 0.5);
            }
            const ms_density_report r = solve(&clump, &particle, &(ms_density_options){.input_frame = power & 1});
            const double gyration = sqrt((0.5 + 0.8 + 1.1) / 4);
            assert_true(r.optimal);
            expect_close(r.centre, off / gyration, 2e-9);
            assert_true(r.error_centre > r.centre - 2e-9 && r.error_centre < r.centre * sqrt(3) + 2e-7);
            expect_close(r.error_mass, 0, 1e-9);
            ms_clump_free(&clump);
        }
    }
}

/* Two spheres: the mass of one says all. Within the tolerance the centre gives way to the moments, no farther. */
static void the_tolerance_reaches_the_programme(void **state)
{
    const double x[2] = {-1, 2}, r = 0.6, moment[2] = {0.2, 1.5}; /* exact centre: 2/3 and 1/3, across 2.144 */
    ms_particle particle = {.scale = 1, .mass = 1};
    ms_clump clump = {0};
    (void)state;
    for (int s = 0; s < 3; s++) {
        particle.inertia[s][s] = moment[s > 0];
    }
    add_sphere(&clump, x[0], 0, 0, r);
    add_sphere(&clump, x[1], 0, 0, r);
    const double gyration = sqrt((moment[0] + 2 * moment[1]) / 2), spin = 0.4 * r * r;
    const double tolerances[] = {DBL_MIN, 1e-3, 0.1, 10};
    for (int k = 0; k < 4; k++) {
        /* Of m on the second sphere the moment across is spin + 1 + 3 m, and the centre at 3 m - 1. */
        const double wanted = fmax((1.5 - spin - 1) / 3, 1e-3), least = (1 - tolerances[k] * gyration) / 3;
        const double m = fmax(wanted, least);
        const ms_density_report report =
            solve(&clump, &particle, &(ms_density_options){.centre_tolerance = tolerances[k]});
        /* The moment about the axis is off by 28 % whatever the masses: no smaller error across is worth a thing. */
        const double along = fabs(spin / moment[0] - 1), across = fabs((spin + 1 + 3 * m) / moment[1] - 1);
        assert_true(report.centre == 0);
        expect_close(report.epsilon, fmax(along, across), 1e-8);
        assert_true(report.error_centre <= tolerances[k] + 1e-9);
        if (across < along) { /* then the centre takes back what it does not need */
            const double enough = (moment[1] * (1 + along) - spin - 1) / 3;
            expect_close(clump.mass[1], fmin(1.0 / 3, enough), 1e-8);
        } else {
            expect_close(clump.mass[1], m, 1e-8);
        }
    }
    ms_clump_free(&clump);
}

static void a_simplex_without_end_is_said(void **state)
{
    ms_error err = {{0}};
    double value;
    const double ones[2] = {1, 1};
    (void)state;
    /* Shares of sum 1 and of sum 2. */
    ms_linear_program *p = ms_linear_program_new(2, 1, 0, 1, &err);
    assert_non_null(p);
    assert_int_equal(ms_linear_program_equation(p, ones, 1, -1, 0, &err), MS_OK);
    assert_int_equal(ms_linear_program_equation(p, ones, 2, -1, 0, &err), MS_OK);
    assert_int_equal(ms_linear_program_minimise(p, 0, 0, &value, &err), MS_ERR_LIMIT);
    assert_non_null(strstr(err.text, "found no masses"));
    assert_int_equal(ms_linear_program_spread(p, &err), MS_ERR_LIMIT);
    ms_linear_program_free(p);
}

/* A hundred thousand radii of gyration away there are more digits than doubles have. Some masses there are even so. */
static void masses_that_may_not_be_the_best(void **state)
{
    uint64_t seed = 23;
    int poor = 0;
    (void)state;
    for (int run = 0; run < 20; run++) {
        ms_particle particle = {.scale = 1, .mass = 1};
        ms_clump clump = {0};
        for (int k = 0; k < 3; k++) {
            particle.inertia[k][k] = 0.4 + 0.1 * k;
        }
        for (int s = 0; s < 50; s++) {
            const double far = 1e5;
            add_sphere(&clump, between(&seed, -far, far), between(&seed, -far, far), between(&seed, -far, far), 0.3);
        }
        const ms_density_report r = solve(&clump, &particle, &DEFAULTS);
        expect_close(r.error_mass, 0, 1e-5);
        assert_true(r.least_mass > 0.999e-3 && r.most_mass < 1);
        if (!r.optimal) {
            poor++;
            expect_close(r.centre, r.error_centre > 1e-9 ? r.error_centre : 0, 0);
            expect_close(r.epsilon, fmax(r.error_moment[0], fmax(r.error_moment[1], r.error_moment[2])), 0);
        }
        ms_clump_free(&clump);
    }
    assert_true(poor > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_and_lopsided_clumps_miss_the_centre_least),
        cmocka_unit_test(a_centre_beside_the_line_is_a_number),
        cmocka_unit_test(the_tolerance_reaches_the_programme),
        cmocka_unit_test(a_simplex_without_end_is_said),
        cmocka_unit_test(masses_that_may_not_be_the_best),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
