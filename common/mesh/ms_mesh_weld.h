/** Joins corners that differ by rounding. Private to mesh repair. */
#ifndef MS_MESH_WELD_H
#define MS_MESH_WELD_H

#include "ms_mesh_edges.h"

/**
 * Joins vertices of open edges (of an odd number of triangles) none of whose coordinates differ by more than a
 * tolerance, as each is rounded by itself. Others stay where they are: a closed mesh is not touched, however fine.
 *
 * Pairs are joined nearest first, and only while all that would become one vertex lie within the tolerance of each
 * other: no chain creeps along a fine seam, and no coordinate changes by more than the tolerance. The two ends of an
 * edge are never joined: nothing collapses. The vertex of lowest number gives the place.
 *
 * @param[in,out] mesh      corners are renumbered; vertices that are not used any more stay
 * @param[out]    joined    vertices that became another
 * @param         edges     of the mesh
 * @param         tolerance in the unit of the mesh; at least MS_MESH_LEAST_WELD of its longest side
 * @return MS_OK; MS_ERR_LIMIT where so many vertices lie within the tolerance that it must be a mistake; MS_ERR_NOMEM
 *
 * Source: complete linkage, as in Defays, The Computer Journal 20 (1977) 364. Cost: O(vertices + p log p), p the pairs
 * within the tolerance.
 */
ms_status ms_mesh_weld(ms_mesh *mesh, size_t *joined, const ms_edges *edges, double tolerance, ms_error *err);

#endif
