/** The convex hull of a clump. */
#ifndef MS_CLUMP_HULL_H
#define MS_CLUMP_HULL_H

#include "mesh/ms_mesh.h"
#include "ms_clump.h"

MS_C_BEGIN

/**
 * A polyhedron that stands for the convex hull of the spheres: for each of 2048 directions, spread evenly, the point of
 * the spheres that lies farthest that way. These are a little outside of the spheres, so that the polyhedron about one
 * sphere has its volume; of others its volume is good to 1e-3.
 *
 * @param[out] hull  closed, wound outward, in the clump's unit; ms_mesh_free frees it; empty on failure
 * @return as ms_hull_build; MS_ERR_SHAPE for an empty clump. Cost: O(n)
 */
ms_status ms_clump_hull_build(ms_mesh *hull, const ms_clump *clump, ms_error *err);

MS_C_END

#endif
