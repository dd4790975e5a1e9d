/* Nearest points against brute force, by formulas other than the library's. */
#include "mesh/ms_closest.h"
#include "support/body_samples.h"

typedef double vec[3];

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double distance_of(const double a[3], const double b[3])
{
    const vec d = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(dot(d, d));
}

static double to_segment(const double p[3], const double a[3], const double b[3])
{
    const vec ab = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const vec ap = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    double length2 = dot(ab, ab);
    double s = length2 > 0 ? fmax(0, fmin(1, dot(ap, ab) / length2)) : 0;
    const vec q = {a[0] + s * ab[0], a[1] + s * ab[1], a[2] + s * ab[2]};
    return distance_of(p, q);
}

/* The least of the three edges and, if the projection falls within, the plane. */
static double to_triangle(const double p[3], const double a[3], const double b[3], const double c[3])
{
    double least = fmin(to_segment(p, a, b), fmin(to_segment(p, b, c), to_segment(p, c, a)));
    const vec u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const vec w = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const vec n = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const vec ap = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    double n2 = dot(n, n);
    const vec ap_w = {ap[1] * w[2] - ap[2] * w[1], ap[2] * w[0] - ap[0] * w[2], ap[0] * w[1] - ap[1] * w[0]};
    const vec u_ap = {u[1] * ap[2] - u[2] * ap[1], u[2] * ap[0] - u[0] * ap[2], u[0] * ap[1] - u[1] * ap[0]};
    double s = dot(ap_w, n) / n2;
    double t = dot(u_ap, n) / n2;
    return n2 > 0 && s >= 0 && t >= 0 && s + t <= 1 ? fmin(least, fabs(dot(ap, n)) / sqrt(n2)) : least;
}

static double brute_distance(const ms_mesh *mesh, const double p[3])
{
    double least = HUGE_VAL;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle[t];
        least = fmin(least, to_triangle(p, mesh->vertex[c[0]], mesh->vertex[c[1]], mesh->vertex[c[2]]));
    }
    return least;
}

/* Times that the surface winds around the point: 1 inside, 0 outside. Source: van Oosterom &
   Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983) 125. */
static double winding_number(const ms_mesh *mesh, const double p[3])
{
    double sum = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        vec r[3];
        double length[3];
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++) {
                r[k][i] = mesh->vertex[mesh->triangle[t][k]][i] - p[i];
            }
            length[k] = sqrt(dot(r[k], r[k]));
        }
        const vec cross = {r[1][1] * r[2][2] - r[1][2] * r[2][1], r[1][2] * r[2][0] - r[1][0] * r[2][2],
                           r[1][0] * r[2][1] - r[1][1] * r[2][0]};
        double below = length[0] * length[1] * length[2] + dot(r[0], r[1]) * length[2] + dot(r[1], r[2]) * length[0] +
                       dot(r[2], r[0]) * length[1];
        sum += 2 * atan2(dot(r[0], cross), below);
    }
    return sum / (4 * pi);
}

static ms_closest *build(const ms_mesh *mesh)
{
    ms_closest *closest;
    ms_error err = {{0}};
    if (ms_closest_build(&closest, mesh, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return closest;
}

static void random_point(double p[3], double reach, uint64_t *state)
{
    for (int k = 0; k < 3; k++) {
        p[k] = reach * (2 * next_uniform(state) - 1);
    }
}

/* Triangles anywhere in a cube; some of them thin, some without area, some without length. */
static ms_mesh random_soup(size_t n, uint64_t *state)
{
    ms_mesh mesh;
    assert_int_equal(ms_mesh_alloc(&mesh, 3 * n, n, NULL), MS_OK);
    for (size_t t = 0; t < n; t++) {
        double(*v)[3] = mesh.vertex + 3 * t;
        for (uint32_t k = 0; k < 3; k++) {
            random_point(v[k], 1, state);
            mesh.triangle[t][k] = (uint32_t)(3 * t + k);
        }
        double thin = t % 5 == 1 ? 1e-3 : t % 5 == 2 ? 1e-9 : t % 5 == 3 ? 0 : 1;
        for (int i = 0; i < 3; i++) {
            double along = t % 10 == 8 ? 1.0 : 0.3;
            v[2][i] = v[0][i] + along * (v[1][i] - v[0][i]) + thin * (v[2][i] - v[0][i]);
            if (t % 50 == 7) {
                v[1][i] = v[2][i] = v[0][i];
            }
        }
    }
    return mesh;
}

static void distances_agree_with_brute_force(void **state)
{
    static const size_t sizes[] = {1, 2, 3, 5, 9, 40, 300, 2000};
    uint64_t random = 3;
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        ms_mesh mesh = random_soup(sizes[s], &random);
        ms_closest *closest = build(&mesh);
        for (int k = 0; k < 300; k++) {
            vec p, q;
            random_point(p, k % 3 == 0 ? 0.3 : k % 3 == 1 ? 1.5 : 50, &random);
            double expected = brute_distance(&mesh, p);
            double got = ms_closest_distance(q, closest, p, HUGE_VAL);
            expect_close(got, expected, 1e-12 * (1 + expected));
            expect_close(distance_of(p, q), got, 1e-12 * (1 + expected));
            expect_close(brute_distance(&mesh, q), 0, 1e-12 * (1 + expected));
            expect_close(ms_closest_distance(NULL, closest, p, HUGE_VAL), got, 0);
        }
        ms_closest_free(closest);
        ms_mesh_free(&mesh);
    }
}

static void points_of_the_surface_are_at_no_distance(void **state)
{
    uint64_t random = 8;
    (void)state;
    ms_mesh mesh = make_body("grain", (double[]){1, 1.5, 1.4, 0.2, 8, 3, 5, 16});
    ms_closest *closest = build(&mesh);
    for (size_t t = 0; t < mesh.n_triangles; t++) {
        vec q;
        double a = next_uniform(&random);
        double b = next_uniform(&random) * (1 - a);
        const uint32_t *c = mesh.triangle[t];
        const double *corner = mesh.vertex[c[0]];
        vec p;
        for (int i = 0; i < 3; i++) {
            p[i] = a * mesh.vertex[c[0]][i] + b * mesh.vertex[c[1]][i] + (1 - a - b) * mesh.vertex[c[2]][i];
        }
        expect_close(ms_closest_distance(q, closest, p, HUGE_VAL), 0, 1e-15);
        expect_close(distance_of(p, q), 0, 1e-15);
        expect_close(ms_closest_distance(q, closest, corner, HUGE_VAL), 0, 1e-15);
        expect_close(ms_closest_signed_distance(closest, corner), 0, 1e-15);
    }
    ms_closest_free(closest);
    ms_mesh_free(&mesh);
}

static void a_bound_returns_itself(void **state)
{
    uint64_t random = 21;
    (void)state;
    ms_mesh mesh = make_body("torus", (double[]){3, 1, 8});
    ms_closest *closest = build(&mesh);
    for (int k = 0; k < 500; k++) {
        vec p, q = {7, 7, 7};
        random_point(p, 5, &random);
        double exact = ms_closest_distance(NULL, closest, p, HUGE_VAL);
        double below = 0.999 * exact;
        assert_true(ms_closest_distance(q, closest, p, below) == below);
        assert_true(q[0] == 7 && q[1] == 7 && q[2] == 7);
        assert_true(ms_closest_distance(q, closest, p, 1.001 * exact) == exact);
        expect_close(distance_of(p, q), exact, 1e-14);
        assert_true(ms_closest_distance(NULL, closest, p, 0) == 0);
    }
    const vec nowhere = {(double)NAN, 0, 0};
    vec q = {7, 7, 7};
    assert_true(ms_closest_distance(q, closest, nowhere, 2.5) == 2.5);
    assert_true(q[0] == 7);
    ms_closest_free(closest);
    ms_mesh_free(&mesh);
}

typedef struct side_case {
    const char *kind;
    double value[MS_SHAPE_MAX_PARAMETERS];
} side_case;

/* Sharp edges and corners, hollows, saddles, thin walls. */
static const side_case side_cases[] = {
    {"tetrahedron", {1.3, 2}},        {"octahedron", {1, 2}},
    {"plate", {2, 2, 0.04, 6}},       {"cone", {1, 0.2, 3}},
    {"torus", {1, 0.4, 4}},           {"hollow", {1, 0.9, 4}},
    {"dumbbell", {0.7, 1.5, 0.1, 6}}, {"grain", {1, 1.5, 1.4, 0.5, 12, 1, 5, 10}},
};

static void expect_sides(const ms_mesh *mesh, uint64_t *random)
{
    double lo[3], hi[3];
    ms_closest *closest = build(mesh);
    ms_mesh_box(lo, hi, mesh);
    for (int k = 0; k < 1500; k++) {
        vec p;
        for (int i = 0; i < 3; i++) {
            p[i] = lo[i] + (1.2 * next_uniform(random) - 0.1) * (hi[i] - lo[i]);
        }
        if (k % 3 == 0) { /* beside a vertex */
            size_t v = (size_t)(next_uniform(random) * (double)mesh->n_vertices);
            random_point(p, 1e-3, random);
            for (int i = 0; i < 3; i++) {
                p[i] += mesh->vertex[v][i];
            }
        }
        double winding = winding_number(mesh, p);
        double expected = brute_distance(mesh, p) * (winding > 0.5 ? -1 : 1);
        expect_close(ms_closest_signed_distance(closest, p), expected, 1e-12);
    }
    ms_closest_free(closest);
}

static void sides_agree_with_winding_numbers(void **state)
{
    uint64_t random = 34;
    (void)state;
    for (size_t k = 0; k < sizeof side_cases / sizeof *side_cases; k++) {
        ms_mesh mesh = make_body(side_cases[k].kind, side_cases[k].value);
        expect_sides(&mesh, &random);
        ms_mesh_free(&mesh);
    }
    ms_mesh mesh = unit_cube();
    expect_sides(&mesh, &random);
    /* A saddle: one corner pushed in, so that edges there bend both ways. */
    mesh.vertex[7][0] = mesh.vertex[7][1] = mesh.vertex[7][2] = 0.2;
    mesh.vertex[6][0] = 0.3;
    expect_sides(&mesh, &random);
    ms_mesh_free(&mesh);
}

/* Within a cube that of the nearest face; beyond an edge or a corner the mean of its faces'. */
static void normals_are_those_of_the_nearest_faces(void **state)
{
    uint64_t random = 58;
    (void)state;
    ms_mesh mesh = unit_cube();
    ms_closest *closest = build(&mesh);
    for (int k = 0; k < 2000; k++) {
        vec p, normal;
        int nearest = 0;
        for (int i = 0; i < 3; i++) {
            p[i] = next_uniform(&random);
            nearest = fabs(p[i] - 0.5) > fabs(p[nearest] - 0.5) ? i : nearest;
        }
        const double distance = ms_closest_signed_normal(normal, closest, p);
        assert_true(distance == ms_closest_signed_distance(closest, p));
        assert_true(distance == ms_closest_side(NULL, closest, p, ms_closest_distance(NULL, closest, p, HUGE_VAL)));
        expect_close(normal[nearest] / sqrt(dot(normal, normal)), p[nearest] > 0.5 ? 1 : -1, 1e-12);
        for (int i = 0; i < 3; i++) { /* all beyond: the corner; one less: an edge */
            p[i] = 1 + p[i];
        }
        p[k % 3] = k % 2 ? 0.37 : p[k % 3];
        ms_closest_signed_normal(normal, closest, p);
        for (int i = 0; i < 3; i++) {
            expect_close(normal[i] / sqrt(dot(normal, normal)),
                         k % 2 == 0   ? sqrt(1 / 3.0)
                         : i == k % 3 ? 0
                                      : sqrt(0.5),
                         1e-12);
        }
    }
    ms_closest_free(closest);
    ms_mesh_free(&mesh);
}

/* At the centre of a ball every triangle is as near, on the axis of a torus rings of them. */
static void ties_do_not_confuse_the_side(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 12});
    ms_closest *closest = build(&mesh);
    assert_true(ms_closest_signed_distance(closest, (const vec){0, 0, 0}) < 0);
    ms_closest_free(closest);
    ms_mesh_free(&mesh);
    mesh = make_body("torus", (double[]){3, 1, 12});
    closest = build(&mesh);
    for (int k = -20; k <= 20; k++) {
        assert_true(ms_closest_signed_distance(closest, (const vec){0, 0, 0.1 * k}) > 0);
    }
    assert_true(ms_closest_signed_distance(closest, (const vec){3, 0, 0}) < 0);
    ms_closest_free(closest);
    ms_mesh_free(&mesh);
}

static void a_mesh_far_off_gives_the_same_distances(void **state)
{
    uint64_t random = 55;
    (void)state;
    ms_mesh near = make_body("box", (double[]){12, 8, 4, 6});
    ms_mesh far = make_body("box", (double[]){12, 8, 4, 6});
    move_body(&far, 1e9, -2e9, 1e9);
    ms_closest *a = build(&near);
    ms_closest *b = build(&far);
    for (int k = 0; k < 500; k++) {
        vec p;
        for (int i = 0; i < 3; i++) {
            p[i] = floor(64 * (16 * next_uniform(&random) - 8)) / 64; /* exact at 1e9 too */
        }
        const vec q = {p[0] + 1e9, p[1] - 2e9, p[2] + 1e9};
        expect_close(ms_closest_signed_distance(b, q), ms_closest_signed_distance(a, p), 1e-12);
    }
    ms_closest_free(a);
    ms_closest_free(b);
    ms_mesh_free(&near);
    ms_mesh_free(&far);
}

static void threads_may_share_it(void **state)
{
    enum { N = 2000 };
    static double alone[N], together[N];
    static vec point[N];
    uint64_t random = 89;
    (void)state;
    ms_mesh mesh = make_body("dumbbell", (double[]){1, 3, 0.4, 16});
    ms_closest *closest = build(&mesh);
    for (int k = 0; k < N; k++) {
        random_point(point[k], 3, &random);
        alone[k] = ms_closest_signed_distance(closest, point[k]);
    }
#pragma omp parallel for num_threads(4)
    for (int k = 0; k < N; k++) {
        together[k] = ms_closest_signed_distance(closest, point[k]);
    }
    assert_memory_equal(alone, together, sizeof alone);
    ms_closest_free(closest);
    ms_mesh_free(&mesh);
}

static void an_empty_mesh_is_refused(void **state)
{
    ms_mesh mesh = {0};
    ms_error err;
    ms_closest *closest = (ms_closest *)&mesh;
    (void)state;
    assert_int_equal(ms_closest_build(&closest, &mesh, &err), MS_ERR_ARG);
    expect_message(&err, "without triangles");
    assert_null(closest);
    ms_closest_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_agree_with_brute_force),
        cmocka_unit_test(points_of_the_surface_are_at_no_distance),
        cmocka_unit_test(a_bound_returns_itself),
        cmocka_unit_test(sides_agree_with_winding_numbers),
        cmocka_unit_test(normals_are_those_of_the_nearest_faces),
        cmocka_unit_test(ties_do_not_confuse_the_side),
        cmocka_unit_test(a_mesh_far_off_gives_the_same_distances),
        cmocka_unit_test(threads_may_share_it),
        cmocka_unit_test(an_empty_mesh_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
