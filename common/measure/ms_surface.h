/** How far a clump stands out of a mesh, and how far the mesh stands out of the clump. */
#ifndef MS_SURFACE_H
#define MS_SURFACE_H

#include "clump/ms_clump.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/** Distances over a surface, counted 0 where it does not stand out. */
typedef struct ms_standout {
    double max; /* largest */
    double rms; /* root of the mean square over the whole surface */
} ms_standout;

/**
 * The exposed surface of the spheres (what lies in no other sphere) outside the mesh.
 * Sampled by a Fibonacci lattice on each sphere, about one point for each 4 h^2, 32 to 1000
 * of them.
 *
 * @param target of a closed mesh
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(n^2) for the neighbours, a search of the mesh per
 *         sample near or outside the surface; all cores, the same bits at any number of threads.
 */
ms_status ms_surface_protrusion(ms_standout *out, const ms_target *target, const ms_clump *clump, ms_error *err);

/**
 * The surface of the mesh outside all spheres, by the distance to the nearest sphere.
 * Sampled at one point or more in each triangle, about one for each 4 h^2, and for the
 * largest distance at the vertices too.
 *
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(samples * n); threads as above.
 */
ms_status ms_surface_gap(ms_standout *out, const ms_target *target, const ms_clump *clump, ms_error *err);

MS_C_END

#endif
