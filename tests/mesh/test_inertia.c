/* Integrals against formulas. */
#include "support/body_samples.h"

/* Exact moments about the centroid, axes of the kind. */
typedef void exact_moments(double moment[3], double volume, const double *value);

static void box_moments(double moment[3], double m, const double *v)
{
    for (int k = 0; k < 3; k++) {
        double a = v[(k + 1) % 3];
        double b = v[(k + 2) % 3];
        moment[k] = m * (a * a + b * b) / 12;
    }
}

static void ellipsoid_moments(double moment[3], double m, const double *v)
{
    for (int k = 0; k < 3; k++) {
        double a = v[(k + 1) % 3];
        double b = v[(k + 2) % 3];
        moment[k] = m * (a * a + b * b) / 5;
    }
}

static void hollow_moments(double moment[3], double m, const double *v)
{
    moment[0] = moment[1] = moment[2] = 0.4 * m * (pow(v[0], 5) - pow(v[1], 5)) / (pow(v[0], 3) - pow(v[1], 3));
}

static void cone_moments(double moment[3], double m, const double *v)
{
    moment[0] = moment[1] = m * (3 * v[0] * v[0] / 20 + 3 * v[1] * v[1] / 80);
    moment[2] = 0.3 * m * v[0] * v[0];
}

static void cylinder_moments(double moment[3], double m, const double *v)
{
    moment[0] = moment[1] = m * (v[0] * v[0] / 4 + v[1] * v[1] / 12);
    moment[2] = 0.5 * m * v[0] * v[0];
}

static void torus_moments(double moment[3], double m, const double *v)
{
    moment[0] = moment[1] = m * (v[0] * v[0] / 2 + 5 * v[1] * v[1] / 8);
    moment[2] = m * (v[0] * v[0] + 3 * v[1] * v[1] / 4);
}

/* Of a body of revolution whose radius at height z is r(z): slices, by the midpoint rule. */
static void slice_moments(double moment[3], double (*radius)(double z, const double *v), double top, const double *v)
{
    const int n = 200000;
    moment[0] = moment[1] = moment[2] = 0;
    for (int k = 0; k < n; k++) {
        double z = top * (2 * (k + 0.5) / n - 1);
        double r2 = pow(radius(z, v), 2);
        double slice = pi * r2 * 2 * top / n;
        moment[0] += slice * (r2 / 4 + z * z);
        moment[2] += slice * r2 / 2;
    }
    moment[1] = moment[0];
}

static double tablet_radius(double z, const double *v)
{
    double sphere = (v[0] * v[0] + v[2] * v[2]) / (2 * v[2]);
    double above = fabs(z) - v[1] / 2 + sphere - v[2];
    return fabs(z) <= v[1] / 2 ? v[0] : sqrt(sphere * sphere - above * above);
}

static void tablet_moments(double moment[3], double m, const double *v)
{
    (void)m;
    slice_moments(moment, tablet_radius, v[1] / 2 + v[2], v);
}

static double needle_radius(double z, const double *v)
{
    double above = fmax(0, fabs(z) - (v[0] / 2 - v[1]));
    return sqrt(v[1] * v[1] - above * above);
}

static void turn_to_x(double moment[3])
{
    double along = moment[2];
    moment[2] = moment[0];
    moment[0] = along;
}

static void needle_moments(double moment[3], double m, const double *v)
{
    (void)m;
    slice_moments(moment, needle_radius, v[0] / 2, v);
    turn_to_x(moment);
}

static double dumbbell_radius(double z, const double *v)
{
    double across = v[0] * v[0] - pow(fabs(z) - v[1] / 2, 2);
    return fmax(sqrt(fmax(0, across)), fabs(z) < v[1] / 2 ? v[2] : 0);
}

static void dumbbell_moments(double moment[3], double m, const double *v)
{
    (void)m;
    slice_moments(moment, dumbbell_radius, v[1] / 2 + v[0], v);
    turn_to_x(moment);
}

static void regular_moments(double moment[3], double m, const double *v)
{
    moment[0] = moment[1] = moment[2] = m * v[0] * v[0] / 20;
}

static void octahedron_moments(double moment[3], double m, const double *v)
{
    moment[0] = moment[1] = moment[2] = m * v[0] * v[0] / 5;
}

typedef struct analytic_case {
    const char *kind;
    double value[MS_SHAPE_MAX_PARAMETERS];
    int fineness_at; /* index of that parameter */
    exact_moments *moments;
    double tolerance; /* relative, at the given fineness */
} analytic_case;

static const analytic_case analytic_cases[] = {
    {"box", {1.3, 2.385, 0.7, 8}, 3, box_moments, 1e-14},
    {"plate", {5, 5, 0.1, 10}, 3, box_moments, 1e-14},
    {"tetrahedron", {1.7, 5}, 1, regular_moments, 1e-14},
    {"octahedron", {1.7, 5}, 1, octahedron_moments, 1e-14},
    {"ellipsoid", {2.385, 1.1, 0.7, 64}, 3, ellipsoid_moments, 1e-3},
    {"hollow", {2.385, 1.1, 64}, 2, hollow_moments, 1e-3},
    {"cone", {1.3, 2.385, 64}, 2, cone_moments, 5e-4},
    {"cylinder", {1.3, 2.385, 64}, 2, cylinder_moments, 5e-4},
    {"torus", {2.385, 0.8, 64}, 2, torus_moments, 5e-4},
    {"tablet", {5.675, 4.0, 1.23, 64}, 3, tablet_moments, 5e-4},
    {"needle", {20, 0.5, 64}, 2, needle_moments, 5e-4},
    {"dumbbell", {1.1, 3, 0.4, 64}, 3, dumbbell_moments, 1e-3},
};

enum { N_ANALYTIC = sizeof analytic_cases / sizeof *analytic_cases };

/* Largest relative error of the moments. */
static double error_of(const analytic_case *c, double fineness)
{
    double value[MS_SHAPE_MAX_PARAMETERS], moment[3];
    memcpy(value, c->value, sizeof value);
    value[c->fineness_at] = fineness;
    ms_mesh mesh = make_body(c->kind, value);
    ms_body body = body_of(&mesh);
    c->moments(moment, ms_shape_find(c->kind, NULL)->volume(value), value);
    double worst = 0;
    for (int k = 0; k < 3; k++) {
        worst = fmax(worst, fabs(body.inertia[k][k] / moment[k] - 1));
        expect_close(body.centroid[k], 0, 1e-13);
        expect_close(body.inertia[k][(k + 1) % 3], 0, 1e-12 * body.inertia[k][k]);
        expect_close(body.inertia[(k + 1) % 3][k], body.inertia[k][(k + 1) % 3], 0);
    }
    ms_mesh_free(&mesh);
    return worst;
}

static void tensors_agree_with_formulas(void **state)
{
    (void)state;
    for (int k = 0; k < N_ANALYTIC; k++) {
        const analytic_case *c = &analytic_cases[k];
        expect_close(error_of(c, c->value[c->fineness_at]), 0, c->tolerance);
    }
}

static void errors_fall_with_the_square_of_fineness(void **state)
{
    (void)state;
    for (int k = 0; k < N_ANALYTIC; k++) {
        if (analytic_cases[k].tolerance > 1e-10) {
            double coarse = error_of(&analytic_cases[k], 32);
            double fine = error_of(&analytic_cases[k], 96);
            double order = log(coarse / fine) / log(3);
            if (!(order > 1.85 && order < 2.15)) {
                fail_msg("%s: order %g", analytic_cases[k].kind, order);
            }
        }
    }
}

static void multiply(double out[3][3], double a[3][3], double b[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
}

/* About (1, 2, 3), by an angle that is no fraction of a turn. */
static void make_rotation(double r[3][3])
{
    const double u[3] = {1 / sqrt(14), 2 / sqrt(14), 3 / sqrt(14)};
    const double c = cos(0.7);
    const double s = sin(0.7);
    const double cross[3][3] = {{0, -u[2], u[1]}, {u[2], 0, -u[0]}, {-u[1], u[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r[i][j] = c * (i == j) + (1 - c) * u[i] * u[j] + s * cross[i][j];
        }
    }
}

static void rotate(ms_mesh *mesh, double r[3][3])
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double p[3];
        memcpy(p, mesh->vertex[v], sizeof p);
        for (int k = 0; k < 3; k++) {
            mesh->vertex[v][k] = r[k][0] * p[0] + r[k][1] * p[1] + r[k][2] * p[2];
        }
    }
}

static void a_rotated_body_has_a_rotated_tensor(void **state)
{
    double r[3][3], transposed[3][3], half[3][3], expected[3][3];
    (void)state;
    make_rotation(r);
    ms_mesh mesh = make_body("grain", (double[]){1.3, 1.5, 1.4, 0.2, 8, 3, 11, 20});
    ms_body before = body_of(&mesh);
    rotate(&mesh, r);
    ms_body after = body_of(&mesh);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            transposed[i][j] = r[j][i];
        }
    }
    multiply(half, r, before.inertia);
    multiply(expected, half, transposed);
    for (int i = 0; i < 9; i++) {
        expect_close(after.inertia[i / 3][i % 3], expected[i / 3][i % 3], 1e-13);
    }
    expect_close(after.volume, before.volume, 1e-13);
    ms_principal p, q;
    assert_int_equal(ms_inertia_principal(&p, &before, NULL), MS_OK);
    assert_int_equal(ms_inertia_principal(&q, &after, NULL), MS_OK);
    for (int k = 0; k < 3; k++) {
        expect_close(p.moment[k], q.moment[k], 1e-13);
    }
    ms_mesh_free(&mesh);
}

static void a_body_far_off_keeps_its_precision(void **state)
{
    (void)state;
    /* Coordinates in steps of 1/8, which double precision still holds at 1e9. */
    ms_mesh near = make_body("box", (double[]){12, 8, 4, 6});
    ms_mesh far = make_body("box", (double[]){12, 8, 4, 6});
    move_body(&far, 1e9, -2e9, 1e9 + 0.125);
    ms_body a = body_of(&near);
    ms_body b = body_of(&far);
    expect_close(b.volume, a.volume, 1e-12 * a.volume);
    for (int k = 0; k < 9; k++) {
        expect_close(b.inertia[k / 3][k % 3], a.inertia[k / 3][k % 3], 1e-12 * a.inertia[0][0]);
    }
    expect_close(b.centroid[1], -2e9, 1e-6);
    ms_mesh_free(&near);
    ms_mesh_free(&far);
}

static void what_encloses_nothing_is_refused(void **state)
{
    ms_body body;
    ms_error err;
    (void)state;
    ms_mesh mesh = unit_cube();
    reverse_all(&mesh);
    assert_int_equal(ms_inertia_mesh(&body, &mesh, &err), MS_ERR_SHAPE);
    expect_message(&err, "encloses no volume (-1)");
    expect_close(body.volume, 0, 0);
    reverse_all(&mesh);
    mesh.vertex[3][1] = (double)NAN;
    assert_int_equal(ms_inertia_mesh(&body, &mesh, &err), MS_ERR_SHAPE);
    expect_message(&err, "not finite");
    ms_mesh_free(&mesh);
    /* A flat bag, oblique so that its volume is rounding. */
    mesh = make_body("box", (double[]){1, 1, 1, 4});
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        mesh.vertex[v][2] = 0.3 * mesh.vertex[v][0] + 0.7 * mesh.vertex[v][1];
    }
    move_body(&mesh, 0.1, 0.2, 0.7);
    assert_int_equal(ms_inertia_mesh(&body, &mesh, &err), MS_ERR_SHAPE);
    ms_mesh_free(&mesh);
    assert_int_equal(ms_inertia_mesh(&body, &mesh, &err), MS_ERR_SHAPE);
    assert_int_equal(ms_inertia_mesh(&body, &mesh, NULL), MS_ERR_SHAPE);
}

static void areas_agree_with_formulas(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("box", (double[]){1.3, 2.385, 0.7, 9});
    expect_close(ms_mesh_area(&mesh), 2 * (1.3 * 2.385 + 2.385 * 0.7 + 0.7 * 1.3), 1e-13);
    move_body(&mesh, 1e6, 0, 0);
    expect_close(ms_mesh_area(&mesh), 2 * (1.3 * 2.385 + 2.385 * 0.7 + 0.7 * 1.3), 1e-8);
    ms_mesh_free(&mesh);
    mesh = make_body("torus", (double[]){3, 1, 64});
    expect_close(ms_mesh_area(&mesh), 12 * pi * pi, 5e-4 * 12 * pi * pi);
    ms_mesh_free(&mesh);
    expect_close(ms_mesh_area(&mesh), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tensors_agree_with_formulas),
        cmocka_unit_test(errors_fall_with_the_square_of_fineness),
        cmocka_unit_test(a_rotated_body_has_a_rotated_tensor),
        cmocka_unit_test(a_body_far_off_keeps_its_precision),
        cmocka_unit_test(what_encloses_nothing_is_refused),
        cmocka_unit_test(areas_agree_with_formulas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
