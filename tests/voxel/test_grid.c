/* Voxel grids: extents, indices, enlargement. */
#include "support/grid_samples.h"

static const double nowhere[3] = {0};

static void expect_no_grid(int nx, int ny, int nz, double h, ms_status status, const char *message)
{
    ms_grid grid;
    ms_error err = {{0}};
    const int n[3] = {nx, ny, nz};
    assert_int_equal(ms_grid_alloc(&grid, n, h, nowhere, &err), status);
    expect_message(&err, message);
    assert_null(grid.inside);
    assert_int_equal(ms_grid_alloc(&grid, n, h, nowhere, NULL), status);
    ms_grid_free(&grid);
}

static void bad_extents_are_refused(void **state)
{
    (void)state;
    expect_no_grid(0, 1, 1, 1, MS_ERR_ARG, "extent 0 along x");
    expect_no_grid(1, -3, 1, 1, MS_ERR_ARG, "extent -3 along y");
    expect_no_grid(1, 1, MS_GRID_MAX_EXTENT + 1, 1, MS_ERR_LIMIT, "along z");
    expect_no_grid(1, 1, 1, 0, MS_ERR_ARG, "voxel size 0");
    expect_no_grid(1, 1, 1, -2.385, MS_ERR_ARG, "voxel size -2.385");
    expect_no_grid(1, 1, 1, (double)NAN, MS_ERR_ARG, "voxel size");
    expect_no_grid(1, 1, 1, HUGE_VAL, MS_ERR_ARG, "voxel size");
}

static void a_grid_begins_empty_with_x_fastest(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(3, 4, 5, 2.385);
    assert_int_equal(ms_grid_voxels(&grid), 60);
    assert_int_equal(ms_grid_count(&grid), 0);
    for (size_t v = 0; v < 60; v++) {
        const int x = (int)v % 3, y = (int)v / 3 % 4, z = (int)v / 12;
        int voxel[3];
        assert_int_equal(ms_grid_index(&grid, x, y, z), v);
        ms_grid_voxel(voxel, grid.n, v);
        assert_true(voxel[0] == x && voxel[1] == y && voxel[2] == z);
        grid.inside[v] = v % 7 == 0;
    }
    assert_int_equal(ms_grid_count(&grid), 9);
    ms_grid_free(&grid);
    assert_null(grid.inside);
    ms_grid_free(&grid);
    ms_grid_free(NULL);
}

static void corners_of_triangles_are_in_voxels(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(3, 4, 5, 0.5);
    double vertex[4][3] = {{0, 0, 0}, {1, 1.5, -2}, {4, 4, 4}, {0.25, 8, 1}}, corner[3][3];
    uint32_t triangle[2][3] = {{0, 1, 2}, {3, 0, 1}};
    const ms_mesh mesh = {4, 2, vertex, triangle};
    grid.origin[1] = 1;
    ms_grid_corners(corner, &grid, &mesh, 1);
    assert_true(corner[0][0] == 0.5 && corner[0][1] == 14 && corner[0][2] == 2);
    assert_true(corner[1][0] == 0 && corner[1][1] == -2 && corner[1][2] == 0);
    assert_true(corner[2][0] == 2 && corner[2][1] == 1 && corner[2][2] == -4);
    ms_grid_free(&grid);
}

/* The larger grid holds the box with a voxel to spare, and each old voxel at its old place. */
static void expect_enlarged(const ms_grid *grid, const double lo[3], const double hi[3])
{
    ms_grid out;
    int shift[3];
    assert_int_equal(ms_grid_enlarge(&out, grid, lo, hi, 1u << 24, NULL), MS_OK);
    assert_true(out.h == grid->h);
    for (int a = 0; a < 3; a++) {
        const double before = (grid->origin[a] - out.origin[a]) / grid->h;
        shift[a] = (int)rint(before);
        expect_close(before, shift[a], 1e-9);
        assert_true(shift[a] >= 0 && shift[a] + grid->n[a] <= out.n[a]);
        assert_true(out.origin[a] <= lo[a] - 0.5 * out.h);
        assert_true(out.origin[a] + out.h * (out.n[a] - 1) >= hi[a] + 0.5 * out.h);
    }
    assert_int_equal(ms_grid_count(&out), ms_grid_count(grid));
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                assert_int_equal(inside_at(&out, i + shift[0], j + shift[1], k + shift[2]), inside_at(grid, i, j, k));
            }
        }
    }
    ms_grid_free(&out);
}

static void a_larger_grid_keeps_what_it_had(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int run = 0; run < 50; run++) {
        ms_grid grid = empty_grid(1 + pick(&seed, 6), 1 + pick(&seed, 6), 1 + pick(&seed, 6), 0.77);
        double lo[3], hi[3];
        for (int a = 0; a < 3; a++) {
            grid.origin[a] = between(&seed, -100, 100);
            lo[a] = grid.origin[a] + between(&seed, -9, 5);
            hi[a] = lo[a] + between(&seed, 0, 12);
        }
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            grid.inside[v] = next_uniform(&seed) < 0.5;
        }
        expect_enlarged(&grid, lo, hi);
        ms_grid_free(&grid);
    }
}

static void what_is_far_away_is_refused(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(4, 4, 4, 1), out;
    const double lo[3] = {0, 0, 0}, far[][3] = {{3, 3, 1e9}, {3, 3, HUGE_VAL}, {40, 40, 40}, {1e300, 3, 3}};
    for (int f = 0; f < 4; f++) {
        ms_error err = {{0}};
        assert_int_equal(ms_grid_enlarge(&out, &grid, lo, far[f], 43 * 43 * 43 - 1, &err), MS_ERR_LIMIT);
        expect_message(&err, "check units and frame");
        assert_null(out.inside);
    }
    const double below[3] = {-40000, 0, 0};
    assert_int_equal(ms_grid_enlarge(&out, &grid, below, lo, SIZE_MAX, NULL), MS_ERR_LIMIT);
    /* A voxel before 0, that at 0, 40 beyond it and one more: 43 along each axis. */
    assert_int_equal(ms_grid_enlarge(&out, &grid, lo, far[2], 43 * 43 * 43, NULL), MS_OK);
    ms_grid_free(&out);
    ms_grid_free(&grid);
}

/* Gives each voxel inside its number and lowers it to that of any neighbour, of 26, until nothing changes. */
static size_t brute_pieces(size_t *largest, const ms_grid *grid)
{
    const int nx = grid->n[0], ny = grid->n[1], nz = grid->n[2];
    size_t name[512], count[512] = {0}, pieces = 0;
    const size_t voxels = ms_grid_voxels(grid);
    assert_true(voxels <= 512);
    for (size_t v = 0; v < voxels; v++) {
        name[v] = v;
    }
    for (int changed = 1; changed;) {
        changed = 0;
        for (size_t m = 0; m < voxels * 27; m++) {
            const size_t v = m / 27;
            const int x = (int)v % nx, y = (int)v / nx % ny, z = (int)v / nx / ny;
            const int i = x + (int)(m % 3) - 1, j = y + (int)(m / 3 % 3) - 1, k = z + (int)(m / 9 % 3) - 1;
            if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz || !grid->inside[v] ||
                !inside_at(grid, i, j, k)) {
                continue;
            }
            const size_t other = name[ms_grid_index(grid, i, j, k)];
            changed |= other < name[v];
            name[v] = other < name[v] ? other : name[v];
        }
    }
    *largest = 0;
    for (size_t v = 0; v < voxels; v++) {
        if (grid->inside[v]) {
            pieces += name[v] == v;
            count[name[v]]++;
            *largest = count[name[v]] > *largest ? count[name[v]] : *largest;
        }
    }
    return pieces;
}

static void pieces_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 23;
    int met[64] = {0}, different = 0;
    for (int run = 0; run < 400; run++) {
        ms_grid grid = empty_grid(1 + pick(&seed, 8), 1 + pick(&seed, 8), 1 + pick(&seed, 8), 1);
        const double filled = between(&seed, 0, run % 2 ? 0.15 : 1);
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            grid.inside[v] = next_uniform(&seed) < filled;
        }
        size_t pieces, largest, expected;
        const size_t truth = brute_pieces(&expected, &grid);
        assert_int_equal(ms_grid_pieces(&pieces, &largest, &grid, NULL), MS_OK);
        assert_int_equal(pieces, truth);
        assert_int_equal(largest, expected);
        different += !met[pieces];
        met[pieces] = 1;
        ms_grid_free(&grid);
    }
    assert_true(different > 8);
}

/* Two voxels at steps (i, j, k) from each other: of one piece if no step is above 1. */
static void a_corner_joins_and_a_gap_does_not(void **state)
{
    (void)state;
    for (int to = 0; to < 125; to++) {
        ms_grid grid = empty_grid(5, 5, 5, 1);
        const int at[3] = {to % 5, to / 5 % 5, to / 25};
        size_t pieces, largest;
        grid.inside[ms_grid_index(&grid, 2, 2, 2)] = grid.inside[ms_grid_index(&grid, at[0], at[1], at[2])] = 1;
        assert_int_equal(ms_grid_pieces(&pieces, &largest, &grid, NULL), MS_OK);
        const int near = abs(at[0] - 2) < 2 && abs(at[1] - 2) < 2 && abs(at[2] - 2) < 2;
        assert_int_equal(pieces, near ? 1 : 2);
        assert_int_equal(largest, near && to != 62 ? 2 : 1);
        ms_grid_free(&grid);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_extents_are_refused),
        cmocka_unit_test(a_grid_begins_empty_with_x_fastest),
        cmocka_unit_test(corners_of_triangles_are_in_voxels),
        cmocka_unit_test(a_larger_grid_keeps_what_it_had),
        cmocka_unit_test(what_is_far_away_is_refused),
        cmocka_unit_test(pieces_agree_with_brute_force),
        cmocka_unit_test(a_corner_joins_and_a_gap_does_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
