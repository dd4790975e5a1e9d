/* The parts of the variational generator: signed distances, losses, fits, bounds. */
#include "support/variational_samples.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

#include "mesh/ms_closest.h"
#include "variational/ms_coverage_count.h"
#include "variational/ms_exposed.h"
#include "variational/ms_pattern_search.h"
#include "variational/ms_prune.h"
#include "variational/ms_split.h"
#include "variational/ms_surface_fit.h"
#include "variational/ms_surface_tally.h"

/* To the last bit, whichever neighbours a node was bounded by. */
static void expect_nodes_of_mesh(const ms_signed_distance *field)
{
    const ms_target *target = field->target;
    int known = 0;
    for (int i = 0; i < field->n[0] * field->n[1] * field->n[2]; i++) {
        const int on[3] = {i % field->n[0], i / field->n[0] % field->n[1], i / field->n[0] / field->n[1]};
        const double at[3] = {on[0] * field->step, on[1] * field->step, on[2] * field->step};
        double place[3];
        ms_grid_place(place, &target->grid, at);
        const double truth = ms_closest_signed_distance(target->closest, place) / target->grid.h;
        known += !isnan(field->phi[i]);
        assert_true(isnan(field->phi[i]) || field->phi[i] == (float)truth);
    }
    assert_true(known > 200);
}

/* Exact at the nodes, linear between them, and beyond the lattice never too small. */
static void field_is_the_distance(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_signed_distance field;
    ms_error err;
    make_shape(&mesh, "ball", "r=1 fineness=60");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    const ms_sphere unit = {.radius = 1};
    const ms_ball ball = ms_grid_ball(&target.grid, &unit);
    const double *middle = ball.centre, radius = ball.radius;
    for (int step = 1; step <= 3; step++) {
        assert_int_equal(ms_signed_distance_open(&field, &target, step, &err), MS_OK);
        for (int t = 0; t < 300; t++) {
            const double p[3] = {uniform(-3, 37), uniform(-3, 37), uniform(-3, 37)};
            const double truth = sqrt(ms_squared_distance(p, middle)) - radius;
            const double away = fmax(2, sqrt(ms_squared_distance(p, middle)));
            /* Linear: off by up to 3/8 step^2 times the curvature; beyond the lattice by the corner's way. */
            const int beyond = p[0] < 0 || p[1] < 0 || p[2] < 0 || p[0] > 33 || p[1] > 33 || p[2] > 33;
            const double phi = ms_signed_distance_at(&field, p);
            assert_true(phi > truth - 0.4 * step * step / away - 0.05);
            assert_true(phi < truth + 0.8 * step * step / away + 0.05 + 3 * beyond);
        }
        expect_nodes_of_mesh(&field);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

enum { RUNS = 4, PLACES = 2000 };

/* A run on a target, beside others. */
typedef struct side_run {
    const ms_target *target;
    int step;
    float *nodes;
    double phi[PLACES];
} side_run;

static void *look_up_places(void *context)
{
    side_run *run = context;
    ms_signed_distance field;
    ms_error err;
    assert_int_equal(ms_signed_distance_open(&field, run->target, run->step, &err), MS_OK);
    run->nodes = field.phi;
    for (int p = 0; p < PLACES; p++) {
        const double place[3] = {0.011 * p, 20 - 0.007 * p, 7 + 0.005 * p};
        run->phi[p] = ms_signed_distance_at(&field, place);
    }
    return NULL;
}

/* Runs side by side share the nodes of their step, and find what a run alone finds. */
static void field_is_kept_with_its_target(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target, other;
    static side_run run[RUNS], alone;
    pthread_t thread[RUNS];
    make_shape(&mesh, "ball", "r=1 fineness=60");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    make_target(&other, &mesh, 30, MS_VOXEL_HALF);
    for (int r = 0; r < RUNS; r++) {
        run[r] = (side_run){.target = &target, .step = r % 2 + 1};
        assert_int_equal(pthread_create(&thread[r], NULL, look_up_places, &run[r]), 0);
    }
    for (int r = 0; r < RUNS; r++) {
        assert_int_equal(pthread_join(thread[r], NULL), 0);
    }
    for (int r = 0; r < RUNS; r++) {
        assert_ptr_equal(run[r].nodes, run[r % 2].nodes);
        alone = (side_run){.target = &other, .step = r % 2 + 1};
        look_up_places(&alone);
        assert_memory_equal(alone.phi, run[r].phi, sizeof alone.phi);
    }
    assert_ptr_not_equal(run[0].nodes, run[1].nodes);
    ms_target_free(&other);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void losses_are_those_of_brute_force(void **state)
{
    (void)state;
    ms_grid grid;
    ms_error err;
    const int n[3] = {13, 11, 9};
    const double origin[3] = {0, 0, 0};
    assert_int_equal(ms_grid_alloc(&grid, n, 1, origin, &err), MS_OK);
    for (int t = 0; t < 100; t++) {
        ms_ball ball[6];
        ms_coverage_count o;
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            grid.inside[v] = rand() % 2 != 0;
        }
        for (int b = 0; b < 6; b++) {
            ball[b] = (ms_ball){{uniform(-3, 16), uniform(-3, 14), uniform(-3, 12)}, uniform(0, 6)};
        }
        assert_int_equal(ms_coverage_count_open(&o, &grid, ball, 5, &err), MS_OK);
        const int64_t all = brute_mismatch(&grid, ball, 5);
        assert_int_equal(o.mismatch, all);
        assert_int_equal(ms_coverage_count_loss(&o, &ball[4]), brute_mismatch(&grid, ball, 4) - all);
        assert_int_equal(ms_coverage_count_gain(&o, &ball[5]), all - brute_mismatch(&grid, ball, 6));
        ms_coverage_count_add(&o, &ball[5]);
        assert_int_equal(o.mismatch, brute_mismatch(&grid, ball, 6));
        ms_coverage_count_remove(&o, &ball[5]);
        ms_coverage_count_remove(&o, &ball[4]);
        assert_int_equal(o.mismatch, brute_mismatch(&grid, ball, 4));
        ms_coverage_count_clear(&grid, ball, 4);
        assert_int_equal(brute_mismatch(&grid, ball, 0), (int64_t)ms_grid_count(&grid));
        for (int b = 0; b < 4; b++) {
            ms_ball alone = ball[b];
            ms_coverage_count empty;
            assert_int_equal(ms_coverage_count_open(&empty, &grid, NULL, 0, &err), MS_OK);
            assert_true(ms_coverage_count_gain(&empty, &alone) <= 0); /* nothing of it is left */
            ms_coverage_count_close(&empty);
        }
        ms_coverage_count_close(&o);
    }
    ms_grid_free(&grid);
}

/* What is left is no worse, and all of it is needed; the cheapest sphere goes first. */
static void spheres_are_dropped_by_their_loss(void **state)
{
    (void)state;
    ms_target target = {.mesh = NULL};
    ms_grid grid;
    ms_error err;
    const int n[3] = {13, 11, 9};
    const double origin[3] = {0, 0, 0};
    assert_int_equal(ms_grid_alloc(&grid, n, 1, origin, &err), MS_OK);
    target.grid = grid;
    const ms_signed_distance field = {.target = &target}; /* of voxels: only counts matter */
    const ms_surface_fit fit = {.field = &field};
    for (int t = 0; t < 100; t++) {
        ms_ball ball[8], few[8];
        size_t count = 8;
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            grid.inside[v] = rand() % 3 != 0;
        }
        for (int b = 0; b < 8; b++) {
            ball[b] = (ms_ball){{uniform(0, 12), uniform(0, 10), uniform(0, 8)}, uniform(0, 5)};
        }
        const int64_t before = brute_mismatch(&grid, ball, 8);
        assert_int_equal(ms_prune_idle(ball, &count, &fit, &err), MS_OK);
        const int64_t after = brute_mismatch(&grid, ball, count);
        assert_true(after <= before);
        int64_t least = INT64_MAX;
        for (size_t gone = 0; gone < count; gone++) {
            memcpy(few, ball, sizeof few);
            few[gone] = ball[count - 1];
            const int64_t without = brute_mismatch(&grid, few, count - 1);
            assert_true(without > after);
            least = without < least ? without : least;
        }
        if (count > 0) {
            const ms_coarse_view whole = {.step = 1, .grid = grid};
            assert_int_equal(ms_prune_cheapest(ball, &count, 1, &whole, &fit, &err), MS_OK);
            assert_int_equal(brute_mismatch(&grid, ball, count), least);
        }
    }
    ms_grid_free(&grid);
}

/* The mismatch falls along the step of a fit: finite differences of the voxels' count. */
static void step_lowers_the_mismatch(void **state)
{
    const ms_target *target = *state;
    ms_signed_distance field;
    ms_error err;
    ms_lattice lattice;
    int fell = 0, tried = 0;
    assert_int_equal(ms_lattice_alloc(&lattice, 256, &err), MS_OK);
    assert_int_equal(ms_signed_distance_open(&field, target, 1, &err), MS_OK);
    for (int t = 0; t < 40; t++) {
        ms_ball ball[3], before[3];
        const double damping[2] = {0.3, 0.3};
        for (int b = 0; b < 3; b++) {
            do {
                for (int a = 0; a < 3; a++) {
                    ball[b].centre[a] = uniform(0, target->grid.n[a]);
                }
            } while (ms_signed_distance_at(&field, ball[b].centre) > -3);
            ball[b].radius = uniform(0.5, 1.5) * -ms_signed_distance_at(&field, ball[b].centre);
        }
        memcpy(before, ball, sizeof ball);
        ms_surface_fit fit = {
            .field = &field, .bounds = {.least = 0.5, .protrusion = HUGE_VAL}, .lattice = &lattice, .seed = 1};
        assert_int_equal(ms_surface_fit_steps(&fit, ball, 3, 1, damping, &err), MS_OK);
        if (memcmp(before, ball, sizeof ball) != 0) {
            tried++;
            fell += brute_mismatch(&target->grid, ball, 3) < brute_mismatch(&target->grid, before, 3);
        }
    }
    assert_true(tried > 30);
    ms_lattice_free(&lattice);
    assert_true(fell >= tried - 2); /* a sphere and its neighbour may both fill the same gap */
}

/* In the target, away from its surface. */
static void place_at_random(ms_ball *ball, size_t count, const ms_signed_distance *field)
{
    for (size_t b = 0; b < count; b++) {
        do {
            for (int a = 0; a < 3; a++) {
                ball[b].centre[a] = uniform(0, field->target->grid.n[a]);
            }
        } while (ms_signed_distance_at(field, ball[b].centre) > -2);
        ball[b].radius = uniform(0.5, 1.1) * -ms_signed_distance_at(field, ball[b].centre);
    }
}

static void held_spheres_stay(void **state)
{
    const ms_target *target = *state;
    static const uint8_t MOVING[6] = {1, 0, 1, 0, 0, 1};
    ms_signed_distance field;
    ms_lattice lattice;
    ms_error err;
    ms_ball ball[6], before[6];
    const double damping[2] = {0.5, 0.5};
    assert_int_equal(ms_lattice_alloc(&lattice, 128, &err), MS_OK);
    assert_int_equal(ms_signed_distance_open(&field, target, 1, &err), MS_OK);
    place_at_random(ball, 6, &field);
    memcpy(before, ball, sizeof ball);
    ms_surface_fit fit = {.field = &field, .bounds = {.protrusion = HUGE_VAL}, .lattice = &lattice, .moving = MOVING};
    assert_int_equal(ms_surface_fit_steps(&fit, ball, 6, 5, damping, &err), MS_OK);
    int moved = 0;
    for (int b = 0; b < 6; b++) {
        const int is_same = memcmp(&ball[b], &before[b], sizeof ball[b]) == 0;
        assert_true(is_same || MOVING[b]);
        moved += !is_same;
    }
    assert_true(moved >= 2); /* one may be covered by others */
    ms_lattice_free(&lattice);
}

/* The sphere that bears most is now two, a quarter of the way to its nearest and as far the other way. */
static void worst_sphere_is_split(void **state)
{
    const ms_target *target = *state;
    ms_signed_distance field;
    ms_lattice lattice;
    ms_error err;
    ms_ball ball[8], before[8];
    ms_surface_worth worth[7];
    assert_int_equal(ms_lattice_alloc(&lattice, 256, &err), MS_OK);
    assert_int_equal(ms_signed_distance_open(&field, target, 1, &err), MS_OK);
    const ms_surface_fit fit = {.field = &field, .lattice = &lattice};
    for (int t = 0; t < 20; t++) {
        size_t count = 7, worst = 0, near = 7;
        place_at_random(ball, 7, &field);
        memcpy(before, ball, sizeof ball);
        assert_int_equal(ms_surface_tally(worth, NULL, NULL, &fit, ball, 7, &err), MS_OK);
        for (size_t b = 1; b < 7; b++) {
            worst = worth[b].mismatch > worth[worst].mismatch ? b : worst;
        }
        for (size_t b = 0; b < 7; b++) {
            const double *of = ball[worst].centre;
            if (b != worst &&
                (near == 7 || ms_squared_distance(ball[b].centre, of) < ms_squared_distance(ball[near].centre, of))) {
                near = b;
            }
        }
        assert_int_equal(ms_split_worst(ball, &count, 1, &fit, &err), MS_OK);
        assert_int_equal(count, 8);
        for (size_t b = 0; b < 7; b++) {
            assert_true(b == worst || memcmp(&ball[b], &before[b], sizeof ball[b]) == 0);
        }
        const ms_ball *whole = &before[worst], *to = &before[near];
        assert_true(fabs(ball[worst].radius - (whole->radius + 0.25 * (to->radius - whole->radius))) < 1e-9);
        assert_true(fabs(ball[7].radius - (whole->radius - 0.25 * (to->radius - whole->radius))) < 1e-9);
        for (int c = 0; c < 3; c++) {
            const double way = 0.25 * (to->centre[c] - whole->centre[c]);
            assert_true(fabs(ball[worst].centre[c] - (whole->centre[c] + way)) < 1e-9);
            assert_true(fabs(ball[7].centre[c] - (whole->centre[c] - way)) < 1e-9);
        }
    }
    ms_lattice_free(&lattice);
}

/* Eight to each new one: as many as those that are no farther from it than one that is marked. */
static void nearest_spheres_are_marked(void **state)
{
    (void)state;
    enum { COUNT = 40, FIRST = 38 };
    ms_ball ball[COUNT];
    uint8_t near[COUNT], brute[COUNT] = {0};
    for (int b = 0; b < COUNT; b++) {
        ball[b] = (ms_ball){{uniform(0, 9), uniform(0, 9), uniform(0, 9)}, 1};
    }
    ms_split_mark_near(near, ball, COUNT, FIRST);
    for (int a = FIRST; a < COUNT; a++) {
        brute[a] = 1;
        for (int b = 0; b < FIRST; b++) {
            int nearer = 0;
            for (int k = 0; k < FIRST; k++) {
                nearer += ms_squared_distance(ball[k].centre, ball[a].centre) <
                          ms_squared_distance(ball[b].centre, ball[a].centre);
            }
            brute[b] |= nearer < 8;
        }
    }
    assert_memory_equal(near, brute, sizeof near);
}

static void search_never_raises_the_mismatch(void **state)
{
    const ms_target *target = *state;
    ms_signed_distance field;
    ms_error err;
    ms_ball ball[8];
    assert_int_equal(ms_signed_distance_open(&field, target, 1, &err), MS_OK);
    ms_surface_fit fit = {.field = &field, .bounds = {.least = 0.5, .protrusion = 1.5}};
    for (int b = 0; b < 8; b++) {
        do {
            for (int a = 0; a < 3; a++) {
                ball[b].centre[a] = uniform(0, target->grid.n[a]);
            }
        } while (ms_signed_distance_at(&field, ball[b].centre) > -2);
        ball[b].radius = 50;
    }
    ms_bounds_confine(&fit.bounds, &field, ball, 8);
    int64_t before = brute_mismatch(&target->grid, ball, 8);
    const int64_t first = before;
    for (int round = 0; round < 6; round++) {
        assert_int_equal(ms_pattern_search(ball, 8, &target->grid, &fit, 1, &err), MS_OK);
        const int64_t after = brute_mismatch(&target->grid, ball, 8);
        assert_true(after <= before);
        before = after;
        for (int b = 0; b < 8; b++) {
            assert_true(ball[b].radius <= ms_bounds_most_radius(&fit.bounds, &field, ball[b].centre) + 1e-9);
        }
    }
    assert_true(before < first);
}

/* Places of each level that lie in no other sphere, and no others. */
static void exposed_places_are_those_of_brute_force(void **state)
{
    (void)state;
    enum { BALLS = 40 };
    ms_lattice lattice;
    ms_exposed exposed;
    ms_error err;
    ms_caps_window window;
    assert_int_equal(ms_lattice_alloc(&lattice, 192, &err), MS_OK);
    assert_true(ms_caps_window_alloc(&window, BALLS));
    ms_ball *ball = window.ball;
    window.count = BALLS;
    assert_true(ms_exposed_alloc(&exposed, &lattice, BALLS));
    for (int t = 0; t < 60; t++) {
        const int level = t % MS_LATTICE_LEVELS;
        for (int b = 0; b < BALLS; b++) {
            ball[b] = (ms_ball){{uniform(0, 6), uniform(0, 6), uniform(0, 6)}, uniform(0.1, 3)};
        }
        ms_caps_sort(&window);
        ms_lattice_turn(&lattice, (unsigned long)t);
        for (uint32_t self = 0; self < BALLS; self++) {
            assert_int_equal(ms_exposed_find(&exposed, &lattice, &window, self, level, 0), level);
            int count = 0, near = 0;
            for (int p = 0; p < lattice.level[level].points; p++) {
                double u[3], place[3], least = HUGE_VAL;
                ms_lattice_normal(u, &lattice, lattice.level[level].direction[p]);
                for (int c = 0; c < 3; c++) {
                    place[c] = ball[self].centre[c] + ball[self].radius * u[c];
                }
                for (uint32_t b = 0; b < BALLS; b++) {
                    const double away = sqrt(ms_squared_distance(place, ball[b].centre)) - ball[b].radius;
                    least = b == self ? least : fmin(least, away);
                }
                count += least > 0;
                near += fabs(least) < 1e-5; /* floats may say either */
            }
            assert_true(abs(exposed.count - count) <= near);
        }
    }
    ms_exposed_free(&exposed);
    ms_caps_window_free(&window);
    ms_lattice_free(&lattice);
}

/* Of balls about as large as the shape, against the volumes of caps and shells. */
static void tally_is_the_volume(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_signed_distance field;
    ms_lattice lattice;
    ms_error err;
    make_shape(&mesh, "ball", "r=1 fineness=120");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    assert_int_equal(ms_signed_distance_open(&field, &target, 1, &err), MS_OK);
    assert_int_equal(ms_lattice_alloc(&lattice, 512, &err), MS_OK);
    field.cubic = 1;
    const ms_surface_fit fit = {.field = &field, .lattice = &lattice};
    const double h = target.grid.h, cell = h * h * h, pi = acos(-1.0);
    ms_surface_worth worth[2];
    double mismatch, alone;
    const ms_sphere smaller = {.radius = 0.99}, beside = {.centre = {0.05, 0, 0}, .radius = 0.99};
    ms_ball ball[2] = {ms_grid_ball(&target.grid, &smaller), ms_grid_ball(&target.grid, &beside)};
    assert_int_equal(ms_surface_tally(worth, &mismatch, NULL, &fit, ball, 1, &err), MS_OK);
    assert_true(fabs(mismatch * cell / (4 * pi * 0.99 * 0.99 * 0.01) - 1) < 0.03);
    assert_true(fabs(worth[0].loss * cell / (4 * pi / 3 * 0.99 * 0.99 * 0.99) - 1) < 0.01);
    /* Moved by d, a lune of pi r^2 d - pi d^3 / 12 is added: what lies outside of the shape, all but the shell between,
     * counts against it. */
    assert_int_equal(ms_surface_tally(worth, &mismatch, NULL, &fit, ball, 2, &err), MS_OK);
    assert_int_equal(ms_surface_tally(NULL, &alone, NULL, &fit, ball, 2, &err), MS_OK);
    assert_true(alone == mismatch);
    ms_surface_worth some[2] = {{-7, -7}};
    assert_int_equal(ms_surface_tally(some, NULL, (const uint8_t[]){0, 1}, &fit, ball, 2, &err), MS_OK);
    assert_true(some[0].loss == -7 && some[0].mismatch == -7 && some[1].loss == worth[1].loss);
    const double lune = pi * (0.99 * 0.99 * 0.05 - 0.05 * 0.05 * 0.05 / 12);
    assert_true(-worth[1].loss * cell < lune && -worth[1].loss * cell > lune - 2 * 2 * pi * 0.01);
    assert_true(worth[0].loss * cell > 0.95 * lune && worth[0].loss * cell < 1.01 * lune);
    ms_lattice_free(&lattice);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exposed_places_are_those_of_brute_force),
        cmocka_unit_test(tally_is_the_volume),
        cmocka_unit_test(field_is_the_distance),
        cmocka_unit_test(field_is_kept_with_its_target),
        cmocka_unit_test(losses_are_those_of_brute_force),
        cmocka_unit_test(spheres_are_dropped_by_their_loss),
        cmocka_unit_test(step_lowers_the_mismatch),
        cmocka_unit_test(held_spheres_stay),
        cmocka_unit_test(worst_sphere_is_split),
        cmocka_unit_test(nearest_spheres_are_marked),
        cmocka_unit_test(search_never_raises_the_mismatch),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
