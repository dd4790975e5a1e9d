/** What every nested method does with a sphere that it has chosen: into the clump, ask the stop rule, report. */
#ifndef MS_NESTED_H
#define MS_NESTED_H

#include "ms_generator.h"
#include "voxel/ms_raster.h"

MS_C_BEGIN

/**
 * Adds one sphere to a clump.
 *
 * @param[in,out] sum    of the spheres before, then with this one
 * @param[out]    reason as ms_stop_reached; MS_STOP_INTERRUPTED
 * @param         ball   in voxels
 * @param         adds   what it covers first
 * @return MS_OK; as ms_clump_add
 */
ms_status ms_nested_accept(ms_clump *clump, ms_stop_reason *reason, ms_tally *sum, const ms_run *run,
                           const ms_ball *ball, const ms_tally *adds, ms_error *err);

/**
 * Chooses the next sphere.
 *
 * @param[out] ball   in voxels, no smaller than the least radius of the run
 * @param[out] reason set where there is none: MS_STOP_EXHAUSTED, or MS_STOP_RADIUS if only smaller ones are left
 * @param      placed the spheres so far and the voxels that they cover
 */
typedef ms_status (*ms_nested_choose)(void *context, ms_ball *ball, ms_stop_reason *reason, const ms_raster *placed,
                                      ms_error *err);

/**
 * Runs a method that chooses one sphere after the other, until the stop rule holds or there is none left.
 *
 * @param clump, reason, run, err as of ms_generator's generate
 * @return MS_OK; as choose, ms_raster_add and ms_clump_add
 */
ms_status ms_nested_run(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_nested_choose choose,
                        void *context, ms_error *err);

MS_C_END

#endif
