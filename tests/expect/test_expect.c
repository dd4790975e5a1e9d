/* What is expected, against the laws that tubes, spheroids, walls and the ball have in closed form. */
#include "support/test_support.h"

#include <omp.h>

#include "expect/ms_expect.h"
#include "mesh/ms_inertia.h"

static const double PI = 3.14159265358979323846;
/* What a hexagonal cap errs by, for each unit of its area and of the root of K1 K2, as mskit's derivation has it. */
static double hexagon(void)
{
    return (5 / (18 * sqrt(3)) - 1 / (4 * PI)) / 2;
}

static void expect_shape(ms_expect *expect, const char *kind, const char *parameters)
{
    ms_mesh mesh;
    ms_error err;
    make_shape(&mesh, kind, parameters);
    if (ms_expect_mesh(expect, &mesh, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    ms_mesh_free(&mesh);
}

static void assert_ratio(const ms_expect *expect, double n, double law, double tolerance)
{
    const double ratio = ms_expect_dice(expect, MS_EXPECT_FREE, n) / law;
    if (!(fabs(ratio - 1) <= tolerance)) {
        fail_msg("%g spheres: %.3f of the law", n, ratio);
    }
}

static void tubes_follow_the_law_of_a_curve(void **state)
{
    (void)state;
    ms_expect expect;
    expect_shape(&expect, "torus", "R=3 r=1");
    for (double n = 10; n <= 60; n += 10) {
        assert_ratio(&expect, n, 11.72 / (n * n), 0.05);
    }
    expect_shape(&expect, "ellipsoid", "a=2 b=1 c=1 fineness=150");
    for (double n = 10; n <= 60; n += 10) {
        assert_ratio(&expect, n, 0.5625 / (n * n), 0.05);
    }
    /* balls along an axis of length L in a tube of radius r, L/n apart: D = (L / (n r))^2 / 32; the ends, which take
     * half a gap each, are a part of it */
    expect_shape(&expect, "needle", "length=41 r=0.5");
    for (double n = 50; n <= 90; n += 20) {
        assert_ratio(&expect, n, pow(41 / (0.5 * n), 2) / 32, 0.08);
    }
}

/* Integral of (K1 K2)^(1/4) over the spheroid a, a, c, flat along c: the ball that touches at (a sin t, c cos t) has
 * its centre on the disc, radius rho = c q / a with q^2 = c^2 sin^2 t + a^2 cos^2 t along the normal. */
static double oblate_integral(double a, double c)
{
    enum { STEPS = 4000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double t = (i + 0.5) * PI / STEPS, s = sin(t), o = cos(t);
        const double q = sqrt(c * c * s * s + a * a * o * o); /* speed along the meridian is sqrt(a^2 o^2 + c^2 s^2) */
        const double meridian = a * c / (q * q * q), around = c / (a * q);
        const double rho = c * q / a;
        const double k1 = 1 / rho - meridian, k2 = 1 / rho - around;
        sum += pow(fmax(0, k1) * fmax(0, k2), 0.25) * 2 * PI * a * s * q * PI / STEPS;
    }
    return sum;
}

static void sheets_follow_the_law_of_a_sheet(void **state)
{
    (void)state;
    ms_expect expect;
    const double volume = 4 * PI / 3 * 2 * 2 * 1, integral = oblate_integral(2, 1);
    const double law = hexagon() * integral * integral / (4 * volume);
    expect_shape(&expect, "ellipsoid", "a=2 b=2 c=1 fineness=100");
    /* the best clumps known of 60, 100 and 200 spheres have 1.083, 1.082 and 1.067 times the law (docs/expected.md):
     * of few spheres the estimate is more above them than of many */
    assert_ratio(&expect, 60, 1.083 * law / 60, 0.09);
    assert_ratio(&expect, 100, 1.082 * law / 100, 0.06);
    assert_ratio(&expect, 200, 1.067 * law / 200, 0.06);
    assert_ratio(&expect, 1000, law / 1000, 0.10);
}

static void a_thin_wall_takes_spheres_by_its_area(void **state)
{
    (void)state;
    ms_expect expect;
    const double area = 5 * 5, thickness = 0.2, law = 2 * hexagon() * area / (thickness * thickness);
    expect_shape(&expect, "plate", "a=5 b=5 c=0.2");
    assert_ratio(&expect, 300, law / 300, 0.15);
    assert_ratio(&expect, 600, law / 600, 0.15);
    const double least = ms_expect_least_spheres(&expect, MS_EXPECT_FREE);
    assert_true(least > 50 && least < 300);
    assert_true(ms_expect_dice(&expect, MS_EXPECT_FREE, 10) > 0.8); /* spheres far apart: next to nothing is held */
}

static void a_ball_takes_one(void **state)
{
    (void)state;
    ms_expect expect;
    expect_shape(&expect, "ball", "r=2.385 fineness=100"); /* facets make centres of balls err */
    assert_true(ms_expect_dice(&expect, MS_EXPECT_FREE, 1) < 5e-3);
    assert_close(ms_expect_spheres(&expect, MS_EXPECT_FREE, 0.01), 1, 0.05);
    assert_close(ms_expect_least_spheres(&expect, MS_EXPECT_FREE), 1, 0.1);
}

/* Twice as much on a sheet and 4/3 on a curve: without a shift the mean of a square over a disc is 1/2 of the largest
 * and not 1/4, over a line 1/3. */
static void inscribed_clumps_err_more(void **state)
{
    (void)state;
    ms_expect expect;
    expect_shape(&expect, "torus", "");
    assert_close(ms_expect_dice(&expect, MS_EXPECT_INSCRIBED, 30) / ms_expect_dice(&expect, MS_EXPECT_FREE, 30),
                 4.0 / 3, 0.08);
    expect_shape(&expect, "ellipsoid", "a=2 b=2 c=1");
    assert_close(ms_expect_dice(&expect, MS_EXPECT_INSCRIBED, 100) / ms_expect_dice(&expect, MS_EXPECT_FREE, 100), 2,
                 0.12);
}

static void numbers_and_mismatches_are_inverse(void **state)
{
    (void)state;
    ms_expect expect;
    expect_shape(&expect, "grain", "fineness=24");
    for (double n = 3; n < 2000; n *= 1.7) {
        const double dice = ms_expect_dice(&expect, MS_EXPECT_FREE, n);
        assert_close(ms_expect_spheres(&expect, MS_EXPECT_FREE, dice) / n, 1, 1e-6);
        assert_true(ms_expect_dice(&expect, MS_EXPECT_FREE, 1.1 * n) < dice);
        assert_true(ms_expect_dice(&expect, MS_EXPECT_INSCRIBED, n) > dice);
    }
    assert_true(isinf(ms_expect_spheres(&expect, MS_EXPECT_FREE, 1e-300)));
    assert_close(ms_expect_spheres(&expect, MS_EXPECT_FREE, 1), 1, 0);
}

/* The one number that a run asks for, at a part of the cost, against all of them. */
static void one_number_is_that_of_the_whole(void **state)
{
    static const struct {
        const char *kind, *parameters;
        double tolerance; /* a wall begins to be worth while at one price: D by n is a chord there */
    } SHAPE[] = {{"grain", "seed=3 fineness=24", 0.02},
                 {"torus", "", 0.02},
                 {"ellipsoid", "a=3 b=2 c=1.5", 0.02},
                 {"plate", "a=5 b=5 c=0.2", 0.05}};
    static const double NUMBERS[] = {1, 7, 12, 20, 50, 100, 150, 400};
    (void)state;
    for (size_t s = 0; s < sizeof SHAPE / sizeof *SHAPE; s++) {
        ms_expect whole, near;
        ms_mesh mesh;
        ms_target target;
        ms_error err;
        make_shape(&mesh, SHAPE[s].kind, SHAPE[s].parameters);
        make_target(&target, &mesh, 10, MS_VOXEL_HALF);
        assert_int_equal(ms_expect_mesh(&whole, &mesh, &err), MS_OK);
        for (size_t i = 0; i < sizeof NUMBERS / sizeof *NUMBERS; i++) {
            const double n = NUMBERS[i], tolerance = n > 170 ? 2 * SHAPE[s].tolerance : SHAPE[s].tolerance;
            assert_int_equal(ms_expect_near(&near, &target, n, &err), MS_OK);
            const double ratio = ms_expect_dice(&near, MS_EXPECT_FREE, n) / ms_expect_dice(&whole, MS_EXPECT_FREE, n);
            if (!(fabs(ratio - 1) <= tolerance)) {
                fail_msg("%s, %g spheres: %.3f of the whole", SHAPE[s].kind, n, ratio);
            }
            assert_int_equal(near.curve[MS_EXPECT_INSCRIBED].count, 0);
        }
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

static void turn_and_scale(ms_mesh *mesh, double angle, double scale, double shift)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double *p = mesh->vertex[v];
        for (int a = 0; a < 2; a++) { /* about z, then about x */
            const double x = p[a], y = p[a + 1];
            p[a] = cos(angle) * x - sin(angle) * y;
            p[a + 1] = sin(angle) * x + cos(angle) * y;
        }
        for (int a = 0; a < 3; a++) {
            p[a] = scale * p[a] + shift;
        }
    }
}

static void size_place_and_direction_do_not_matter(void **state)
{
    static const struct {
        double angle, scale, shift, tolerance;
    } way[] = {{0, 1024, 0, 0}, {0, 0.001, 0, 1e-6}, {0, 1, 1e5, 1e-3}, {0.7, 1, 0, 0.05}, {2.1, 3.7, 11, 0.05}};
    (void)state;
    ms_expect expect, other;
    expect_shape(&expect, "grain", "seed=3 fineness=24");
    for (size_t w = 0; w < sizeof way / sizeof *way; w++) {
        ms_mesh mesh;
        make_shape(&mesh, "grain", "seed=3 fineness=24");
        turn_and_scale(&mesh, way[w].angle, way[w].scale, way[w].shift);
        assert_int_equal(ms_expect_mesh(&other, &mesh, NULL), MS_OK);
        for (double n = 5; n < 200; n *= 2) {
            assert_close(ms_expect_dice(&other, MS_EXPECT_FREE, n) / ms_expect_dice(&expect, MS_EXPECT_FREE, n), 1,
                         way[w].tolerance);
        }
        ms_mesh_free(&mesh);
    }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    ms_expect one, three;
    memset(&one, 0, sizeof one);
    memset(&three, 0, sizeof three);
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    expect_shape(&one, "plate", "c=0.2");
    omp_set_num_threads(3);
    expect_shape(&three, "plate", "c=0.2");
    omp_set_num_threads(before);
    assert_memory_equal(&one, &three, sizeof one);
}

static void voxels_are_taken_by_their_surface(void **state)
{
    (void)state;
    ms_expect of_mesh, of_grid, near;
    ms_mesh mesh;
    ms_target target;
    ms_error err;
    make_shape(&mesh, "ellipsoid", "a=3 b=2 c=1.5");
    make_target(&target, &mesh, 60, MS_VOXEL_HALF);
    assert_int_equal(ms_expect_mesh(&of_mesh, &mesh, &err), MS_OK);
    assert_int_equal(ms_expect_grid(&of_grid, &target.grid, &err), MS_OK);
    target.mesh = NULL; /* as of a volume */
    assert_int_equal(ms_expect_near(&near, &target, 20, &err), MS_OK);
    assert_close(ms_expect_dice(&near, MS_EXPECT_FREE, 20) / ms_expect_dice(&of_grid, MS_EXPECT_FREE, 20), 1, 0.02);
    for (double n = 5; n <= 20; n *= 2) { /* from there on the steps of the voxels are felt */
        assert_close(ms_expect_dice(&of_grid, MS_EXPECT_FREE, n) / ms_expect_dice(&of_mesh, MS_EXPECT_FREE, n), 1, 0.2);
    }
    memset(target.grid.inside, 0, ms_grid_voxels(&target.grid));
    assert_int_equal(ms_expect_grid(&of_grid, &target.grid, &err), MS_ERR_SHAPE);
    assert_non_null(strstr(err.text, "too few"));
    assert_int_equal(of_grid.curve[0].count, 0);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void what_has_no_volume_is_refused(void **state)
{
    (void)state;
    ms_expect expect;
    ms_mesh mesh;
    ms_error err;
    make_shape(&mesh, "cube", "");
    for (size_t t = 0; t < mesh.n_triangles; t++) {
        const uint32_t corner = mesh.triangle[t][0];
        mesh.triangle[t][0] = mesh.triangle[t][1];
        mesh.triangle[t][1] = corner;
    }
    assert_int_equal(ms_expect_mesh(&expect, &mesh, &err), MS_ERR_SHAPE);
    assert_int_equal(expect.curve[0].count, 0);
    ms_mesh_free(&mesh);
}

/* Slivers and triangles that fold back: no figure may be other than finite. */
static void ragged_meshes_give_finite_figures(void **state)
{
    (void)state;
    ms_expect expect;
    ms_mesh mesh;
    make_shape(&mesh, "cube", "");
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        for (int a = 0; a < 3; a++) {
            mesh.vertex[v][a] = round(mesh.vertex[v][a] * 5) / 5 + 1e-9 * (double)((v * 7 + (size_t)a * 3) % 11);
        }
    }
    assert_int_equal(ms_expect_mesh(&expect, &mesh, NULL), MS_OK);
    for (double n = 1; n < 2000; n *= 3) {
        const double dice = ms_expect_dice(&expect, MS_EXPECT_FREE, n);
        assert_true(isfinite(dice) && dice > 0 && dice < 1);
    }
    ms_mesh_free(&mesh);
}

static void numbers_are_told_to_three_digits(void **state)
{
    (void)state;
    const double told[][2] = {{1, 1}, {3.2, 4}, {99.5, 100}, {100, 100}, {456.001, 457}, {1234, 1240}, {98765, 98800}};
    for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
        assert_close(ms_expect_round(told[i][0]), told[i][1], 0);
    }
    assert_true(isinf(ms_expect_round(HUGE_VAL)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tubes_follow_the_law_of_a_curve),
        cmocka_unit_test(sheets_follow_the_law_of_a_sheet),
        cmocka_unit_test(a_thin_wall_takes_spheres_by_its_area),
        cmocka_unit_test(a_ball_takes_one),
        cmocka_unit_test(inscribed_clumps_err_more),
        cmocka_unit_test(numbers_and_mismatches_are_inverse),
        cmocka_unit_test(one_number_is_that_of_the_whole),
        cmocka_unit_test(size_place_and_direction_do_not_matter),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(voxels_are_taken_by_their_surface),
        cmocka_unit_test(what_has_no_volume_is_refused),
        cmocka_unit_test(ragged_meshes_give_finite_figures),
        cmocka_unit_test(numbers_are_told_to_three_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
