/* No part of the surface is farther from the spheres than the bound: by dense samples of the surface. */
#include "support/variational_samples.h"

#include <string.h>

#include "mesh/ms_closest.h"
#include "variational/ms_gap.h"

static double find_distance(const double place[3], const ms_ball *ball, size_t count)
{
    double least = HUGE_VAL;
    for (size_t b = 0; b < count; b++) {
        least = fmin(least, sqrt(ms_squared_distance(place, ball[b].centre)) - ball[b].radius);
    }
    return least;
}

/* The largest over places a part of a voxel apart on every triangle, corners and edges among them. */
static double find_densely(const ms_target *target, const ms_ball *ball, size_t count, double apart)
{
    const ms_mesh *mesh = target->mesh;
    double largest = -HUGE_VAL;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        double corner[3][3];
        for (int c = 0; c < 3; c++) {
            ms_grid_at(corner[c], &target->grid, mesh->vertex[mesh->triangle[t][c]]);
        }
        const double longest =
            sqrt(fmax(ms_squared_distance(corner[0], corner[1]), ms_squared_distance(corner[0], corner[2])));
        const int n = 1 + (int)(longest / apart);
        for (int i = 0; i <= n; i++) {
            for (int j = 0; i + j <= n; j++) {
                double place[3];
                for (int a = 0; a < 3; a++) {
                    place[a] = ((n - i - j) * corner[0][a] + i * corner[1][a] + j * corner[2][a]) / n;
                }
                largest = fmax(largest, find_distance(place, ball, count));
            }
        }
    }
    return largest;
}

static size_t to_balls(ms_ball *ball, size_t room, const ms_clump *clump, const ms_target *target)
{
    assert_true(clump->n_spheres <= room);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ball[s] = ms_grid_ball(&target->grid, &clump->sphere[s]);
    }
    return clump->n_spheres;
}

/* Large triangles, whose insides matter, and small ones. */
static void largest_gap_is_found(void **state)
{
    (void)state;
    static const char *const SHAPES[][2] = {{"box", "fineness=2"}, {"tablet", "fineness=6"}};
    enum { BALLS = 6, APART = 4 };
    ms_error err;
    srand(5);
    for (int s = 0; s < 2; s++) {
        ms_mesh mesh;
        ms_target target;
        make_shape(&mesh, SHAPES[s][0], SHAPES[s][1]);
        make_target(&target, &mesh, 16, MS_VOXEL_CENTRE);
        for (int t = 0; t < 10; t++) {
            ms_ball ball[BALLS];
            ms_gap_far far[BALLS];
            double largest, same;
            for (int b = 0; b < BALLS; b++) {
                ball[b].radius = uniform(2, t < 5 ? 8 : 14);
                for (int a = 0; a < 3; a++) {
                    ball[b].centre[a] = uniform(0, target.grid.n[a]);
                }
            }
            const double apart = 1.0 / APART, truth = find_densely(&target, ball, BALLS, apart);
            assert_int_equal(ms_gap_largest(&largest, far, &target, ball, BALLS, -100, &err), MS_OK);
            assert_true(largest >= truth - 0.0101 && largest <= truth + apart); /* 1-Lipschitz */
            double of_all = 0;
            for (int b = 0; b < BALLS; b++) {
                of_all = fmax(of_all, far[b].away);
                assert_true(far[b].away <= 0 || fabs(find_distance(far[b].place, ball, BALLS) - far[b].away) < 2e-3);
            }
            assert_true(of_all == fmax(largest, 0));
            assert_int_equal(ms_gap_largest(&same, NULL, &target, ball, BALLS, largest + 0.011, &err), MS_OK);
            assert_true(same == largest + 0.011); /* held */
            assert_int_equal(ms_gap_largest(&same, NULL, &target, ball, BALLS, truth - 0.02, &err), MS_OK);
            assert_true(same > truth - 0.02);
        }
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

/* By small steps what is known of places is the same as made anew. */
static void expect_places_known(ms_gap *gap, ms_ball *ball, uint32_t count)
{
    ms_gap_find(gap, ball, count, HUGE_VAL);
    for (int step = 0; step < 30; step++) {
        for (uint32_t b = 0; b < count; b++) {
            ball[b].centre[step % 3] += b % 2 ? 0.3 : -0.2;
            ball[b].radius += 0.1 * (step % 2 ? 1 : -1);
        }
        ms_gap_find(gap, ball, count, 0.4);
        size_t found = 0, truth = 0;
        for (size_t p = 0; p < gap->count; p++) {
            truth += find_distance(gap->place[p], ball, count) > 3;
        }
        for (uint32_t b = 0; b < count; b++) {
            for (size_t i = gap->first[b]; i < gap->first[b + 1]; i++, found++) {
                assert_int_equal(gap->nearest[gap->far[i]], b);
                assert_true(find_distance(gap->place[gap->far[i]], &ball[b], 1) > 3);
            }
        }
        assert_int_equal(found, truth);
    }
}

/* Excess and losses over the places, against sums made anew for each sphere. */
static void losses_are_those_of_the_places(void **state)
{
    const ms_target *target = *state;
    enum { BALLS = 7 };
    static const ms_mirror NONE;
    ms_gap gap;
    ms_error err;
    ms_ball ball[BALLS], other[BALLS];
    double loss[BALLS];
    assert_int_equal(ms_gap_open(&gap, target, &NONE, 3, BALLS, &err), MS_OK);
    const double h = target->grid.h, area = ms_mesh_area(target->mesh) / (h * h);
    assert_true(fabs(gap.area * (double)gap.count / area - 1) < 0.01);
    srand(6);
    for (int b = 0; b < BALLS; b++) {
        ball[b].radius = uniform(4, 12);
        for (int a = 0; a < 3; a++) {
            ball[b].centre[a] = uniform(5, target->grid.n[a] - 5);
        }
    }
    ms_gap_losses(loss, &gap, ball, BALLS);
    const double all = ms_gap_excess(&gap, ball, BALLS);
    assert_true(all > 0);
    for (int gone = 0; gone < BALLS; gone++) {
        memcpy(other, ball, sizeof other);
        other[gone] = other[BALLS - 1];
        assert_true(fabs(ms_gap_excess(&gap, other, BALLS - 1) - all - loss[gone]) < 1e-6 * all);
    }
    expect_places_known(&gap, ball, BALLS);
    ms_gap_close(&gap);
}

static void gap_is_kept(void **state)
{
    const ms_target *target = *state;
    static const struct {
        const char *options;
        size_t spheres;
        double bound;
    } CASES[] = {{"gap=2", 6, 2},
                 {"gap=0.5", 12, 0.5},
                 {"gap=0", 3, 0},
                 {"gap=3 symmetry=x", 8, 3},
                 {"gap=2 equal-radius", 8, 2},
                 {"gap=4 protrusion=3", 12, 4}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        ms_ball ball[16];
        ms_clump clump = run_generator(&ms_generator_variational, target, (ms_stop){.spheres = CASES[c].spheres},
                                       CASES[c].options, NULL);
        const size_t count = to_balls(ball, 16, &clump, target);
        const double largest = find_densely(target, ball, count, 0.5);
        print_message("%s: %zu spheres, largest %.4f, D %.4f\n", CASES[c].options, count, largest,
                      dice_of(target, &clump));
        assert_true(largest <= CASES[c].bound + 1e-9);
        ms_clump_free(&clump);
    }
}

/* One inscribed sphere reaches no tip of a needle: the nearest possible is said, and it is true. */
static void gap_that_cannot_be_kept_is_said(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_stop_reason reason;
    ms_clump clump;
    ms_error err;
    ms_ball ball[2];
    char remark[512] = "";
    make_shape(&mesh, "needle", "length=6 r=0.5 fineness=8");
    make_target(&target, &mesh, 10, MS_VOXEL_CENTRE);
    const ms_stop stop = {.spheres = 2};
    assert_int_equal(try_generator(&clump, &reason, &ms_generator_variational, &target, stop, "gap=1 protrusion=0",
                                   keep_remark, remark, &err),
                     MS_OK);
    const double largest = find_densely(&target, ball, to_balls(ball, 2, &clump, &target), 0.2);
    double said = 0;
    print_message("%s\n", remark);
    assert_non_null(strstr(remark, "gap=1 cannot be held by 2 spheres"));
    assert_int_equal(sscanf(strstr(remark, "surface is "), "surface is %lf voxels", &said), 1);
    assert_true(fabs(said - largest) < 0.05);
    assert_true(said < 16); /* at a quarter of the length each, 15 from its middle and 13 from an end */
    ms_clump_free(&clump);
    remark[0] = 0;
    assert_int_equal(
        try_generator(&clump, &reason, &ms_generator_variational, &target, stop, "gap=1", keep_remark, remark, &err),
        MS_OK);
    assert_string_equal(remark, "");
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Inscribed spheres are moved on the medial axis without regard to either, before both are held. */
static void inscribed_spheres_keep_gap_and_stay_one_piece(void **state)
{
    (void)state;
    static const char *const OPTIONS[] = {"protrusion=0", "protrusion=0 gap=1.2 connected"};
    double largest[2];
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ellipsoid", "a=2 b=1 c=1 fineness=20");
    make_target(&target, &mesh, 20, MS_VOXEL_CENTRE);
    for (int o = 0; o < 2; o++) {
        ms_stop_reason reason;
        ms_clump clump;
        ms_error err;
        ms_ball ball[5];
        size_t pieces;
        char remark[512] = "";
        assert_int_equal(try_generator(&clump, &reason, &ms_generator_variational, &target, (ms_stop){.spheres = 5},
                                       OPTIONS[o], keep_remark, remark, &err),
                         MS_OK);
        assert_string_equal(remark, "");
        largest[o] = find_densely(&target, ball, to_balls(ball, 5, &clump, &target), 0.2);
        assert_int_equal(ms_clump_pieces(&pieces, &clump, &err), MS_OK);
        assert_int_equal(pieces, 1);
        for (size_t s = 0; s < clump.n_spheres; s++) {
            double nearest[3];
            const double away = ms_closest_distance(nearest, target.closest, clump.sphere[s].centre, HUGE_VAL);
            assert_true(clump.sphere[s].radius <= away + 1e-9);
        }
        ms_clump_free(&clump);
    }
    print_message("inscribed: largest %.4f, and %.4f where it is bound\n", largest[0], largest[1]);
    assert_true(largest[0] > 1.3 && largest[1] <= 1.2 + 1e-9);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Of a volume the surface is that of its border voxels' centres. */
static void gap_of_a_volume_is_kept(void **state)
{
    (void)state;
    ms_target target;
    ms_ball ball[4];
    make_voxel_box(&target, (const int[3]){30, 12, 9});
    ms_clump clump = run_generator(&ms_generator_variational, &target, (ms_stop){.spheres = 4}, "gap=1.5", NULL);
    const size_t count = to_balls(ball, 4, &clump, &target);
    double largest = 0;
    for (size_t v = 0; v < ms_grid_voxels(&target.grid); v++) {
        if (target.grid.inside[v]) {
            const double at[3] = {(double)(v % (size_t)target.grid.n[0]),
                                  (double)(v / (size_t)target.grid.n[0] % (size_t)target.grid.n[1]),
                                  (double)(v / (size_t)target.grid.n[0] / (size_t)target.grid.n[1])};
            largest = fmax(largest, find_distance(at, ball, count));
        }
    }
    assert_true(largest <= 1.5 + 1e-9);
    assert_true(dice_of(&target, &clump) < 0.3);
    ms_clump_free(&clump);
    ms_target_free(&target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(largest_gap_is_found),
        cmocka_unit_test(losses_are_those_of_the_places),
        cmocka_unit_test(gap_is_kept),
        cmocka_unit_test(gap_that_cannot_be_kept_is_said),
        cmocka_unit_test(inscribed_spheres_keep_gap_and_stay_one_piece),
        cmocka_unit_test(gap_of_a_volume_is_kept),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
