#include "ms_inertia.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <string.h>

#include "base/ms_vector.h"

/* A sum that carries its own rounding error along (Neumaier 1974). */
typedef struct sum {
    double value, carry;
} sum;

static void add_term(sum *s, double term)
{
    double total = s->value + term;
    if (fabs(s->value) >= fabs(term)) {
        s->carry += (s->value - total) + term;
    } else {
        s->carry += (term - total) + s->value;
    }
    s->value = total;
}

static double read_sum(const sum *s)
{
    return s->value + s->carry;
}

static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};

/* Integrals over the body of 1, x_i and x_i x_j, about the centre of the box. */
typedef struct integrals {
    sum volume, first[3], second[6];
    double gross; /* of the volumes without their signs: what rounding is measured against */
} integrals;

static void add_tetrahedron(integrals *sums, double p[3][3])
{
    double cross[3], together[3];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3;
        int j = (k + 2) % 3;
        cross[k] = p[1][i] * p[2][j] - p[1][j] * p[2][i];
        together[k] = p[0][k] + p[1][k] + p[2][k];
    }
    double volume = (p[0][0] * cross[0] + p[0][1] * cross[1] + p[0][2] * cross[2]) / 6;
    sums->gross += fabs(volume);
    add_term(&sums->volume, volume);
    for (int k = 0; k < 3; k++) {
        add_term(&sums->first[k], volume * together[k] / 4);
    }
    for (int k = 0; k < 6; k++) {
        int i = pair[k][0];
        int j = pair[k][1];
        double products = p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j];
        add_term(&sums->second[k], volume * (products + together[i] * together[j]) / 20);
    }
}

static void integrate_mesh(integrals *sums, const ms_mesh *mesh, const double centre[3])
{
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        double p[3][3];
        for (int corner = 0; corner < 3; corner++) {
            const double *v = mesh->vertex[mesh->triangle[t][corner]];
            for (int k = 0; k < 3; k++) {
                p[corner][k] = v[k] - centre[k];
            }
        }
        add_tetrahedron(sums, p);
    }
}

/* From integrals about `centre` to the tensor about the centroid. */
static void fill_body(ms_body *body, const integrals *sums, const double centre[3])
{
    double shift[3], moment[6];
    body->volume = read_sum(&sums->volume);
    for (int k = 0; k < 3; k++) {
        shift[k] = read_sum(&sums->first[k]) / body->volume;
        body->centroid[k] = centre[k] + shift[k];
    }
    for (int k = 0; k < 6; k++) {
        moment[k] = read_sum(&sums->second[k]) - body->volume * shift[pair[k][0]] * shift[pair[k][1]];
    }
    for (int k = 0; k < 3; k++) {
        body->inertia[k][k] = moment[(k + 1) % 3] + moment[(k + 2) % 3];
        int i = pair[3 + k][0];
        int j = pair[3 + k][1];
        body->inertia[i][j] = body->inertia[j][i] = 0.0 - moment[3 + k]; /* never -0 */
    }
}

/* A volume below this part of its gross sum is the rounding of a mesh that encloses none. */
#define VOLUME_ROUNDING 1e-12

ms_status ms_inertia_mesh(ms_body *body, const ms_mesh *mesh, ms_error *err)
{
    double lo[3] = {0}, hi[3] = {0}, centre[3];
    integrals sums = {0};
    *body = (ms_body){0};
    if (mesh->n_vertices > 0) {
        ms_mesh_box(lo, hi, mesh);
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = lo[k] + (hi[k] - lo[k]) / 2;
    }
    integrate_mesh(&sums, mesh, centre);
    double volume = read_sum(&sums.volume);
    if (!isfinite(sums.gross)) {
        return ms_fail(err, MS_ERR_SHAPE, "the mesh has coordinates that are not finite or overflow when multiplied");
    }
    if (!(volume > VOLUME_ROUNDING * sums.gross)) {
        return ms_fail(err, MS_ERR_SHAPE,
                       "the mesh encloses no volume (%g): it is flat, open, inside out or empty; repair or close it",
                       volume);
    }
    fill_body(body, &sums, centre);
    for (int k = 0; k < 3; k++) {
        if (!isfinite(body->centroid[k]) || !isfinite(body->inertia[k][k])) {
            *body = (ms_body){0};
            return ms_fail(err, MS_ERR_SHAPE, "the moments of the mesh overflow; scale it down");
        }
    }
    return MS_OK;
}

/* Moves the tensor of a body by `shift` away from its centroid, `volume` times. */
static void shift_inertia(double inertia[3][3], const double shift[3], double volume)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            inertia[i][j] += volume * ((i == j ? ms_dot(shift, shift) : 0) - shift[i] * shift[j]);
        }
    }
}

void ms_inertia_add(ms_body *body, const ms_body *part, int sign)
{
    const double added = sign * part->volume, volume = body->volume + added;
    double to_body[3], to_part[3];
    for (int k = 0; k < 3; k++) {
        const double apart = part->centroid[k] - body->centroid[k];
        to_body[k] = -apart * added / volume;
        to_part[k] = apart + to_body[k];
        body->centroid[k] -= to_body[k];
    }
    for (int k = 0; k < 9; k++) {
        body->inertia[k / 3][k % 3] += sign * part->inertia[k / 3][k % 3];
    }
    shift_inertia(body->inertia, to_body, body->volume);
    shift_inertia(body->inertia, to_part, added);
    body->volume = volume;
}

double ms_inertia_factor(const ms_body *body, double size)
{
    return size / cbrt(6 * body->volume / acos(-1.0));
}

void ms_inertia_scale(ms_body *body, double factor)
{
    const double f = factor;
    body->volume = f * f * f * body->volume;
    for (int k = 0; k < 3; k++) {
        body->centroid[k] = f * body->centroid[k];
        for (int l = 0; l < 3; l++) {
            body->inertia[k][l] = f * f * f * f * f * body->inertia[k][l];
        }
    }
}

double ms_mesh_area(const ms_mesh *mesh)
{
    sum area = {0};
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *corner = mesh->triangle[t];
        double cross[3];
        ms_vector_triangle(cross, mesh->vertex[corner[0]], mesh->vertex[corner[1]], mesh->vertex[corner[2]]);
        add_term(&area, sqrt(ms_dot(cross, cross)) / 2);
    }
    return read_sum(&area);
}

#define TIE 1e-9

static void make_largest_component_positive(double axis[3])
{
    int largest = 0;
    for (int k = 1; k < 3; k++) {
        if (fabs(axis[k]) > fabs(axis[largest]) + TIE) {
            largest = k;
        }
    }
    if (axis[largest] < 0) {
        for (int k = 0; k < 3; k++) {
            axis[k] = 0.0 - axis[k];
        }
    }
}

/* The unit vector along the projection of the input's x axis onto the plane across `normal`,
   or of y where that of x is shorter than 1/2: then y's is longer, for their squares add up
   to 1 or more. */
static void first_axis_across(double out[3], const double normal[3])
{
    int input = 1 - normal[0] * normal[0] > 0.25 ? 0 : 1;
    double length = sqrt(1 - normal[input] * normal[input]);
    for (int k = 0; k < 3; k++) {
        out[k] = ((k == input) - normal[input] * normal[k]) / length;
    }
}

static void orient_axes(ms_principal *principal)
{
    double(*axis)[3] = principal->axis;
    double tie = TIE * fabs(principal->moment[2]);
    int first_tie = principal->moment[1] - principal->moment[0] <= tie;
    int last_tie = principal->moment[2] - principal->moment[1] <= tie;
    if (first_tie && last_tie) {
        memset(principal->axis, 0, sizeof principal->axis);
        axis[0][0] = axis[1][1] = axis[2][2] = 1;
        return;
    }
    if (first_tie) {
        first_axis_across(axis[0], axis[2]);
        ms_cross(axis[1], axis[2], axis[0]);
    } else if (last_tie) {
        first_axis_across(axis[1], axis[0]);
    }
    make_largest_component_positive(axis[0]);
    make_largest_component_positive(axis[1]);
    ms_cross(axis[2], axis[0], axis[1]);
}

/* GSL's solver takes any finite matrix whose squares do not overflow. */
static ms_status solve_eigensystem(ms_principal *principal, double matrix[9], double scale, ms_error *err)
{
    double value[3], vector[9];
    gsl_matrix_view matrix_view = gsl_matrix_view_array(matrix, 3, 3);
    gsl_matrix_view vectors = gsl_matrix_view_array(vector, 3, 3);
    gsl_vector_view values = gsl_vector_view_array(value, 3);
    /* On the stack: gsl_eigen_symmv_alloc calls GSL's error handler where there is no memory. */
    double diagonal[3], off_diagonal[3], cosine[3], sine[3];
    gsl_eigen_symmv_workspace work = {3, diagonal, off_diagonal, cosine, sine};
    int failed = gsl_eigen_symmv(&matrix_view.matrix, &values.vector, &vectors.matrix, &work) != GSL_SUCCESS;
    failed = failed || gsl_eigen_symmv_sort(&values.vector, &vectors.matrix, GSL_EIGEN_SORT_VAL_ASC) != GSL_SUCCESS;
    if (failed) {
        return ms_fail(err, MS_ERR_ARG, "the principal axes of the inertia tensor could not be found");
    }
    for (int m = 0; m < 3; m++) {
        principal->moment[m] = value[m] * scale;
        for (int k = 0; k < 3; k++) {
            principal->axis[m][k] = vector[3 * k + m];
        }
    }
    return MS_OK;
}

ms_status ms_inertia_principal(ms_principal *principal, const ms_body *body, ms_error *err)
{
    *principal = (ms_principal){0};
    double matrix[9];
    double largest = 0;
    for (int k = 0; k < 9; k++) {
        matrix[k] = body->inertia[k / 3][k % 3] / 2 + body->inertia[k % 3][k / 3] / 2;
        if (!isfinite(matrix[k])) {
            return ms_fail(err, MS_ERR_ARG, "element %d,%d of the inertia tensor is not finite", k / 3, k % 3);
        }
        largest = fmax(largest, fabs(matrix[k]));
    }
    if (largest > 0) {
        double scale = ldexp(1, ilogb(largest)); /* a power of two: scaling is exact */
        for (int k = 0; k < 9; k++) {
            matrix[k] /= scale;
        }
        ms_status status = solve_eigensystem(principal, matrix, scale, err);
        if (status != MS_OK) {
            return status;
        }
    }
    orient_axes(principal);
    return MS_OK;
}
