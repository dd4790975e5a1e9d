/** Private: the normal of the body of which voxels are the digital image. */
#ifndef MS_VOXEL_NORMAL_H
#define MS_VOXEL_NORMAL_H

#include "ms_grid.h"

/**
 * Outward normal at a place on the surface or near it: towards fewer voxels inside, weighted by a Gaussian of 2 voxels
 * around the place. What is beyond the grid is outside. Of digitised planes and balls from 20 voxels across it is 1.2
 * degrees off (root of the mean square), of planes nearly along the lattice up to 4, and 11 at the worst; at edges it
 * is that of an edge rounded off.
 *
 * @param[out] normal of length 1; undefined if there is none
 * @param      place  in voxels, from the centre of voxel (0, 0, 0)
 * @return 0 if all voxels around are of one kind
 *
 * Source: Coeurjolly, Flin, Teytaud & Tougne, LNCS 2616 (2003) 101. Cost: 1728 voxels.
 */
int ms_voxel_normal(double normal[3], const ms_grid *grid, const double place[3]);

#endif
