/* MSS, both variants: its field against a recomputation, its spheres against symmetry, constraints and the
 * paper's own figures. */
#include <stdlib.h>

#include "mesh/formats/ms_mesh_read.h"
#include "mesh/ms_closest.h"
#include "mss/ms_mss_field.h"
#include "support/mss_samples.h"
#include "support/reader_samples.h"
#include "voxel/ms_distance.h"

/* E~ is what a transform of the whole union gives, however it was updated: whole, in parts, with spheres that stand
 * out of the target, that add nothing, or that hide one another. */
static void field_equals_recomputation(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_mss_field field;
    ms_error err;
    make_shape(&mesh, "grain", "");
    make_target(&target, &mesh, 45, MS_VOXEL_HALF);
    assert_int_equal(ms_mss_field_init(&field, &target, &(ms_settings){0}, &err), MS_OK);
    assert_int_equal(ms_mss_field_start(&field, &err), MS_OK);
    const size_t voxels = ms_grid_voxels(&target.grid);
    uint8_t *covered = malloc(voxels);
    float *distance = malloc(voxels * sizeof *distance);
    srand(3);
    for (int round = 0; round < 40; round++) {
        ms_ball balls[3];
        const size_t count = 1 + (size_t)(rand() % 3);
        for (size_t b = 0; b < count; b++) {
            for (int a = 0; a < 3; a++) {
                balls[b].centre[a] = target.grid.n[a] * (0.2 + 0.6 * rand() / RAND_MAX);
            }
            balls[b].radius = round < 4 ? 12.3 : 0.4 + 5.0 * rand() / RAND_MAX;
        }
        assert_int_equal(ms_mss_field_add(&field, balls, count, &err), MS_OK);
        for (size_t v = 0; v < voxels; v++) {
            covered[v] = field.raster.first[v] != MS_RASTER_NONE;
        }
        assert_int_equal(ms_distance(distance, covered, target.grid.n, &err), MS_OK);
        for (size_t v = 0; v < voxels; v++) {
            assert_true(field.within[v] == distance[v]);
        }
    }
    free(covered);
    free(distance);
    ms_mss_field_free(&field);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* For each sphere there is its mirror image about the middle of the grid. */
static void assert_mirrored(const ms_clump *clump, const ms_target *target, int axis)
{
    const ms_grid *grid = &target->grid;
    const double twice_middle = 2 * grid->origin[axis] + grid->h * (grid->n[axis] - 1);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        double nearest = HUGE_VAL;
        for (size_t o = 0; o < clump->n_spheres; o++) {
            double away = fabs(clump->sphere[o].radius - clump->sphere[s].radius);
            for (int a = 0; a < 3; a++) {
                const double here = clump->sphere[s].centre[a], there = clump->sphere[o].centre[a];
                away += fabs(there - (a == axis ? twice_middle - here : here));
            }
            nearest = fmin(nearest, away);
        }
        if (!(nearest < 1e-6 * grid->h)) {
            fail_msg("sphere %zu of %zu has no mirror image along %c: nearest is %g voxels away", s + 1,
                     clump->n_spheres, "xyz"[axis], nearest / grid->h);
        }
    }
}

/* The paper's claim (4.1, Fig. 8), for odd and even numbers of voxels. Runs end by a measure,
 * so that no set of mirror images is cut: it is checked on the last whole step. */
static void symmetric_targets_give_symmetric_clumps(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"ellipsoid", "torus", "cube", "tablet", "box"};
    static const char *const OPTIONS[] = {"",
                                          "confine=on",
                                          "spacing=4",
                                          "variant=paper",
                                          "variant=paper spacing=4",
                                          "variant=paper order=gain spacing=3",
                                          "variant=paper confine=on boost=2"};
    for (size_t kind = 0; kind < sizeof KINDS / sizeof *KINDS; kind++) {
        ms_mesh mesh;
        make_shape(&mesh, KINDS[kind], "");
        for (int cells = 14; cells <= 19; cells += 5) {
            ms_target target;
            make_target(&target, &mesh, cells, MS_VOXEL_HALF);
            for (size_t o = 0; o < sizeof OPTIONS / sizeof *OPTIONS; o++) {
                ms_stop stop = {0};
                stop.radius = 2 * target.grid.h; /* to the end: all sets are whole */
                mss_outcome out = run_mss(&target, stop, OPTIONS[o]);
                assert_true(out.reason == MS_STOP_RADIUS || out.reason == MS_STOP_EXHAUSTED);
                for (int axis = 0; axis < 3; axis++) {
                    assert_mirrored(&out.clump, &target, axis);
                }
                ms_clump_free(&out.clump);
            }
            ms_target_free(&target);
        }
        ms_mesh_free(&mesh);
    }
}

/* Fig. 6: a target of two intersecting balls; E has one maximum, 2E - E~ finds the other. */
static void two_balls_are_found(void **state)
{
    (void)state;
    enum { N = 60 };
    static uint32_t label[N * N * N];
    const ms_ball truth[2] = {{{22, 30, 30}, 16}, {{36, 30, 30}, 11}};
    for (size_t v = 0; v < N * N * N; v++) {
        const double at[3] = {(double)(v % N), (double)(v / N % N), (double)(v / N / N)};
        label[v] = 0;
        for (int b = 0; b < 2; b++) {
            const double x = at[0] - truth[b].centre[0], y = at[1] - truth[b].centre[1], z = at[2] - truth[b].centre[2];
            label[v] |= x * x + y * y + z * z <= truth[b].radius * truth[b].radius;
        }
    }
    const ms_volume volume = {.n = {N, N, N}, .spacing = 1, .label = label};
    ms_target target;
    ms_error err;
    assert_int_equal(ms_target_from_volume(&target, &volume, 0, &err), MS_OK);
    mss_outcome o = run_mss(&target, at_most(2), "variant=paper");
    for (int b = 0; b < 2; b++) {
        for (int a = 0; a < 3; a++) {
            assert_close(o.clump.sphere[b].centre[a], truth[b].centre[a], 0.6);
        }
        assert_close(o.clump.sphere[b].radius, truth[b].radius, 0.9); /* E reaches to the next voxel's centre */
    }
    ms_clump_free(&o.clump);
    ms_target_free(&target);
}

/* Two plates with a gap between them, and a bar: the mean of mirrored maxima lies in the gap.
 * Whatever the number asked for, the run gives it, and prefixes agree. */
static void gaps_do_not_swallow_spheres(void **state)
{
    (void)state;
    enum { N = 24 };
    static uint32_t label[N * N * N];
    for (size_t v = 0; v < N * N * N; v++) {
        const size_t i = v % N, j = v / N % N, k = v / N / N;
        const int plates = i >= 4 && i < 20 && j >= 4 && j < 16 && ((k >= 4 && k < 8) || (k >= 10 && k < 14));
        label[v] = plates || (i >= 4 && i < 20 && j >= 18 && j < 20 && k >= 4 && k < 6);
    }
    const ms_volume volume = {.n = {N, N, N}, .spacing = 1, .label = label};
    static const char *const OPTIONS[] = {"variant=paper spacing=9", "variant=paper spacing=7", "variant=paper",
                                          "spacing=7", ""};
    ms_target target;
    ms_error err;
    assert_int_equal(ms_target_from_volume(&target, &volume, 0, &err), MS_OK);
    for (size_t o = 0; o < sizeof OPTIONS / sizeof *OPTIONS; o++) {
        mss_outcome all = run_mss(&target, at_most(300), OPTIONS[o]);
        assert_true(all.clump.n_spheres >= 4);
        for (size_t n = 1; n <= 4; n++) {
            mss_outcome some = run_mss(&target, at_most(n), OPTIONS[o]);
            assert_int_equal(some.clump.n_spheres, n);
            assert_memory_equal(some.clump.sphere, all.clump.sphere, n * sizeof *some.clump.sphere);
            ms_clump_free(&some.clump);
        }
        ms_clump_free(&all.clump);
    }
    ms_target_free(&target);
}

/* Every radius grows by the offset, those of means too. */
static void offset_reaches_every_sphere(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "box", "a=3 b=2 c=1");
    make_target(&target, &mesh, 20, MS_VOXEL_HALF);
    mss_outcome plain = run_mss(&target, at_most(3), "variant=paper spacing=4");
    mss_outcome more = run_mss(&target, at_most(3), "variant=paper spacing=4 radius-offset=0.5");
    for (size_t s = 0; s < 3; s++) {
        assert_close((more.clump.sphere[s].radius - plain.clump.sphere[s].radius) / target.grid.h, 0.5, 1e-9);
    }
    ms_clump_free(&plain.clump);
    ms_clump_free(&more.clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void confined_spheres_stay_inside(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"grain", "cube", "torus"};
    for (size_t kind = 0; kind < sizeof KINDS / sizeof *KINDS; kind++) {
        ms_mesh mesh;
        ms_target target;
        make_shape(&mesh, KINDS[kind], "");
        make_target(&target, &mesh, 30, MS_VOXEL_HALF);
        static const char *const OPTIONS[] = {"confine=on", "confine=on polish=on",
                                              "variant=paper confine=on radius-offset=1"};
        for (size_t option = 0; option < sizeof OPTIONS / sizeof *OPTIONS; option++) {
            mss_outcome o = run_mss(&target, at_most(40), OPTIONS[option]);
            for (size_t s = 0; s < o.clump.n_spheres; s++) {
                const ms_sphere *sphere = &o.clump.sphere[s];
                const double room = -ms_closest_signed_distance(target.closest, sphere->centre);
                assert_true(sphere->radius <= room * (1 + 1e-12));
            }
            ms_clump_free(&o.clump);
        }
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

static void planes_are_not_crossed(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ball", "r=1");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    static const char *const OPTIONS[] = {"plane=2,0,0,0.5 plane=0,1,1,-0.3",
                                          "variant=paper plane=2,0,0,0.5 plane=0,1,1,-0.3"};
    for (size_t option = 0; option < 2; option++) {
        mss_outcome o = run_mss(&target, at_most(40), OPTIONS[option]);
        for (size_t s = 0; s < o.clump.n_spheres; s++) {
            const double *c = o.clump.sphere[s].centre, r = o.clump.sphere[s].radius;
            assert_true(fabs(c[0] - 0.25) >= r * (1 - 1e-12));
            assert_true(fabs((c[1] + c[2] + 0.3) / sqrt(2)) >= r * (1 - 1e-12));
        }
        assert_true(o.clump.n_spheres > 10);
        ms_clump_free(&o.clump);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void spacing_is_kept(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "grain", "");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    static const char *const OPTIONS[] = {"spacing=5", "variant=paper spacing=5"};
    for (size_t option = 0; option < 2; option++) {
        mss_outcome o = run_mss(&target, at_most(200), OPTIONS[option]);
        for (size_t s = 0; s < o.clump.n_spheres; s++) {
            for (size_t t = 0; t < s; t++) {
                double square = 0;
                for (int a = 0; a < 3; a++) {
                    square += pow((o.clump.sphere[s].centre[a] - o.clump.sphere[t].centre[a]) / target.grid.h, 2);
                }
                assert_true(square >= 25 * (1 - 1e-9));
            }
        }
        ms_clump_free(&o.clump);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Section 4.2: the ellipsoid 2:1:1 on 209 x 107 x 107 voxels by 10 spheres: D = 0.0626. */
static void ellipsoid_of_the_paper(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ellipsoid", "a=2 b=1 c=1");
    make_target(&target, &mesh, 103, MS_VOXEL_HALF);
    mss_outcome paper = run_mss(&target, at_most(10), "variant=paper"), best = run_mss(&target, at_most(10), "");
    const double dice = score_of(&paper.clump, &target).dice;
    assert_true(dice <= 0.0626);
    assert_true(score_of(&best.clump, &target).dice < dice);
    ms_clump_free(&paper.clump);
    ms_clump_free(&best.clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Section 4.3: the femur by 70 spheres: D = 0.1760. */
static void femur_of_the_paper(void **state)
{
    (void)state;
    char path[512];
    ms_mesh mesh;
    ms_mesh_report report;
    ms_target target;
    ms_error err;
    shared_path(path, "human_femur.stl");
    assert_int_equal(ms_mesh_read(&mesh, path, &err), MS_OK);
    assert_int_equal(ms_mesh_repair(&mesh, &report, &err), MS_OK);
    make_target(&target, &mesh, 103, MS_VOXEL_HALF);
    mss_outcome paper = run_mss(&target, at_most(70), "variant=paper"), best = run_mss(&target, at_most(70), "");
    assert_int_equal(paper.clump.n_spheres, 70);
    assert_int_equal(best.clump.n_spheres, 70);
    const double dice = score_of(&paper.clump, &target).dice;
    assert_true(dice <= 0.1760);
    assert_true(score_of(&best.clump, &target).dice < 0.6 * dice);
    ms_clump_free(&paper.clump);
    ms_clump_free(&best.clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* What a variant does not have is refused, and not passed over. */
static void options_of_the_other_variant_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *options, *says;
    } CASES[] = {{"variant=paper polish=on", "polish"},
                 {"variant=best order=gain", "order"},
                 {"variant=best radius-offset=0.5", "radius-offset"}};
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ball", "");
    make_target(&target, &mesh, 12, MS_VOXEL_HALF);
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        ms_error err;
        ms_clump clump;
        ms_stop_reason reason;
        assert_int_equal(
            try_generator(&clump, &reason, &ms_generator_mss, &target, at_most(2), CASES[c].options, NULL, NULL, &err),
            MS_ERR_ARG);
        assert_non_null(strstr(err.text, CASES[c].says));
        assert_non_null(strstr(err.text, "variant=paper"));
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(field_equals_recomputation),
        cmocka_unit_test(symmetric_targets_give_symmetric_clumps),
        cmocka_unit_test(two_balls_are_found),
        cmocka_unit_test(gaps_do_not_swallow_spheres),
        cmocka_unit_test(offset_reaches_every_sphere),
        cmocka_unit_test(confined_spheres_stay_inside),
        cmocka_unit_test(planes_are_not_crossed),
        cmocka_unit_test(spacing_is_kept),
        cmocka_unit_test(options_of_the_other_variant_are_refused),
        cmocka_unit_test(ellipsoid_of_the_paper),
        cmocka_unit_test(femur_of_the_paper),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
