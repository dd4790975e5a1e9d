/* Contacts: against counts by stepping, spheres whose contacts are known, and a damped oscillator in time. */
#include "contact/ms_touch.h"

#include "base/ms_vector.h"
#include "support/test_support.h"

enum { MOST = 64 };

/* `count` spheres of one radius in a row or a square, at a distance. */
static void make_flat(ms_sphere *sphere, int rows, int columns, double distance, double radius)
{
    for (int i = 0; i < rows * columns; i++) {
        sphere[i] = (ms_sphere){
            {distance * (i % columns - (columns - 1) / 2.0), distance * (i / columns - (rows - 1) / 2.0), 0}, radius};
    }
}

static double draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static void make_heap(ms_sphere *sphere, size_t count, uint32_t seed)
{
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            sphere[i].centre[k] = 2 * draw(&seed) - 1;
        }
        sphere[i].radius = 0.2 + 0.5 * draw(&seed);
    }
}

static void make_place(ms_touch_place *place, uint32_t seed)
{
    double length = 0, way = 0;
    for (int k = 0; k < 4; k++) {
        place->turn[k] = 2 * draw(&seed) - 1;
        length += place->turn[k] * place->turn[k];
    }
    for (int k = 0; k < 4; k++) {
        place->turn[k] /= sqrt(length);
    }
    for (int k = 0; k < 3; k++) {
        place->u[k] = 2 * draw(&seed) - 1;
        place->aside[k] = 0.4 * draw(&seed);
        way += place->u[k] * place->u[k];
    }
    for (int k = 0; k < 3; k++) {
        place->u[k] /= sqrt(way);
    }
}

/* N equal spheres: N times as stiff as one, of root(R / r_eq); damping ratio root(N). */
static void test_flat_on_plane(void **state)
{
    (void)state;
    ms_sphere sphere[MOST];
    const double down[3] = {0, 0, -1};
    for (int side = 1; side <= 5; side++) {
        const ms_support body = {(size_t)(side * side), sphere};
        make_flat(sphere, side, side, 0.31, 0.45);
        const ms_touch touch = ms_touch_plane(&body, down, 1.8, 0.01);
        assert_int_equal(touch.count, side * side);
        assert_close(touch.stiffness, side * side * 0.5, 1e-10);
        assert_close(touch.damping, side * side * sqrt(0.5), 1e-10);
        assert_close(ms_touch_number(&touch), side * side, 1e-9);
    }
}

/* A sphere that lies higher touches with what is left of the overlap, or not. */
static void test_steps_on_plane(void **state)
{
    (void)state;
    ms_sphere sphere[] = {{{0, 0, 0}, 0.5}, {{1, 0, 0.006}, 0.5}, {{2, 0, 0.011}, 0.5}};
    const ms_support body = {3, sphere};
    const double down[3] = {0, 0, -1};
    const ms_touch touch = ms_touch_plane(&body, down, 0.5, 0.01);
    assert_int_equal(touch.count, 2);
    assert_close(touch.stiffness, 1 + sqrt(0.4), 1e-10);
    assert_close(touch.damping, 1 + pow(0.4, 0.25), 1e-10);
    assert_int_equal(ms_touch_plane(&body, down, 0.5, 0.0115).count, 3);
}

/* Two balls of r_eq are the one contact itself, from any side. */
static void test_two_balls(void **state)
{
    (void)state;
    ms_sphere ball = {{0}, 0.7}, turned;
    const ms_support body = {1, &ball};
    ms_touch_pair pair;
    ms_touch_place place;
    for (uint32_t seed = 1; seed < 20; seed++) {
        make_place(&place, seed);
        memset(place.aside, 0, sizeof place.aside);
        const ms_touch touch = ms_touch_second(&pair, 1, &turned, &body, &place, 0.7, 0.003);
        assert_int_equal(touch.count, 1);
        assert_close(touch.stiffness, 1, 1e-9);
        assert_close(touch.damping, 1, 1e-9);
        assert_close(pair.overlap, 0.003, 1e-12);
        assert_close(pair.radius, 0.35, 1e-15);
        assert_close(ms_dot(pair.normal, place.u), 1, 1e-12);
    }
}

/* The largest overlap at a distance along u, and how many pairs have any. Turned by a matrix of its own. */
static double find_overlap(size_t *count, const ms_support *body, const ms_touch_place *place, double distance)
{
    const double *q = place->turn, w = q[0], x = q[1], y = q[2], z = q[3];
    const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    double largest = -(double)INFINITY;
    *count = 0;
    for (size_t j = 0; j < body->count; j++) {
        double at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = ms_dot(turn[k], body->sphere[j].centre) + place->aside[k] + distance * place->u[k];
        }
        for (size_t i = 0; i < body->count; i++) {
            const double overlap =
                body->sphere[i].radius + body->sphere[j].radius - sqrt(ms_squared_distance(at, body->sphere[i].centre));
            *count += overlap > 0;
            largest = fmax(largest, overlap);
        }
    }
    return largest;
}

/* The second body moved in by small steps from afar, then by halves. */
static size_t step_in(const ms_support *body, const ms_touch_place *place, double overlap)
{
    size_t count;
    double far = 8;
    while (far > -8 && find_overlap(&count, body, place, far - 1e-3) < overlap) {
        far -= 1e-3;
    }
    double near = far - 1e-3;
    if (far <= -8) {
        return 0;
    }
    for (int i = 0; i < 60; i++) {
        const double middle = (far + near) / 2;
        *(find_overlap(&count, body, place, middle) < overlap ? &far : &near) = middle;
    }
    find_overlap(&count, body, place, near);
    return count;
}

static void test_second_by_steps(void **state)
{
    (void)state;
    ms_sphere sphere[12], turned[12];
    const ms_support body = {12, sphere};
    size_t several = 0;
    for (uint32_t seed = 1; seed <= 40; seed++) {
        ms_touch_place place;
        ms_touch_pair pair[144];
        make_heap(sphere, 12, seed);
        make_place(&place, 1000 + seed);
        const ms_touch touch = ms_touch_second(pair, 144, turned, &body, &place, 1, 0.05);
        assert_int_equal(touch.count, step_in(&body, &place, 0.05));
        assert_true(touch.count > 0);
        several += touch.count > 1;
        double largest = 0, stiffness = 0;
        for (size_t p = 0; p < touch.count; p++) {
            largest = fmax(largest, pair[p].overlap);
            stiffness += sqrt(pair[p].radius * pair[p].overlap);
        }
        assert_close(largest, 0.05, 1e-12);
        assert_close(touch.stiffness, stiffness / sqrt(0.5 * 0.05), 1e-9);
    }
    assert_in_range(several, 5, 40); /* the case that matters */
}

/* A second body that is led past the first. */
static void test_missed(void **state)
{
    (void)state;
    ms_sphere ball = {{0}, 0.7}, turned;
    const ms_support body = {1, &ball};
    const ms_touch_place place = {{1, 0, 0, 0}, {0, 0, 1}, {1.41, 0, 0}};
    assert_int_equal(ms_touch_second(NULL, 0, &turned, &body, &place, 0.7, 0.003).count, 0);
}

/* Speed behind / before of a mass on n springs with a dashpot each, of the first time it is back at 0. */
static double bounce(double single, int n)
{
    const double k = 3.7e4, mass = 0.021, l = -log(single), b = l / sqrt(3.14159265358979 * 3.14159265358979 + l * l);
    const double c = 2 * b * sqrt(k * mass), step = 1e-4 / sqrt(n * k / mass);
    double x = 0, v = 1.3;
    for (int i = 0; i < 400000; i++) {
        double dx[4], dv[4];
        const double part[4] = {0, 0.5, 0.5, 1};
        for (int s = 0; s < 4; s++) {
            const double xs = x + (s ? part[s] * step * dx[s - 1] : 0), vs = v + (s ? part[s] * step * dv[s - 1] : 0);
            double force = 0;
            for (int contact = 0; contact < n; contact++) {
                force += k * xs + c * vs;
            }
            dx[s] = vs;
            dv[s] = -force / mass;
        }
        x += step / 6 * (dx[0] + 2 * dx[1] + 2 * dx[2] + dx[3]);
        v += step / 6 * (dv[0] + 2 * dv[1] + 2 * dv[2] + dv[3]);
        if (x <= 0) {
            return -v / 1.3;
        }
    }
    return 0; /* it creeps back */
}

static void test_restitution_against_oscillator(void **state)
{
    (void)state;
    for (int n = 1; n <= 9; n += 2) {
        assert_close(ms_touch_restitution(0.5, n), bounce(0.5, n), 1e-4);
        assert_close(ms_touch_restitution(0.83, n), bounce(0.83, n), 1e-4);
    }
    assert_close(ms_touch_restitution(0.62, 1), 0.62, 1e-14);
    assert_close(ms_touch_restitution(1, 50), 1, 0);
}

/* Flat impacts in LIGGGHTS 3.8.0 with e = 0.5. */
static void test_restitution_as_measured(void **state)
{
    (void)state;
    const double measured[][2] = {{4, 0.222}, {9, 0.068}, {16, 0.004}};
    for (int i = 0; i < 3; i++) {
        assert_close(ms_touch_restitution(0.5, measured[i][0]), measured[i][1], 0.0025);
    }
}

/* b(0.5)^2 = 1 / 21.54: 21 contacts hardly rebound, 22 creep. */
static void test_overdamped(void **state)
{
    (void)state;
    assert_true(ms_touch_restitution(0.5, 21) > 0 && ms_touch_restitution(0.5, 21) < 1e-6);
    assert_close(ms_touch_restitution(0.5, 22), 0, 0);
    assert_close(bounce(0.5, 22), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat_on_plane),
        cmocka_unit_test(test_steps_on_plane),
        cmocka_unit_test(test_two_balls),
        cmocka_unit_test(test_second_by_steps),
        cmocka_unit_test(test_missed),
        cmocka_unit_test(test_restitution_against_oscillator),
        cmocka_unit_test(test_restitution_as_measured),
        cmocka_unit_test(test_overdamped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
