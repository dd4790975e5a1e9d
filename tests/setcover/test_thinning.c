/* Thinning: topology by brute force, algorithm 1 on whole grids, places by analysis. */
#include "setcover/ms_clique.h"
#include "setcover/ms_thinning.h"
#include "support/topology_samples.h"

static const ms_skeleton both_kinds[] = {MS_SKELETON_SURFACE, MS_SKELETON_CURVE};

static ms_grid thinned(const ms_grid *grid, ms_skeleton kind)
{
    ms_grid skeleton = copy_of(grid);
    ms_error err = {{0}};
    if (ms_thinning(skeleton.inside, skeleton.n, kind, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return skeleton;
}

static int is_end(const ms_grid *grid, const int at[3], ms_skeleton kind)
{
    if (count_neighbours(grid, at, BY_FACES) == 6) {
        return 0;
    }
    if (kind == MS_SKELETON_CURVE) {
        return count_neighbours(grid, at, BY_CORNERS) == 1;
    }
    for (int face = 0; face < 6; face++) {
        int beside[3] = {at[0], at[1], at[2]};
        beside[face / 2] += face % 2 ? 1 : -1;
        if (inside_at(grid, beside[0], beside[1], beside[2]) && count_neighbours(grid, beside, BY_FACES) == 6) {
            return 0;
        }
    }
    return 1;
}

/* A subset of the grid in which none but ends could be removed. */
static void expect_thin(const ms_grid *skeleton, const ms_grid *grid, ms_skeleton kind)
{
    for (size_t v = 0; v < ms_grid_voxels(skeleton); v++) {
        int at[3];
        assert_true(skeleton->inside[v] <= grid->inside[v]);
        place_of(at, skeleton, v);
        if (skeleton->inside[v] && !is_end(skeleton, at, kind) &&
            brute_is_simple(neighbours_at(skeleton, skeleton->inside, at[0], at[1], at[2]))) {
            fail_msg("voxel (%d, %d, %d) is simple and no end", at[0], at[1], at[2]);
        }
    }
}

/* Both skeletons of a set: all that must hold of any. Returns its topology. */
static topology expect_skeletons(const ms_grid *grid)
{
    const topology before = topology_of(grid);
    for (int kind = 0; kind < 2; kind++) {
        ms_grid skeleton = thinned(grid, both_kinds[kind]);
        const topology after = topology_of(&skeleton);
        if (after.pieces != before.pieces || after.cavities != before.cavities || after.tunnels != before.tunnels) {
            fail_msg("%dx%dx%d, kind %d: pieces %d to %d, cavities %d to %d, tunnels %ld to %ld", grid->n[0],
                     grid->n[1], grid->n[2], kind, before.pieces, after.pieces, before.cavities, after.cavities,
                     before.tunnels, after.tunnels);
        }
        expect_thin(&skeleton, grid, both_kinds[kind]);
        ms_grid_free(&skeleton);
    }
    return before;
}

static void known_bodies_keep_their_topology(void **state)
{
    (void)state;
    const struct {
        level body;
        double value[3];
        topology expected;
    } bodies[] = {
        {ellipsoid, {9.6, 9.6, 9.6}, {1, 0, 0}}, {ellipsoid, {13.3, 9.1, 4.7}, {1, 0, 0}},
        {torus, {9.2, 3.7}, {1, 0, 1}},          {torus, {9.2, 1.1}, {1, 0, 1}},
        {joined_tori, {6.1, 2.6}, {1, 0, 2}},    {linked_rings, {8.2, 2.3}, {2, 0, 2}},
        {shell, {12.7, 6.2}, {1, 1, 0}},         {shell, {12.7, 10.4}, {1, 1, 0}},
        {cylinder, {11.2, 6.3, 1}, {1, 0, 0}},   {cuboid_level, {12.2, 8.6, 3.1}, {1, 0, 0}},
    };
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; b++) {
        for (int odd = 0; odd < 2; odd++) {
            const int n[3] = {34 + odd, 34 + odd, 34 + odd};
            ms_grid grid = body_grid(n, bodies[b].body, bodies[b].value);
            const topology got = expect_skeletons(&grid);
            assert_int_equal(got.pieces, bodies[b].expected.pieces);
            assert_int_equal(got.cavities, bodies[b].expected.cavities);
            assert_int_equal(got.tunnels, bodies[b].expected.tunnels);
            ms_grid_free(&grid);
        }
    }
}

static void random_blobs_keep_their_topology(void **state)
{
    (void)state;
    uint64_t seed = 41;
    topology most = {0, 0, 0};
    for (int run = 0; run < 150; run++) {
        ms_grid grid = random_blobs(16, 28, &seed);
        const topology got = expect_skeletons(&grid);
        most.pieces += got.pieces;
        most.cavities += got.cavities;
        most.tunnels += got.tunnels;
        ms_grid_free(&grid);
    }
    assert_true(most.pieces > 500 && most.cavities > 500 && most.tunnels > 500); /* or nothing has been tested */
}

static void noise_keeps_its_topology(void **state)
{
    (void)state;
    uint64_t seed = 42;
    for (int run = 0; run < 120; run++) {
        const int percent[] = {2, 10, 20, 35, 50, 65, 80, 90, 95, 98};
        ms_grid grid =
            noise(10 + pick(&seed, 8), 10 + pick(&seed, 8), 10 + pick(&seed, 8), percent[run % 10] / 100.0, &seed);
        expect_skeletons(&grid);
        ms_grid_free(&grid);
    }
}

/* One step of algorithm 1 that chooses voxels: the critical cliques of a rank, free of chosen voxels. */
static void choose(uint8_t *is_free, const ms_grid *x, int rank)
{
    const size_t voxels = ms_grid_voxels(x);
    uint8_t *chosen = calloc(voxels, 1);
    assert_non_null(chosen);
    for (size_t v = 0; v < voxels; v++) {
        if (is_free[v]) {
            int at[3];
            place_of(at, x, v);
            const uint32_t object = neighbours_at(x, x->inside, at[0], at[1], at[2]);
            chosen[v] =
                (uint8_t)(rank == 3 ? !brute_is_simple(object)
                                    : ms_clique_keeps(object, neighbours_at(x, is_free, at[0], at[1], at[2]), rank));
        }
    }
    for (size_t v = 0; v < voxels; v++) {
        is_free[v] &= !chosen[v];
    }
    free(chosen);
}

/* Algorithm 1, line by line, all voxels at each line: no lists of what may have changed. */
static void reference_thinning(ms_grid *x, ms_skeleton kind)
{
    const size_t voxels = ms_grid_voxels(x);
    uint8_t *kept = calloc(voxels, 1), *is_free = malloc(voxels);
    assert_non_null(kept);
    assert_non_null(is_free);
    for (int again = 1; again;) {
        again = 0;
        for (size_t v = 0; v < voxels; v++) {
            is_free[v] = x->inside[v] & !kept[v];
        }
        for (int rank = 3; rank >= 0; rank--) {
            choose(is_free, x, rank);
        }
        for (size_t v = 0; v < voxels; v++) {
            again |= is_free[v];
            x->inside[v] &= !is_free[v];
        }
        for (size_t v = 0; v < voxels; v++) {
            int at[3];
            place_of(at, x, v);
            kept[v] |= x->inside[v] && is_end(x, at, kind);
        }
    }
    free(kept);
    free(is_free);
}

static void expect_reference(const ms_grid *grid)
{
    for (int kind = 0; kind < 2; kind++) {
        ms_grid got = thinned(grid, both_kinds[kind]), expected = copy_of(grid);
        reference_thinning(&expected, both_kinds[kind]);
        assert_true(same_voxels(&got, &expected));
        ms_grid_free(&got);
        ms_grid_free(&expected);
    }
}

static void layers_give_what_algorithm_1_gives(void **state)
{
    (void)state;
    uint64_t seed = 43;
    for (int run = 0; run < 60; run++) {
        ms_grid grid = run % 3 ? random_blobs(10, 22, &seed) : noise(12, 9, 11, between(&seed, 0.1, 0.99), &seed);
        expect_reference(&grid);
        ms_grid_free(&grid);
    }
    for (int size = 19; size < 21; size++) {
        const int n[3] = {size, size, size};
        ms_grid ball = body_grid(n, ellipsoid, (double[]){8.3, 8.3, 8.3});
        expect_reference(&ball);
        ms_grid_free(&ball);
    }
}

static void threads_change_nothing(void **state)
{
    (void)state;
    uint64_t seed = 44;
    const int before = omp_get_max_threads(), threads[] = {1, 2, 5}, n[3] = {64, 60, 56};
    ms_grid grid[2] = {body_grid(n, ellipsoid, (double[]){30.7, 28.4, 26.5}), blobs(n, 2, 0, &seed)};
    for (int g = 0; g < 2; g++) {
        for (int kind = 0; kind < 2; kind++) {
            ms_grid got[3];
            for (int t = 0; t < 3; t++) {
                omp_set_num_threads(threads[t]);
                got[t] = thinned(&grid[g], both_kinds[kind]);
                assert_true(same_voxels(&got[0], &got[t]));
            }
            for (int t = 0; t < 3; t++) {
                ms_grid_free(&got[t]);
            }
        }
        ms_grid_free(&grid[g]);
    }
    omp_set_num_threads(before);
}

/* The difference of the two shortest of the six ways out. */
static int excess(const int way[6])
{
    const int least = least_of(way, 6);
    int second = 9999, equal = 0;
    for (int face = 0; face < 6; face++) {
        equal += way[face] == least;
        second = way[face] > least && way[face] < second ? way[face] : second;
    }
    return equal > 1 ? 0 : second - least;
}

/* Each step takes what lies at a face of the background, so that the distance that counts is the
 * city-block one. In a convex body symmetric as these are it is the shortest way out along an axis,
 * and the skeleton must lie where two of the six are equal, or differ by 1 between even layers.
 * (In a box that is the medial surface; in a ball it is six planes and not the centre.) In the
 * flat middle, where only the ways up and down are short, it must be complete. */
static void expect_medial(const ms_grid *grid)
{
    ms_grid skeleton = thinned(grid, MS_SKELETON_SURFACE);
    for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
        int at[3], way[6];
        if (!grid->inside[v]) {
            continue;
        }
        place_of(at, grid, v);
        ways_out(way, grid, at);
        if (skeleton.inside[v] && excess(way) > 1) {
            fail_msg("voxel (%d, %d, %d): two ways out differ by %d", at[0], at[1], at[2], excess(way));
        }
        if (at[2] == grid->n[2] / 2 && least_of(way, 4) > least_of(way + 4, 2) + 1 && !skeleton.inside[v] &&
            !inside_at(&skeleton, at[0], at[1], at[2] - 1)) {
            fail_msg("no voxel in the middle at (%d, %d)", at[0], at[1]);
        }
    }
    ms_grid_free(&skeleton);
}

static void convex_bodies_thin_to_where_two_ways_out_are_equal(void **state)
{
    (void)state;
    const struct {
        level body;
        double value[3];
    } bodies[] = {
        {ellipsoid, {19.7, 19.7, 8.3}}, {ellipsoid, {12.4, 12.4, 12.4}}, {ellipsoid, {8.2, 10.6, 20.4}},
        {ellipsoid, {21.3, 14.2, 6.1}}, {cylinder, {4.6, 18.3, 2}},      {cuboid_level, {20.2, 15.2, 4.2}},
    };
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; b++) {
        for (int odd = 0; odd < 8; odd++) { /* each axis by itself */
            const int n[3] = {44 + (odd & 1), 44 + (odd >> 1 & 1), 44 + (odd >> 2)};
            ms_grid grid = body_grid(n, bodies[b].body, bodies[b].value);
            expect_medial(&grid);
            ms_grid_free(&grid);
        }
    }
}

/* Layer by layer a box is a box again, whose edges are ends of surfaces; and so is all of a box that
 * is one or two voxels thick. Only the outermost layer has no ends: K is empty at first. */
static int is_of_box_skeleton(const int way[6], int thickness)
{
    const int least = least_of(way, 6);
    int edge = 0;
    for (int axis = 0; axis < 3; axis++) {
        edge += least_of(way + 2 * axis, 2) == least;
    }
    return least > 1 && (edge > 1 || thickness - 2 * (least - 1) <= 2);
}

static void a_box_thins_to_the_edges_of_the_boxes_within(void **state)
{
    (void)state;
    const int sizes[][3] = {{30, 24, 7}, {30, 24, 8}, {31, 25, 6}, {7, 31, 24}, {20, 20, 20}, {21, 21, 21}, {9, 40, 9}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const int *side = sizes[s], n[3] = {side[0] + 2, side[1] + 2, side[2] + 2};
        ms_grid box = body_grid(n, cuboid_level, (double[]){0.5 * side[0], 0.5 * side[1], 0.5 * side[2]});
        ms_grid skeleton = thinned(&box, MS_SKELETON_SURFACE);
        for (size_t v = 0; v < ms_grid_voxels(&box); v++) {
            int at[3], way[6];
            place_of(at, &box, v);
            ways_out(way, &box, at);
            assert_int_equal(skeleton.inside[v], box.inside[v] && is_of_box_skeleton(way, least_of(side, 3)));
        }
        ms_grid_free(&box);
        ms_grid_free(&skeleton);
    }
}

/* In the middle plane the skeleton is complete within that radius (one of two layers if they are even). */
static void expect_disc(const ms_grid *skeleton, double radius)
{
    const size_t layer = (size_t)skeleton->n[0] * (size_t)skeleton->n[1];
    for (size_t v = layer; v < ms_grid_voxels(skeleton); v++) {
        double p[3];
        from_middle(p, skeleton, v);
        if (p[2] >= 0 && p[2] < 0.6 && hypot(p[0], p[1]) < radius) {
            assert_true(skeleton->inside[v] || (p[2] > 0 && skeleton->inside[v - layer]));
        }
    }
}

/* The medial surface of a spheroid is a disc in its middle plane, of radius (a^2 - c^2) / a. By the
 * city-block distance it parts into sheets already at a (a^2 - c^2) / (a^2 + c^2), where the way out
 * is as long to the side as upwards, so that some voxels lie off the plane: of a flat spheroid's
 * less than a fourth lie more than a voxel off, none more than 0.4 c. */
static void a_flat_spheroid_thins_to_its_focal_disc(void **state)
{
    (void)state;
    const double axes[][2] = {{20, 8}, {20.4, 6.3}, {30.3, 10.2}};
    for (int run = 0; run < 6; run++) {
        const double a = axes[run / 2][0], c = axes[run / 2][1], disc = (a * a - c * c) / a;
        const int side = 64 + run % 2, n[3] = {side, side, side};
        ms_grid grid = body_grid(n, ellipsoid, (double[]){a, a, c}), skeleton = thinned(&grid, MS_SKELETON_SURFACE);
        int astray = 0;
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            double p[3];
            from_middle(p, &grid, v);
            const double off = hypot(fmax(0, hypot(p[0], p[1]) - disc), p[2]);
            astray += skeleton.inside[v] && off > 1;
            assert_true(!skeleton.inside[v] || off < 0.4 * c);
        }
        assert_true(astray < 0.25 * (double)ms_grid_count(&skeleton));
        expect_disc(&skeleton, a * (a * a - c * c) / (a * a + c * c) - 1);
        ms_grid_free(&grid);
        ms_grid_free(&skeleton);
    }
}

/* A line within a voxel of the axis, one voxel in each plane, its ends as far from the middle as `tip`. */
static void expect_axis(const ms_grid *grid, int axis, double tip, double tolerance)
{
    ms_grid skeleton = thinned(grid, MS_SKELETON_CURVE);
    double farthest[2] = {0, 0};
    int count = 0;
    for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
        if (skeleton.inside[v]) {
            double p[3];
            from_middle(p, grid, v);
            assert_true(hypot(p[(axis + 1) % 3], p[(axis + 2) % 3]) < 1);
            farthest[0] = fmax(farthest[0], -p[axis]);
            farthest[1] = fmax(farthest[1], p[axis]);
            count++;
        }
    }
    expect_close(count, farthest[0] + farthest[1] + 1, 1e-9);
    expect_close(farthest[0], tip, tolerance);
    expect_close(farthest[1], tip, tolerance);
    ms_grid_free(&skeleton);
}

/* The axis begins where the way out along it is as long as the way to the side: at c (c^2 - a^2) /
 * (c^2 + a^2), and in a cylinder a radius below its end; give or take two voxels, for both ways are
 * whole numbers. The focal points, (c^2 - a^2) / c, lie farther out. */
static void long_bodies_thin_to_their_axis(void **state)
{
    (void)state;
    const double sizes[][2] = {{8, 20}, {10.2, 30.3}, {6, 30}, {14, 20}};
    for (int run = 0; run < 24; run++) {
        const int axis = run % 3, side = 66 + run / 3 % 2, n[3] = {side, side, side};
        const double a = sizes[run / 6][0], c = sizes[run / 6][1];
        double axes[3] = {a, a, a};
        axes[axis] = c;
        ms_grid spheroid = body_grid(n, ellipsoid, axes);
        expect_axis(&spheroid, axis, c * (c * c - a * a) / (c * c + a * a), 2);
        ms_grid rod = body_grid(n, cylinder, (double[]){c, 0.7 * a, axis});
        expect_axis(&rod, axis, c - 0.7 * a, 2);
        ms_grid_free(&spheroid);
        ms_grid_free(&rod);
    }
}

static void balls_thin_to_their_centre_and_rings_to_their_circle(void **state)
{
    (void)state;
    for (int run = 0; run < 20; run++) {
        const int side = 44 + run % 2, n[3] = {side, side, side};
        const double radius = 3.3 + 0.8 * run, ring[] = {9.2 + 0.4 * (run / 2), 1.1 + 0.5 * (run / 2)};
        ms_grid grid[2] = {body_grid(n, ellipsoid, (double[]){radius, radius, radius}), body_grid(n, torus, ring)};
        for (int g = 0; g < 2; g++) {
            ms_grid skeleton = thinned(&grid[g], MS_SKELETON_CURVE);
            assert_true(g == 1 || ms_grid_count(&skeleton) == 1);
            for (size_t v = 0; v < ms_grid_voxels(&skeleton); v++) {
                double p[3];
                from_middle(p, &skeleton, v);
                const double far = g == 0 ? hypot(hypot(p[0], p[1]), p[2]) : torus(p, ring) + ring[1];
                assert_true(!skeleton.inside[v] || far < 1.25); /* a voxel, and what the lattice is off */
            }
            ms_grid_free(&skeleton);
            ms_grid_free(&grid[g]);
        }
    }
}

/* Nothing is an end in the first step; then all is that is left. */
static void lines_and_plates_lose_their_rim(void **state)
{
    (void)state;
    const int sizes[][3] = {{1, 1, 1}, {9, 1, 1}, {1, 9, 1}, {1, 1, 9}, {9, 7, 1}, {1, 8, 6}, {5, 1, 4}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const int *side = sizes[s], n[3] = {side[0] + 4, side[1] + 4, side[2] + 4};
        double half[3], smaller[3];
        for (int a = 0; a < 3; a++) {
            half[a] = 0.5 * side[a];
            smaller[a] = side[a] > 1 ? half[a] - 1 : half[a];
        }
        ms_grid grid = body_grid(n, cuboid_level, half), expected = body_grid(n, cuboid_level, smaller);
        for (int kind = 0; kind < (side[0] * side[1] * side[2] > 9 ? 1 : 2); kind++) {
            ms_grid skeleton = thinned(&grid, both_kinds[kind]);
            assert_true(same_voxels(&skeleton, &expected));
            ms_grid_free(&skeleton);
        }
        ms_grid_free(&grid);
        ms_grid_free(&expected);
    }
}

static void a_voxel_on_the_rim_is_refused(void **state)
{
    (void)state;
    const int rim[][3] = {{0, 2, 2}, {5, 2, 2}, {2, 0, 2}, {2, 4, 2}, {2, 2, 0}, {2, 2, 6}, {0, 0, 0}, {5, 4, 6}};
    for (size_t r = 0; r < sizeof rim / sizeof *rim; r++) {
        for (int kind = 0; kind < 2; kind++) {
            ms_grid grid = empty_grid(6, 5, 7, 1);
            ms_error err = {{0}};
            grid.inside[ms_grid_index(&grid, 3, 2, 3)] = 1;
            grid.inside[ms_grid_index(&grid, rim[r][0], rim[r][1], rim[r][2])] = 1;
            assert_int_equal(ms_thinning(grid.inside, grid.n, both_kinds[kind], &err), MS_ERR_ARG);
            expect_message(&err, "inside");
            assert_int_equal(ms_thinning(grid.inside, grid.n, both_kinds[kind], NULL), MS_ERR_ARG);
            ms_grid_free(&grid);
        }
    }
}

static void small_and_empty_grids(void **state)
{
    (void)state;
    for (int size = 0; size < 64; size++) {
        const int n[3] = {1 + size % 4, 1 + size / 4 % 4, 1 + size / 16};
        uint8_t inside[64] = {0}, empty[64] = {0};
        const int voxels = n[0] * n[1] * n[2], thin = n[0] < 3 || n[1] < 3 || n[2] < 3;
        for (int kind = 0; kind < 2; kind++) {
            assert_int_equal(ms_thinning(inside, n, both_kinds[kind], NULL), MS_OK);
            assert_memory_equal(inside, empty, sizeof empty);
        }
        for (int v = 0; thin && v < voxels; v++) { /* all voxels are on the rim */
            memset(inside, 0, sizeof inside);
            inside[v] = 1;
            assert_int_equal(ms_thinning(inside, n, MS_SKELETON_CURVE, NULL), MS_ERR_ARG);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_bodies_keep_their_topology),
        cmocka_unit_test(random_blobs_keep_their_topology),
        cmocka_unit_test(noise_keeps_its_topology),
        cmocka_unit_test(layers_give_what_algorithm_1_gives),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(convex_bodies_thin_to_where_two_ways_out_are_equal),
        cmocka_unit_test(a_box_thins_to_the_edges_of_the_boxes_within),
        cmocka_unit_test(a_flat_spheroid_thins_to_its_focal_disc),
        cmocka_unit_test(long_bodies_thin_to_their_axis),
        cmocka_unit_test(balls_thin_to_their_centre_and_rings_to_their_circle),
        cmocka_unit_test(lines_and_plates_lose_their_rim),
        cmocka_unit_test(a_voxel_on_the_rim_is_refused),
        cmocka_unit_test(small_and_empty_grids),
    };
    omp_set_num_threads(1); /* small grids */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
