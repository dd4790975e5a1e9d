/* Templates of a scene: the search against all that there are, and what a size and a length are. */
#include "clump/ms_equal_volume.h"
#include "clump/ms_union.h"
#include "ms_templates.h"
#include "support/clump_samples.h"
#include "support/run_samples.h"

enum { MOST = 40 };

static int n_runs[MOST + 1], is_interrupted; /* are the runs of so many spheres and of fewer */

/* n balls in one place, the first of which grows with n until it is the ball of the target, of radius 10 voxels. */
static ms_status grow(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const size_t n = run->stop.spheres;
    ms_status status = MS_OK;
    n_runs[n]++;
    for (size_t s = 0; s < n && status == MS_OK; s++) {
        const ms_sphere sphere = {{0, 0, 0}, s == 0 ? 10 * pow((double)n / MOST, 0.25) : 1};
        status = ms_clump_add(clump, &sphere, err);
    }
    *reason = (int)n <= is_interrupted ? MS_STOP_INTERRUPTED : MS_STOP_SPHERES;
    return status;
}

/* The same with one ball less for odd numbers, which says of what number it is. */
static ms_status grow_by_pairs(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const ms_status status = grow(clump, reason, run, err);
    ms_generator_remark(run, "of %zu", run->stop.spheres);
    clump->n_spheres -= clump->n_spheres > 1 && clump->n_spheres % 2;
    return status;
}

static const ms_option NO_OPTIONS[] = {{0}};
static const ms_generator GROWING = {.name = "growing", .options = NO_OPTIONS, .generate = grow};
static const ms_generator BY_PAIRS = {.name = "pairs", .options = NO_OPTIONS, .generate = grow_by_pairs};

/* @param[out] mesh outlives the target */
static void make_ball(ms_target *target, ms_mesh *mesh, double h)
{
    make_shape(mesh, "ball", "r=10 fineness=40");
    assert_int_equal(ms_target_from_mesh(target, mesh, 1, h, MS_VOXEL_HALF, NULL), MS_OK);
}

static int count_runs(void)
{
    int sum = 0;
    for (int n = 1; n <= MOST; n++) {
        assert_true(n_runs[n] <= 1); /* none twice */
        sum += n_runs[n];
    }
    return sum;
}

/* From wherever it begins, it finds the least number of all, by few runs; a further value runs but what is new. */
static void a_search_finds_the_least_number(void **state)
{
    static const double VALUES[] = {0.3, 0.1, 0.35, 0.02, 0.6};
    ms_target target;
    ms_mesh mesh;
    ms_templates all, some;
    double best;
    const ms_measure *dice = &ms_measures[MS_MEASURE_DICE];
    (void)state;
    make_ball(&target, &mesh, 1);
    const ms_run run = {.target = &target, .stop = {.spheres = MOST}};
    const ms_templates_how how = {.generator = &GROWING, .run = &run, .max_voxels = 1u << 24};
    assert_int_equal(ms_templates_make(&all, &how, NULL), MS_OK);
    assert_int_equal(all.most, MOST);
    for (size_t first = 0; first <= MOST + 5; first += 9) {
        memset(n_runs, 0, sizeof n_runs);
        assert_int_equal(ms_templates_alloc(&some, MOST, NULL), MS_OK);
        for (size_t v = 0; v < sizeof VALUES / sizeof *VALUES; v++) {
            size_t found;
            assert_int_equal(ms_templates_search(&some, &found, &how, dice, VALUES[v], first, NULL), MS_OK);
            assert_int_equal(found, ms_templates_least(&best, &all, dice, VALUES[v]));
            assert_true(some.dice[found - 1] <= VALUES[v] && some.dice[found - 1] == all.dice[found - 1]);
            assert_true(found == 1 || some.dice[found - 2] > VALUES[v]);
        }
        assert_in_range(count_runs(), 2, MOST - 8);
        ms_templates_free(&some);
    }
    ms_templates_free(&all);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void where_none_reaches_it(void **state)
{
    ms_target target;
    ms_mesh mesh;
    ms_templates some;
    size_t found;
    double best;
    const ms_measure *coverage = &ms_measures[MS_MEASURE_COVERAGE];
    (void)state;
    make_ball(&target, &mesh, 1);
    const ms_run run = {.target = &target, .stop = {.spheres = 12}};
    const ms_templates_how how = {.generator = &GROWING, .run = &run, .max_voxels = 1u << 24};
    memset(n_runs, 0, sizeof n_runs);
    assert_int_equal(ms_templates_alloc(&some, 0, NULL), MS_ERR_ARG);
    assert_int_equal(ms_templates_alloc(&some, 12, NULL), MS_OK);
    assert_true(isnan(some.dice[3]));
    assert_true(ms_templates_least(&best, &some, coverage, 0) == 0 && isnan(best)); /* nothing was run */
    assert_int_equal(ms_templates_search(&some, &found, &how, coverage, 0.9, 4, NULL), MS_OK);
    assert_int_equal(found, 0);
    assert_int_equal(ms_templates_least(&best, &some, coverage, 0.9), 0);
    assert_true(n_runs[12] == 1 && best == some.score[11].coverage);
    expect_close(best, pow(12.0 / MOST, 0.75), 0.02);
    ms_templates_free(&some);
    ms_templates_free(&some); /* of nothing */
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void an_interrupted_run_ends_it(void **state)
{
    ms_target target;
    ms_mesh mesh;
    ms_templates some;
    size_t found;
    ms_error err;
    (void)state;
    make_ball(&target, &mesh, 1);
    const ms_run run = {.target = &target, .stop = {.spheres = 12}};
    const ms_templates_how how = {.generator = &GROWING, .run = &run, .max_voxels = 1u << 24};
    memset(n_runs, 0, sizeof n_runs);
    assert_int_equal(ms_templates_alloc(&some, 12, NULL), MS_OK);
    is_interrupted = 12;
    const ms_status searched = ms_templates_search(&some, &found, &how, &ms_measures[MS_MEASURE_DICE], 0.1, 4, &err);
    const int runs = count_runs();
    ms_templates_free(&some);
    const ms_status made = ms_templates_make(&some, &how, NULL);
    is_interrupted = 5; /* the first run is whole, and of the others seven are */
    memset(n_runs, 0, sizeof n_runs);
    ms_error later;
    const ms_status made_in_part = ms_templates_make(&some, &how, &later);
    is_interrupted = 0;
    assert_int_equal(made_in_part, MS_ERR_INTERRUPTED);
    assert_non_null(strstr(later.text, "interrupted at 5 spheres"));
    assert_int_equal(count_runs(), 8);
    assert_int_equal(searched, MS_ERR_INTERRUPTED);
    assert_int_equal(runs, 1);
    assert_non_null(strstr(err.text, "interrupted at 4 spheres"));
    assert_int_equal(made, MS_ERR_INTERRUPTED);
    assert_int_equal(some.most, 0);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Of two clumps of as many spheres the better one stands at their number, with its score and remarks. */
static void the_better_clump_has_the_number(void **state)
{
    static const size_t FROM[] = {1, 3, 2, 5, 4, 7, 6, 9}, HAS[] = {1, 2, 2, 4, 4, 6, 6, 8};
    ms_target target;
    ms_mesh mesh;
    ms_templates all;
    (void)state;
    make_ball(&target, &mesh, 1);
    const ms_run run = {.target = &target, .stop = {.spheres = 9}};
    const ms_templates_how how = {.generator = &BY_PAIRS, .run = &run, .max_voxels = 1u << 24};
    assert_int_equal(ms_templates_make(&all, &how, NULL), MS_OK);
    assert_int_equal(all.most, 8);
    for (size_t n = 0; n < 8; n++) {
        char remark[16];
        snprintf(remark, sizeof remark, "of %zu", FROM[n]);
        assert_int_equal(all.clump[n].n_spheres, HAS[n]);
        expect_close(all.clump[n].sphere[0].radius, 10 * pow((double)FROM[n] / MOST, 0.25), 1e-12);
        assert_string_equal(all.remarks[n].text, remark);
        assert_true(all.dice[n] == all.score[n].dice && (FROM[n] <= n + 1 || n == 7 || all.dice[n] < all.dice[n + 1]));
    }
    ms_templates_free(&all);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Each has the volume asked for before it is judged, and says how far it was from it: here all are the ball itself. */
static void templates_of_equal_volume(void **state)
{
    ms_target target;
    ms_mesh mesh;
    ms_templates all;
    (void)state;
    make_ball(&target, &mesh, 1);
    const ms_run run = {.target = &target, .stop = {.spheres = 3}};
    const ms_templates_how how = {.generator = &GROWING, .run = &run, .equal = &target.body, .max_voxels = 1u << 24};
    assert_int_equal(ms_templates_make(&all, &how, NULL), MS_OK);
    for (size_t n = 0; n < 3; n++) {
        double volume, area, held;
        assert_int_equal(ms_union_measure(&volume, &area, &all.clump[n], NULL), MS_OK);
        expect_close(volume, target.body.volume, 1e-4 * volume);
        assert_int_equal(sscanf(all.remarks[n].text, "the spheres held %lf %% of the shape's volume", &held), 1);
        expect_close(held, 100 * pow((double)(n + 1) / MOST, 0.75), 0.1);
        assert_true(all.dice[n] < 0.02);
    }
    ms_templates_free(&all);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Of a ball of radius r and one larger by L: (q - 1) / (q + 1), where q = (1 + L/r)^3. */
static void a_length_is_a_mismatch(void **state)
{
    ms_target target;
    ms_mesh mesh;
    double surface;
    (void)state;
    make_ball(&target, &mesh, 0.5);
    assert_int_equal(ms_templates_surface(&surface, &target, NULL), MS_OK);
    expect_close(surface, 3.0 / 10, 0.002);
    for (double factor = 0.5; factor < 5; factor *= 3) {
        const double l = 0.01, q = pow(1 + l, 3), length = l * 10 * factor;
        const double dice = ms_templates_dice(length, surface, factor);
        expect_close(dice, (q - 1) / (q + 1), 0.02 * dice);
        expect_close(ms_templates_length(dice, surface, factor), length, 1e-12);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A body in another size is that of the scaled mesh. */
static void a_body_in_its_size(void **state)
{
    ms_mesh mesh;
    ms_body body, large;
    (void)state;
    make_shape(&mesh, "torus", "fineness=10");
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        mesh.vertex[v][0] += 2.385;
    }
    assert_int_equal(ms_inertia_mesh(&body, &mesh, NULL), MS_OK);
    const double factor = ms_inertia_factor(&body, 7.3);
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            mesh.vertex[v][k] *= factor;
        }
    }
    assert_int_equal(ms_inertia_mesh(&large, &mesh, NULL), MS_OK);
    ms_inertia_scale(&body, factor);
    expect_close(large.volume, ball_volume(7.3 / 2), 1e-9 * large.volume);
    expect_close(body.volume, large.volume, 1e-12 * large.volume);
    for (int k = 0; k < 3; k++) {
        expect_close(body.centroid[k], large.centroid[k], 1e-12 * factor);
        for (int l = 0; l < 3; l++) {
            expect_close(body.inertia[k][l], large.inertia[k][l], 1e-11 * large.inertia[0][0]);
        }
    }
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_search_finds_the_least_number),
        cmocka_unit_test(where_none_reaches_it),
        cmocka_unit_test(an_interrupted_run_ends_it),
        cmocka_unit_test(the_better_clump_has_the_number),
        cmocka_unit_test(templates_of_equal_volume),
        cmocka_unit_test(a_length_is_a_mismatch),
        cmocka_unit_test(a_body_in_its_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
