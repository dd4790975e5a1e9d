/* What a perturbation must keep, what it must change, and that a motion can be undone. */
#include "stability/ms_perturb.h"

#include "support/body_samples.h"

static double determinant(const ms_motion *m)
{
    const double(*t)[3] = m->turn;
    return t[0][0] * (t[1][1] * t[2][2] - t[1][2] * t[2][1]) - t[0][1] * (t[1][0] * t[2][2] - t[1][2] * t[2][0]) +
           t[0][2] * (t[1][0] * t[2][1] - t[1][1] * t[2][0]);
}

static void expect_rotation(const ms_motion *m, double tolerance)
{
    expect_close(determinant(m), 1, tolerance);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const double *p = m->turn[i], *q = m->turn[j];
            expect_close(p[0] * q[0] + p[1] * q[1] + p[2] * q[2], i == j, tolerance);
        }
    }
}

/* A clump with spheres on the vertices of a mesh goes with it and comes back. */
static void expect_undone(const ms_motion *motion, double tolerance)
{
    ms_mesh before = make_body("grain", (double[]){2.385, 1.3, 1.2, 0.1, 16, 3, 1, 6});
    ms_mesh after = make_body("grain", (double[]){2.385, 1.3, 1.2, 0.1, 16, 3, 1, 6});
    ms_clump clump = {0};
    ms_perturb_motion_apply(&after, motion);
    for (size_t v = 0; v < after.n_vertices; v++) {
        ms_sphere sphere = {.radius = 0.17};
        memcpy(sphere.centre, after.vertex[v], sizeof sphere.centre);
        assert_int_equal(ms_clump_add(&clump, &sphere, NULL), MS_OK);
    }
    ms_perturb_motion_undo(&clump, motion);
    for (size_t v = 0; v < before.n_vertices; v++) {
        for (int a = 0; a < 3; a++) {
            expect_close(clump.sphere[v].centre[a], before.vertex[v][a], tolerance);
        }
        assert_true(clump.sphere[v].radius == 0.17);
    }
    expect_close(volume_of(&after), volume_of(&before), 1e-13 * volume_of(&before));
    ms_clump_free(&clump);
    ms_mesh_free(&before);
    ms_mesh_free(&after);
}

static void axis_turns_are_the_rotations_of_the_cube(void **state)
{
    (void)state;
    for (int k = 0; k < MS_MOTION_AXIS_TURNS; k++) {
        const ms_motion turn = ms_perturb_motion_axis_turn(k);
        expect_rotation(&turn, 0);
        expect_undone(&turn, 0);
        for (int other = 0; other < k; other++) {
            const ms_motion earlier = ms_perturb_motion_axis_turn(other);
            assert_true(memcmp(&earlier.turn, &turn.turn, sizeof turn.turn) != 0);
        }
    }
    const ms_motion none = ms_perturb_motion_none(), first = ms_perturb_motion_axis_turn(0);
    for (int k = 0; k < 9; k++) {
        assert_true(none.turn[k / 3][k % 3] == (k % 4 == 0));
        assert_true(first.turn[k / 3][k % 3] == none.turn[k / 3][k % 3]);
    }
}

/* Of uniform rotations every element has mean 0 and mean square 1/3. */
static void random_turns_are_uniform(void **state)
{
    enum { TURNS = 2000 };
    double mean[9] = {0}, square[9] = {0};
    (void)state;
    for (int k = 0; k < TURNS; k++) {
        ms_motion turn;
        assert_int_equal(ms_perturb_motion_random_turn(&turn, (uint64_t)k, NULL), MS_OK);
        expect_rotation(&turn, 1e-15 * 4);
        for (int e = 0; e < 9; e++) {
            mean[e] += turn.turn[e / 3][e % 3] / TURNS;
            square[e] += turn.turn[e / 3][e % 3] * turn.turn[e / 3][e % 3] / TURNS;
        }
    }
    for (int e = 0; e < 9; e++) {
        expect_close(mean[e], 0, 5 * sqrt(1.0 / 3 / TURNS));          /* five standard deviations */
        expect_close(square[e], 1.0 / 3, 5 * sqrt(4.0 / 45 / TURNS)); /* u^2 of a uniform u: variance 4/45 */
    }
}

static void motions_are_undone(void **state)
{
    ms_motion turn, again;
    (void)state;
    assert_int_equal(ms_perturb_motion_random_turn(&turn, 7, NULL), MS_OK);
    assert_int_equal(ms_perturb_motion_random_turn(&again, 7, NULL), MS_OK);
    assert_memory_equal(&turn, &again, sizeof turn);
    expect_undone(&turn, 1e-14);
    turn.shift[0] = 0.0173;
    turn.shift[1] = -11.3;
    turn.shift[2] = 0.5;
    expect_undone(&turn, 1e-13);
}

/* Vertices within a face of a box move along the face's normal, by no more than asked and by nearly as much. */
static void noise_is_along_the_normal_and_as_large_as_asked(void **state)
{
    const double amplitude = 0.0137;
    double most = 0, mean = 0;
    size_t n = 0;
    (void)state;
    ms_mesh before = make_body("box", (double[]){3, 2, 1, 60}), after;
    assert_int_equal(ms_perturb_copy(&after, &before, NULL), MS_OK);
    assert_int_equal(ms_perturb_noise(&after, amplitude, 3, NULL), MS_OK);
    for (size_t v = 0; v < before.n_vertices; v++) {
        const double *p = before.vertex[v], *q = after.vertex[v];
        if (fabs(p[0]) < 1.5 - 1e-9 && fabs(p[1]) < 1 - 1e-9) { /* within the faces above and below */
            assert_true(q[0] == p[0] && q[1] == p[1]);
            const double out = (q[2] - p[2]) * (p[2] > 0 ? 1 : -1);
            most = fmax(most, fabs(out));
            mean += out;
            n++;
        }
    }
    assert_true(n > 4000);
    assert_true(most <= amplitude * (1 + 1e-12) && most > 0.99 * amplitude);
    expect_close(mean / (double)n, 0, 5 * amplitude / sqrt(3.0 * (double)n));
    ms_mesh_report report = repair_body(&after);
    assert_true(report.closed && report.flipped == 0 && after.n_triangles == before.n_triangles);
    ms_mesh_free(&before);
    ms_mesh_free(&after);
}

static void no_noise_changes_nothing(void **state)
{
    (void)state;
    ms_mesh before = unit_cube(), after = unit_cube();
    assert_int_equal(ms_perturb_noise(&after, 0, 3, NULL), MS_OK);
    assert_memory_equal(after.vertex, before.vertex, before.n_vertices * sizeof *before.vertex);
    ms_mesh_free(&before);
    ms_mesh_free(&after);
}

static void refining_keeps_the_surface(void **state)
{
    static const char *const kinds[] = {"grain", "torus", "hollow", "tetrahedron"};
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        double value[MS_SHAPE_MAX_PARAMETERS];
        const ms_shape_kind *kind = ms_shape_find(kinds[k], NULL);
        default_values(value, kind);
        value[fineness_at(kind)] = 9;
        ms_mesh mesh = make_body(kinds[k], value), fine;
        assert_int_equal(ms_perturb_refine(&fine, &mesh, NULL), MS_OK);
        assert_int_equal(fine.n_triangles, 4 * mesh.n_triangles);
        assert_int_equal(fine.n_vertices, mesh.n_vertices + 3 * mesh.n_triangles / 2); /* closed: 3 edges for 2 */
        const ms_body was = body_of(&mesh), is = body_of(&fine);
        expect_close(is.volume, was.volume, 1e-13 * was.volume);
        for (int e = 0; e < 9; e++) {
            expect_close(is.inertia[e / 3][e % 3], was.inertia[e / 3][e % 3], 1e-13 * was.inertia[0][0]);
        }
        expect_close(ms_mesh_area(&fine), ms_mesh_area(&mesh), 1e-13 * ms_mesh_area(&mesh));
        const size_t n_triangles = fine.n_triangles;
        ms_mesh_report report = repair_body(&fine);
        assert_true(report.closed && report.flipped == 0 && fine.n_triangles == n_triangles);
        ms_mesh_free(&mesh);
        ms_mesh_free(&fine);
    }
}

/* Occupied cells, by comparing each vertex with all before it. */
static size_t count_cells(const ms_mesh *mesh, double cell)
{
    double lo[3], hi[3];
    size_t count = 0;
    ms_mesh_box(lo, hi, mesh);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        int known = 0;
        for (size_t w = 0; w < v && !known; w++) {
            known = 1;
            for (int a = 0; a < 3; a++) {
                const double middle = lo[a] + 0.5 * (hi[a] - lo[a]);
                known &= floor((mesh->vertex[v][a] - middle) / cell) == floor((mesh->vertex[w][a] - middle) / cell);
            }
        }
        count += !known;
    }
    return count;
}

static void decimating_joins_the_vertices_of_a_cell(void **state)
{
    ms_mesh mesh = make_body("ball", (double[]){1, 24}), coarse;
    ms_mesh_report report;
    (void)state;
    assert_int_equal(ms_perturb_decimate(&coarse, &report, &mesh, 0.21, NULL), MS_OK);
    assert_true(report.closed);
    assert_int_equal(coarse.n_vertices, count_cells(&mesh, 0.21));
    for (size_t v = 0; v < coarse.n_vertices; v++) {
        const double *p = coarse.vertex[v];
        const double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        assert_true(r <= 1 && r > 1 - 0.21 * 0.21 * 3 / 2); /* a mean of points of a cap as wide as a cell's diagonal */
    }
    ms_mesh_free(&coarse);
    /* Cells smaller than any edge change nothing. */
    assert_int_equal(ms_perturb_decimate(&coarse, &report, &mesh, 1e-4, NULL), MS_OK);
    assert_int_equal(coarse.n_triangles, mesh.n_triangles);
    assert_memory_equal(coarse.vertex, mesh.vertex, mesh.n_vertices * sizeof *mesh.vertex);
    ms_mesh_free(&coarse);
    ms_mesh_free(&mesh);
}

static void decimating_to_nothing_is_refused(void **state)
{
    ms_mesh mesh = unit_cube(), coarse;
    ms_mesh_report report;
    ms_error err = {{0}};
    (void)state;
    assert_int_equal(ms_perturb_decimate(&coarse, &report, &mesh, 0, &err), MS_ERR_ARG);
    expect_message(&err, "cells of 0");
    assert_int_equal(ms_perturb_decimate(&coarse, &report, &mesh, (double)NAN, &err), MS_ERR_ARG);
    ms_mesh_free(&mesh);
    /* Two sides of one triangle. */
    assert_int_equal(ms_mesh_alloc(&mesh, 3, 2, NULL), MS_OK);
    memcpy(mesh.vertex, (double[3][3]){{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 3 * sizeof *mesh.vertex);
    memcpy(mesh.triangle, (uint32_t[2][3]){{0, 1, 2}, {0, 2, 1}}, 2 * sizeof *mesh.triangle);
    assert_int_equal(ms_perturb_decimate(&coarse, &report, &mesh, 0.1, &err), MS_ERR_SHAPE);
    assert_null(coarse.vertex);
    ms_mesh_free(&mesh);
}

/* Triangles by coordinates, each from its least corner, sorted: equal for equal sets. */
typedef struct corners {
    double at[3][3];
} corners;

static int compare_bytes(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(corners));
}

static corners *list_triangles(const ms_mesh *mesh)
{
    corners *list = malloc(mesh->n_triangles * sizeof *list);
    assert_non_null(list);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        int first = 0;
        for (int k = 1; k < 3; k++) {
            const double *p = mesh->vertex[mesh->triangle[t][k]], *q = mesh->vertex[mesh->triangle[t][first]];
            first = memcmp(p, q, 3 * sizeof *p) < 0 ? k : first;
        }
        for (int k = 0; k < 3; k++) {
            memcpy(list[t].at[k], mesh->vertex[mesh->triangle[t][(first + k) % 3]], sizeof list[t].at[k]);
        }
    }
    qsort(list, mesh->n_triangles, sizeof *list, compare_bytes);
    return list;
}

static void another_order_is_the_same_set(void **state)
{
    ms_mesh mesh = make_body("torus", (double[]){3, 1, 8});
    corners *before = list_triangles(&mesh);
    uint32_t first[3];
    (void)state;
    memcpy(first, mesh.triangle[0], sizeof first);
    const size_t n_vertices = mesh.n_vertices, n_triangles = mesh.n_triangles;
    assert_int_equal(ms_perturb_order(&mesh, 5, NULL), MS_OK);
    assert_int_equal(mesh.n_vertices, n_vertices);
    assert_int_equal(mesh.n_triangles, n_triangles);
    assert_true(memcmp(first, mesh.triangle[0], sizeof first) != 0);
    corners *after = list_triangles(&mesh);
    assert_memory_equal(before, after, n_triangles * sizeof *before);
    free(before);
    free(after);
    ms_mesh_free(&mesh);
}

static void opening_takes_as_many_triangles_as_asked(void **state)
{
    (void)state;
    const struct {
        double part;
        size_t left;
    } cases[] = {{0, 11}, {0.25, 9}, {0.5, 6}, {1, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ms_mesh mesh = unit_cube();
        assert_int_equal(ms_perturb_open(&mesh, cases[k].part, 4, NULL), MS_OK);
        assert_int_equal(mesh.n_triangles, cases[k].left);
        ms_mesh_report report = repair_body(&mesh);
        assert_true(!report.closed && report.open_edges > 0);
        ms_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axis_turns_are_the_rotations_of_the_cube),
        cmocka_unit_test(random_turns_are_uniform),
        cmocka_unit_test(motions_are_undone),
        cmocka_unit_test(noise_is_along_the_normal_and_as_large_as_asked),
        cmocka_unit_test(no_noise_changes_nothing),
        cmocka_unit_test(refining_keeps_the_surface),
        cmocka_unit_test(decimating_joins_the_vertices_of_a_cell),
        cmocka_unit_test(decimating_to_nothing_is_refused),
        cmocka_unit_test(another_order_is_the_same_set),
        cmocka_unit_test(opening_takes_as_many_triangles_as_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
