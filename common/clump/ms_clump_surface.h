/** The surface of the union of a clump's spheres as a closed mesh. */
#ifndef MS_CLUMP_SURFACE_H
#define MS_CLUMP_SURFACE_H

#include "mesh/ms_mesh.h"
#include "ms_clump.h"

/**
 * Cuts the union by a lattice. Each corner of the mesh lies where an edge of the lattice leaves the spheres, to 1/64 of
 * the edge; the faces between are flat, so that the mesh holds somewhat less than the spheres. What is thinner
 * than h, a neck between two spheres or a whole sphere, can be lost.
 *
 * @param[out] mesh       closed, wound outward; freed by ms_mesh_free; empty on failure
 * @param      h          lattice constant, in the clump's unit
 * @param      max_points of the lattice
 * @return MS_OK; MS_ERR_ARG for an empty clump; MS_ERR_SHAPE if no point is inside; MS_ERR_LIMIT; MS_ERR_NOMEM
 *
 * Cost: O(points k) for k spheres near one; all cores, the same bits at any number of threads.
 */
ms_status ms_clump_surface(ms_mesh *mesh, const ms_clump *clump, double h, size_t max_points, ms_error *err);

#endif
