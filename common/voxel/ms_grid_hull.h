/** Convex hulls of the voxels inside a grid. */
#ifndef MS_GRID_HULL_H
#define MS_GRID_HULL_H

#include "mesh/ms_mesh.h"
#include "ms_grid.h"

MS_C_BEGIN

/**
 * The hull of the centres of the voxels, and that of the centres of their faces, which is half a voxel larger along
 * the axes and as much less along diagonals as planes of voxels are nearer to each other there: its dimensions are
 * those of the body, on the average over its places on the grid.
 *
 * @param[out] centres, faces  in voxels of the grid; ms_mesh_free frees them; empty on failure
 * @return MS_OK; MS_ERR_SHAPE where the centres span no volume (`centres` is empty then, `faces` is not), or no voxel
 *         is inside; as ms_hull_build
 */
ms_status ms_grid_hull_build(ms_mesh *centres, ms_mesh *faces, const ms_grid *grid, ms_error *err);

/**
 * How many voxels have their centre in a convex hull, or on it. Those of a digitised convex body have all of these in
 * the hull of their centres, and no other.
 *
 * @param[out] count
 * @param      hull  of ms_grid_hull_build, within the grid
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(triangles + rows of voxels).
 */
ms_status ms_grid_hull_count(size_t *count, const ms_mesh *hull, const ms_grid *grid, ms_error *err);

MS_C_END

#endif
