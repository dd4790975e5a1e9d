/** Which time step a body of spheres bears: its mass swings on its contacts, whatever sphere makes them. Private to the
 * writers of formats. */
#ifndef MS_STABLE_H
#define MS_STABLE_H

#include "clump/ms_clump.h"
#include "clump/ms_particle.h"

/** What presses on it, at a restitution of 0.5. */
typedef struct ms_stable_law {
    double young, poisson; /* of both bodies */
    double overlap;        /* of a contact, metres */
} ms_stable_law;

/**
 * Largest stable steps against a body of its kind, by Hertz: 2/omega (root(1 + z^2) - z) of integrators that take the
 * velocity of half a step before for the damping. omega^2 and the ratio of damping z are those of contacts that are as
 * stiff along the plane as across it. One is at the worst of seven points of a sphere, that farthest from the centre of
 * mass and its ends along the axes; many are at the farthest point of each sphere, and added as if they all moved the
 * body the same way. A plane of the same stuff allows steps that are longer by 2^(1/4).
 *
 * @param[out] one  s, on one contact, of the sphere that makes it shortest
 * @param[out] all  s, on one contact of each sphere at once
 * @param      clump in the frame of the template; not empty. Carriers touch nothing
 * @param      scale of its spheres, to metres
 * @param      particle its mass and diagonal inertia
 *
 * Source: Belytschko, An overview of semidiscretization and time integration procedures (1983). Cost: O(spheres)
 */
void ms_stable_step(double *one, double *all, const ms_clump *clump, double scale, const ms_particle *particle,
                    const ms_stable_law *law);

#endif
