/** The surface area of the body of which voxels are the digital image. */
#ifndef MS_CROFTON_H
#define MS_CROFTON_H

#include "ms_grid.h"

MS_C_BEGIN

/**
 * Surface area by Crofton's formula: how often lines in 13 directions (along edges, diagonals of faces and of the
 * voxel) pass from inside to outside, weighted by the part of the sphere of directions that is nearest to each. Voxel
 * faces would overstate it by up to 1.73. What faces a cavity counts as well.
 *
 * @param grid with a layer of background all around
 * @return in the unit of the grid, squared
 *
 * Source: Ohser & Muecklich, Statistical Analysis of Microstructures in Materials Science (2000), section 4.2.5; Lang,
 * Ohser & Hilfer, J. Microsc. 203 (2001) 303. Cost: one pass; all cores, the same bits at any number of threads.
 */
MS_API double ms_crofton_area(const ms_grid *grid);

MS_C_END

#endif
