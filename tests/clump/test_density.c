/* Masses by linear programme, against masses that are known and against brute force. */
#include "support/density_samples.h"

static void expect_exact(const ms_density_report *r)
{
    assert_true(r->centre == 0 && r->epsilon == 0 && r->products == 0);
    expect_close(r->error_mass, 0, 1e-9);
    expect_close(r->error_centre, 0, 1e-9);
    for (int m = 0; m < 3; m++) {
        expect_close(r->error_moment[m], 0, 1e-9);
        expect_close(r->error_product[m], 0, 1e-9);
    }
}

static void expect_failure(ms_clump *clump, const ms_particle *particle, const ms_density_options *options,
                           ms_status expected, const char *says)
{
    ms_density_report report;
    ms_error err = {{0}};
    assert_int_equal(ms_density_solve(clump, &report, particle, options, &err), expected);
    if (!strstr(err.text, says)) {
        fail_msg("'%s' does not say '%s'", err.text, says);
    }
    assert_null(clump->mass);
}

static ms_clump random_clump(size_t n, uint64_t *seed)
{
    ms_clump clump = {0};
    for (size_t s = 0; s < n; s++) {
        add_sphere(&clump, between(seed, -2, 2), between(seed, -1, 1), between(seed, 3, 4), between(seed, 0.2, 0.6));
    }
    return clump;
}

static void sums_of_spheres(void **state)
{
    ms_clump clump = {0};
    (void)state;
    add_sphere(&clump, 1, 0, 0, 0.5);
    add_sphere(&clump, -2, 0, 0, 0.25);
    /* Centre at 0: m1 = 2, m2 = 1. */
    const ms_particle p = particle_of(&clump, (double[]){2, 1});
    const double spin = 0.4 * (2 * 0.25 + 0.0625);
    expect_close(p.mass, 3, 1e-15);
    expect_close(p.centre[0], 0, 1e-15);
    expect_close(p.inertia[0][0], spin, 1e-15);
    expect_close(p.inertia[1][1], spin + 6, 1e-14);
    expect_close(p.inertia[2][2], spin + 6, 1e-14);
    expect_close(p.inertia[0][1], 0, 1e-15);
    expect_close(ms_particle_gyration(&p), sqrt((3 * spin + 12) / 6), 1e-15);
    ms_clump_free(&clump);
}

static void a_ball_in_millimetres(void **state)
{
    ms_particle p;
    ms_body ball = {.volume = ball_volume(2), .centroid = {1, 2, 3}};
    (void)state;
    for (int k = 0; k < 3; k++) {
        ball.inertia[k][k] = 0.4 * ball.volume * 4;
    }
    assert_int_equal(ms_particle_from_body(&p, &ball, 2500, 1e-3, NULL), MS_OK);
    expect_close(p.mass, 2500 * ball_volume(2e-3), 1e-18);
    expect_close(p.inertia[1][1], 0.4 * p.mass * 4e-6, 1e-24);
    expect_close(p.centre[2], 3, 0);
    expect_close(ms_particle_gyration(&p), 2 * sqrt(0.6), 1e-14);
    assert_int_equal(ms_particle_from_body(&p, &ball, 0, 1, NULL), MS_ERR_ARG);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1e31, 1, NULL), MS_ERR_ARG);
    assert_int_equal(ms_particle_from_body(&p, &ball, 0.9e-30, 1, NULL), MS_ERR_ARG);
    /* whose mass and inertia are numbers, but not its volume, or its inertia over the density */
    assert_int_equal(ms_particle_from_body(&p, &ball, 1e-30, 1e60, NULL), MS_ERR_ARG);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1e-30, 0.9e58, NULL), MS_ERR_ARG);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1e30, 1e-60, NULL), MS_ERR_ARG);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1e-30, 1e57, NULL), MS_OK);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1e30, 1e-57, NULL), MS_OK);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1, (double)NAN, NULL), MS_ERR_ARG);
    assert_int_equal(ms_particle_from_body(&p, &ball, 1, 1e-200, NULL), MS_ERR_ARG);
    ball.volume = 0;
    assert_int_equal(ms_particle_from_body(&p, &ball, 1, 1, NULL), MS_ERR_ARG);
}

static void union_of_two_balls(void **state)
{
    /* Balls of radius 1, centres 1 apart: each is cut by a cap of height 1/2. */
    ms_clump clump = {0};
    ms_body body;
    (void)state;
    add_sphere(&clump, 10, 0, 0, 1);
    add_sphere(&clump, 11, 0, 0, 1);
    assert_int_equal(ms_particle_union(&body, &clump, MANY_VOXELS, NULL), MS_OK);
    const double truth = 2 * ball_volume(1) - 2 * pi * 0.25 * (3 - 0.5) / 3;
    expect_close(body.volume, truth, 2e-4 * truth);
    expect_close(body.centroid[0], 10.5, 1e-9);
    /* About the axis: the balls' 2/5 m each less that of the two caps, integral of pi/2 (1 - z^2)^2 from 1/2 to 1. */
    const double cap = pi / 2 * (8.0 / 15 - (0.5 - 2.0 / 24 + 1.0 / 160));
    const double axial = 2 * 0.4 * ball_volume(1) - 2 * cap;
    expect_close(body.inertia[0][0], axial, 5e-4 * axial);
    assert_int_equal(ms_particle_union(&body, &clump, 1000, NULL), MS_ERR_LIMIT);
    clump.n_spheres = 0;
    assert_int_equal(ms_particle_union(&body, &clump, MANY_VOXELS, NULL), MS_ERR_ARG);
    ms_clump_free(&clump);
}

static void two_balls_and_a_dumbbell(void **state)
{
    (void)state;
    for (int unequal = 0; unequal < 2; unequal++) {
        ms_clump clump = {0};
        const double mass[2] = {1.5, unequal ? 0.4 : 1.5};
        add_sphere(&clump, -1, 0.3, 2, 0.75);
        add_sphere(&clump, 1, 0.7, 2.5, unequal ? 0.4 : 0.75);
        const ms_particle particle = particle_of(&clump, mass);
        const ms_density_report r = solve(&clump, &particle, &DEFAULTS);
        expect_exact(&r);
        expect_close(clump.mass[0], mass[0], 1e-9);
        expect_close(clump.mass[1], mass[1], 1e-9);
        ms_clump_free(&clump);
    }
}

static void a_cube_of_eight_balls(void **state)
{
    /* Many masses do; the greatest least one is the mean. */
    ms_clump clump = {0};
    double mass[8];
    (void)state;
    for (int c = 0; c < 8; c++) {
        add_sphere(&clump, c & 1, c >> 1 & 1, c >> 2, 0.3);
        mass[c] = 2.385;
    }
    const ms_particle particle = particle_of(&clump, mass);
    const ms_density_report r = solve(&clump, &particle, &DEFAULTS);
    expect_exact(&r);
    for (int c = 0; c < 8; c++) {
        expect_close(clump.mass[c], 2.385, 1e-9);
    }
    expect_close(r.least_mass, 2.385, 1e-9);
    ms_clump_free(&clump);
}

static void ten_spheres_have_one_solution(void **state)
{
    /* Ten equations, ten unknowns. */
    uint64_t seed = 7;
    (void)state;
    for (int frame = 0; frame < 2; frame++) {
        double mass[10];
        const ms_density_options options = {.input_frame = frame, .centre_tolerance = DBL_MIN};
        ms_clump clump = random_clump(10, &seed);
        for (int s = 0; s < 10; s++) {
            mass[s] = between(&seed, 0.5, 1.5);
        }
        const ms_particle particle = particle_of(&clump, mass);
        const ms_density_report r = solve(&clump, &particle, &options);
        expect_exact(&r);
        for (int s = 0; s < 10; s++) {
            /* Sums are exact to 1e-9, the equations are not well conditioned: built by clang 5.5e-7 was seen. */
            expect_close(clump.mass[s], mass[s], 1e-5);
        }
        ms_clump_free(&clump);
    }
}

static void no_least_mass_is_greater(void **state)
{
    /* The masses that made the particle are one solution: the one found must be as even. */
    uint64_t seed = 11;
    (void)state;
    for (int run = 0; run < 20; run++) {
        double mass[40], least = HUGE_VAL;
        ms_clump clump = random_clump(40, &seed);
        for (int s = 0; s < 40; s++) {
            mass[s] = between(&seed, 0.5, 1.5);
            least = fmin(least, mass[s]);
        }
        const ms_particle particle = particle_of(&clump, mass);
        const ms_density_report r = solve(&clump, &particle, &DEFAULTS);
        expect_exact(&r);
        assert_true(r.least_mass >= least * (1 - 1e-9));
        ms_clump_free(&clump);
    }
}

/* The largest relative error of the moments across the line, with mass m in the middle of three balls. */
static double error_of_three(const double x[3], const double r[3], double m, const double *moment)
{
    /* The outer ones keep the centre at 0: m0 x0 + m x1 + m2 x2 = 0, m0 + m + m2 = 1. */
    const double m2 = (-(1 - m) * x[0] - m * x[1]) / (x[2] - x[0]), m0 = 1 - m - m2;
    if (m < 1e-3 || m0 < 1e-3 || m2 < 1e-3) {
        return HUGE_VAL;
    }
    const double spin = 0.4 * (m0 * r[0] * r[0] + m * r[1] * r[1] + m2 * r[2] * r[2]);
    const double across = spin + m0 * x[0] * x[0] + m * x[1] * x[1] + m2 * x[2] * x[2];
    return fmax(fabs(spin / moment[0] - 1), fabs(across / moment[1] - 1));
}

static void least_epsilon_by_brute_force(void **state)
{
    const double x[3] = {-1.2, 0.1, 0.9}, r[3] = {0.5, 0.8, 0.3}, moment[2] = {0.3, 0.55};
    ms_particle particle = {.scale = 1, .mass = 1};
    ms_clump clump = {0};
    double best = HUGE_VAL;
    (void)state;
    for (int s = 0; s < 3; s++) {
        add_sphere(&clump, x[s], 0, 0, r[s]);
        particle.inertia[s][s] = moment[s > 0];
    }
    for (int step = 0; step <= 1000000; step++) {
        best = fmin(best, error_of_three(x, r, step * 1e-6, moment));
    }
    const ms_density_report report = solve(&clump, &particle, &NO_TOLERANCE);
    assert_true(best > 0.01);
    expect_close(report.epsilon, best, 1e-5);
    for (int m = 0; m < 3; m++) {
        assert_true(fabs(report.error_moment[m]) <= report.epsilon * (1 + 1e-8) + 1e-9);
    }
    expect_close(report.error_centre, 0, 1e-9);
    ms_clump_free(&clump);
}

static void bounds(void **state)
{
    uint64_t seed = 3;
    double mass[20];
    ms_clump clump = random_clump(20, &seed);
    (void)state;
    for (int s = 0; s < 20; s++) {
        mass[s] = 1 + 0.3 * (s % 2);
    }
    const ms_particle particle = particle_of(&clump, mass);
    const ms_density_options narrow = {.least = 0.9 / 23, .most = 1.4 / 23};
    const ms_density_report r = solve(&clump, &particle, &narrow);
    expect_exact(&r);
    assert_true(r.least_mass >= 0.9 - 1e-8 && r.most_mass <= 1.4 + 1e-8);
    expect_failure(&clump, &particle, &(ms_density_options){.least = 0.06}, MS_ERR_ARG, "eq. 5");
    expect_failure(&clump, &particle, &(ms_density_options){.most = 0.04}, MS_ERR_ARG, "eq. 5");
    expect_failure(&clump, &particle, &(ms_density_options){.least = 0.05, .most = 0.04}, MS_ERR_ARG, "eq. 5");
    expect_failure(&clump, &particle, &(ms_density_options){.centre_tolerance = -1}, MS_ERR_ARG, "tolerance");
    ms_clump_free(&clump);
}

static void odd_spheres_do_no_harm(void **state)
{
    ms_clump clump = {0};
    ms_particle particle = {.scale = 1, .mass = 1};
    (void)state;
    for (int k = 0; k < 3; k++) {
        particle.inertia[k][k] = 0.4;
    }
    expect_failure(&clump, &particle, &DEFAULTS, MS_ERR_ARG, "without spheres");
    add_sphere(&clump, 0, 0, 0, 1);
    add_sphere(&clump, 0, 0, 0, 1);
    const ms_density_report r = solve(&clump, &particle, &DEFAULTS); /* two spheres in one place */
    expect_exact(&r);
    add_sphere(&clump, 0, (double)NAN, 0, 1);
    expect_failure(&clump, &particle, &DEFAULTS, MS_ERR_ARG, "sphere 3");
    clump.sphere[2] = (ms_sphere){{1e30, 0, 0}, 1};
    expect_failure(&clump, &particle, &DEFAULTS, MS_ERR_ARG, "one unit and frame");
    ms_clump_free(&clump);
}

static void microns_and_kilometres(void **state)
{
    /* A grain by few spheres, so that epsilon is not 0: the same shares of the mass in any unit. */
    const double grain[MS_SHAPE_MAX_PARAMETERS] = {1, 0.7, 0.5, 16};
    double share[12] = {0}, epsilon = 0;
    ms_mesh mesh = make_body("ellipsoid", grain);
    const ms_body body = body_of(&mesh);
    (void)state;
    for (int power = -6; power <= 3; power += 3) {
        const double unit = pow(10, power);
        uint64_t seed = 5;
        ms_particle particle;
        ms_clump clump = {0};
        ms_body scaled = body;
        scaled.volume *= pow(unit, 3);
        for (int k = 0; k < 9; k++) {
            scaled.inertia[k / 3][k % 3] *= pow(unit, 5);
        }
        for (int s = 0; s < 12; s++) {
            const double x = between(&seed, -0.7, 0.7), y = between(&seed, -0.2, 0.2), z = between(&seed, -0.2, 0.2);
            add_sphere(&clump, unit * x, unit * y, unit * z, unit * 0.2);
        }
        assert_int_equal(ms_particle_from_body(&particle, &scaled, 2650, 1, NULL), MS_OK);
        const ms_density_report r = solve(&clump, &particle, &DEFAULTS);
        for (int s = 0; s < 12; s++) {
            const double part = clump.mass[s] / particle.mass;
            expect_close(part, power == -6 ? part : share[s], 1e-8);
            share[s] = part;
        }
        expect_close(r.epsilon, power == -6 ? r.epsilon : epsilon, 1e-9);
        assert_true(r.epsilon > 1e-3);
        epsilon = r.epsilon;
        ms_clump_free(&clump);
    }
    ms_mesh_free(&mesh);
}

static void many_spheres(void **state)
{
    uint64_t seed = 1;
    double *mass = malloc(3000 * sizeof *mass);
    ms_clump clump = random_clump(3000, &seed);
    (void)state;
    assert_non_null(mass);
    for (int s = 0; s < 3000; s++) {
        mass[s] = between(&seed, 0.5, 1.5);
    }
    const ms_particle particle = particle_of(&clump, mass);
    const ms_density_report r = solve(&clump, &particle, &DEFAULTS);
    expect_exact(&r);
    assert_true(r.least_mass >= 0.5);
    free(mass);
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_of_spheres),
        cmocka_unit_test(a_ball_in_millimetres),
        cmocka_unit_test(union_of_two_balls),
        cmocka_unit_test(two_balls_and_a_dumbbell),
        cmocka_unit_test(a_cube_of_eight_balls),
        cmocka_unit_test(ten_spheres_have_one_solution),
        cmocka_unit_test(no_least_mass_is_greater),
        cmocka_unit_test(least_epsilon_by_brute_force),
        cmocka_unit_test(bounds),
        cmocka_unit_test(odd_spheres_do_no_harm),
        cmocka_unit_test(microns_and_kilometres),
        cmocka_unit_test(many_spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
