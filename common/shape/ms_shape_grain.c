/* Gaussian random grains: the logarithm of the radius is a random field on the sphere whose
   power falls with the degree of its spherical harmonics, so that the radius stays positive
   and the surface never cuts itself. Source: Muinonen, Nousiainen, Fast, Lumme & Peltoniemi,
   Light scattering by Gaussian random particles, JQSRT 55 (1996) 577. */
#include <gsl/gsl_math.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdlib.h>

#include "mesh/ms_inertia.h"
#include "ms_shape_build.h"

/* Degrees 0 (size) and 1 (place) say nothing of the shape. */
enum { DEGREE_MIN = 2, DEGREE_MAX = 64, COEFFICIENTS = (DEGREE_MAX + 1) * (DEGREE_MAX + 1) };

typedef struct field {
    int degree;
    double coefficient[COEFFICIENTS];                             /* of degree l, order m: [l * l + l + m] */
    double legendre[(DEGREE_MAX + 1) * (DEGREE_MAX + 4) / 2 + 2]; /* scratch */
} field;

/* SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every platform. */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* Normal deviate, by Box and Muller. */
static double next_normal(uint64_t *state)
{
    double u = ((double)(next_random(state) >> 11) + 0.5) * 0x1p-53;
    double v = (double)(next_random(state) >> 11) * 0x1p-53;
    return sqrt(-2 * log(u)) * cos(2 * M_PI * v);
}

/* Variance sigma^2 in all, shared by the degrees as l^-decay. */
static void draw_field(field *f, double sigma, int degree, double decay, uint64_t seed)
{
    double total = 0;
    for (int l = DEGREE_MIN; l <= degree; l++) {
        total += pow(l, -decay);
    }
    uint64_t state = seed;
    f->degree = degree;
    for (int l = DEGREE_MIN; l <= degree; l++) {
        /* The squares of the harmonics of one degree add up to (2l + 1) / 4 pi everywhere. */
        double deviation = sigma * sqrt(pow(l, -decay) / total * 4 * M_PI / (2 * l + 1));
        for (int m = -l; m <= l; m++) {
            f->coefficient[l * l + l + m] = deviation * next_normal(&state);
        }
    }
}

static double field_at(field *f, const double direction[3])
{
    double z = fmax(-1, fmin(1, direction[2]));
    double azimuth = atan2(direction[1], direction[0]);
    gsl_sf_legendre_array(GSL_SF_LEGENDRE_SPHARM, (size_t)f->degree, z, f->legendre);
    double sum = 0;
    for (int m = 0; m <= f->degree; m++) {
        double c = m == 0 ? 1 : M_SQRT2 * cos(m * azimuth);
        double s = m == 0 ? 0 : M_SQRT2 * sin(m * azimuth);
        for (int l = m < DEGREE_MIN ? DEGREE_MIN : m; l <= f->degree; l++) {
            const double *at = f->coefficient + l * l + l;
            sum += f->legendre[gsl_sf_legendre_array_index((size_t)l, (size_t)m)] * (c * at[m] + s * at[-m]);
        }
    }
    return sum;
}

/* Scales to the volume of a ball of that radius and moves the centre of mass to the origin. */
static ms_status fit_to_ball(ms_mesh *mesh, double radius, ms_error *err)
{
    ms_body body;
    ms_status status = ms_inertia_mesh(&body, mesh, err);
    if (status != MS_OK) {
        return status;
    }
    double scale = radius * cbrt(4.0 / 3.0 * M_PI / body.volume);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int axis = 0; axis < 3; axis++) {
            mesh->vertex[v][axis] = scale * (mesh->vertex[v][axis] - body.centroid[axis]);
        }
    }
    return MS_OK;
}

/* value: r, elongation, flatness, noise, degree, decay, seed, fineness */
ms_status ms_shape_grain(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    field *f = malloc(sizeof *f);
    if (!f) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the surface of a grain");
    }
    draw_field(f, value[3], (int)value[4], value[5], (uint64_t)value[6]);
    ms_status status = ms_shape_unit_ball(mesh, (int)value[7], err);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double r = exp(field_at(f, mesh->vertex[v]));
        for (int axis = 0; axis < 3; axis++) {
            mesh->vertex[v][axis] *= r;
        }
    }
    ms_shape_scale(mesh, value[1], 1, 1 / value[2]);
    if (status == MS_OK) {
        status = fit_to_ball(mesh, value[0], err);
    }
    if (status != MS_OK) {
        ms_mesh_free(mesh);
    }
    free(f);
    return status;
}

double ms_shape_grain_volume(const double *value)
{
    return 4.0 / 3.0 * M_PI * gsl_pow_3(value[0]);
}
