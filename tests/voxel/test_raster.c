/* Unions of balls on a grid against brute force. */
#include "clump/ms_clump.h"
#include "support/grid_samples.h"
#include "voxel/ms_raster.h"

static const ms_voxel_rule both_rules[] = {MS_VOXEL_HALF, MS_VOXEL_CENTRE};

static ms_raster raster_of(const ms_grid *grid, ms_voxel_rule rule)
{
    ms_raster raster;
    assert_int_equal(ms_raster_alloc(&raster, grid, rule, NULL), MS_OK);
    return raster;
}

static void add_balls(ms_raster *raster, const ms_ball *balls, size_t count)
{
    ms_error err = {{0}};
    if (ms_raster_add(raster, balls, count, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
}

static int in_ball(const ms_ball *ball, double x, double y, double z)
{
    x -= ball->centre[0];
    y -= ball->centre[1];
    z -= ball->centre[2];
    return x * x + y * y + z * z <= ball->radius * ball->radius;
}

/* The first ball with which the union covers the voxel, by its centre or by 4x4x4 points (the
 * centre is a 65th that matters where just half of the others are covered). */
static int brute_first(const ms_ball *balls, int count, ms_voxel_rule rule, int i, int j, int k)
{
    int covered[65] = {0}, sum = 0;
    for (int b = 0; b < count; b++) {
        for (int p = rule == MS_VOXEL_HALF ? 0 : 64; p < 65; p++) {
            const double x = p < 64 ? i + (p % 4 - 1.5) / 4 : i, y = p < 64 ? j + (p / 4 % 4 - 1.5) / 4 : j;
            const double z = p < 64 ? k + (p / 16 - 1.5) / 4 : k;
            if (!covered[p] && in_ball(&balls[b], x, y, z)) {
                covered[p] = 1;
                sum++;
            }
        }
        if (sum > (rule == MS_VOXEL_HALF ? 32 : 0)) {
            return b;
        }
    }
    return MS_RASTER_NONE;
}

static void expect_first(const ms_raster *raster)
{
    const int *n = raster->grid->n;
    const uint16_t *at = raster->first;
    for (int k = 0; k < n[2]; k++) {
        for (int j = 0; j < n[1]; j++) {
            for (int i = 0; i < n[0]; i++, at++) {
                const int first = brute_first(raster->ball, (int)raster->n_balls, raster->rule, i, j, k);
                if (*at != first) {
                    fail_msg("voxel (%d, %d, %d): first %d and not %d", i, j, k, *at, first);
                }
            }
        }
    }
}

/* The sums of each ball, by one walk over the grid and its first-cover index. */
static void expect_tallies(const ms_raster *raster)
{
    for (size_t b = 0; b < raster->n_balls; b++) {
        ms_tally sum = {0};
        for (size_t v = 0; v < ms_grid_voxels(raster->grid); v++) {
            const int64_t i = (int64_t)v % raster->grid->n[0], j = (int64_t)v / raster->grid->n[0] % raster->grid->n[1];
            const int64_t k = (int64_t)v / raster->grid->n[0] / raster->grid->n[1];
            const ms_tally one = {raster->grid->inside[v] == 1,
                                  raster->grid->inside[v] == 0,
                                  {i, j, k},
                                  {i * i, j * j, k * k, j * k, i * k, i * j},
                                  0};
            if (raster->first[v] == b) {
                ms_tally_add(&sum, &one);
            }
        }
        assert_memory_equal(&sum, &raster->tally[b], sizeof sum);
    }
}

/* The box of the voxels that the balls from `from` on were the first to cover. */
static void expect_box(const ms_raster *raster, size_t from)
{
    int lo[3] = {999, 999, 999}, hi[3] = {0, 0, 0};
    for (size_t v = 0; v < ms_grid_voxels(raster->grid); v++) {
        const int at[3] = {(int)v % raster->grid->n[0], (int)v / raster->grid->n[0] % raster->grid->n[1],
                           (int)v / raster->grid->n[0] / raster->grid->n[1]};
        for (int a = 0; raster->first[v] != MS_RASTER_NONE && raster->first[v] >= from && a < 3; a++) {
            lo[a] = at[a] < lo[a] ? at[a] : lo[a];
            hi[a] = at[a] >= hi[a] ? at[a] + 1 : hi[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        assert_int_equal(raster->hi[a], hi[a]);
        assert_int_equal(raster->lo[a], hi[a] ? lo[a] : 0);
    }
}

static void fill_random(ms_grid *grid, uint64_t *seed)
{
    for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
        grid->inside[v] = next_uniform(seed) < 0.6;
    }
}

static void random_balls(ms_ball *balls, int count, const int n[3], double largest, uint64_t *seed)
{
    for (int b = 0; b < count; b++) {
        for (int a = 0; a < 3; a++) {
            balls[b].centre[a] = between(seed, -2, n[a] + 1);
        }
        balls[b].radius = between(seed, 0.05, largest);
    }
}

static void unions_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 21;
    for (int run = 0; run < 24; run++) {
        ms_grid grid = empty_grid(1 + pick(&seed, 19), 1 + pick(&seed, 14), 1 + pick(&seed, 16), 0.3);
        ms_ball balls[60];
        const int count = 1 + pick(&seed, 60);
        fill_random(&grid, &seed);
        random_balls(balls, count, grid.n, run % 3 ? 2 : 7, &seed);
        ms_raster raster = raster_of(&grid, both_rules[run % 2]);
        add_balls(&raster, balls, (size_t)count);
        expect_first(&raster);
        expect_tallies(&raster);
        expect_box(&raster, 0);
        ms_raster_free(&raster);
        ms_grid_free(&grid);
    }
}

/* Places and radii at quarters: many sample points lie right on the surface of a ball. */
static void balls_on_the_lattice_are_symmetric(void **state)
{
    (void)state;
    for (int r = 0; r < 2; r++) {
        for (double radius = 0.25; radius < 5; radius += 0.25) {
            for (int half = 0; half < 2; half++) {
                const int n = 14 + half;
                ms_grid grid = empty_grid(n, n, n, 1);
                const ms_ball ball = {{0.5 * (n - 1), 0.5 * (n - 1), 0.5 * (n - 1)}, radius};
                ms_raster raster = raster_of(&grid, both_rules[r]);
                add_balls(&raster, &ball, 1);
                expect_first(&raster);
                for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
                    grid.inside[v] = raster.first[v] == 0;
                }
                expect_mirrored(&grid);
                ms_raster_free(&raster);
                ms_grid_free(&grid);
            }
        }
    }
}

/* Adding one by one, or in lots of three, is the same as adding all at once. */
static void the_number_of_calls_does_not_matter(void **state)
{
    (void)state;
    uint64_t seed = 22;
    ms_ball balls[40];
    ms_grid grid = empty_grid(20, 18, 22, 1);
    fill_random(&grid, &seed);
    random_balls(balls, 40, grid.n, 5, &seed);
    for (int r = 0; r < 2; r++) {
        ms_raster whole = raster_of(&grid, both_rules[r]);
        add_balls(&whole, balls, 40);
        for (size_t lot = 1; lot <= 3; lot += 2) {
            ms_raster parts = raster_of(&grid, both_rules[r]);
            for (size_t b = 0; b < 40; b += lot) {
                add_balls(&parts, balls + b, b + lot <= 40 ? lot : 40 - b);
                expect_box(&parts, b);
            }
            add_balls(&parts, NULL, 0);
            assert_int_equal(parts.lo[0], parts.hi[0]);
            assert_memory_equal(parts.first, whole.first, ms_grid_voxels(&grid) * sizeof *whole.first);
            assert_memory_equal(parts.tally, whole.tally, 40 * sizeof *whole.tally);
            ms_raster_free(&parts);
        }
        ms_raster_free(&whole);
    }
    ms_grid_free(&grid);
}

/* MSS 2.3: balls of radius 1/2 on the voxels' centres cover just these voxels. */
static void a_ball_of_half_a_voxel_covers_one_voxel(void **state)
{
    (void)state;
    uint64_t seed = 23;
    for (int r = 0; r < 2; r++) {
        ms_grid grid = empty_grid(9, 8, 7, 1);
        fill_random(&grid, &seed);
        ms_raster raster = raster_of(&grid, both_rules[r]);
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            const ms_ball ball = {{(double)(v % 9), (double)(v / 9 % 8), (double)(v / 72)}, 0.5};
            if (grid.inside[v]) {
                add_balls(&raster, &ball, 1);
            }
        }
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            assert_int_equal(raster.first[v] != MS_RASTER_NONE, grid.inside[v]);
        }
        ms_raster_free(&raster);
        ms_grid_free(&grid);
    }
}

/* The half rule itself: the share of each voxel in the ball, by 20x20x20 points. */
static void the_half_rule_is_near_the_truth(void **state)
{
    (void)state;
    enum { POINTS = 20 };
    ms_grid grid = empty_grid(12, 12, 12, 1);
    const ms_ball ball = {{5.37, 5.81, 5.52}, 4.385};
    ms_raster raster = raster_of(&grid, MS_VOXEL_HALF);
    int wrong = 0;
    add_balls(&raster, &ball, 1);
    for (int v = 0; v < 12 * 12 * 12; v++) {
        int points = 0;
        for (int p = 0; p < POINTS * POINTS * POINTS; p++) {
            points += in_ball(&ball, v % 12 + (p % POINTS + 0.5) / POINTS - 0.5,
                              v / 12 % 12 + (p / POINTS % POINTS + 0.5) / POINTS - 0.5,
                              v / 144 + (p / POINTS / POINTS + 0.5) / POINTS - 0.5);
        }
        const double share = (double)points / (POINTS * POINTS * POINTS);
        const int covered = raster.first[v] == 0;
        assert_true(fabs(share - 0.5) < 0.1 || covered == (share > 0.5));
        wrong += covered != (share > 0.5);
    }
    assert_true(wrong <= 6); /* of some 350 */
    ms_raster_free(&raster);
    ms_grid_free(&grid);
}

static void a_ball_beyond_the_grid_covers_nothing(void **state)
{
    (void)state;
    const ms_ball balls[] = {{{-9, 3, 3}, 2}, {{3, 1e300, 3}, 1}, {{3, 3, 1e9}, 5}, {{3, 3, -7}, 6.4}, {{3, 3, 3}, 0}};
    ms_grid grid = empty_grid(6, 6, 6, 1);
    for (int r = 0; r < 2; r++) {
        ms_raster raster = raster_of(&grid, both_rules[r]);
        add_balls(&raster, balls, 5);
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            assert_int_equal(raster.first[v], MS_RASTER_NONE);
        }
        assert_true(raster.lo[2] == 0 && raster.hi[2] == 0);
        const ms_ball all = {{1e6, 0, 0}, 1e6 + 40};
        add_balls(&raster, &all, 1);
        assert_int_equal(raster.tally[5].outside, 216);
        ms_raster_free(&raster);
    }
    ms_grid_free(&grid);
}

static void expect_refused(ms_raster *raster, const ms_ball *balls, size_t count, ms_status status, const char *message)
{
    ms_error err = {{0}};
    const size_t before = raster->n_balls;
    assert_int_equal(ms_raster_add(raster, balls, count, &err), status);
    expect_message(&err, message);
    assert_int_equal(raster->n_balls, before);
}

static void bad_balls_are_refused(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(3, 3, 3, 1);
    ms_raster raster = raster_of(&grid, MS_VOXEL_HALF);
    const double none = (double)NAN;
    const ms_ball bad[] = {
        {{none, 0, 0}, 1}, {{0, HUGE_VAL, 0}, 1}, {{0, 0, 0}, none}, {{0, 0, 0}, HUGE_VAL}, {{1, 1, 1}, -0.6}};
    for (int b = 0; b < 5; b++) {
        const ms_ball two[] = {{{1, 1, 1}, 1}, bad[b]};
        expect_refused(&raster, two, 2, MS_ERR_ARG, "sphere 2 ");
    }
    ms_ball *many = calloc(MS_CLUMP_MAX_SPHERES + 1, sizeof *many);
    assert_non_null(many);
    expect_refused(&raster, many, MS_CLUMP_MAX_SPHERES + 1, MS_ERR_LIMIT, "65534 spheres");
    add_balls(&raster, many, 1);
    expect_refused(&raster, many, MS_CLUMP_MAX_SPHERES, MS_ERR_LIMIT, "65534 spheres");
    expect_refused(&raster, many, SIZE_MAX, MS_ERR_LIMIT, "65534 spheres");
    free(many);
    ms_raster_free(&raster);
    ms_raster_free(&raster);
    ms_raster_free(NULL);
    ms_grid_free(&grid);
}

/* Balls within others change nothing: all the same prefixes, however many there are. */
static void buried_balls_cover_nothing(void **state)
{
    (void)state;
    uint64_t seed = 5;
    ms_grid grid = empty_grid(24, 24, 24, 1);
    fill_random(&grid, &seed);
    ms_ball *balls = malloc(30000 * sizeof *balls);
    assert_non_null(balls);
    random_balls(balls, 4, grid.n, 8, &seed);
    for (int b = 4; b < 30000; b++) {
        balls[b] = balls[b % 4];
        balls[b].radius *= 1 - 0.2 * (b % 3);
    }
    ms_raster raster = raster_of(&grid, MS_VOXEL_HALF);
    add_balls(&raster, balls, 4);
    expect_first(&raster);
    int64_t covered = 0;
    add_balls(&raster, balls + 4, 29996);
    for (int b = 4; b < 30000; b++) {
        covered += raster.tally[b].inside + raster.tally[b].outside;
    }
    assert_int_equal(covered, 0);
    ms_raster_free(&raster);
    ms_grid_free(&grid);
    free(balls);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    const int before = omp_get_max_threads();
    uint64_t seed = 24;
    ms_ball balls[200];
    ms_grid grid = empty_grid(40, 50, 60, 1);
    fill_random(&grid, &seed);
    random_balls(balls, 200, grid.n, 8, &seed);
    ms_raster raster[3];
    for (int threads = 1; threads <= 3; threads++) {
        omp_set_num_threads(threads);
        raster[threads - 1] = raster_of(&grid, MS_VOXEL_HALF);
        add_balls(&raster[threads - 1], balls, 120);
        add_balls(&raster[threads - 1], balls + 120, 80);
    }
    omp_set_num_threads(before);
    for (int t = 1; t < 3; t++) {
        assert_memory_equal(raster[t].first, raster[0].first, ms_grid_voxels(&grid) * sizeof *raster[0].first);
        assert_memory_equal(raster[t].tally, raster[0].tally, 200 * sizeof *raster[0].tally);
        assert_memory_equal(raster[t].lo, raster[0].lo, sizeof raster[0].lo);
        assert_memory_equal(raster[t].hi, raster[0].hi, sizeof raster[0].hi);
    }
    for (int t = 0; t < 3; t++) {
        ms_raster_free(&raster[t]);
    }
    ms_grid_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(buried_balls_cover_nothing),
        cmocka_unit_test(unions_agree_with_brute_force),
        cmocka_unit_test(balls_on_the_lattice_are_symmetric),
        cmocka_unit_test(the_number_of_calls_does_not_matter),
        cmocka_unit_test(a_ball_of_half_a_voxel_covers_one_voxel),
        cmocka_unit_test(the_half_rule_is_near_the_truth),
        cmocka_unit_test(a_ball_beyond_the_grid_covers_nothing),
        cmocka_unit_test(bad_balls_are_refused),
    };
    omp_set_num_threads(1); /* small grids */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
