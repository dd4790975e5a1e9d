#include "ms_cholesky.h"

#include <math.h>

void ms_cholesky_decompose(double a[4][4])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++) {
                sum -= a[i][k] * a[j][k];
            }
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
    }
}

void ms_cholesky_solve_lower(double l[4][4], double *b, int n)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) {
            b[i] -= l[i][k] * b[k];
        }
        b[i] /= l[i][i];
    }
}

void ms_cholesky_solve_upper(double l[4][4], double *b, int n)
{
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) {
            b[i] -= l[k][i] * b[k];
        }
        b[i] /= l[i][i];
    }
}
