/** In which order the spheres of a clump are given. */
#ifndef MS_ORDER_H
#define MS_ORDER_H

#include "ms_generator.h"

MS_C_BEGIN

/**
 * Adds spheres to a clump, by the voxels of the shape that each adds to those before (ms_cover); those that add none
 * come last, as they are given. No radius is below the least one of the run, where rounding has made it so.
 *
 * @param ball in voxels
 * @return MS_OK; as ms_cover_build and ms_clump_add
 */
ms_status ms_order_by_gain(ms_clump *clump, const ms_ball *ball, size_t count, const ms_run *run, ms_error *err);

MS_C_END

#endif
