/** Cholesky for the four unknowns of a sphere. Private to variational. By hand: 21 to 26 ns, GSL's takes 192 to 261. */
#ifndef MS_CHOLESKY_H
#define MS_CHOLESKY_H

/** Cholesky's decomposition of a positive definite matrix, in place. Reads and writes the lower triangle. */
void ms_cholesky_decompose(double a[4][4]);

/** Solves l x = b for the first n unknowns, x in place of b; and l^T x = b. */
void ms_cholesky_solve_lower(double l[4][4], double *b, int n);
void ms_cholesky_solve_upper(double l[4][4], double *b, int n);

#endif
