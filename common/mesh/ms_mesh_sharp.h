/** Private: edges at which the faces of a mesh meet at an angle. */
#ifndef MS_MESH_SHARP_H
#define MS_MESH_SHARP_H

#include "ms_mesh.h"

/**
 * The edges whose two faces turn by more than an angle, and those of more or fewer faces, as triangles a, b, b without
 * area, of which ms_closest finds the nearest point as of any others. Faces too thin to have a normal are passed over.
 *
 * @param[out] edges   freed by ms_mesh_free; empty on failure, and if there are none
 * @param      degrees between the normals of the faces
 * @return MS_OK; as ms_edges_build. Cost: that of ms_edges_build.
 */
ms_status ms_mesh_sharp_edges(ms_mesh *edges, const ms_mesh *mesh, double degrees, ms_error *err);

#endif
