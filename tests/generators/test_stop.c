/* The stop rule, and the comparison of inertia that it rests on. */
#include "ms_stop.h"
#include "support/clump_samples.h"
#include "voxel/ms_cut_cells.h"
#include "voxel/ms_tally.h"

static void reasons_have_names(void **state)
{
    (void)state;
    static const char *const names[] = {"not",          "spheres", "eta",        "dice",      "coverage",   "inertia",
                                        "coverage_cut", "radius",  "off-volume", "exhausted", "interrupted"};
    for (int reason = 0; reason < 11; reason++) {
        assert_string_equal(ms_stop_name((ms_stop_reason)reason), names[reason]);
    }
    assert_int_equal(MS_STOP_INTERRUPTED, 10);
    assert_string_equal(ms_stop_name((ms_stop_reason)11), "unknown");
}

static void measures_are_set_by_name(void **state)
{
    (void)state;
    ms_stop stop = {0};
    assert_int_equal(ms_stop_set(&stop, "eta", 0.5, NULL), MS_OK);
    assert_int_equal(ms_stop_set(&stop, "dice", 1e-9, NULL), MS_OK);
    assert_int_equal(ms_stop_set(&stop, "coverage", 1, NULL), MS_OK);
    assert_int_equal(ms_stop_set(&stop, "inertia", 0.25, NULL), MS_OK);
    assert_int_equal(ms_stop_set(&stop, "radius", 2385, NULL), MS_OK);
    assert_true(stop.eta == 0.5 && stop.dice == 1e-9 && stop.coverage == 1 && stop.inertia == 0.25);
    assert_true(stop.radius == 2385 && stop.spheres == 0);
}

static void values_out_of_range_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"eta", "dice", "coverage", "inertia", "radius"};
    const double bad[] = {-1e-9, 1.0001, (double)NAN, HUGE_VAL, -HUGE_VAL, -5, 0}; /* 0: not asked for */
    for (int m = 0; m < 5; m++) {
        for (int b = 0; b < 7; b++) {
            ms_stop stop = {0};
            ms_error err = {{0}};
            if (m == 4 && b == 1) {
                continue; /* a radius may be large */
            }
            assert_int_equal(ms_stop_set(&stop, names[m], bad[b], &err), MS_ERR_ARG);
            expect_message(&err, names[m]);
            expect_message(&err, "out of range");
            assert_true(ms_stop_is_none(&stop));
        }
    }
    ms_stop stop = {0};
    static const char *const unknown[] = {"", "Eta", "et", "etaa", "spheres", "exhausted"};
    for (int u = 0; u < 6; u++) {
        ms_error err = {{0}};
        assert_int_equal(ms_stop_set(&stop, unknown[u], 0.5, &err), MS_ERR_ARG);
        expect_message(&err, "eta, dice, coverage, inertia, coverage_cut, radius");
    }
}

/* A cube of 10 voxels a side; a union of the lowest `slices` of it and as many voxels outside as asked. */
static ms_tally lower_part(int slices, int64_t outside)
{
    ms_tally sum = {0};
    for (int v = 0; v < 100 * slices; v++) {
        const int64_t i = 2 + v % 10, j = 2 + v / 10 % 10, k = 2 + v / 100;
        const ms_tally one = {1, 0, {i, j, k}, {i * i, j * j, k * k, j * k, i * k, i * j}, 0};
        ms_tally_add(&sum, &one);
    }
    sum.outside = outside;
    return sum;
}

static ms_stop_reason reached(const ms_target *target, const char *measure, double value, int slices, int64_t outside)
{
    ms_stop stop = {0};
    const ms_tally sum = lower_part(slices, outside);
    assert_int_equal(ms_stop_set(&stop, measure, value, NULL), MS_OK);
    return ms_stop_reached(&stop, target, &sum, 3);
}

static ms_target cube_target(ms_mesh *mesh)
{
    *mesh = cuboid(0, 10, 0, 10, 0, 10);
    ms_target target = target_of(mesh, 1, MS_VOXEL_HALF);
    assert_int_equal(target.voxels, 1000);
    return target;
}

static void each_measure_ends_a_run(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target = cube_target(&mesh);
    /* 700 of 1000 voxels and 100 outside: eta 0.4, D = 1 - 1400/1800, coverage 0.7. */
    assert_int_equal(reached(&target, "eta", 0.4, 7, 100), MS_STOP_ETA);
    assert_int_equal(reached(&target, "eta", 0.399, 7, 100), MS_STOP_NOT);
    assert_int_equal(reached(&target, "dice", 0.223, 7, 100), MS_STOP_DICE);
    assert_int_equal(reached(&target, "dice", 0.222, 7, 100), MS_STOP_NOT);
    assert_int_equal(reached(&target, "coverage", 0.7, 7, 100), MS_STOP_COVERAGE);
    assert_int_equal(reached(&target, "coverage", 0.701, 7, 100), MS_STOP_NOT);
    /* A cuboid 10 x 10 x s: moments s (100 + s^2) 100/12 twice and s 200 100/12, of 1000 200/12 each. */
    for (int s = 1; s <= 10; s++) {
        const double error = 1 - (2 * s * (100.0 + s * s) + 200.0 * s) / 6000;
        assert_int_equal(reached(&target, "inertia", error + 1e-9, s, 0), MS_STOP_INERTIA);
        if (s < 10) {
            assert_int_equal(reached(&target, "inertia", error - 1e-9, s, 0), MS_STOP_NOT);
        }
    }
    assert_int_equal(reached(&target, "inertia", 1, 0, 0), MS_STOP_NOT); /* nothing covered: no inertia at all */
    assert_int_equal(reached(&target, "radius", 2, 10, 0), MS_STOP_NOT); /* the generator's to see */
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A zeroed rule asks for nothing, one of ten spheres for ten and nothing else. */
static void zeroed_is_nothing(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target = cube_target(&mesh);
    const ms_stop none = {0}, ten = {.spheres = 10};
    const ms_tally whole = lower_part(10, 0); /* as good as can be in every measure */
    assert_true(ms_stop_is_none(&none) && !ms_stop_has_measure(&none));
    assert_true(!ms_stop_is_none(&ten) && !ms_stop_has_measure(&ten));
    assert_int_equal(ms_stop_reached(&none, &target, &whole, 9), MS_STOP_NOT);
    assert_int_equal(ms_stop_reached(&ten, &target, &whole, 9), MS_STOP_NOT);
    assert_int_equal(ms_stop_reached(&ten, &target, &whole, 10), MS_STOP_SPHERES);
    for (const ms_measure *m = ms_measures; m->name; m++) {
        assert_true(ms_stop_asked(&ten, m) == 0);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* What the table says can be asked for can be set by name, is found again, and names the reason. */
static void goals_of_the_table_are_known(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target = cube_target(&mesh);
    const ms_cut_cells cells = {.total = 1000};
    ms_tally whole = lower_part(10, 0);
    whole.cut = cells.total;
    target.grid.cells = &cells;
    for (const ms_measure *m = ms_measures; m->name; m++) {
        ms_stop stop = {0};
        const int goal = m->kind == MS_MEASURE_KIND_GOAL;
        assert_int_equal(ms_stop_set(&stop, m->name, 0.5, NULL), goal ? MS_OK : MS_ERR_ARG);
        assert_true(ms_stop_asked(&stop, m) == (goal ? 0.5 : 0));
        assert_int_equal(ms_stop_has_measure(&stop), goal);
        if (goal) {
            assert_string_equal(ms_stop_name(ms_stop_reached(&stop, &target, &whole, 1)), m->name);
        }
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void the_first_of_the_list_is_named(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target = cube_target(&mesh);
    const ms_tally whole = lower_part(10, 0);
    ms_stop stop = {.spheres = 4, .eta = 1e-9, .dice = 1e-9, .coverage = 1, .inertia = 1e-9};
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 4), MS_STOP_SPHERES);
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 5), MS_STOP_SPHERES);
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 3), MS_STOP_ETA);
    stop.eta = 0;
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 3), MS_STOP_DICE);
    stop.dice = 0;
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 3), MS_STOP_COVERAGE);
    stop.coverage = 0;
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 3), MS_STOP_INERTIA);
    stop.inertia = 0;
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 3), MS_STOP_NOT);
    stop = (ms_stop){0};
    assert_int_equal(ms_stop_reached(&stop, &target, &whole, 1000000), MS_STOP_NOT);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A box with these edges, turned about z, moved along x. */
static ms_body turned_box(double a, double b, double c, double degrees, double x)
{
    const double cosine = cos(degrees * pi / 180), sine = sin(degrees * pi / 180), m = a * b * c;
    const double i[3] = {m * (b * b + c * c) / 12, m * (a * a + c * c) / 12, m * (a * a + b * b) / 12};
    ms_body body = {.volume = m, .centroid = {x, 0, 0}};
    body.inertia[0][0] = cosine * cosine * i[0] + sine * sine * i[1];
    body.inertia[1][1] = sine * sine * i[0] + cosine * cosine * i[1];
    body.inertia[0][1] = body.inertia[1][0] = cosine * sine * (i[0] - i[1]);
    body.inertia[2][2] = i[2];
    return body;
}

static void inertia_of_boxes_is_compared(void **state)
{
    (void)state;
    ms_inertia_error e;
    const ms_body box = turned_box(4, 2, 1, 0, 0);
    for (int degrees = 0; degrees <= 180; degrees += 15) {
        const ms_body other = turned_box(4, 2, 1, degrees, 0.3);
        assert_int_equal(ms_metrics_compare_inertia(&e, &other, &box, NULL), MS_OK);
        expect_close(e.angle, degrees <= 90 ? degrees : 180 - degrees, 1e-5); /* an axis has no direction */
        expect_close(e.weighted, 0, 1e-12);
        expect_close(e.centre, 0.3 / cbrt(8 * 3 / (4 * pi)), 1e-12);
    }
    /* 8/12 (b^2 + c^2) ...: 5, 17, 20 against those of 4 x 2 x 1.5, 12/12: 6.25, 18.25, 20. */
    const ms_body thick = turned_box(4, 2, 1.5, 0, 0);
    assert_int_equal(ms_metrics_compare_inertia(&e, &thick, &box, NULL), MS_OK);
    const double p[3] = {6.25, 18.25, 20}, q[3] = {5 * 8 / 12.0, 17 * 8 / 12.0, 20 * 8 / 12.0};
    double difference = 0;
    for (int m = 0; m < 3; m++) {
        expect_close(e.moment[m], p[m] / q[m] - 1, 1e-12);
        difference += fabs(p[m] - q[m]);
    }
    expect_close(e.weighted, difference / (q[0] + q[1] + q[2]), 1e-12);
    expect_close(e.angle, 0, 1e-5);
}

static void axes_that_nothing_determines_have_no_angle(void **state)
{
    (void)state;
    ms_inertia_error e;
    /* A cube, turned: no axis. A square rod, turned about its length: one axis, not turned. */
    const ms_body cube = turned_box(2, 2, 2, 0, 0), turned_cube = turned_box(2, 2, 2, 30, 0);
    assert_int_equal(ms_metrics_compare_inertia(&e, &turned_cube, &cube, NULL), MS_OK);
    expect_close(e.angle, 0, 0);
    const ms_body rod = turned_box(1, 1.001, 5, 0, 0), turned_rod = turned_box(1, 1.001, 5, 40, 0);
    assert_int_equal(ms_metrics_compare_inertia(&e, &turned_rod, &rod, NULL), MS_OK);
    expect_close(e.angle, 0, 1e-5);
    const ms_body nothing = {0};
    assert_int_equal(ms_metrics_compare_inertia(&e, &nothing, &rod, NULL), MS_ERR_SHAPE);
    assert_int_equal(ms_metrics_compare_inertia(&e, &rod, &nothing, NULL), MS_ERR_SHAPE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reasons_have_names),
        cmocka_unit_test(measures_are_set_by_name),
        cmocka_unit_test(values_out_of_range_are_refused),
        cmocka_unit_test(each_measure_ends_a_run),
        cmocka_unit_test(zeroed_is_nothing),
        cmocka_unit_test(goals_of_the_table_are_known),
        cmocka_unit_test(the_first_of_the_list_is_named),
        cmocka_unit_test(inertia_of_boxes_is_compared),
        cmocka_unit_test(axes_that_nothing_determines_have_no_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
