/** The surface area of the body of which voxels are the digital image. */
#ifndef MS_VOXEL_AREA_H
#define MS_VOXEL_AREA_H

#include "ms_grid.h"

MS_C_BEGIN

/**
 * Surface area: the faces between inside and outside, each times the cosine between it and the surface, whose normal
 * is that of the voxels around, weighted by a Gaussian. The faces alone overstate the area by up to 1.73. What faces a
 * cavity counts as well.
 *
 * Digitised balls anywhere on the lattice are within 1 % from 20 voxels across, and within 0.3 % of the ball that has
 * the volume of the voxels (1 % from 8). About the middle of a voxel, of a face, or a corner whole shells of voxels
 * come and go at once: balls 1.3 % apart in area have the same voxels, which no method can tell, and it is within
 * 1.5 %. Ellipsoids, turned, are within 1 %. Edges are rounded off: one at right angles loses 0.2 to 0.6 voxels times
 * its length.
 *
 * Crofton's formula in 13 directions (Ohser & Muecklich 2000, Lang et al. 2001) is nearly twice as far off on balls and
 * understates faces along the axes by 7 %: the tests compare both. An isosurface of the voxels smoothed by a Gaussian
 * rounds edges off more.
 *
 * @param[out] area in the unit of the grid, squared; 0 on failure
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: Lenoir, Malgouyres & Revenu, Proc. DGCI 1996, LNCS 1176, 182; Coeurjolly, Flin, Teytaud & Tougne, LNCS 2616
 * (2003) 101. Cost: one pass, and 200 voxels for each face; all cores, the same bits at any number of threads.
 */
MS_API ms_status ms_voxel_area(double *area, const ms_grid *grid, ms_error *err);

MS_C_END

#endif
