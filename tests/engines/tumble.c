/*
 * A free rigid body by Euler's equations: tumble I1 I2 I3 w1 w2 w3 t1 [t2 ...]
 * prints for each time the angular velocity along the axes of the body, and the quaternion (w, x, y, z) that turns them
 * from where they were at time 0.
 */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <stdio.h>
#include <stdlib.h>

enum { STATE = 7, FIRST_TIME = 7 };

static int euler(double t, const double y[], double rate[], void *context)
{
    const double *inertia = context, *w = y, *q = y + 3;
    (void)t;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        rate[k] = (inertia[i] - inertia[j]) * w[i] * w[j] / inertia[k];
        rate[4 + k] = (q[0] * w[k] + q[1 + i] * w[j] - q[1 + j] * w[i]) / 2;
    }
    rate[3] = -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2;
    return GSL_SUCCESS;
}

int main(int argc, char **argv)
{
    double inertia[3], y[STATE] = {0, 0, 0, 1}, t = 0;
    if (argc <= FIRST_TIME) {
        fputs("usage: tumble I1 I2 I3 w1 w2 w3 t1 [t2 ...]\n", stderr);
        return 2;
    }
    for (int k = 0; k < 3; k++) {
        inertia[k] = strtod(argv[1 + k], NULL);
        y[k] = strtod(argv[4 + k], NULL);
    }
    gsl_odeiv2_system system = {euler, NULL, STATE, inertia};
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-6, 1e-12, 1e-12);
    for (int a = FIRST_TIME; driver && a < argc; a++) {
        const double until = strtod(argv[a], NULL);
        if (until > t && gsl_odeiv2_driver_apply(driver, &t, until, y) != GSL_SUCCESS) {
            return 1;
        }
        for (int k = 0; k < STATE; k++) {
            printf("%.17g%c", y[k], k + 1 < STATE ? ' ' : '\n');
        }
    }
    gsl_odeiv2_driver_free(driver);
    return driver ? 0 : 1;
}
