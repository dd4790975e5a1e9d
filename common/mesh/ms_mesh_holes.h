/** Finds the holes of a mesh and fills them. Private to mesh repair. */
#ifndef MS_MESH_HOLES_H
#define MS_MESH_HOLES_H

#include "ms_mesh_edges.h"

/**
 * Follows the open edges (of an odd number of triangles) around each hole, and fills those that are small enough with
 * triangles as a polygon is cut (ms_mesh_polygon.h): exactly where the hole is flat. A hole that meets itself in a
 * vertex is two. The triangles are wound as their neighbours are.
 *
 * @param[in,out] mesh      triangles are added behind the others; no vertices
 * @param[in,out] report    `filled` is added to; `holes` and `largest_hole` are those that are left
 * @param         edges     of the mesh as it comes
 * @param         max_edges of a hole that is filled; 0: none, holes are counted alone
 * @return MS_OK; as ms_mesh_polygon_cut; MS_ERR_NOMEM
 *
 * Source: every vertex has an even number of open edges, so that they make rings (Euler).
 * Cost: O(vertices + triangles), and of holes that are filled mostly O(edges^2).
 */
ms_status ms_mesh_holes(ms_mesh *mesh, ms_mesh_report *report, const ms_edges *edges, size_t max_edges, ms_error *err);

#endif
