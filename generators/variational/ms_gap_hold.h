/** Makes spheres keep to the largest gap. Private to variational. */
#ifndef MS_GAP_HOLD_H
#define MS_GAP_HOLD_H

#include "ms_surface_fit.h"

/**
 * Moves and widens spheres until no part of the surface is farther from them than the fit's gap, which ms_gap_largest
 * has the last word on: places that it finds too far are added to those of the fit, and the fit aims at less than the
 * bound; in the end radii grow by what is left, which is sure where nothing else bounds them.
 *
 * @param[in,out] ball  `count` spheres, in voxels, within the fit's bounds and left so
 * @return MS_OK; MS_ERR_NOMEM. Whether the bound is held, who calls has to ask.
 *
 * Cost: some 100 steps of the fit, ms_gap_largest for each 12.
 */
ms_status ms_gap_hold(ms_ball *ball, size_t count, ms_surface_fit *fit, ms_error *err);

#endif
