#include "ms_mass_equations.h"

#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

void ms_mass_equations_free(ms_mass_equations *e)
{
    free(e->place);
    free(e->square);
    memset(e, 0, sizeof *e);
}

/* The axes, and the tensor along them. */
static ms_status choose_tensor(ms_mass_equations *e, const ms_particle *particle, int input_frame, double unit,
                               ms_error *err)
{
    ms_principal principal = {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    ms_body body = {.volume = 1};
    for (int i = 0; i < 9; i++) {
        body.inertia[i / 3][i % 3] = particle->inertia[i / 3][i % 3] / particle->mass / unit / unit;
    }
    ms_status status = input_frame ? MS_OK : ms_inertia_principal(&principal, &body, err);
    for (int m = 0; m < 3; m++) {
        const int i = (m + 1) % 3, j = (m + 2) % 3;
        e->moment[m] = input_frame ? body.inertia[m][m] : principal.moment[m];
        e->product[m] = input_frame ? body.inertia[i][j] : 0;
        e->mean += e->moment[m] / 3;
    }
    memcpy(e->axis, principal.axis, sizeof e->axis);
    return status;
}

ms_status ms_mass_equations_make(ms_mass_equations *e, const ms_clump *clump, const ms_particle *particle,
                                 int input_frame, ms_error *err)
{
    const double unit = ms_particle_gyration(particle);
    memset(e, 0, sizeof *e);
    e->n = ms_clump_count_masses(clump);
    e->place = malloc(e->n * sizeof *e->place);
    e->square = malloc(e->n * sizeof *e->square);
    if (!e->place || !e->square) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the equations of %zu spheres", e->n);
    }
    ms_status status = choose_tensor(e, particle, input_frame, unit * particle->scale, err);
    for (size_t s = 0; s < e->n && status == MS_OK; s++) {
        const double r = clump->sphere[s].radius / unit;
        double from_centre[3];
        for (int k = 0; k < 3; k++) {
            from_centre[k] = (clump->sphere[s].centre[k] - particle->centre[k]) / unit;
        }
        for (int m = 0; m < 3; m++) {
            e->place[s][m] = ms_dot(e->axis[m], from_centre);
        }
        e->square[s] = r * r;
        if (!(ms_dot(from_centre, from_centre) + e->square[s] < 1e12)) {
            status = ms_fail(err, MS_ERR_ARG,
                             "sphere %zu is more than a million radii of gyration away from the centre of the "
                             "particle; are clump and particle in one unit and frame?",
                             s + 1);
        }
    }
    return status;
}

/* How much a unit of mass at sphere s adds to the moment about axis m, and to the product of the other two. */
static double moment_of(const ms_mass_equations *e, size_t s, int m)
{
    const double a = e->place[s][(m + 1) % 3], b = e->place[s][(m + 2) % 3];
    return a * a + b * b + 0.4 * e->square[s];
}

static double product_of(const ms_mass_equations *e, size_t s, int m)
{
    return -e->place[s][(m + 1) % 3] * e->place[s][(m + 2) % 3];
}

ms_mass_equation ms_mass_equations_get(double *row, const ms_mass_equations *e, int k)
{
    const ms_mass_equation_kind kind = (ms_mass_equation_kind)((k + 2) / 3);
    const int axis = (k + 2) % 3;
    for (size_t s = 0; s < e->n; s++) {
        row[s] = kind == MS_MASS_EQUATION_MASS     ? 1
                 : kind == MS_MASS_EQUATION_CENTRE ? e->place[s][axis]
                 : kind == MS_MASS_EQUATION_MOMENT ? moment_of(e, s, axis)
                                                   : product_of(e, s, axis);
    }
    switch (kind) {
    case MS_MASS_EQUATION_MASS:
        return (ms_mass_equation){kind, 1, 1};
    case MS_MASS_EQUATION_CENTRE:
        return (ms_mass_equation){kind, 0, 1};
    case MS_MASS_EQUATION_MOMENT:
        return (ms_mass_equation){kind, e->moment[axis], e->moment[axis]};
    default:
        return (ms_mass_equation){kind, e->product[axis], e->mean};
    }
}
