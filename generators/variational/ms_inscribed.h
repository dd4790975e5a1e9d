/** Inscribed spheres: where they cover most. Private to variational. */
#ifndef MS_INSCRIBED_H
#define MS_INSCRIBED_H

#include "ms_surface_fit.h"

/** Are spheres inscribed in a closed mesh, and bound by nothing else that the shape does not say? */
int ms_inscribed_applies(const ms_surface_fit *fit);

/**
 * Inscribed spheres have no freedom but their places on the medial axis. Each is moved along the axes and from there to
 * the medial axis (ms_climb.h) as long as more is covered. Then, twice, a tenth as many are added: of the
 * spheres in which places are that nothing covers those that cover most; all about them are moved, and those of least
 * loss are dropped again. What covers no more is taken back.
 *
 * @param ball `count` spheres, in voxels of the target's grid, inscribed
 * @return MS_OK; MS_ERR_NOMEM. |S xor U|, counted by voxels, is never larger than before
 *
 * Cost: for each move of a sphere its voxels and 5 times ms_closest_distance; what nothing has changed about is not
 * moved again. The spheres to be added by all cores, the same bits at any number of threads.
 */
ms_status ms_inscribed_improve(ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err);

#endif
