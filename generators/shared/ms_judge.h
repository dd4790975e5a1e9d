/** Is a union good enough? What every method asks, and says to whoever listens. */
#ifndef MS_JUDGE_H
#define MS_JUDGE_H

#include "ms_generator.h"
#include "voxel/ms_raster.h"

MS_C_BEGIN

/**
 * Asks the stop rule of a run about a union of n spheres, and reports how far the run is.
 *
 * @param[out] score       all but the inertia; NULL if not wanted
 * @param[out] interrupted what ms_progress returned; NULL if not wanted
 * @param      sum         of the tallies of the n spheres
 * @return as ms_stop_reached
 */
ms_stop_reason ms_judge_sum(ms_score *score, int *interrupted, const ms_run *run, const ms_tally *sum, size_t n);

/**
 * The same of spheres that are all new, for methods whose n spheres are not among those for n + 1.
 *
 * @param[out] reason as ms_stop_reached; MS_STOP_NOT for no sphere at all
 * @param      ball   in voxels
 * @return MS_OK; as ms_raster_union
 */
ms_status ms_judge_union(ms_score *score, ms_stop_reason *reason, const ms_run *run, const ms_ball *ball, size_t count,
                         ms_error *err);

MS_C_END

#endif
