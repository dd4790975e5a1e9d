/* The surface area of voxels: digitised bodies of known area, and Crofton's formula. */
#include "voxel/ms_voxel_area.h"

#include "support/grid_samples.h"

/* Voxels with their centre within an ellipsoid about a place off the lattice. */
static ms_grid digitise(const double semi[3], const double off[3])
{
    int n[3];
    for (int a = 0; a < 3; a++) {
        n[a] = 2 * (int)ceil(semi[a]) + 2 * MS_GRID_HULL + 1;
    }
    ms_grid grid = empty_grid(n[0], n[1], n[2], 1);
    for (int k = 0; k < n[2]; k++) {
        for (int j = 0; j < n[1]; j++) {
            for (int i = 0; i < n[0]; i++) {
                const int at[3] = {i, j, k};
                double sum = 0;
                for (int a = 0; a < 3; a++) {
                    sum += pow((at[a] - n[a] / 2 - off[a]) / semi[a], 2);
                }
                grid.inside[ms_grid_index(&grid, i, j, k)] = sum < 1;
            }
        }
    }
    return grid;
}

static double area_of(const ms_grid *grid)
{
    double area;
    assert_int_equal(ms_voxel_area(&area, grid, NULL), MS_OK);
    return area;
}

/* Crofton's formula: pairs of voxels along 26 directions, each with the part of the sphere that is nearest to it. */
static double crofton_area(const ms_grid *grid)
{
    static const double WEIGHT[4] = {0, 0.0457778912048, 0.0369806278761, 0.0351956397823}; /* Lang et al. 2001 */
    double sum = 0;
    for (int s = 0; s < 27; s++) {
        const int v[3] = {s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1}, axes = abs(v[0]) + abs(v[1]) + abs(v[2]);
        int64_t steps = 0;
        for (int k = 1; k < grid->n[2] - 1 && axes; k++) {
            for (int j = 1; j < grid->n[1] - 1; j++) {
                for (int i = 1; i < grid->n[0] - 1; i++) {
                    steps += inside_at(grid, i, j, k) != inside_at(grid, i + v[0], j + v[1], k + v[2]);
                }
            }
        }
        sum += axes ? 2 * WEIGHT[axes] * (double)steps / sqrt(axes) : 0;
    }
    return sum * grid->h * grid->h;
}

/* Errors of digitised balls at many places on the lattice, and in the middle of a voxel and at its corner. */
typedef struct errors {
    double worst, worst_of_volume, worst_of_crofton; /* against the ball; against that of the voxels' volume */
} errors;

static errors of_balls(double diameter)
{
    uint64_t seed = 2385;
    errors e = {0};
    for (int place = 0; place < 24; place++) {
        const double r = diameter / 2, semi[3] = {r, r, r}, corner = 0.5 * (place == 1);
        double off[3] = {corner, corner, corner};
        for (int a = 0; a < 3 && place > 1; a++) {
            off[a] = between(&seed, -0.5, 0.5);
        }
        ms_grid grid = digitise(semi, off);
        const double of_volume = pi * pow(6 * (double)ms_grid_count(&grid) / pi, 2.0 / 3);
        e.worst = fmax(e.worst, fabs(area_of(&grid) / (4 * pi * r * r) - 1));
        e.worst_of_volume = fmax(e.worst_of_volume, fabs(area_of(&grid) / of_volume - 1));
        e.worst_of_crofton = fmax(e.worst_of_crofton, fabs(crofton_area(&grid) / of_volume - 1));
        ms_grid_free(&grid);
    }
    return e;
}

static void balls(void **state)
{
    (void)state;
    double sum = 0, sum_of_crofton = 0;
    for (double diameter = 20; diameter <= 40; diameter += 2) {
        const errors e = of_balls(diameter);
        assert_true(e.worst < 0.015);
        assert_true(e.worst_of_volume < 0.003);
        sum += e.worst_of_volume;
        sum_of_crofton += e.worst_of_crofton;
    }
    assert_true(sum_of_crofton > 2 * sum);
    for (double diameter = 8; diameter < 20; diameter += 0.5) {
        const errors e = of_balls(diameter);
        assert_true(e.worst_of_volume < 0.01);
    }
}

/* Faces along the axes, edges rounded off by less than two voxels. */
static void cubes(void **state)
{
    (void)state;
    for (int side = 20; side <= 60; side += 20) {
        ms_grid grid = empty_grid(side + 4, side + 4, side + 4, 1);
        for (int v = 0; v < side * side * side; v++) {
            grid.inside[ms_grid_index(&grid, 2 + v % side, 2 + v / side % side, 2 + v / side / side)] = 1;
        }
        const double area = 6.0 * side * side;
        assert_true(area_of(&grid) < area && area_of(&grid) > area * (1 - 1.0 / side));
        assert_true(crofton_area(&grid) < 0.93 * area);
        ms_grid_free(&grid);
    }
}

/* The area of a spheroid of semi-axes a, a, c. */
static double spheroid_area(double a, double c)
{
    const double e = sqrt(c > a ? 1 - a * a / (c * c) : 1 - c * c / (a * a));
    return c > a ? 2 * pi * a * a * (1 + c / (a * e) * asin(e)) : 2 * pi * a * a * (1 + (1 - e * e) / e * atanh(e));
}

static void spheroids(void **state)
{
    (void)state;
    static const double OFF[3] = {0.3, -0.2, 0.45};
    for (int axis = 0; axis < 3; axis++) {
        for (int flat = 0; flat < 2; flat++) {
            double semi[3] = {20.5, 20.5, 20.5};
            semi[axis] = flat ? 10.3 : 41;
            ms_grid grid = digitise(semi, OFF);
            const double area = spheroid_area(20.5, semi[axis]);
            expect_close(area_of(&grid), area, 0.02 * area); /* parts of one direction do not cancel */
            ms_grid_free(&grid);
        }
    }
}

/* What faces a cavity is surface; the unit of the grid counts twice. */
static void a_hollow_ball(void **state)
{
    (void)state;
    static const double OUTER[3] = {21.4, 21.4, 21.4}, INNER[3] = {12.2, 12.2, 12.2}, OFF[3] = {0.1, 0.2, 0.3};
    ms_grid outer = digitise(OUTER, OFF), inner = digitise(INNER, OFF);
    const int shift = (outer.n[0] - inner.n[0]) / 2;
    for (int v = 0; v < (int)ms_grid_voxels(&inner); v++) {
        const int i = v % inner.n[0], j = v / inner.n[0] % inner.n[1], k = v / inner.n[0] / inner.n[1];
        if (inner.inside[v]) {
            outer.inside[ms_grid_index(&outer, i + shift, j + shift, k + shift)] = 0;
        }
    }
    outer.h = 0.5;
    const double area = pi * (21.4 * 21.4 + 12.2 * 12.2);
    expect_close(area_of(&outer), area, 0.01 * area);
    ms_grid_free(&outer);
    ms_grid_free(&inner);
}

/* Bits do not depend on threads; a body at the very border of the grid has the area that it has in the middle. */
static void threads_and_borders(void **state)
{
    (void)state;
    static const double SEMI[3] = {21, 19, 23}, OFF[3] = {0.4, 0.1, -0.3};
    ms_grid grid = digitise(SEMI, OFF);
    const double area = area_of(&grid), origin[3] = {0};
    const int threads = omp_get_max_threads(), n[3] = {grid.n[0] + 10, grid.n[1] + 10, grid.n[2] + 10};
    omp_set_num_threads(3);
    assert_true(area_of(&grid) == area);
    omp_set_num_threads(threads);
    ms_grid wide;
    assert_int_equal(ms_grid_alloc(&wide, n, 1, origin, NULL), MS_OK);
    for (int v = 0; v < (int)ms_grid_voxels(&grid); v++) {
        const int i = v % grid.n[0], j = v / grid.n[0] % grid.n[1], k = v / grid.n[0] / grid.n[1];
        wide.inside[ms_grid_index(&wide, i + 5, j + 5, k + 5)] = grid.inside[v];
    }
    expect_close(area_of(&wide), area, 1e-9);
    ms_grid_free(&wide);
    ms_grid_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls),
        cmocka_unit_test(cubes),
        cmocka_unit_test(spheroids),
        cmocka_unit_test(a_hollow_ball),
        cmocka_unit_test(threads_and_borders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
