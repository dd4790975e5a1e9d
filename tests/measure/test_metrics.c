/* Measures of clumps whose values are known by formula. */
#include "support/clump_samples.h"
#include "voxel/ms_raster.h"

static const ms_voxel_rule both_rules[] = {MS_VOXEL_HALF, MS_VOXEL_CENTRE};

static void scores_follow_from_the_sums(void **state)
{
    (void)state;
    const ms_tally sum = {.inside = 60, .outside = 15};
    const ms_score score = ms_metrics_score(&sum, 80);
    expect_close(score.eta, 35.0 / 80, 1e-15);
    expect_close(score.dice, 1 - 120.0 / 155, 1e-15);
    expect_close(score.coverage, 0.75, 1e-15);
    expect_close(score.overshoot, 15.0 / 80, 1e-15);
    expect_close(score.off_volume, 75.0 / 80, 1e-15);
}

static void a_ball_stands_for_a_ball(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 64});
    for (int r = 0; r < 2; r++) {
        for (double h = 0.24; h > 0.02; h /= 2.1) {
            ms_target target = target_of(&mesh, h, both_rules[r]);
            const ms_metrics m = measure_sphere(&target, 0, 0, 0, 1);
            assert_true(m.score.dice < 0.06 * h);
            expect_close(m.score.eta, 2 * m.score.dice, 0.05 * m.score.dice + 1e-12);
            expect_close(m.score.coverage, 1, 0.06 * h);
            expect_close(m.smallest_radius_ratio, 1, 2e-3);
            expect_close(m.body.volume, ball_volume(1), h);
            assert_int_equal(m.pieces, 1);
            ms_target_free(&target);
        }
    }
    ms_mesh_free(&mesh);
}

/* Concentric balls: coverage is the ratio of the volumes, or what lies outside is. */
static void concentric_balls_have_the_ratio_of_their_volumes(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 64});
    move_body(&mesh, 30, -40, 50);
    ms_target target = target_of(&mesh, 0.04, MS_VOXEL_HALF);
    for (double radius = 0.35; radius < 2; radius += 0.2385) {
        const ms_metrics m = measure_sphere(&target, 30, -40, 50, radius);
        const double ratio = radius * radius * radius, common = fmin(1, ratio);
        expect_close(m.score.coverage, common, 0.004);
        expect_close(m.score.overshoot, ratio - common, 0.004 * (1 + ratio));
        expect_close(m.score.off_volume, ratio, 0.004 * (1 + ratio));
        expect_close(m.score.eta, fabs(ratio - 1), 0.008 * (1 + ratio));
        expect_close(m.score.dice, 1 - 2 * common / (1 + ratio), 0.008);
        expect_close(m.inertia.moment[0], pow(radius, 5) - 1, 0.02 * (1 + pow(radius, 5)));
        expect_close(m.inertia.centre, 0, 1e-3);
        /* One surface is the other moved by the difference of the radii; the mesh is made of chords. */
        const double chord = 4e-4, away = radius - 1;
        expect_close(m.protrusion_max, fmax(0, away), chord);
        expect_close(m.protrusion_rms, fmax(0, away), chord);
        expect_close(m.gap_max, fmax(0, -away), chord);
        expect_close(m.gap_rms, fmax(0, -away), chord);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Volume of the union of two balls of radius r whose centres are d apart. */
static double two_balls(double r, double d)
{
    const double lens = d < 2 * r ? pi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12 : 0;
    return 2 * ball_volume(r) - lens;
}

static void two_balls_unite(void **state)
{
    (void)state;
    ms_mesh mesh = cuboid(-2.2, 2.2, -1.1, 1.1, -1.1, 1.1);
    ms_target target = target_of(&mesh, 0.05, MS_VOXEL_HALF);
    for (double d = 0; d < 2.4; d += 0.385) {
        ms_clump clump = {0};
        ms_score curve[2];
        add_sphere(&clump, -d / 2, 0.01, 0.02, 1); /* off the lattice, where errors do not add up */
        add_sphere(&clump, d / 2, 0.01, 0.02, 1);
        const ms_metrics m = measure(&target, &clump, curve);
        const double box = 4.4 * 2.2 * 2.2;
        expect_close(m.body.volume, two_balls(1, d), 0.01);
        expect_close(m.score.coverage, two_balls(1, d) / box, 0.002);
        expect_close(m.score.overshoot, 0, 1e-12);
        expect_close(curve[0].coverage, ball_volume(1) / box, 0.002);
        assert_memory_equal(&curve[1], &m.score, sizeof m.score);
        assert_int_equal(m.pieces, d < 2 ? 1 : 2);
        assert_int_equal(m.spheres, 2);
        ms_clump_free(&clump);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Apart, their moments are sums: 2/5 m r^2 each, and m d^2/4 across (Steiner). */
static void two_balls_have_the_inertia_of_two_balls(void **state)
{
    (void)state;
    const double r = 0.7, d = 2.27, at[3] = {0.017, -0.021, 0.009}, u[3] = {2 / 3.0, 1 / 3.0, 2 / 3.0};
    const double m = ball_volume(r);
    const double along = 2 * 0.4 * m * r * r, across = along + 2 * m * d * d / 4;
    ms_mesh mesh = cuboid(-2, 2, -2, 2, -2, 2);
    ms_target target = target_of(&mesh, 0.053, MS_VOXEL_HALF);
    ms_clump clump = {0};
    ms_principal p;
    for (int side = -1; side <= 1; side += 2) {
        add_sphere(&clump, at[0] + side * d / 2 * u[0], at[1] + side * d / 2 * u[1], at[2] + side * d / 2 * u[2], r);
    }
    const ms_metrics got = measure(&target, &clump, NULL);
    expect_close(got.body.volume, 2 * m, 0.005 * m);
    assert_int_equal(ms_inertia_principal(&p, &got.body, NULL), MS_OK);
    expect_close(p.moment[0], along, 0.01 * along);
    expect_close(p.moment[1], across, 0.01 * across);
    expect_close(p.moment[2], across, 0.01 * across);
    for (int a = 0; a < 3; a++) {
        expect_close(got.body.centroid[a], at[a], 1e-3);
        expect_close(fabs(p.axis[0][a]), fabs(u[a]), 1e-3);
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A block of voxels is a cuboid: exact, whatever the number of voxels. */
static void a_block_of_voxels_is_a_cuboid(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(9, 9, 9, 0.385);
    for (int nx = 1; nx < 4; nx++) {
        ms_tally sum = {0};
        ms_body body;
        const double side[3] = {0.385 * nx, 0.385 * 2, 0.385 * 5}, m = side[0] * side[1] * side[2];
        for (int v = 0; v < nx * 10; v++) {
            const int64_t i = 3 + v % nx, j = 4 + v / nx % 2, k = 1 + v / nx / 2;
            const ms_tally one = {v % 2, 1 - v % 2, {i, j, k}, {i * i, j * j, k * k, j * k, i * k, i * j}, 0};
            ms_tally_add(&sum, &one);
        }
        ms_tally_body(&body, &sum, &grid);
        expect_close(body.volume, m, 1e-12);
        expect_close(body.centroid[0], 0.385 * (3 + 0.5 * (nx - 1)), 1e-12);
        expect_close(body.centroid[2], 0.385 * 3, 1e-12);
        for (int a = 0; a < 3; a++) {
            const double b = side[(a + 1) % 3], c = side[(a + 2) % 3];
            expect_close(body.inertia[a][a], m * (b * b + c * c) / 12, 1e-12);
            expect_close(body.inertia[a][(a + 1) % 3], 0, 1e-12);
        }
        sum = (ms_tally){0};
        ms_tally_body(&body, &sum, &grid);
        assert_true(body.volume == 0 && body.inertia[0][0] == 0);
    }
    ms_grid_free(&grid);
}

static void a_ball_sticks_out_of_a_box(void **state)
{
    (void)state;
    ms_mesh mesh = cuboid(0, 4, 0, 3, 0, 3);
    ms_target target = target_of(&mesh, 0.05, MS_VOXEL_HALF);
    const ms_metrics m = measure_sphere(&target, 4, 1.5, 1.5, 1);
    expect_close(m.protrusion_max, 1, 0.01);
    /* Half of the surface is inside; over the other the mean of cos^2 is 1/3. */
    expect_close(m.protrusion_rms, sqrt(1 / 6.0), 0.01);
    expect_close(m.score.overshoot, ball_volume(1) / 2 / 36, 1e-3);
    expect_close(m.score.coverage, ball_volume(1) / 2 / 36, 1e-3);
    /* The farthest point of the box is a corner of the side x = 0. */
    expect_close(m.gap_max, sqrt(16 + 2 * 2.25) - 1, 0.05);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A hundredth of the radius, a tenth of a voxel. */
static void less_than_a_voxel_is_seen(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 64});
    ms_target target = target_of(&mesh, 0.1, MS_VOXEL_HALF);
    const ms_metrics out = measure_sphere(&target, 0, 0, 0, 1.01), in = measure_sphere(&target, 0, 0, 0, 0.99);
    expect_close(out.protrusion_max, 0.01, 4e-4);
    expect_close(out.protrusion_rms, 0.01, 4e-4);
    expect_close(out.gap_max, 0, 0);
    expect_close(in.protrusion_max, 0, 0);
    expect_close(in.gap_max, 0.01, 4e-4);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A sphere that others hide has no exposed surface; of equal spheres one counts. */
static void hidden_surface_does_not_count(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 48});
    ms_target target = target_of(&mesh, 0.1, MS_VOXEL_HALF);
    ms_clump clump = {0};
    add_sphere(&clump, 0, 0, 0, 1.2);
    add_sphere(&clump, 0.3, 0, 0, 0.8);
    add_sphere(&clump, 0, 0, 0, 1.2);
    const ms_metrics m = measure(&target, &clump, NULL);
    expect_close(m.protrusion_max, 0.2, 2e-3);
    expect_close(m.protrusion_rms, 0.2, 2e-3);
    assert_int_equal(m.pieces, 1);
    expect_close(m.smallest_radius_ratio, 0.8, 2e-3);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void spheres_beyond_the_grid_are_counted(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 48});
    ms_target target = target_of(&mesh, 0.06, MS_VOXEL_HALF);
    const double far[][3] = {{3, 0, 0}, {-3, 1, 0}, {0, 4, 0}, {0, -4, 2}, {0, 0, 5}, {0, 0, -5}};
    for (int f = 0; f < 6; f++) {
        const ms_metrics m = measure_sphere(&target, far[f][0], far[f][1], far[f][2], 0.8);
        expect_close(m.score.coverage, 0, 1e-12);
        expect_close(m.score.overshoot, 0.512, 0.004);
        expect_close(m.score.dice, 1, 1e-12);
        const double away = sqrt(far[f][0] * far[f][0] + far[f][1] * far[f][1] + far[f][2] * far[f][2]);
        expect_close(m.inertia.centre, away, 0.01);
        expect_close(m.protrusion_max, away - 1 + 0.8, 0.01);
        for (int a = 0; a < 3; a++) {
            expect_close(m.body.centroid[a], far[f][a], 0.01);
        }
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void what_cannot_be_measured_is_refused(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 8});
    ms_target target = target_of(&mesh, 0.2, MS_VOXEL_HALF);
    const double far[][3] = {{1e5, 0, 0}, {0, -1e30, 0}, {0, 0, 1e300}};
    ms_metrics m;
    for (int f = 0; f < 4; f++) {
        ms_clump clump = {0};
        ms_error err = {{0}};
        if (f < 3) {
            add_sphere(&clump, far[f][0], far[f][1], far[f][2], 1);
        }
        assert_int_equal(ms_metrics_compute(&m, NULL, &target, &clump, MANY_VOXELS, &err),
                         f < 3 ? MS_ERR_LIMIT : MS_ERR_ARG);
        expect_message(&err, f < 3 ? "check units and frame" : "without spheres");
        ms_clump_free(&clump);
    }
    /* A speck covers no voxel: nothing is known of its inertia. */
    m = measure_sphere(&target, 0.05, 0.03, 0.01, 1e-3);
    assert_true(m.score.dice == 1 && m.score.coverage == 0 && m.body.volume == 0);
    assert_true(isnan(m.inertia.weighted) && isnan(m.inertia.moment[2]) && isnan(m.inertia.centre));
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void a_volume_has_no_surface(void **state)
{
    (void)state;
    uint32_t label[4 * 3 * 2] = {0};
    for (int v = 0; v < 24; v++) {
        label[v] = v % 4 > 0 ? 7 : 0;
    }
    const ms_volume volume = {.n = {4, 3, 2}, .spacing = 0.5, .origin = {10, 20, 30}, .label = label};
    ms_target target;
    assert_int_equal(ms_target_from_volume(&target, &volume, 0, NULL), MS_OK);
    assert_int_equal(target.voxels, 18);
    expect_close(target.body.volume, 18 * 0.125, 1e-12);
    expect_close(target.body.centroid[0], 11, 1e-12);
    expect_close(target.body.centroid[1], 20.5, 1e-12);
    expect_close(target.body.centroid[2], 30.25, 1e-12);
    const ms_metrics m = measure_sphere(&target, 11, 20.5, 30.25, 5);
    expect_close(m.score.coverage, 1, 0);
    assert_true(isnan(m.protrusion_max) && isnan(m.protrusion_rms) && isnan(m.gap_max) && isnan(m.gap_rms));
    ms_target_free(&target);
    assert_int_equal(ms_target_from_volume(&target, &volume, 6, NULL), MS_ERR_SHAPE);
    label[1] = 6;
    ms_error err = {{0}};
    assert_int_equal(ms_target_from_volume(&target, &volume, 0, &err), MS_ERR_SHAPE);
    expect_message(&err, "several labels");
    assert_int_equal(ms_target_from_volume(&target, &volume, 6, NULL), MS_OK);
    assert_int_equal(target.voxels, 1);
    ms_target_free(&target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scores_follow_from_the_sums),
        cmocka_unit_test(a_ball_stands_for_a_ball),
        cmocka_unit_test(concentric_balls_have_the_ratio_of_their_volumes),
        cmocka_unit_test(two_balls_unite),
        cmocka_unit_test(two_balls_have_the_inertia_of_two_balls),
        cmocka_unit_test(a_block_of_voxels_is_a_cuboid),
        cmocka_unit_test(a_ball_sticks_out_of_a_box),
        cmocka_unit_test(less_than_a_voxel_is_seen),
        cmocka_unit_test(hidden_surface_does_not_count),
        cmocka_unit_test(spheres_beyond_the_grid_are_counted),
        cmocka_unit_test(what_cannot_be_measured_is_refused),
        cmocka_unit_test(a_volume_has_no_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
