/* Polygons cut into triangles: areas known by Gauss's formula, edges used once each. */
#include "mesh/ms_mesh_polygon.h"

#include "support/body_samples.h"
#include "support/mesh_samples.h"

enum { MOST = 256 };

/* Lays points of a plane on a plane askew in space. */
static void lay_askew(double (*out)[3], const double (*in)[2], size_t n)
{
    static const double right[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3}, up[3] = {2.0 / 3, 2.0 / 3, -1.0 / 3};
    for (size_t k = 0; k < n; k++) {
        for (int a = 0; a < 3; a++) {
            out[k][a] = 7.5 - 3 * a + in[k][0] * right[a] + in[k][1] * up[a];
        }
    }
}

static double twice_area(const double (*p)[2], size_t n)
{
    double sum = 0;
    for (size_t k = 0; k < n; k++) {
        const double *a = p[k], *b = p[(k + 1) % n];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum;
}

static void make_fan(uint32_t (*fan)[3], uint32_t n)
{
    for (uint32_t t = 0; t + 2 < n; t++) {
        fan[t][0] = 0;
        fan[t][1] = t + 1;
        fan[t][2] = t + 2;
    }
}

static void cut(uint32_t (*fan)[3], const double (*vertex)[3], uint32_t n)
{
    ms_polygon_work work = {0};
    ms_error err = {{0}};
    make_fan(fan, n);
    if (ms_mesh_polygon_cut(fan, n - 2, vertex, &work, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    ms_mesh_polygon_free(&work);
}

/* Sides of the outline once and forward, those within once each way. */
static void expect_outline(const uint32_t (*triangle)[3], uint32_t n)
{
    static int used[MOST][MOST];
    memset(used, 0, sizeof used);
    for (uint32_t t = 0; t + 2 < n; t++) {
        for (int k = 0; k < 3; k++) {
            used[triangle[t][k]][triangle[t][(k + 1) % 3]]++;
        }
    }
    for (uint32_t a = 0; a < n; a++) {
        for (uint32_t b = 0; b < n; b++) {
            const int forward = b == (a + 1) % n, backward = a == (b + 1) % n;
            assert_int_equal(used[a][b] - used[b][a], forward - backward);
        }
    }
}

/* No triangle is turned over and their areas add up to the polygon's: they tile it. */
static void expect_tiled(const double (*point)[2], uint32_t n)
{
    double vertex[MOST][3];
    uint32_t triangle[MOST][3];
    lay_askew(vertex, point, n);
    cut(triangle, (const double(*)[3])vertex, n);
    expect_outline((const uint32_t(*)[3])triangle, n);
    const double whole = twice_area(point, n);
    double sum = 0;
    for (uint32_t t = 0; t + 2 < n; t++) {
        const double corners[3][2] = {{point[triangle[t][0]][0], point[triangle[t][0]][1]},
                                      {point[triangle[t][1]][0], point[triangle[t][1]][1]},
                                      {point[triangle[t][2]][0], point[triangle[t][2]][1]}};
        const double area = twice_area(corners, 3);
        assert_true(area / whole > -1e-12);
        sum += fabs(area);
    }
    expect_close(sum, fabs(whole), 1e-12 * fabs(whole));
}

/* From each of its corners, both ways round. */
static void expect_tiled_from_anywhere(const double (*point)[2], uint32_t n)
{
    double turned[MOST][2];
    for (uint32_t from = 0; from < n; from++) {
        for (int back = 0; back < 2; back++) {
            for (uint32_t k = 0; k < n; k++) {
                memcpy(turned[k], point[(from + (back ? n - k : k)) % n], sizeof turned[k]);
            }
            expect_tiled((const double(*)[2])turned, n);
        }
    }
}

static void concave_polygons_are_tiled(void **state)
{
    (void)state;
    static const double ell[][2] = {{3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}, {0, 0}},
                        straight[][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 1}, {0, 2}, {0, 1}},
                        triangle[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 2.385}},
                        arrow[][2] = {{0, 0}, {4, 1}, {0, 2}, {1, 1}},
                        slit[][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    expect_tiled_from_anywhere(ell, 6);
    expect_tiled_from_anywhere(straight, 8);
    expect_tiled_from_anywhere(triangle, 5);
    expect_tiled_from_anywhere(arrow, 4);
    expect_tiled(slit, 10);
}

static void combs_and_stars_are_tiled(void **state)
{
    (void)state;
    double point[MOST][2];
    uint64_t random = 1;
    for (uint32_t n = 4; n <= 60; n += 7) {
        for (uint32_t k = 0; k < n; k++) { /* a star around the origin */
            const double r = 0.1 + next_uniform(&random), angle = 2 * pi * k / n;
            point[k][0] = r * cos(angle);
            point[k][1] = r * sin(angle);
        }
        expect_tiled_from_anywhere((const double(*)[2])point, n);
    }
    for (uint32_t k = 0; k < 50; k++) { /* teeth, then the way back */
        point[k][0] = k;
        point[k][1] = k % 2 ? 9.5 : 1;
        point[99 - k][0] = k;
        point[99 - k][1] = 0;
    }
    expect_tiled((const double(*)[2])point, 100);
    for (uint32_t k = 0; k < 64; k++) { /* a spiral of four turns */
        point[k][0] = (k + 20) * cos(pi * k / 8);
        point[k][1] = (k + 20) * sin(pi * k / 8);
        point[127 - k][0] = (k + 15) * cos(pi * k / 8);
        point[127 - k][1] = (k + 15) * sin(pi * k / 8);
    }
    expect_tiled((const double(*)[2])point, 128);
}

static void convex_polygons_stay_fans(void **state)
{
    (void)state;
    double point[MOST][2], vertex[MOST][3];
    uint32_t fan[MOST][3], triangle[MOST][3];
    for (uint32_t n = 3; n < 100; n += 8) {
        for (uint32_t k = 0; k < n; k++) {
            point[k][0] = 2.385 * cos(2 * pi * k / n);
            point[k][1] = sin(2 * pi * k / n);
        }
        lay_askew(vertex, (const double(*)[2])point, n);
        make_fan(fan, n);
        cut(triangle, (const double(*)[3])vertex, n);
        assert_memory_equal(triangle, fan, (n - 2) * sizeof *fan);
    }
}

/* Not flat, crossed, folded to a line, to a point: still n - 2 triangles on its sides. */
static void spoilt_polygons_keep_their_outline(void **state)
{
    (void)state;
    double vertex[6][4][3] = {
        {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {2, 0, 0}},
        {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 0, 0}, {4, 1, 2}, {0, 2, 0}, {1, 1, 5}},
        {{0, 0, 0}, {3, 2, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 0, 0}, {0, 2, 0}, {0, 0, 0}, {3, 1, 0}}};
    uint32_t triangle[MOST][3];
    for (int k = 0; k < 6; k++) {
        cut(triangle, (const double(*)[3])vertex[k], 4);
        expect_outline((const uint32_t(*)[3])triangle, 4);
    }
    double random_points[40][3];
    uint64_t random = 2;
    for (int trial = 0; trial < 50; trial++) {
        for (int k = 0; k < 40; k++) {
            for (int a = 0; a < 3; a++) {
                random_points[k][a] = next_uniform(&random);
            }
        }
        cut(triangle, (const double(*)[3])random_points, 40);
        expect_outline((const uint32_t(*)[3])triangle, 40);
    }
}

/* The same prism by all formats of polygons. */
static void every_format_cuts_its_polygons(void **state)
{
    (void)state;
    static const char vertices[] =
        "3 0 0\n3 1 0\n1 1 0\n1 3 0\n0 3 0\n0 0 0\n3 0 2\n3 1 2\n1 1 2\n1 3 2\n0 3 2\n0 0 2\n";
    static const char faces[] = "6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n4 3 4 10 9\n"
                                "4 4 5 11 10\n4 5 0 6 11\n";
    static const char obj[] = "v 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 0\nf 6 5 4 3 2 1\nf 7 8 9 10 11 12\n"
                              "v 3 0 2\nv 3 1 2\nv 1 1 2\nv 1 3 2\nv 0 3 2\nv 0 0 2\nf 1 2 8 7\nf 2 3 9 8\n"
                              "f 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
    char off[1024], ply[1024];
    snprintf(off, sizeof off, "OFF\n12 8 0\n%s%s", vertices, faces);
    snprintf(ply, sizeof ply,
             "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 8\nproperty list uchar int vertex_indices\nend_header\n%s%s",
             vertices, faces);
    mesh_parser *const parsers[] = {ms_mesh_parse_obj, ms_mesh_parse_off, ms_mesh_parse_ply};
    const char *const texts[] = {obj, off, ply};
    for (int f = 0; f < 3; f++) {
        ms_mesh mesh;
        ms_body body;
        assert_int_equal(parse_sample(&mesh, parsers[f], texts[f], strlen(texts[f]), NULL), MS_OK);
        assert_int_equal(mesh.n_triangles, 20);
        expect_close(ms_mesh_area(&mesh), 2 * 5 + 12 * 2, 1e-12);
        assert_int_equal(ms_inertia_mesh(&body, &mesh, NULL), MS_OK);
        expect_close(body.volume, 10, 1e-12);
        ms_mesh_free(&mesh);
    }
}

/* As the last of polygons that have used up all tests. */
static void what_takes_too_long_is_refused(void **state)
{
    (void)state;
    const uint32_t n = 8;
    double vertex[8][3] = {{3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}, {0, 0, 0}, {1, -1, 0}, {2, -1, 0}};
    uint32_t triangle[MOST][3];
    ms_polygon_work work = {.tests = UINT64_C(1) << 31};
    ms_error err = {{0}};
    make_fan(triangle, n);
    assert_int_equal(ms_mesh_polygon_cut(triangle, n - 2, (const double(*)[3])vertex, &work, &err), MS_ERR_LIMIT);
    expect_message(&err, "cut it into triangles");
    ms_mesh_polygon_free(&work);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(concave_polygons_are_tiled),     cmocka_unit_test(combs_and_stars_are_tiled),
        cmocka_unit_test(convex_polygons_stay_fans),      cmocka_unit_test(spoilt_polygons_keep_their_outline),
        cmocka_unit_test(every_format_cuts_its_polygons), cmocka_unit_test(what_takes_too_long_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
