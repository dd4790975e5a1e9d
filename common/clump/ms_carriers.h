/** Carriers: small spheres wholly inside others that have mass and touch nothing, where no masses of the spheres alone
 * sum to those of the particle. */
#ifndef MS_CARRIERS_H
#define MS_CARRIERS_H

#include "ms_density.h"

MS_C_BEGIN

/** What is asked of carriers; a zeroed struct holds the defaults. */
typedef struct ms_carriers_options {
    ms_density_options masses;
    double
        depth; /* of a carrier below the surface of the sphere around it, in the clump's unit; 0: the larger of 0.1 of
                     that sphere's radius and five times MS_CARRIERS_OVERLAP */
} ms_carriers_options;

/** Overlap to be expected at rest / radius of the ball of the particle's volume: somewhat more than what the weight of
 * that ball makes (Hertz) at the modulus that scripts of templates have, 1e5 density g radius. */
#define MS_CARRIERS_OVERLAP 0.002

/**
 * Masses as ms_density_solve finds them, and where these are not exact, carriers behind the spheres, as few as are
 * found, with which they are: mass, centre and all six elements of the inertia within 1e-9.
 *
 * Why masses alone may not do: balls of radius r whose centres lie in one plane have r^2/5 across it per mass, at most
 * a fifth of the largest r^2, while the particle may have more: an ellipsoid of semi-axis c = r has exactly that, and a
 * plate of thickness 2 r has r^2/3. A carrier at 0.85 r off the plane has 0.72 r^2.
 *
 * Of many places just below the depth in each sphere, in the directions of a cube's lattice along the principal axes, a
 * linear programme takes those whose masses, weighted, sum to the least; weights go with the inverse of the masses
 * found, so that few are left (Candes, Wakin & Boyd, J. Fourier Anal. Appl. 14 (2008) 877). Then one after the other is
 * left out for which the rest can do. The fewest of several starts is taken, which need not be the fewest there are.
 *
 * @param[in,out] clump    carriers and masses that it has are dropped; those found are set; on failure it has none
 * @param[out]    report   zeros on failure
 * @return MS_OK; MS_ERR_LIMIT where no carriers do, with the cause: a wall that has no room for them at this depth, a
 *         least mass that is too large, a centre of mass outside the hull of the centres, spheres that fill too little,
 *         more than 61,484 spheres; MS_ERR_ARG for a particle without density and no depth; as ms_density_solve
 *
 * Cost: some hundred programmes of ten rows and a column for each sphere, two dozen with one for each candidate, too:
 * 0.1 to 4 s for 10 to 100 spheres.
 */
MS_API ms_status ms_carriers_solve(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                                   const ms_carriers_options *options, ms_error *err);

MS_C_END

#endif
