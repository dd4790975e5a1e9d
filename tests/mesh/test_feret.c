/* Feret dimensions: bodies that have known ones, and hulls of points by brute force. */
#include "mesh/ms_feret.h"

#include "mesh/ms_hull.h"
#include "support/grid_samples.h"
#include "support/test_support.h"

static void feret_of_points(double feret[3], const double (*point)[3], size_t count)
{
    ms_mesh hull;
    ms_error err = {{0}};
    if (ms_hull_build(&hull, point, count, &err) != MS_OK || ms_feret_measure(feret, &hull, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    ms_mesh_free(&hull);
}

/* Turns a point about two axes. */
static void turn(double out[3], const double in[3], double a, double b)
{
    const double x = cos(a) * in[0] - sin(a) * in[1], y = sin(a) * in[0] + cos(a) * in[1];
    out[0] = x;
    out[1] = cos(b) * y - sin(b) * in[2];
    out[2] = sin(b) * y + cos(b) * in[2];
}

/* A box has its sides, however it lies; with points on its faces and edges, which leave triangles without area. */
static void boxes(void **state)
{
    (void)state;
    static const double SIDES[][3] = {{4, 2, 1}, {1, 1, 1}, {7, 7, 0.1}, {30, 0.2, 0.1}, {5, 4.9, 4.8}};
    for (int b = 0; b < 5; b++) {
        for (int per_side = 2; per_side <= 5; per_side += 3) {
            for (int t = 0; t < 4; t++) {
                double point[125][3], feret[3];
                int count = 0;
                for (int p = 0; p < per_side * per_side * per_side; p++) {
                    const double at[3] = {SIDES[b][0] * (p % per_side) / (per_side - 1),
                                          SIDES[b][1] * (p / per_side % per_side) / (per_side - 1),
                                          SIDES[b][2] * (p / per_side / per_side) / (per_side - 1)};
                    turn(point[count++], at, 0.7 * t, 1.1 * t);
                }
                feret_of_points(feret, (const double(*)[3])point, (size_t)count);
                for (int a = 0; a < 3; a++) {
                    expect_close(feret[a], SIDES[b][a], 1e-9 * SIDES[b][0]);
                }
            }
        }
    }
}

/* The least width of a regular tetrahedron of edge a is over two opposite edges, a / sqrt 2: no face shows it (its
 * height is a sqrt(2/3)). Along that width it is a square of side a / sqrt 2. */
static void over_two_edges(void **state)
{
    (void)state;
    static const double CORNER[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (int t = 0; t < 7; t++) {
        double point[4][3], feret[3];
        for (int c = 0; c < 4; c++) {
            turn(point[c], CORNER[c], 0.3 * t, 0.9 * t);
        }
        feret_of_points(feret, (const double(*)[3])point, 4);
        for (int a = 0; a < 3; a++) {
            expect_close(feret[a], 2, 1e-12);
        }
    }
}

static void ellipsoids(void **state)
{
    (void)state;
    ms_mesh mesh;
    double feret[3];
    make_shape(&mesh, "ellipsoid", "a=3 b=2 c=1 fineness=40");
    feret_of_points(feret, (const double(*)[3])mesh.vertex, mesh.n_vertices);
    for (int a = 0; a < 3; a++) {
        expect_close(feret[a], 2.0 * (3 - a), 2e-3 * (3 - a));
    }
    ms_mesh_free(&mesh);
}

static double width_along(const double (*point)[3], int count, const double direction[3])
{
    double lo = HUGE_VAL, hi = -HUGE_VAL, square = 0;
    for (int a = 0; a < 3; a++) {
        square += direction[a] * direction[a];
    }
    for (int p = 0; p < count; p++) {
        double at = 0;
        for (int a = 0; a < 3; a++) {
            at += point[p][a] * direction[a];
        }
        lo = fmin(lo, at);
        hi = fmax(hi, at);
    }
    return square > 1e-20 ? (hi - lo) / sqrt(square) : HUGE_VAL;
}

static void cross_of(double out[3], const double (*point)[3], int a, int b, int c, int d)
{
    double u[3], v[3];
    for (int m = 0; m < 3; m++) {
        u[m] = point[b][m] - point[a][m];
        v[m] = point[d][m] - point[c][m];
    }
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

/* Every direction that is normal to two lines through points: the width is the least of all of these. Then, about the
 * best, every direction normal to it and to one such line. */
static void brute_force(double feret[3], const double (*point)[3], int count)
{
    double best[3] = {0}, normal[3], aside[3];
    feret[2] = feret[1] = HUGE_VAL;
    for (int pair = 0; pair < count * count * count * count; pair++) {
        const int a = pair % count, b = pair / count % count, c = pair / count / count % count;
        const int d = pair / count / count / count;
        cross_of(normal, point, a, b, c, d);
        const double width = a < b && c < d ? width_along(point, count, normal) : HUGE_VAL;
        if (width < feret[2]) {
            feret[2] = width;
            memcpy(best, normal, sizeof best);
        }
    }
    for (int pair = 0; pair < count * count; pair++) {
        const double line[2][3] = {{0, 0, 0}, {best[0], best[1], best[2]}};
        const double two[4][3] = {{line[0][0], 0, 0},
                                  {line[1][0], line[1][1], line[1][2]},
                                  {point[pair % count][0], point[pair % count][1], point[pair % count][2]},
                                  {point[pair / count][0], point[pair / count][1], point[pair / count][2]}};
        cross_of(normal, two, 0, 1, 2, 3);
        const double width = width_along(point, count, normal);
        if (width < feret[1]) {
            feret[1] = width;
            const double lines[4][3] = {
                {0, 0, 0}, {best[0], best[1], best[2]}, {0, 0, 0}, {normal[0], normal[1], normal[2]}};
            cross_of(aside, lines, 0, 1, 2, 3);
            feret[0] = width_along(point, count, aside);
        }
    }
}

static void points_by_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 41;
    for (int round = 0; round < 60; round++) {
        const int count = 4 + round % 13;
        double point[16][3], feret[3], expected[3];
        for (int p = 0; p < count; p++) {
            for (int a = 0; a < 3; a++) {
                point[p][a] = between(&seed, 0, 1 + a * (round % 3));
            }
        }
        feret_of_points(feret, (const double(*)[3])point, (size_t)count);
        brute_force(expected, (const double(*)[3])point, count);
        for (int a = 0; a < 3; a++) {
            expect_close(feret[a], expected[a], 1e-9);
        }
    }
}

/* A fine hull against every pair of its directions: no width is less. */
static void nothing_is_narrower(void **state)
{
    (void)state;
    uint64_t seed = 5;
    ms_mesh mesh;
    double feret[3];
    make_shape(&mesh, "grain", "");
    feret_of_points(feret, (const double(*)[3])mesh.vertex, mesh.n_vertices);
    double least = HUGE_VAL;
    for (int d = 0; d < 20000; d++) {
        const double z = between(&seed, -1, 1), t = between(&seed, 0, 2 * pi), r = sqrt(1 - z * z);
        const double direction[3] = {r * cos(t), r * sin(t), z};
        least = fmin(least, width_along((const double(*)[3])mesh.vertex, (int)mesh.n_vertices, direction));
    }
    assert_true(feret[2] <= least * (1 + 1e-12));
    expect_close(feret[2], least, 0.01 * least);
    assert_true(feret[0] >= feret[1] && feret[1] >= feret[2]);
    ms_mesh_free(&mesh);
}

static void without_area(void **state)
{
    (void)state;
    double vertex[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, feret[3];
    uint32_t triangle[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const ms_mesh line = {4, 4, vertex, triangle};
    ms_error err = {{0}};
    assert_int_equal(ms_feret_measure(feret, &line, &err), MS_ERR_SHAPE);
    assert_non_null(strstr(err.text, "without area"));
    assert_true(feret[0] == 0 && feret[1] == 0 && feret[2] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes),
        cmocka_unit_test(over_two_edges),
        cmocka_unit_test(ellipsoids),
        cmocka_unit_test(points_by_brute_force),
        cmocka_unit_test(nothing_is_narrower),
        cmocka_unit_test(without_area),
    };
    const struct CMUnitTest without[] = {cmocka_unit_test(without_area)}; /* qhull */
    return ms_hull_is_built() ? cmocka_run_group_tests(tests, NULL, NULL) : cmocka_run_group_tests(without, NULL, NULL);
}
