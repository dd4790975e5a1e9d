/* The distance transform against brute force and formulas. */
#include "support/grid_samples.h"
#include "voxel/ms_distance.h"

static float *distances(const uint8_t *inside, const int n[3])
{
    float *out = malloc((size_t)n[0] * (size_t)n[1] * (size_t)n[2] * sizeof *out);
    assert_non_null(out);
    assert_int_equal(ms_distance(out, inside, n, NULL), MS_OK);
    return out;
}

/* The nearest background voxel of all: the root of the least sum of squares. */
static float brute_distance(const uint8_t *inside, const int n[3], int i, int j, int k)
{
    long least = -1;
    const uint8_t *at = inside;
    for (int z = 0; z < n[2]; z++) {
        for (int y = 0; y < n[1]; y++) {
            for (int x = 0; x < n[0]; x++, at++) {
                const long square = (long)(x - i) * (x - i) + (long)(y - j) * (y - j) + (long)(z - k) * (z - k);
                least = !*at && (least < 0 || square < least) ? square : least;
            }
        }
    }
    return least < 0 ? (float)HUGE_VAL : sqrtf((float)least);
}

static void expect_brute(const uint8_t *inside, const int n[3])
{
    float *got = distances(inside, n), *at = got;
    for (int k = 0; k < n[2]; k++) {
        for (int j = 0; j < n[1]; j++) {
            for (int i = 0; i < n[0]; i++, at++) {
                const float expected = brute_distance(inside, n, i, j, k);
                if (*at != expected) {
                    fail_msg("voxel (%d, %d, %d) of %dx%dx%d: %.9g and not %.9g", i, j, k, n[0], n[1], n[2],
                             (double)*at, (double)expected);
                }
            }
        }
    }
    free(got);
}

static void fill_random(uint8_t *inside, const int n[3], double density, uint64_t *seed)
{
    const size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    for (size_t v = 0; v < voxels; v++) {
        inside[v] = next_uniform(seed) < density;
    }
}

static void every_small_size_agrees_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 1;
    uint8_t inside[9 * 7 * 5];
    for (int size = 0; size < 9 * 7 * 5; size++) {
        const int n[3] = {1 + size % 9, 1 + size / 9 % 7, 1 + size / 63};
        const double density[] = {0, 0.5, 0.9, 0.98, 1};
        for (int d = 0; d < 5; d++) {
            fill_random(inside, n, density[d], &seed);
            expect_brute(inside, n);
        }
    }
}

static void random_sizes_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 2;
    uint8_t *inside = malloc(40 * 40 * 40);
    assert_non_null(inside);
    for (int run = 0; run < 300; run++) {
        /* One axis in ten is long: blocks of lines are 16 wide. */
        int n[3];
        for (int a = 0; a < 3; a++) {
            n[a] = 1 + pick(&seed, pick(&seed, 10) ? 9 : 39);
        }
        fill_random(inside, n, 1 - pow(10, -between(&seed, 0, 3)), &seed);
        expect_brute(inside, n);
    }
    free(inside);
}

/* The blocks wanted are as the transform of all of the grid has them; the others are left as they are. */
static void blocks_agree_with_the_whole(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int round = 0; round < 300; round++) {
        int n[3];
        for (int a = 0; a < 3; a++) {
            n[a] = 1 + (int)((a == 0 ? 70 : 40) * next_uniform(&seed));
        }
        const size_t rows = (size_t)n[1] * (size_t)n[2], voxels = rows * (size_t)n[0];
        const size_t blocks = ((size_t)n[0] + MS_DISTANCE_BLOCK - 1) / MS_DISTANCE_BLOCK;
        uint8_t *inside = malloc(voxels), *wanted = malloc(rows * blocks);
        float *got = malloc(voxels * sizeof *got);
        assert_true(inside && wanted && got);
        fill_random(inside, n, (const double[]){0.9, 0.999, 1}[round % 3], &seed);
        for (size_t b = 0; b < rows * blocks; b++) { /* from a few to all but a few */
            wanted[b] = next_uniform(&seed) < pow(0.01, round % 7 / 6.);
        }
        float *whole = distances(inside, n);
        for (size_t v = 0; v < voxels; v++) {
            got[v] = -1;
        }
        assert_int_equal(ms_distance_blocks(got, inside, n, wanted, NULL), MS_OK);
        for (size_t v = 0; v < voxels; v++) {
            const size_t block = v / (size_t)n[0] * blocks + v % (size_t)n[0] / MS_DISTANCE_BLOCK;
            assert_true(got[v] == (wanted[block] ? whole[v] : -1));
        }
        free(whole);
        free(got);
        free(wanted);
        free(inside);
    }
}

static void blocks_of_no_grid_are_refused(void **state)
{
    (void)state;
    const int zero[3] = {3, 0, 3};
    const uint8_t none[1] = {0};
    float out[1];
    ms_error err;
    assert_int_equal(ms_distance_blocks(out, none, zero, none, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "extent 0 along y"));
}

static void one_background_voxel_gives_the_distance_from_it(void **state)
{
    (void)state;
    const int sizes[][3] = {{2000, 1, 1}, {1, 2000, 1}, {1, 1, 2000}, {300, 1, 40}, {17, 33, 65}, {1, 300, 40}};
    uint64_t seed = 4;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const int *n = sizes[s];
        const size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
        uint8_t *inside = malloc(voxels);
        assert_non_null(inside);
        memset(inside, 1, voxels);
        const int p[3] = {pick(&seed, n[0]), pick(&seed, n[1]), pick(&seed, n[2])};
        inside[(size_t)p[0] + (size_t)n[0] * ((size_t)p[1] + (size_t)n[1] * (size_t)p[2])] = 0;
        float *got = distances(inside, n);
        for (size_t v = 0; v < voxels; v++) {
            const double x = (double)(v % n[0]) - p[0], y = (double)(v / n[0] % n[1]) - p[1];
            const double z = (double)(v / n[0] / n[1]) - p[2];
            assert_true(got[v] == (float)sqrt(x * x + y * y + z * z));
        }
        free(got);
        free(inside);
    }
}

/* Squares up to 1e9: beyond the whole numbers that a float holds. */
static void the_longest_lines_are_exact(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        int n[3] = {1, 1, 1};
        n[axis] = MS_GRID_MAX_EXTENT;
        uint8_t *inside = malloc(MS_GRID_MAX_EXTENT);
        assert_non_null(inside);
        memset(inside, 1, MS_GRID_MAX_EXTENT);
        inside[0] = 0;
        float *got = distances(inside, n);
        for (int v = 0; v < MS_GRID_MAX_EXTENT; v++) {
            assert_true(got[v] == (float)v);
        }
        free(got);
        free(inside);
    }
}

static void any_nonzero_byte_is_inside(void **state)
{
    (void)state;
    const int n[3] = {5, 1, 1};
    const uint8_t inside[5] = {0, 2, 255, 7, 0}, all[5] = {2, 3, 4, 5, 6};
    const float expected[5] = {0, 1, 2, 1, 0};
    float *got = distances(inside, n);
    assert_memory_equal(got, expected, sizeof expected);
    free(got);
    got = distances(all, n);
    for (int v = 0; v < 5; v++) {
        assert_true(isinf(got[v]));
    }
    free(got);
}

static void bad_extents_are_refused(void **state)
{
    (void)state;
    const int bad[][3] = {{0, 1, 1}, {1, -1, 1}, {1, 1, 32768}};
    for (int b = 0; b < 3; b++) {
        float out[1];
        ms_error err = {{0}};
        assert_int_equal(ms_distance(out, (const uint8_t[]){1}, bad[b], &err), MS_ERR_ARG);
        expect_message(&err, "grid extent");
    }
}

static void threads_change_nothing(void **state)
{
    (void)state;
    const int before = omp_get_max_threads();
    ms_mesh body = make_body("torus", (double[]){1.5, 0.6, 20});
    ms_grid grid = voxels_of(&body, 0.05, MS_VOXEL_HALF);
    float *got[3];
    for (int threads = 1; threads <= 3; threads++) {
        omp_set_num_threads(threads);
        got[threads - 1] = distances(grid.inside, grid.n);
    }
    omp_set_num_threads(before);
    assert_memory_equal(got[0], got[1], ms_grid_voxels(&grid) * sizeof *got[0]);
    assert_memory_equal(got[0], got[2], ms_grid_voxels(&grid) * sizeof *got[0]);
    for (int g = 0; g < 3; g++) {
        free(got[g]);
    }
    ms_grid_free(&grid);
    ms_mesh_free(&body);
}

/* In a ball of voxels the field at its centre is the least distance to a voxel outside it. */
static void the_centre_of_a_ball_is_its_radius_away(void **state)
{
    (void)state;
    const int size = 31, middle = 15;
    for (double radius = 1.3; radius < 14; radius += 1.7) {
        ms_grid grid = empty_grid(size, size, size, 1);
        int least = 1000000;
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            const int x = (int)v % size - middle, y = (int)v / size % size - middle, z = (int)v / size / size - middle;
            const int square = x * x + y * y + z * z;
            grid.inside[v] = square < radius * radius;
            least = !grid.inside[v] && square < least ? square : least;
        }
        float *got = distances(grid.inside, grid.n);
        assert_true(got[ms_grid_index(&grid, middle, middle, middle)] == sqrtf((float)least));
        free(got);
        ms_grid_free(&grid);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(every_small_size_agrees_with_brute_force),
        cmocka_unit_test(random_sizes_agree_with_brute_force),
        cmocka_unit_test(one_background_voxel_gives_the_distance_from_it),
        cmocka_unit_test(the_longest_lines_are_exact),
        cmocka_unit_test(any_nonzero_byte_is_inside),
        cmocka_unit_test(bad_extents_are_refused),
        cmocka_unit_test(blocks_agree_with_the_whole),
        cmocka_unit_test(blocks_of_no_grid_are_refused),
        cmocka_unit_test(the_centre_of_a_ball_is_its_radius_away),
    };
    omp_set_num_threads(1); /* small grids */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
