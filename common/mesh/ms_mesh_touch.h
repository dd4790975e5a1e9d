/** Whether the surface of a mesh meets itself. Private. */
#ifndef MS_MESH_TOUCH_H
#define MS_MESH_TOUCH_H

#include "ms_mesh.h"

/**
 * Looks for two triangles that meet, to 1e-9 of the mesh's longest side, elsewhere than in a
 * vertex or an edge of both. Where shells overlap or one passes through itself there are
 * such; also where they do no more than touch. Triangles with a common edge are passed over:
 * folded onto each other, they enclose nothing.
 *
 * @param[out] touches 1 if there are two such triangles
 * @param      mesh    repaired (ms_mesh_repair)
 * @return MS_OK; as ms_bvh_build
 *
 * Source: separating axes, Gottschalk, Lin & Manocha, OBBTree (1996), on a bounding volume
 * hierarchy. Cost: O(triangles log triangles); it ends with the first that it finds.
 */
ms_status ms_mesh_touch(int *touches, const ms_mesh *mesh, ms_error *err);

#endif
