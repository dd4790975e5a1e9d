/** Feret dimensions of a convex body: how far apart parallel planes are that hold it between them. */
#ifndef MS_FERET_H
#define MS_FERET_H

#include "ms_mesh.h"

MS_C_BEGIN

/**
 * The sides L >= I >= S of the box that holds the body, as calipers find it: S is the least distance of two parallel
 * planes that hold it, I the least of two that are normal to those, L that of the third pair.
 *
 * @param[out] feret  L, I, S in the unit of the mesh; zeros on failure
 * @param      hull   convex, closed, wound outward (ms_hull_build)
 * @return MS_OK; MS_ERR_SHAPE for a hull without area; as ms_edges_build
 *
 * Source: ISO 9276-6:2008 (least Feret diameter, and that at right angles to it). S is over a face and a corner or over
 * two edges, Houle & Toussaint, IEEE Trans. Pattern Anal. 10 (1988) 761; I is over a side of the projection, Freeman &
 * Shapira, Commun. ACM 18 (1975) 409.
 * Cost: O(triangles^1.5) for the faces at most, a hundredth of all pairs of edges at most.
 */
ms_status ms_feret_measure(double feret[3], const ms_mesh *hull, ms_error *err);

MS_C_END

#endif
