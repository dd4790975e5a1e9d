/** Rays through a mesh, along one axis of a grid. Private to the voxeliser. */
#ifndef MS_SWEEP_H
#define MS_SWEEP_H

#include "mesh/ms_mesh.h"
#include "ms_grid.h"

/**
 * Sends rays x rays parallel rays through each voxel and marks what they find inside.
 *
 * @param[in,out] grid   with the box of the mesh in its middle and a hull around it
 * @param         mesh   all coordinates finite; at least one triangle
 * @param         axis   along which the rays run: 0, 1, 2
 * @param         rays   per voxel and axis across: a power of two up to 8
 * @param         parity 0: 1 in voxels of which more than half of the rays' length runs in
 *                       matter (with one ray: whose centre does); 1: sets the bit `axis` in
 *                       voxels beyond whose centre the number of crossings is odd
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_sweep(ms_grid *grid, const ms_mesh *mesh, int axis, int rays, int parity, ms_error *err);

#endif
