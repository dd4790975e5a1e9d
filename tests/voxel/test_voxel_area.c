/* The surface area of voxels: digitised bodies of known area, and Crofton's formula. */
#include "voxel/ms_voxel_area.h"

#include "support/overlap_samples.h"

/* Whether a body of those semi-axes, radius and half height, or half sides holds a point. */
typedef int (*holds)(const double p[3], const double size[3]);

static int ellipsoid(const double p[3], const double size[3])
{
    return pow(p[0] / size[0], 2) + pow(p[1] / size[1], 2) + pow(p[2] / size[2], 2) < 1;
}

static int cylinder(const double p[3], const double size[3])
{
    return hypot(p[0], p[1]) < size[0] && fabs(p[2]) < size[2];
}

static int box(const double p[3], const double size[3])
{
    return fabs(p[0]) < size[0] && fabs(p[1]) < size[1] && fabs(p[2]) < size[2];
}

/* Voxels with their centre within a body about a place off the lattice, turned. */
static ms_grid digitise_body(holds body, const double size[3], const double off[3], const double turn[3][3])
{
    const double corner = sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]);
    const double reach = body == ellipsoid ? fmax(size[0], fmax(size[1], size[2])) : corner;
    const int n = 2 * (int)ceil(reach) + 2 * MS_GRID_HULL + 1;
    ms_grid grid = empty_grid(n, n, n, 1);
    for (int k = 0; k < n; k++) {
        for (int j = 0; j < n; j++) {
            for (int i = 0; i < n; i++) {
                const double at[3] = {i - n / 2 - off[0], j - n / 2 - off[1], k - n / 2 - off[2]};
                double own[3];
                for (int a = 0; a < 3; a++) {
                    own[a] = turn[a][0] * at[0] + turn[a][1] * at[1] + turn[a][2] * at[2];
                }
                grid.inside[ms_grid_index(&grid, i, j, k)] = (uint8_t)body(own, size);
            }
        }
    }
    return grid;
}

static ms_grid digitise(const double semi[3], const double off[3])
{
    return digitise_body(ellipsoid, semi, off, upright);
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
    for (int s = 0; s < 13; s++) { /* those opposite have the same pairs */
        const int v[3] = {s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1}, axes = abs(v[0]) + abs(v[1]) + abs(v[2]);
        int64_t steps = 0;
        for (int k = 1; k < grid->n[2] - 1; k++) {
            for (int j = 1; j < grid->n[1] - 1; j++) {
                for (int i = 1; i < grid->n[0] - 1; i++) {
                    steps += inside_at(grid, i, j, k) != inside_at(grid, i + v[0], j + v[1], k + v[2]);
                }
            }
        }
        sum += 4 * WEIGHT[axes] * (double)steps / sqrt(axes);
    }
    return sum * grid->h * grid->h;
}

/* Worst errors of digitised balls, against the ball itself and that of the voxels' volume. */
typedef struct errors {
    double area, of_volume, crofton;
} errors;

static void add_errors(errors *e, double diameter, const double off[3])
{
    const double r = diameter / 2, semi[3] = {r, r, r}, truth = 4 * pi * r * r;
    ms_grid grid = digitise(semi, off);
    const double of_volume = pi * pow(6 * (double)ms_grid_count(&grid) / pi, 2.0 / 3);
    const double area = area_of(&grid);
    e->area = fmax(e->area, fabs(area / truth - 1));
    e->of_volume = fmax(e->of_volume, fabs(area / of_volume - 1));
    e->crofton = fmax(e->crofton, fabs(crofton_area(&grid) / truth - 1));
    ms_grid_free(&grid);
}

/* At places anywhere on the lattice. */
static errors of_balls(double diameter)
{
    uint64_t seed = 2385;
    errors e = {0};
    for (int place = 0; place < 24; place++) {
        double off[3];
        for (int a = 0; a < 3; a++) {
            off[a] = between(&seed, -0.5, 0.5);
        }
        add_errors(&e, diameter, off);
    }
    return e;
}

static void balls(void **state)
{
    (void)state;
    double sum = 0, sum_of_crofton = 0;
    for (double diameter = 20; diameter <= 50; diameter += diameter < 40 ? 2 : 10) {
        const errors e = of_balls(diameter);
        assert_true(e.area < 0.005);
        assert_true(e.of_volume < 0.002);
        sum += e.area;
        sum_of_crofton += e.crofton;
    }
    assert_true(sum_of_crofton > 1.5 * sum);
    for (double diameter = 8; diameter < 20; diameter += 0.5) {
        assert_true(of_balls(diameter).of_volume < 0.005);
    }
}

/* About a voxel's middle, the middle of a face, and a corner, whole shells of voxels come and go at once: balls that
 * differ by 1.3 % of their area have the same voxels, and no method can tell them apart. */
static void balls_in_special_places(void **state)
{
    (void)state;
    static const double PLACE[3][3] = {{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0.5}};
    const double smaller[3] = {11.92, 11.92, 11.92}, larger[3] = {12, 12, 12};
    ms_grid small = digitise(smaller, PLACE[0]), large = digitise(larger, PLACE[0]);
    assert_true(same_voxels(&small, &large));
    for (double diameter = 20; diameter <= 40; diameter++) {
        errors e = {0};
        for (int place = 0; place < 3; place++) {
            add_errors(&e, diameter, PLACE[place]);
        }
        assert_true(e.area < 0.015);
        assert_true(e.of_volume < 0.003);
    }
    ms_grid_free(&small);
    ms_grid_free(&large);
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
            ms_grid upright_grid = digitise(semi, OFF), turned = digitise_body(ellipsoid, semi, OFF, askew);
            const double area = spheroid_area(20.5, semi[axis]);
            expect_close(area_of(&upright_grid), area, 0.005 * area); /* parts of one direction do not cancel */
            expect_close(area_of(&turned), area, 0.002 * area);
            ms_grid_free(&upright_grid);
            ms_grid_free(&turned);
        }
    }
}

/* Of an edge at right angles 0.4 voxels times its length are missing, up to 0.2 more or less by how it lies. */
static void bodies_with_edges(void **state)
{
    (void)state;
    static const double OFF[3] = {0.3, -0.2, 0.45},
                        SIZE[3][3] = {{10.2, 10.2, 10.2}, {20.3, 20.3, 20.3}, {20.3, 15, 10.2}};
    for (int s = 0; s < 3; s++) {
        const double *a = SIZE[s], edges = 8 * (a[0] + a[1] + a[2]), rims = 4 * pi * a[0];
        const double faces = 8 * (a[0] * a[1] + a[1] * a[2] + a[0] * a[2]), round = 2 * pi * a[0] * (a[0] + 2 * a[2]);
        ms_grid turned = digitise_body(box, a, OFF, askew), drum = digitise_body(cylinder, a, OFF, askew);
        expect_close(area_of(&turned), faces - 0.4 * edges, 0.2 * edges);
        expect_close(area_of(&drum), round - 0.4 * rims, 0.2 * rims);
        ms_grid_free(&turned);
        ms_grid_free(&drum);
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
    expect_close(area_of(&outer), area, 0.002 * area);
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
        cmocka_unit_test(balls_in_special_places),
        cmocka_unit_test(cubes),
        cmocka_unit_test(spheroids),
        cmocka_unit_test(bodies_with_edges),
        cmocka_unit_test(a_hollow_ball),
        cmocka_unit_test(threads_and_borders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
