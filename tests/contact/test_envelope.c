/* Envelopes by rolling balls, against bodies of revolution in closed form. */
#include "contact/ms_envelope.h"
#include "support/clump_samples.h"
#include "support/test_support.h"

static ms_envelope find_envelope(const ms_envelope_body *body, double radius)
{
    ms_envelope out;
    ms_error err;
    if (ms_envelope_compute(&out, body, radius, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return out;
}

static ms_envelope envelope_of_clump(double *volume, const ms_clump *clump, double radius)
{
    ms_envelope out;
    assert_int_equal(ms_envelope_clump(&out, volume, clump, &radius, 1, NULL), MS_OK);
    return out;
}

/* Of a mesh; its volume, too. */
static ms_envelope envelope_of_mesh(double *volume, const ms_mesh *mesh, double radius)
{
    ms_body solid;
    ms_envelope out;
    assert_int_equal(ms_inertia_mesh(&solid, mesh, NULL), MS_OK);
    assert_int_equal(ms_envelope_mesh(&out, mesh, solid.volume, &radius, 1, NULL), MS_OK);
    *volume = solid.volume;
    return out;
}

/* By a ball of a fraction of a cell, too. */
static const double ROLLED[] = {0.01, 0.7};

static void one_ball_is_its_own(void **state)
{
    ms_clump clump = {0};
    double volume;
    (void)state;
    add_sphere(&clump, 5.3, 0.2, 0.1, 1.7);
    for (size_t r = 0; r < sizeof ROLLED / sizeof *ROLLED; r++) {
        const ms_envelope e = envelope_of_clump(&volume, &clump, ROLLED[r]);
        expect_close(e.volume, ball_volume(1.7), 1e-9);
        expect_close(e.error, 0, 1e-9);
    }
    ms_clump_free(&clump);
}

static void convex_bodies_are_their_own(void **state)
{
    ms_mesh cube;
    double volume;
    (void)state;
    make_shape(&cube, "cube", "fineness=1");
    for (size_t r = 0; r < sizeof ROLLED / sizeof *ROLLED; r++) {
        const ms_envelope e = envelope_of_mesh(&volume, &cube, ROLLED[r]);
        expect_close(e.volume, volume, 1e-9 * volume);
        expect_close(e.error, 0, 1e-9 * volume);
    }
    ms_mesh_free(&cube);
}

/* Between two balls of radius 1 that touch: the ball rolls about their axis with its centre on a ring of radius s, so
 * that the neck is s - root(R^2 - x^2) wide, up to x = R / (1 + R) where it touches. */
static double neck_of(double r)
{
    const double s = sqrt((1 + r) * (1 + r) - 1), x = r / (1 + r);
    const double ring = (s * s + r * r) * x - s * (x * sqrt(r * r - x * x) + r * r * asin(x / r)) - x * x * x / 3;
    return 2 * pi * (ring - (x * x - x * x * x / 3));
}

static void two_balls_that_touch(void **state)
{
    static const double RADIUS[] = {0.2, 3};
    ms_clump clump = {0};
    (void)state;
    add_sphere(&clump, 0.3, 0.2, 0.1, 1);
    add_sphere(&clump, 0.3 + 1.2, 0.2 + 1.28, 0.1 + 0.96, 1);
    assert_int_equal(ms_clump_add_carrier(&clump, &(ms_sphere){{0, 0, 2}, 1}, NULL), MS_OK); /* touches nothing */
    for (size_t r = 0; r < sizeof RADIUS / sizeof *RADIUS; r++) {
        double volume;
        const ms_envelope e = envelope_of_clump(&volume, &clump, RADIUS[r]);
        expect_close(volume, 2 * ball_volume(1), 1e-12);
        expect_close(e.volume - volume, neck_of(RADIUS[r]), 1e-3);
        assert_true(e.error > 0 && e.error < 2e-2);
    }
    ms_clump_free(&clump);
}

/* The ring of 3 and 1 about z, exactly, which a mesh is not. */
static double distance_to_ring(double nearest[3], const void *body, const double place[3])
{
    const double out = hypot(place[0], place[1]), away = hypot(out - 3, place[2]);
    const double at = 3 + (out - 3) / away;
    (void)body;
    nearest[0] = out > 0 ? at / out * place[0] : at;
    nearest[1] = out > 0 ? at / out * place[1] : 0;
    nearest[2] = place[2] / away;
    return away - 1;
}

/* A ball of 4 on a ring of 3 and 1 rests at 4 above its middle, and touches at 2.4 from the axis: above the hole there
 * is 4 - root(16 - p^2), less the ring from 2 to 2.4. Its centre is in a corner, that of a cone. */
static void the_hole_of_a_ring(void **state)
{
    const double above = 4 * 2.88 - (64 - 32.768) / 3;
    const double ring = 1.5 * (pi / 2 - 0.48 - asin(0.6)) - 0.512 / 3;
    const ms_envelope_body body = {.lo = {-4, -4, -1}, .hi = {4, 4, 1}, .distance = distance_to_ring};
    (void)state;
    const ms_envelope e = find_envelope(&body, 4);
    expect_close(e.volume, 4 * pi * (above - ring), 0.003 * 4 * pi * (above - ring));
}

/* A cube of 2 about a cube of 1, which is turned inside out. */
static void make_hollow_cube(ms_mesh *mesh)
{
    static double vertex[16][3];
    static uint32_t triangle[24][3];
    ms_mesh cube;
    make_shape(&cube, "cube", "fineness=1");
    assert_int_equal(cube.n_vertices, 8);
    assert_int_equal(cube.n_triangles, 12);
    for (int v = 0; v < 8; v++) {
        for (int k = 0; k < 3; k++) {
            vertex[v][k] = cube.vertex[v][k] > 0 ? 1 : -1;
            vertex[8 + v][k] = vertex[v][k] / 2;
        }
    }
    for (int t = 0; t < 12; t++) {
        for (int k = 0; k < 3; k++) {
            triangle[t][k] = cube.triangle[t][k];
            triangle[12 + t][k] = 8 + cube.triangle[t][2 - k];
        }
    }
    ms_mesh_free(&cube);
    *mesh = (ms_mesh){.n_vertices = 16, .n_triangles = 24, .vertex = vertex, .triangle = triangle};
}

/* A cavity of 1 holds the ball of 0.3, which leaves only a cube of 0.4 with that ball rolled about it; one of 0.6 is
 * filled. */
static void a_cavity(void **state)
{
    const double rolled = 0.4 * 0.4 * 0.4 + 6 * 0.4 * 0.4 * 0.3 + 3 * pi * 0.4 * 0.3 * 0.3 + ball_volume(0.3);
    ms_mesh mesh;
    double volume;
    (void)state;
    make_hollow_cube(&mesh);
    ms_envelope e = envelope_of_mesh(&volume, &mesh, 0.3);
    expect_close(e.volume, 8 - rolled, 0.002 * (1 - rolled));
    e = envelope_of_mesh(&volume, &mesh, 0.6);
    expect_close(e.volume, 8, 1e-9);
}

static void what_there_is_none_of(void **state)
{
    ms_envelope out;
    ms_error err = {{0}};
    const double radius = 1;
    double volume;
    (void)state;
    assert_int_equal(ms_envelope_clump(&out, &volume, &(const ms_clump){0}, &radius, 1, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "no spheres"));
    assert_int_equal(ms_envelope_mesh(&out, &(const ms_mesh){0}, 1, &radius, 1, &err), MS_ERR_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_ball_is_its_own),
        cmocka_unit_test(convex_bodies_are_their_own),
        cmocka_unit_test(two_balls_that_touch),
        cmocka_unit_test(the_hole_of_a_ring),
        cmocka_unit_test(a_cavity),
        cmocka_unit_test(what_there_is_none_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
