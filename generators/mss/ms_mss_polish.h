/** Radii anew once all spheres are there. Private to ms_mss. */
#ifndef MS_MSS_POLISH_H
#define MS_MSS_POLISH_H

#include "ms_mss_run.h"

/**
 * Gives each sphere the radius that makes |S xor S~| least given all the others, a few times over. Voxels are covered
 * by their centres.
 *
 * @param clump the spheres of m's raster
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: the voxels of the spheres' boxes, for each sweep; two bytes a voxel
 */
ms_status ms_mss_polish(ms_clump *clump, ms_mss_run *m, ms_error *err);

#endif
