/* Carriers: sums made again here, places and bounds, a case whose least number is known, and failures. */
#include "base/ms_vector.h"
#include "clump/ms_carriers.h"
#include "support/density_samples.h"

static const ms_carriers_options PLAIN = {0};

/* A homogeneous ellipsoid about the origin, of density 1: m (b^2 + c^2) / 5. */
static ms_particle ellipsoid(double a, double b, double c)
{
    const double semi[3] = {a, b, c}, volume = 4 * pi / 3 * a * b * c;
    ms_particle p = {.scale = 1, .density = 1, .mass = volume};
    for (int k = 0; k < 3; k++) {
        const double one = semi[(k + 1) % 3], two = semi[(k + 2) % 3];
        p.inertia[k][k] = volume * (one * one + two * two) / 5;
    }
    return p;
}

/* Balls that touch an ellipsoid of revolution from within, along its axis. */
static ms_clump balls_in_spheroid(double a, double b, int n)
{
    ms_clump clump = {0};
    for (int s = 0; s < n; s++) {
        const double x = (a - b * b / a) * (2.0 * s / (n - 1) - 1);
        add_sphere(&clump, x, 0, 0, b * sqrt(1 - x * x / (a * a - b * b)));
    }
    return clump;
}

static ms_density_report solve_with(ms_clump *clump, const ms_particle *particle, const ms_carriers_options *options)
{
    ms_density_report report;
    ms_error err = {{0}};
    if (ms_carriers_solve(clump, &report, particle, options, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return report;
}

/* The ten sums, element by element. */
static void expect_all_ten(const ms_clump *clump, const ms_particle *p)
{
    double sum[3][3] = {{0}}, centre[3] = {0}, mass = 0, spin = 0;
    for (size_t s = 0; s < clump->n_spheres + clump->n_carriers; s++) {
        const double m = clump->mass[s], r = clump->sphere[s].radius;
        mass += m;
        spin += 0.4 * m * r * r;
        for (int i = 0; i < 3; i++) {
            const double x = clump->sphere[s].centre[i] - p->centre[i];
            centre[i] += m * x;
            for (int j = 0; j < 3; j++) {
                sum[i][j] += m * x * (clump->sphere[s].centre[j] - p->centre[j]);
            }
        }
    }
    const double trace = sum[0][0] + sum[1][1] + sum[2][2], size = p->inertia[2][2];
    expect_close(mass, p->mass, 1e-9 * p->mass);
    for (int i = 0; i < 3; i++) {
        expect_close(centre[i], 0, 1e-9 * sqrt(size * p->mass));
        for (int j = 0; j < 3; j++) {
            expect_close((i == j ? trace + spin : 0) - sum[i][j], p->inertia[i][j], 1e-9 * size);
        }
    }
}

/* Each is in some sphere, `part` of its radius below the surface; no mass is below the bound. */
static void expect_in_place(const ms_clump *clump, double part, double least)
{
    const size_t n = clump->n_spheres;
    for (size_t c = n; c < n + clump->n_carriers; c++) {
        int inside = 0;
        for (size_t s = 0; s < n; s++) {
            const ms_sphere *host = &clump->sphere[s], *carrier = &clump->sphere[c];
            const double distance = sqrt(ms_squared_distance(host->centre, carrier->centre));
            inside |= distance + carrier->radius <= (1 - part) * host->radius * (1 + 1e-12);
        }
        assert_true(inside);
    }
    for (size_t s = 0; s < n + clump->n_carriers; s++) {
        assert_true(clump->mass[s] >= least * (1 - 1e-9));
    }
}

static void a_spheroid_by_balls_on_its_axis(void **state)
{
    /* About the axis each ball has 2/5 m r^2, no more than the spheroid of the largest r: no masses do. */
    (void)state;
    const ms_particle particle = ellipsoid(2, 1, 1);
    ms_clump clump = balls_in_spheroid(2, 1, 11), alone = balls_in_spheroid(2, 1, 11);
    assert_true(solve(&alone, &particle, &DEFAULTS).epsilon > 0.01);
    const double smallest = ms_clump_smallest_radius(&clump);
    const ms_density_report r = solve_with(&clump, &particle, &PLAIN);
    assert_true(r.epsilon == 0 && r.products == 0 && r.centre == 0);
    assert_int_equal(clump.n_spheres, 11);
    assert_in_range(clump.n_carriers, 1, 8);
    expect_all_ten(&clump, &particle);
    expect_in_place(&clump, 0.1, 1e-3 * particle.mass);
    assert_true(ms_clump_smallest_radius(&clump) == smallest);
    assert_memory_equal(clump.sphere, alone.sphere, 11 * sizeof *alone.sphere);
    ms_clump_free(&clump);
    ms_clump_free(&alone);
}

static void turned_moved_and_in_millimetres(void **state)
{
    /* The axes of the body are at 30 degrees in x and y, its centre off the origin. */
    const double c = cos(pi / 6), s = sin(pi / 6), scale = 1e-3;
    (void)state;
    ms_particle straight = ellipsoid(2, 1, 0.8), p = {.scale = scale, .density = 1, .centre = {5, -7, 3}};
    const double x = straight.inertia[0][0], y = straight.inertia[1][1], unit = pow(scale, 5);
    p.mass = straight.mass * pow(scale, 3);
    p.inertia[0][0] = (c * c * x + s * s * y) * unit;
    p.inertia[1][1] = (s * s * x + c * c * y) * unit;
    p.inertia[0][1] = p.inertia[1][0] = c * s * (x - y) * unit;
    p.inertia[2][2] = straight.inertia[2][2] * unit;
    ms_clump clump = {0}, along = balls_in_spheroid(2, 0.8, 12);
    for (size_t b = 0; b < along.n_spheres; b++) {
        const ms_sphere *ball = &along.sphere[b];
        for (int side = -1; side <= 1; side += 2) {
            const double q = ball->centre[0], off = 0.1 * side * ball->radius;
            add_sphere(&clump, 5 + c * q - s * off, -7 + s * q + c * off, 3, ball->radius);
        }
    }
    const ms_density_report r = solve_with(&clump, &p, &(ms_carriers_options){.depth = 0.05});
    assert_true(r.epsilon == 0 && r.products == 0 && r.centre == 0);
    assert_in_range(clump.n_carriers, 1, 8);
    expect_close(r.error_product[0], 0, 1e-9);
    expect_close(r.error_product[2], 0, 1e-9);
    for (size_t k = clump.n_spheres; k < clump.n_spheres + clump.n_carriers; k++) {
        double deepest = 0;
        for (size_t b = 0; b < clump.n_spheres; b++) {
            const ms_sphere *host = &clump.sphere[b], *carrier = &clump.sphere[k];
            deepest = fmax(deepest,
                           host->radius - carrier->radius - sqrt(ms_squared_distance(host->centre, carrier->centre)));
        }
        assert_true(deepest >= 0.05 * (1 - 1e-9));
    }
    ms_clump_free(&along);
    ms_clump_free(&clump);
}

static void two_are_the_fewest(void **state)
{
    /* Five balls in the plane z = 0, and more mass across it than they can have: one carrier alone would take the
     * centre out of the plane. */
    ms_clump clump = {0};
    (void)state;
    for (int b = 0; b < 5; b++) {
        add_sphere(&clump, 2 * (b == 1) - 2 * (b == 2), 1.7 * (b == 3) - 1.7 * (b == 4), 0, b ? 0.5 : 1);
    }
    ms_particle p = particle_of(&clump, (double[]){6, 1, 1, 1, 1});
    p.density = 1;
    for (int k = 0; k < 2; k++) {
        p.inertia[k][k] += 2 * 1.5 * 0.7 * 0.7;
    }
    const ms_density_report alone = solve(&clump, &p, &DEFAULTS);
    assert_true(alone.epsilon > 0.01);
    solve_with(&clump, &p, &PLAIN);
    assert_int_equal(clump.n_carriers, 2);
    expect_all_ten(&clump, &p);
    ms_clump_free(&clump);
}

static void none_where_masses_do(void **state)
{
    ms_clump clump = {0}, plain = {0};
    (void)state;
    for (int c = 0; c < 8; c++) {
        add_sphere(&clump, c & 1, c >> 1 & 1, c >> 2, 0.3);
        add_sphere(&plain, c & 1, c >> 1 & 1, c >> 2, 0.3);
    }
    ms_particle p = particle_of(&plain, (double[]){1, 2, 1, 2, 1, 2, 1, 2});
    p.density = 1;
    assert_int_equal(ms_clump_add_carrier(&clump, &(ms_sphere){{0}, 0.1}, NULL), MS_OK); /* an old one is dropped */
    solve_with(&clump, &p, &PLAIN);
    solve(&plain, &p, &DEFAULTS);
    assert_int_equal(clump.n_carriers, 0);
    assert_memory_equal(clump.mass, plain.mass, 8 * sizeof *plain.mass);
    ms_clump_free(&clump);
    ms_clump_free(&plain);
}

static void expect_failure(ms_clump *clump, const ms_particle *p, const ms_carriers_options *options, ms_status status,
                           const char *says)
{
    ms_density_report report;
    ms_error err = {{0}};
    assert_int_equal(ms_carriers_solve(clump, &report, p, options, &err), status);
    if (!strstr(err.text, says)) {
        fail_msg("'%s' does not say '%s'", err.text, says);
    }
    assert_null(clump->mass);
    assert_int_equal(clump->n_carriers, 0);
    assert_true(report.most_mass == 0);
}

/* Five balls in a plane that have a particle's mass all but for two points above and below, of less than the least. */
static void a_least_mass_too_large(void **state)
{
    ms_clump clump = {0};
    (void)state;
    for (int b = 0; b < 5; b++) {
        add_sphere(&clump, 2 * (b == 1) - 2 * (b == 2), 1.7 * (b == 3) - 1.7 * (b == 4), 0, 0.5);
    }
    ms_particle p = particle_of(&clump, (double[]){1, 1, 1, 1, 1});
    p.density = 1;
    p.mass += 0.3;
    for (int k = 0; k < 2; k++) {
        p.inertia[k][k] += 0.3 * 0.4 * 0.4;
    }
    expect_failure(&clump, &p, &(ms_carriers_options){.masses = {.least = 0.18}}, MS_ERR_LIMIT,
                   "the least mass, 0.18 of the particle's, though lighter ones");
    solve_with(&clump, &p, &PLAIN);
    expect_all_ten(&clump, &p);
    ms_clump_free(&clump);
}

static void too_many_to_look_in(void **state)
{
    (void)state;
    const ms_particle p = ellipsoid(2, 1, 1);
    ms_clump clump = {0};
    for (int s = 0; s < 62000; s++) {
        add_sphere(&clump, 0, 0, 0, 1);
    }
    expect_failure(&clump, &p, &PLAIN, MS_ERR_LIMIT, "looked for in up to 61484 spheres, and here are 62000");
    ms_clump_free(&clump);
}

static void failures(void **state)
{
    (void)state;
    ms_particle p = ellipsoid(2, 1, 1);
    ms_clump clump = balls_in_spheroid(2, 1, 11);
    expect_failure(&clump, &p, &(ms_carriers_options){.depth = 0.8}, MS_ERR_LIMIT,
                   "the wall around sphere 6 at (0, 0, 0), of radius 1");
    expect_failure(&clump, &p, &(ms_carriers_options){.depth = -1}, MS_ERR_ARG, "depth of carriers, -1");
    expect_failure(&clump, &p, &(ms_carriers_options){.depth = (double)NAN}, MS_ERR_ARG, "depth of carriers");
    expect_failure(&clump, &p, &(ms_carriers_options){.masses = {.least = 0.2}}, MS_ERR_ARG, "eq. 5");
    p.density = 0;
    expect_failure(&clump, &p, &PLAIN, MS_ERR_ARG, "a volume that is not known");
    p.density = 1;
    p.centre[2] = 1.5;
    expect_failure(&clump, &p, &PLAIN, MS_ERR_LIMIT, "outside the hull");
    ms_clump_free(&clump);
    /* A ball an eighth as wide as the particle cannot stand for it. */
    p.centre[2] = 0;
    add_sphere(&clump, 0, 0, 0, 0.125);
    expect_failure(&clump, &p, &PLAIN, MS_ERR_LIMIT, "at any depth");
    ms_clump_free(&clump);
    expect_failure(&clump, &p, &PLAIN, MS_ERR_ARG, "without spheres");
}

static void carriers_are_no_spheres(void **state)
{
    ms_clump clump = {0};
    double lo[3], hi[3];
    size_t pieces;
    (void)state;
    add_sphere(&clump, 0, 0, 0, 1);
    add_sphere(&clump, 4, 0, 0, 1);
    assert_int_equal(ms_clump_add_carrier(&clump, &(ms_sphere){{2, 9, 0}, 0.01}, NULL), MS_OK);
    assert_int_equal(ms_clump_count_masses(&clump), 3);
    assert_true(ms_clump_smallest_radius(&clump) == 1);
    ms_clump_box(lo, hi, &clump);
    assert_true(hi[1] == 1 && hi[0] == 5);
    assert_int_equal(ms_clump_pieces(&pieces, &clump, NULL), MS_OK);
    assert_int_equal(pieces, 2);
    add_sphere(&clump, 8, 0, 0, 1);
    assert_int_equal(clump.n_spheres, 3);
    assert_int_equal(clump.n_carriers, 0);
    assert_true(clump.sphere[2].centre[0] == 8);
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spheroid_by_balls_on_its_axis),
        cmocka_unit_test(turned_moved_and_in_millimetres),
        cmocka_unit_test(two_are_the_fewest),
        cmocka_unit_test(none_where_masses_do),
        cmocka_unit_test(a_least_mass_too_large),
        cmocka_unit_test(too_many_to_look_in),
        cmocka_unit_test(failures),
        cmocka_unit_test(carriers_are_no_spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
