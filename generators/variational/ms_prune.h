/** Which spheres a clump can do without. Private to variational. */
#ifndef MS_PRUNE_H
#define MS_PRUNE_H

#include "ms_coarse_view.h"
#include "ms_coverage_count.h"
#include "ms_surface_fit.h"

/**
 * Drops the spheres whose loss raises |S xor U| least. Of those dropped at once no two are close, as the loss of one
 * changes that of the other.
 *
 * @param[in,out] ball  `count` spheres, in voxels of the target's grid
 * @param         most  up to so many, mirror images among them: at least one; but where all have more images, one
 *                      moves onto a plane of symmetry instead, which leaves half of its images
 * @param         view  where it is counted
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: ms_coverage_count_open, and the voxels of all spheres; all cores.
 */
ms_status ms_prune_cheapest(ms_ball *ball, size_t *count, size_t most, const ms_coarse_view *view,
                            const ms_surface_fit *fit, ms_error *err);

/**
 * Drops spheres without which |S xor U| is no larger: inside others, or where nothing is left to gain.
 *
 * @return, cost: as above
 */
ms_status ms_prune_idle(ms_ball *ball, size_t *count, const ms_surface_fit *fit, ms_error *err);

#endif
