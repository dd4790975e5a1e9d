/* Clustered random spheres: the filling, the search for a number of spheres, the options, the paper's figure. */
#include "support/test_support.h"

#include <omp.h>

#include "fcm/ms_random_spheres.h"
#include "ms_generator_list.h"
#include "shared/ms_bisect_count.h"
#include "support/body_samples.h"
#include "support/run_samples.h"
#include "voxel/ms_raster.h"

static ms_status try_fcm(ms_clump *clump, ms_stop_reason *reason, const ms_target *target, ms_stop stop,
                         const char *options, uint64_t seed, ms_error *err)
{
    const ms_run run = {.target = target, .stop = stop, .seed = seed};
    return try_run(clump, reason, &ms_generator_fcm, run, options, err);
}

static ms_clump run_fcm(const ms_target *target, size_t spheres, const char *options, uint64_t seed)
{
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    ms_stop stop = {0};
    stop.spheres = spheres;
    if (try_fcm(&clump, &reason, target, stop, options, seed, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return clump;
}

static double away(const double a[3], const double b[3], ms_norm norm)
{
    const double x = fabs(a[0] - b[0]), y = fabs(a[1] - b[1]), z = fabs(a[2] - b[2]);
    return norm == MS_NORM_SUM ? x + y + z : sqrt(x * x + y * y + z * z);
}

/* Every centre inside, every radius the least distance to any node plus what is asked for, and the filling
 * over with the sphere that touches the last node needed. */
static void check_filling(const ms_target *target, const ms_random_spheres_rule *rule, double beyond)
{
    ms_nodes nodes;
    ms_ball *ball;
    size_t count, counted, touched = 0, before = 0;
    ms_error err;
    assert_int_equal(ms_nodes_of_target(&nodes, target, &err), MS_OK);
    if (ms_random_spheres(&ball, &count, &counted, target, &nodes, rule, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    uint8_t *covered = calloc(nodes.count, 1);
    assert_non_null(covered);
    for (size_t b = 0; b < count; b++) {
        const double *c = ball[b].centre;
        size_t nearest = 0;
        assert_true(
            target->grid.inside[ms_grid_index(&target->grid, (int)rint(c[0]), (int)rint(c[1]), (int)rint(c[2]))]);
        for (size_t n = 1; n < nodes.count; n++) {
            if (away(nodes.at[n], c, rule->norm) < away(nodes.at[nearest], c, rule->norm)) {
                nearest = n;
            }
        }
        assert_close(ball[b].radius, away(nodes.at[nearest], c, rule->norm) + beyond, 1e-9);
        before = touched;
        for (size_t n = 0; n < nodes.count && target->mesh; n++) {
            const int is_within = rule->within && away(nodes.at[n], c, MS_NORM_EUCLIDEAN) <= ball[b].radius;
            touched += (n == nearest || is_within) && !covered[n];
            covered[n] |= n == nearest || is_within;
        }
    }
    if (target->mesh) { /* of a volume several nodes may be nearest */
        const double wanted = rule->nodes_covered * (double)nodes.count;
        assert_true((double)touched >= wanted && ((double)before < wanted || count == rule->least));
    }
    free(covered);
    free(ball);
    ms_nodes_free(&nodes);
}

static void the_filling_touches_nodes(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "grain", "fineness=10");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    check_filling(&target, &(ms_random_spheres_rule){.nodes_covered = 0.9, .tries = 1000000, .seed = 1}, 0);
    check_filling(&target,
                  &(ms_random_spheres_rule){.nodes_covered = 0.6, .norm = MS_NORM_SUM, .offset = 1.5, .tries = 1000000},
                  1.5);
    check_filling(&target,
                  &(ms_random_spheres_rule){
                      .nodes_covered = 0.8, .within = 1, .norm = MS_NORM_SUM, .offset = 0.7, .tries = 1000000},
                  0.7);
    check_filling(&target, &(ms_random_spheres_rule){.nodes_covered = 0.2, .least = 1234, .tries = 1000000}, 0);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Half a voxel beyond the centres of the border's voxels is the surface: the one sphere of a cube touches it
 * but for the chance of where its centre, the mean of 10000 voxels, lies. */
static void volumes_are_filled_by_voxels(void **state)
{
    (void)state;
    static uint32_t label[9 * 9 * 9];
    for (int v = 0; v < 9 * 9 * 9; v++) {
        label[v] = 3;
    }
    const ms_volume box = {.n = {9, 9, 9}, .spacing = 2, .label = label};
    ms_target target;
    ms_error err;
    assert_int_equal(ms_target_from_volume(&target, &box, 0, &err), MS_OK);
    check_filling(&target, &(ms_random_spheres_rule){.nodes_covered = 0.9, .tries = 1000000}, 0.5);
    ms_clump clump = run_fcm(&target, 1, "", 1);
    const double four_sigma = 4 * 2 * sqrt((81 - 1) / 12.0 / 10000);
    for (int a = 0; a < 3; a++) {
        assert_close(clump.sphere[0].centre[a], 8, four_sigma);
    }
    assert_close(clump.sphere[0].radius, 9, four_sigma);
    ms_clump_free(&clump);
    ms_target_free(&target);
}

static void nodes_out_of_reach_are_an_error(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    ms_stop stop = {0};
    stop.spheres = 5;
    make_shape(&mesh, "cube", "");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    assert_int_equal(try_fcm(&clump, &reason, &target, stop, "tries=3000", 1, &err), MS_ERR_LIMIT);
    double share;
    const char *at = strstr(err.text, "touch ");
    assert_non_null(at);
    assert_int_equal(sscanf(at, "touch %lf %%", &share), 1);
    assert_true(share > 30 && share < 90); /* 3000 spheres, 1538 nodes */
    assert_non_null(strstr(err.text, "nodes-covered"));
    assert_int_equal(clump.n_spheres, 0);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* One cluster is the mean of the filling, whatever m: in a ball of radius 1, of points whose mean distance to
 * the surface is 1/4 (standard deviation sqrt(3/80)). */
static void one_cluster_is_the_mean(void **state)
{
    (void)state;
    static const char *const OPTIONS[] = {"radius=mean filling=20000", "radius=mean filling=20000 clustering=kmeans",
                                          "radius=mean filling=20000 fuzzifier=3 scale-radius=5",
                                          "radius=node filling=20000"};
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ball", "");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    for (int o = 0; o < 4; o++) {
        ms_clump clump = run_fcm(&target, 1, OPTIONS[o], 2);
        const double four_sigma = 4 * sqrt(3.0 / 80 / 20000);
        for (int a = 0; a < 3; a++) { /* standard deviation sqrt(1/5) */
            assert_close(clump.sphere[0].centre[a], 0, 4 * sqrt(0.2 / 20000));
        }
        if (o < 3) { /* nodes are sparse: 1e-3 beyond the faces at most, and the half voxel of the inside test */
            assert_close(clump.sphere[0].radius, 0.25, four_sigma + 2e-3);
        } else {
            assert_close(clump.sphere[0].radius, 1, 4 * sqrt(3 * 0.2 / 20000));
        }
        ms_clump_free(&clump);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* By voxels' centres, no sphere adds more than the one before. */
static void spheres_come_by_what_they_add(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_raster raster;
    ms_error err;
    make_shape(&mesh, "grain", "fineness=10");
    make_target(&target, &mesh, 40, MS_VOXEL_CENTRE);
    ms_clump clump = run_fcm(&target, 30, "", 1);
    assert_int_equal(ms_raster_alloc(&raster, &target.grid, MS_VOXEL_CENTRE, &err), MS_OK);
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_ball ball = ms_grid_ball(&target.grid, &clump.sphere[s]);
        assert_int_equal(ms_raster_add(&raster, &ball, 1, &err), MS_OK);
        assert_true(s == 0 || raster.tally[s].inside <= raster.tally[s - 1].inside);
    }
    ms_raster_free(&raster);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A stone of 402 nodes, 90 % of them covered, an off-volume ratio of 90 %: 37 spheres in the paper, for
 * another stone. Distances by eq. 1 as it is printed. */
static void the_stone_of_the_paper(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_error err;
    ms_stop stop = {0};
    stop.spheres = 500;
    make_shape(&mesh, "grain", "fineness=10");
    assert_in_range(mesh.n_vertices, 390, 410);
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    for (uint64_t seed = 1; seed <= 2; seed++) {
        ms_clump clump;
        ms_stop_reason reason;
        assert_int_equal(try_fcm(&clump, &reason, &target, stop,
                                 "norm=sum radius=mean filling=0 nodes-covered=0.9 off-volume=0.9", seed, &err),
                         MS_OK);
        assert_int_equal(reason, MS_STOP_OFF_VOLUME);
        assert_true(score_of(&clump, &target).off_volume >= 0.9);
        assert_in_range(clump.n_spheres, 30, 44);
        ms_clump_free(&clump);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Without a number or a measure the paper's 0.9 ends the run. */
static void the_volume_ends_the_run(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    ms_stop stop = {0};
    stop.radius = 0.05;
    make_shape(&mesh, "ellipsoid", "fineness=12");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    assert_int_equal(try_fcm(&clump, &reason, &target, stop, "", 1, &err), MS_OK);
    assert_int_equal(reason, MS_STOP_OFF_VOLUME);
    assert_true(score_of(&clump, &target).off_volume >= 0.9);
    assert_true(ms_clump_smallest_radius(&clump) >= 0.05);
    ms_clump_free(&clump);
    stop.spheres = 2; /* a number comes first */
    assert_int_equal(try_fcm(&clump, &reason, &target, stop, "off-volume=0.95", 1, &err), MS_OK);
    assert_int_equal(reason, MS_STOP_SPHERES);
    assert_int_equal(clump.n_spheres, 2);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* The same bytes for the same seed, by every way of clustering; others for another seed. */
static void the_seed_decides(void **state)
{
    (void)state;
    static const char *const OPTIONS[] = {"", "clustering=kmeans", "start=random restarts=3", "norm=sum radius=mean"};
    const int before = omp_get_max_threads();
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "grain", "fineness=16");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    for (int o = 0; o < 4; o++) {
        omp_set_num_threads(1);
        ms_clump alone = run_fcm(&target, 15, OPTIONS[o], 5), other = run_fcm(&target, 15, OPTIONS[o], 6);
        omp_set_num_threads(3);
        ms_clump team = run_fcm(&target, 15, OPTIONS[o], 5);
        assert_int_equal(alone.n_spheres, 15);
        assert_memory_equal(alone.sphere, team.sphere, 15 * sizeof *alone.sphere);
        assert_memory_not_equal(alone.sphere, other.sphere, 15 * sizeof *alone.sphere);
        ms_clump_free(&alone);
        ms_clump_free(&team);
        ms_clump_free(&other);
    }
    omp_set_num_threads(before);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void bad_options_are_refused(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    ms_stop stop = {0};
    stop.spheres = 5;
    make_shape(&mesh, "ball", "fineness=8");
    make_target(&target, &mesh, 20, MS_VOXEL_HALF);
    assert_int_equal(try_fcm(&clump, &reason, &target, stop, "fuzzifier=1.001", 1, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "fuzzifier"));
    /* nothing is left of the radii */
    assert_int_equal(try_fcm(&clump, &reason, &target, stop, "radius-offset=-50", 1, &err), MS_ERR_SHAPE);
    /* fewer spheres than clusters */
    stop.spheres = 50;
    assert_int_equal(try_fcm(&clump, &reason, &target, stop, "filling=20 nodes-covered=0", 1, &err), MS_OK);
    assert_int_equal(reason, MS_STOP_EXHAUSTED);
    assert_in_range(clump.n_spheres, 15, 20);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A method that needs a certain number of spheres, and has no more than some. */
typedef struct pretence {
    size_t needed, available, calls;
} pretence;

static ms_status pretend(void *context, ms_clump *clump, ms_stop_reason *reason, size_t n, ms_error *err)
{
    pretence *p = context;
    const ms_sphere sphere = {{0}, 1};
    p->calls++;
    for (size_t s = 0; s < n && s < p->available; s++) {
        assert_int_equal(ms_clump_add(clump, &sphere, err), MS_OK);
    }
    *reason = n >= p->needed ? MS_STOP_DICE : n > p->available ? MS_STOP_EXHAUSTED : MS_STOP_NOT;
    return MS_OK;
}

static void the_least_number_is_found(void **state)
{
    (void)state;
    for (size_t needed = 1; needed <= 140; needed++) {
        for (size_t most = 1; most <= 150; most += 7) {
            pretence p = {.needed = needed, .available = 100};
            ms_clump clump = {0};
            ms_stop_reason reason;
            assert_int_equal(ms_bisect_count(&clump, &reason, most, pretend, &p, NULL), MS_OK);
            if (needed <= most && needed <= 100) {
                assert_int_equal(reason, MS_STOP_DICE);
                assert_int_equal(clump.n_spheres, needed);
            } else if (most <= 100) {
                assert_int_equal(reason, MS_STOP_SPHERES);
                assert_int_equal(clump.n_spheres, most);
            }
            assert_true(p.calls <= 18);
            ms_clump_free(&clump);
        }
    }
}

/* What a run of n spheres says of a mesh, "" for nothing. */
static void remark_on(char remark[512], const ms_target *target, size_t n)
{
    ms_settings settings;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    ms_run run = {.target = target, .settings = &settings, .remark = keep_remark, .remark_context = remark};
    run.stop.spheres = n;
    remark[0] = '\0';
    assert_int_equal(ms_option_settings_init(&settings, ms_generator_fcm.options, &err), MS_OK);
    assert_int_equal(ms_option_settings_set(&settings, "filling", "2000", &err), MS_OK);
    assert_int_equal(ms_generator_run(&clump, &reason, &ms_generator_fcm, &run, &err), MS_OK);
    ms_clump_free(&clump);
    ms_option_settings_free(&settings);
}

/* Cubes of k edges a side: the longest edge is sqrt(2) / k, d_eq (6 / pi)^(1/3); it is long from 1.5 / n^(1/3) d_eq
 * on. */
static void long_edges_are_remarked(void **state)
{
    (void)state;
    static const struct {
        const char *fineness;
        size_t n;
        const char *says;
    } cases[] = {{NULL, 2, "1.1 times"},
                 {NULL, 100, "below 0.32 d_eq for 100 spheres"},
                 {"fineness=2", 10, ""},
                 {"fineness=2", 100, "0.57 times the diameter"},
                 {"fineness=6", 100, ""}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        ms_mesh mesh;
        ms_target target;
        char remark[512];
        if (cases[c].fineness) {
            make_shape(&mesh, "cube", cases[c].fineness);
        } else {
            mesh = unit_cube(); /* 8 nodes */
        }
        make_target(&target, &mesh, 20, MS_VOXEL_HALF);
        remark_on(remark, &target, cases[c].n);
        if (cases[c].says[0] ? !strstr(remark, cases[c].says) : remark[0] != '\0') {
            fail_msg("case %zu: \"%s\"", c, remark);
        }
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_filling_touches_nodes),       cmocka_unit_test(volumes_are_filled_by_voxels),
        cmocka_unit_test(nodes_out_of_reach_are_an_error), cmocka_unit_test(one_cluster_is_the_mean),
        cmocka_unit_test(spheres_come_by_what_they_add),   cmocka_unit_test(the_stone_of_the_paper),
        cmocka_unit_test(the_volume_ends_the_run),         cmocka_unit_test(the_seed_decides),
        cmocka_unit_test(bad_options_are_refused),         cmocka_unit_test(the_least_number_is_found),
        cmocka_unit_test(long_edges_are_remarked),

    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
