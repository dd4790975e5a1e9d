/* The rules for principal axes. */
#include "support/body_samples.h"

static ms_principal principal_of(const ms_body *body)
{
    ms_principal p;
    ms_error err = {{0}};
    if (ms_inertia_principal(&p, body, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    /* A right-handed frame of unit vectors in which the tensor is diagonal. */
    for (int m = 0; m < 3; m++) {
        const double *a = p.axis[m];
        const double *b = p.axis[(m + 1) % 3];
        const double *c = p.axis[(m + 2) % 3];
        expect_close(a[0] * a[0] + a[1] * a[1] + a[2] * a[2], 1, 1e-14);
        for (int k = 0; k < 3; k++) {
            expect_close(c[k], a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3], 1e-14);
            const double *row = body->inertia[k];
            expect_close(row[0] * a[0] + row[1] * a[1] + row[2] * a[2], p.moment[m] * a[k], 2e-9 * fabs(p.moment[2]));
        }
    }
    assert_true(p.moment[0] <= p.moment[1] && p.moment[1] <= p.moment[2]);
    return p;
}

static void expect_axes(const char *kind, const double *value, const int expected[3])
{
    ms_mesh mesh = make_body(kind, value);
    ms_body body = body_of(&mesh);
    ms_principal p = principal_of(&body);
    for (int m = 0; m < 3; m++) {
        for (int k = 0; k < 3; k++) {
            /* The third axis may point backward. */
            expect_close(m == 2 ? fabs(p.axis[m][k]) : p.axis[m][k], k == expected[m], 1e-12);
        }
    }
    ms_mesh_free(&mesh);
}

static void equal_moments_take_the_input_axes(void **state)
{
    (void)state;
    static const int xyz[3] = {0, 1, 2};
    static const int yzx[3] = {1, 2, 0};
    static const int zxy[3] = {2, 0, 1};
    expect_axes("ball", (double[]){2.385, 16}, xyz);
    expect_axes("cube", (double[]){2.385, 4}, xyz);
    expect_axes("tetrahedron", (double[]){2.385, 4}, xyz);
    expect_axes("ellipsoid", (double[]){2, 1, 1, 16}, xyz);
    expect_axes("ellipsoid", (double[]){1, 2, 2, 16}, yzx);
    expect_axes("ellipsoid", (double[]){6.585, 6.585, 3.395, 16}, xyz);
    expect_axes("ellipsoid", (double[]){1, 1, 2, 16}, zxy);
    expect_axes("torus", (double[]){3, 1, 16}, xyz);
    expect_axes("box", (double[]){3, 2, 1, 4}, xyz);
    expect_axes("box", (double[]){1, 2, 3, 4}, (const int[3]){2, 1, 0});
}

static void a_tilted_body_of_revolution_projects_x(void **state)
{
    const double u[3] = {0.6, 0, 0.8};
    ms_body body = {0};
    (void)state;
    for (int k = 0; k < 9; k++) {
        body.inertia[k / 3][k % 3] = (k / 3 == k % 3) + 0.5 * u[k / 3] * u[k % 3];
    }
    ms_principal p = principal_of(&body);
    const double expected[3][3] = {{0.8, 0, -0.6}, {0, 1, 0}, {0.6, 0, 0.8}};
    for (int k = 0; k < 9; k++) {
        expect_close(p.axis[k / 3][k % 3], expected[k / 3][k % 3], 1e-12);
    }
    /* A perturbation far below the tie changes nothing to speak of. */
    body.inertia[0][1] = body.inertia[1][0] = 3e-11;
    p = principal_of(&body);
    for (int k = 0; k < 9; k++) {
        expect_close(p.axis[k / 3][k % 3], expected[k / 3][k % 3], 1e-9);
    }
}

static void odd_tensors_do_no_harm(void **state)
{
    ms_principal p;
    ms_error err;
    ms_body body = {0};
    (void)state;
    principal_of(&body);
    for (int k = 0; k < 3; k++) {
        body.inertia[k][k] = 1e300 * (k + 1);
    }
    p = principal_of(&body);
    expect_close(p.moment[2], 3e300, 0);
    for (int k = 0; k < 3; k++) {
        body.inertia[k][k] = 5e-310 * (3 - k);
    }
    p = principal_of(&body);
    expect_close(p.axis[0][2], 1, 1e-12);
    static const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 27; k++) {
        memset(body.inertia, 0, sizeof body.inertia);
        body.inertia[k % 9 / 3][k % 3] = bad[k / 9];
        assert_int_equal(ms_inertia_principal(&p, &body, &err), MS_ERR_ARG);
        expect_message(&err, "not finite");
        expect_close(p.moment[0] + p.axis[0][0], 0, 0);
    }
    assert_int_equal(ms_inertia_principal(&p, &body, NULL), MS_ERR_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_moments_take_the_input_axes),
        cmocka_unit_test(a_tilted_body_of_revolution_projects_x),
        cmocka_unit_test(odd_tensors_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
