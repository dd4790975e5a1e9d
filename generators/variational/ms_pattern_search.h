/** Pattern search: moves single spheres as long as the mismatch falls. Private to variational. */
#ifndef MS_PATTERN_SEARCH_H
#define MS_PATTERN_SEARCH_H

#include "ms_surface_fit.h"

/**
 * Tries, for one sphere after the other, its centre a step to either side along each axis and its
 * radius a step larger and smaller; keeps what makes |S xor U| smaller, counted by voxels. Halves the
 * step when no sphere moves any more.
 *
 * A sphere whose protrusion is bounded takes the largest radius that is allowed where it would be, if
 * that is less than it has or if its own could not be larger; equal radii stay. Inscribed spheres, if they are bound by
 * nothing else, are left to ms_inscribed_improve.
 *
 * @param ball   `count` spheres, in voxels of the grid, within the fit's bounds
 * @param rounds over all spheres, at most
 * @return MS_OK; MS_ERR_NOMEM. |S xor U| is never larger than before.
 *
 * Cost: rounds x count x 8 x voxels of a sphere; one core.
 */
ms_status ms_pattern_search(ms_ball *ball, size_t count, const ms_grid *grid, const ms_surface_fit *fit, int rounds,
                            ms_error *err);

#endif
