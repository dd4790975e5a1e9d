/** The ten equations on the masses of spheres: mass, centre and inertia of the particle. Private to the programmes that
 * solve them. */
#ifndef MS_MASS_EQUATIONS_H
#define MS_MASS_EQUATIONS_H

#include "ms_particle.h"

/** Without units: lengths over the radius of gyration and from the true centre, masses over that of the particle,
 * along the axes in which they are solved. A zeroed struct is empty. */
typedef struct ms_mass_equations {
    size_t n; /* spheres and carriers */
    double (*place)[3];
    double *square; /* of the radius */
    double axis[3][3];
    double moment[3], product[3]; /* what they shall sum to; products yz, zx, xy */
    double mean;                  /* of the moments */
} ms_mass_equations;

typedef enum ms_mass_equation_kind {
    MS_MASS_EQUATION_MASS,
    MS_MASS_EQUATION_CENTRE,
    MS_MASS_EQUATION_MOMENT,
    MS_MASS_EQUATION_PRODUCT,
    MS_MASS_EQUATIONS_KINDS
} ms_mass_equation_kind;

enum { MS_MASS_EQUATIONS_COUNT = 10 };

/** sum of row_s m_s = right. */
typedef struct ms_mass_equation {
    ms_mass_equation_kind kind;
    double right;
    double scale; /* over which an error of it is told */
} ms_mass_equation;

/**
 * The equations of a clump.
 *
 * @param[out] e           ms_mass_equations_free in any case
 * @param      input_frame 0: along the principal axes of the particle; 1: along the clump's own
 * @return MS_OK; MS_ERR_ARG where a sphere is absurdly far away; MS_ERR_NOMEM; as ms_inertia_principal
 *
 * Source: Yuan 2019, eqs. 2 to 5, and the products of inertia.
 */
ms_status ms_mass_equations_make(ms_mass_equations *e, const ms_clump *clump, const ms_particle *particle,
                                 int input_frame, ms_error *err);

/** One of them. @param[out] row n coefficients @param k 0 mass, 1 to 3 centre, 4 to 6 moments, 7 to 9 products */
ms_mass_equation ms_mass_equations_get(double *row, const ms_mass_equations *e, int k);

void ms_mass_equations_free(ms_mass_equations *e);

#endif
