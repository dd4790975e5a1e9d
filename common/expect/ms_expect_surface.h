/** Private: a mesh about the voxels of a grid. */
#ifndef MS_EXPECT_SURFACE_H
#define MS_EXPECT_SURFACE_H

#include "mesh/ms_mesh.h"
#include "voxel/ms_grid.h"

/**
 * The surface on which the part of the inside, averaged with weights 1, 2, 1 along each axis, is a half; closed, wound
 * outward, in the grid's frame.
 *
 * @param[out] mesh freed by ms_mesh_free; empty on failure
 * @param      grid with background at its border (MS_GRID_HULL)
 * @return MS_OK; MS_ERR_SHAPE if nothing is left inside; MS_ERR_LIMIT; MS_ERR_NOMEM
 * Source: surface nets, Gibson, MICCAI 1998, LNCS 1496, 888. Cost: O(voxels); 8 bytes a voxel.
 */
ms_status ms_expect_surface(ms_mesh *mesh, const ms_grid *grid, ms_error *err);

#endif
