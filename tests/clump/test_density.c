/* Masses by linear programme, against masses that are known and against brute force. */
#include <float.h>

#include "clump/ms_density.h"
#include "clump/ms_linear_program.h"
#include "support/body_samples.h"
#include "support/clump_samples.h"

static const ms_density_options DEFAULTS = {0};
static const ms_density_options NO_TOLERANCE = {.centre_tolerance = DBL_MIN};

static void set_masses(ms_clump *clump, const double *mass)
{
    assert_int_equal(ms_clump_alloc_masses(clump, NULL), MS_OK);
    memcpy(clump->mass, mass, clump->n_spheres * sizeof *mass);
}

/* What the spheres sum to with these masses. */
static ms_particle particle_of(ms_clump *clump, const double *mass)
{
    ms_particle particle;
    set_masses(clump, mass);
    assert_int_equal(ms_particle_from_spheres(&particle, clump, 1, NULL), MS_OK);
    return particle;
}

static ms_density_report solve(ms_clump *clump, const ms_particle *particle, const ms_density_options *options)
{
    ms_density_report report;
    ms_error err = {{0}};
    if (ms_density_solve(clump, &report, particle, options, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return report;
}

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
        cmocka_unit_test(flat_and_lopsided_clumps_miss_the_centre_least),
        cmocka_unit_test(a_centre_beside_the_line_is_a_number),
        cmocka_unit_test(the_tolerance_reaches_the_programme),
        cmocka_unit_test(a_simplex_without_end_is_said),
        cmocka_unit_test(masses_that_may_not_be_the_best),
        cmocka_unit_test(bounds),
        cmocka_unit_test(odd_spheres_do_no_harm),
        cmocka_unit_test(microns_and_kilometres),
        cmocka_unit_test(many_spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
