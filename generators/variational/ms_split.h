/** New spheres beside those that bear most of the mismatch. Private to variational. */
#ifndef MS_SPLIT_H
#define MS_SPLIT_H

#include "ms_surface_fit.h"

/**
 * Puts two spheres in place of each of those at whose exposed surface most of |S xor U| is, apart along the line to the
 * nearest other sphere: where spheres stand in a row or side by side, that is along the row.
 *
 * @param[in,out] ball  `count` spheres without mirror images, in voxels; room for `more` others, which are appended
 * @param         more  at most `count` are made
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: ms_surface_tally.
 */
ms_status ms_split_worst(ms_ball *ball, size_t *count, size_t more, const ms_surface_fit *fit, ms_error *err);

/** Marks the spheres from `first` on, and of the others those whose centres are the few nearest to one of them.
 * Cost: spheres x those from first on. */
void ms_split_mark_near(uint8_t *near, const ms_ball *ball, size_t count, size_t first);

#endif
