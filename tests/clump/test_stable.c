/* The step that a body bears: an integrator at both sides of it, levers against brute force. */
#include "clump/formats/ms_stable.h"

#include "base/ms_vector.h"
#include "support/clump_samples.h"

static const ms_stable_law LAW = {.young = 7e9, .poisson = 0.3, .overlap = 2e-6};
enum { STEPS = 3000 };

static double stiffness_of(double radius)
{
    return LAW.young / (1 - LAW.poisson * LAW.poisson) * sqrt(radius * LAW.overlap) / sqrt(2); /* of two such spheres */
}

/* Greatest swing of a mass on a spring, damped by the velocity of half a step before; it begins with 1. */
static double swing(double square, double rate, double step)
{
    double x = 1, v = 0, most = 0;
    for (int n = 0; n < STEPS; n++) {
        v += step * (-square * x - rate * v);
        x += step * v;
        most = fmax(most, fabs(x));
    }
    return most;
}

/* Two balls, each a clump of `count` spheres in one place. Pushed along the plane, their surfaces move by 1 + 1/0.4 of
 * what their centres do. */
static void check_balls(size_t count)
{
    enum { MOST = 20 };
    const double m = 1.3e-3, r = 5e-3, i = 0.4 * m * r * r;
    ms_sphere sphere[MOST];
    const ms_clump clump = {.sphere = sphere, .n_spheres = count};
    const ms_particle particle = {.mass = m, .inertia = {{i, 0, 0}, {0, i, 0}, {0, 0, i}}};
    for (size_t s = 0; s < count; s++) {
        sphere[s] = (ms_sphere){.centre = {0, 0, 0}, .radius = 5};
    }
    double one, all;
    ms_stable_step(&one, &all, &clump, 1e-3, &particle, &LAW);
    const double n = (double)count, k = stiffness_of(r), yield = 3.5 * 2 / m;
    /* each by 2 root(5/6) b root(S m'), m' = m/2 */
    const double damping = 2 * sqrt(5.0 / 6) * 0.2553 * sqrt(k * m / 2);
    assert_true(swing(n * k * yield, n * damping * yield, 0.998 * all) < 10);
    assert_true(swing(n * k * yield, n * damping * yield, 1.002 * all) > 100);
    assert_true(swing(k * yield, damping * yield, 0.998 * one) < 10);
    assert_true(swing(k * yield, damping * yield, 1.002 * one) > 100);
}

static void the_step_is_the_last_that_does_not_grow(void **state)
{
    (void)state;
    check_balls(1);
    check_balls(4);
    check_balls(20);
}

/* Largest of d (1/m + C^T J C) d over directions. */
static double brute_yield(const double p[3], const ms_particle *particle)
{
    enum { FINE = 400 };
    double most = 0;
    for (int a = 0; a < FINE; a++) {
        for (int b = 0; b < 2 * FINE; b++) {
            const double t = pi * a / FINE, f = pi * b / FINE;
            const double d[3] = {sin(t) * cos(f), sin(t) * sin(f), cos(t)};
            double across[3], sum = 1 / particle->mass;
            ms_cross(across, p, d);
            for (int k = 0; k < 3; k++) {
                sum += across[k] * across[k] / particle->inertia[k][k];
            }
            most = fmax(most, sum);
        }
    }
    return most;
}

static void levers_are_those_of_the_farthest_points(void **state)
{
    static ms_sphere SPHERE[] = {{.centre = {1, -2, 3}, .radius = 0.7}, {.centre = {-3.1, 0.2, 0}, .radius = 1.1}};
    const ms_particle particle = {.mass = 2.385, .inertia = {{0.8, 0, 0}, {0, 3.1, 0}, {0, 0, 3.6}}};
    (void)state;
    for (int s = 0; s < 2; s++) {
        const ms_clump clump = {.sphere = &SPHERE[s], .n_spheres = 1};
        const double *c = SPHERE[s].centre, stretch = 1 + SPHERE[s].radius / sqrt(ms_dot(c, c));
        const double p[3] = {c[0] * stretch, c[1] * stretch, c[2] * stretch};
        double one, all;
        ms_stable_step(&one, &all, &clump, 1, &particle, &LAW);
        const double yield = brute_yield(p, &particle), z = sqrt(5.0 / 6 * particle.mass * yield) * 0.2553;
        expect_close(one * sqrt(2 * yield * stiffness_of(SPHERE[s].radius)) / 2, sqrt(1 + z * z) - z, 1e-4);
        expect_close(all / one, 1, 1e-14);
    }
}

/* A sphere on the axis of a slim body, which a push at its side twists. Truth: the worst of all points of the sphere,
 * by their angle to the axis. */
static void a_slim_body_is_twisted(void **state)
{
    enum { FINE = 10000 };
    static ms_sphere SPHERE = {.centre = {1, 0, 0}, .radius = 0.5};
    const double along = 0.02, across = 0.4, farthest = 1 + 1.5 * 1.5 / across;
    const ms_particle particle = {.mass = 1, .inertia = {{along, 0, 0}, {0, across, 0}, {0, 0, across}}};
    const ms_clump clump = {.sphere = &SPHERE, .n_spheres = 1};
    double one, all, truth = 0;
    (void)state;
    for (int a = 0; a <= FINE; a++) {
        const double x = 1 + 0.5 * cos(pi * a / FINE), y = 0.5 * sin(pi * a / FINE);
        truth = fmax(truth, 1 + fmax(y * y / along + x * x / across, (x * x + y * y) / across));
    }
    assert_true(truth > 2 * farthest);
    ms_stable_step(&one, &all, &clump, 1, &particle, &LAW);
    const double z = sqrt(5.0 / 6 * truth) * 0.2553;
    expect_close(one * sqrt(2 * truth * stiffness_of(0.5)) / 2, sqrt(1 + z * z) - z, 0.01);
}

/* With the mass the step goes as its root, however small it is. */
static void a_mote_has_its_step(void **state)
{
    static ms_sphere SPHERE = {.centre = {1, 2, -1}, .radius = 0.5};
    const ms_clump clump = {.sphere = &SPHERE, .n_spheres = 1};
    double one, all, mote, ignored;
    ms_particle particle = {.mass = 1, .inertia = {{0.3, 0, 0}, {0, 0.4, 0}, {0, 0, 0.5}}};
    (void)state;
    ms_stable_step(&one, &all, &clump, 1, &particle, &LAW);
    particle.mass = 1e-200;
    for (int k = 0; k < 3; k++) {
        particle.inertia[k][k] *= 1e-200;
    }
    ms_stable_step(&mote, &ignored, &clump, 1, &particle, &LAW);
    expect_close(mote / one / 1e-100, 1, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_step_is_the_last_that_does_not_grow),
        cmocka_unit_test(levers_are_those_of_the_farthest_points),
        cmocka_unit_test(a_slim_body_is_twisted),
        cmocka_unit_test(a_mote_has_its_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
