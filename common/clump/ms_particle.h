/** The particle that a clump stands for: its true mass and inertia, in SI. */
#ifndef MS_PARTICLE_H
#define MS_PARTICLE_H

#include "mesh/ms_inertia.h"
#include "ms_clump.h"

MS_C_BEGIN

/* Of densities, kg/m^3: no body is as thin or as dense, and what follows from it, as the modulus that bears a drop,
 * stays finite. */
#define MS_PARTICLE_LEAST_DENSITY 1e-30
#define MS_PARTICLE_MOST_DENSITY 1e30

typedef struct ms_particle {
    double scale;         /* metres in a unit of length of the clump */
    double density;       /* of its matter, kg/m^3; 0 where it is not known */
    double mass;          /* kg */
    double centre[3];     /* of mass, in the unit and frame of the clump */
    double inertia[3][3]; /* about the centre, along the axes of the clump, kg m^2; off-diagonals are -sum(m x y) */
} ms_particle;

/**
 * Is it one of which a template can be made? A density that is known is from 1e-30 to 1e30 kg/m^3; scale and centre are
 * finite; mass and moments, and both over the density, are from 1e-290 to 1e290, so that sums over all particles and
 * quotients are numbers.
 *
 * @return MS_OK; MS_ERR_ARG
 */
MS_API ms_status ms_particle_check(const ms_particle *particle, ms_error *err);

/**
 * A homogeneous particle.
 *
 * @param[out] particle zeros on failure
 * @param      body     its shape, of unit density, in the clump's unit
 * @param      density  kg/m^3, from 1e-30 to 1e30
 * @param      scale    metres in a unit of length of the clump
 * @return MS_OK; MS_ERR_ARG where a value is not above 0 and within bounds; as ms_particle_check
 */
MS_API ms_status ms_particle_from_body(ms_particle *particle, const ms_body *body, double density, double scale,
                                       ms_error *err);

/**
 * What an engine finds that sums the spheres and carriers: each solid, of the mass that the clump says.
 *
 * @param[out] particle zeros on failure; its density is not known
 * @param      scale    metres in a unit of length of the clump
 * @return MS_OK; MS_ERR_ARG for a clump without masses, or as above
 *
 * Source: Yuan 2019, left-hand sides of eqs. 2 to 5.
 */
MS_API ms_status ms_particle_from_spheres(ms_particle *particle, const ms_clump *clump, double scale, ms_error *err);

/** Radius of gyration sqrt(trace of inertia / 2 mass), in the unit of the clump: how far off the centre its mass is. */
MS_API double ms_particle_gyration(const ms_particle *particle);

/**
 * Volume, centroid and inertia of the union of the spheres, counted on voxels of 1/200 of the diameter of the ball of
 * equal volume.
 *
 * @param[out] body       zeros on failure
 * @param      max_voxels the largest grid that may be made
 * @return MS_OK; MS_ERR_ARG for an empty clump; MS_ERR_LIMIT where the spheres are so far apart that the grid would be
 *         too large, or so large or small that their volume is no number; MS_ERR_NOMEM
 *
 * Source: the prototypical clump of Yuan 2019, section 4. Cost: one raster of 4 million voxels inside.
 */
MS_API ms_status ms_particle_union(ms_body *body, const ms_clump *clump, size_t max_voxels, ms_error *err);

MS_C_END

#endif
