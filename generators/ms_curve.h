/** How good the clumps of a generator are, by number of spheres. */
#ifndef MS_CURVE_H
#define MS_CURVE_H

#include "measure/ms_metrics.h"
#include "ms_generator.h"

MS_C_BEGIN

/**
 * Scores of a generator's clumps of 1, 2, ... spheres, up to one that is given.
 *
 * Of a nested generator these are the prefixes of the clump, counted in one pass. Of another one, each
 * is a run of its own: from the largest number down, each starting from the clump before if the
 * generator has an option that takes one (MS_OPTION_CLUMP), else anew.
 *
 * @param[out] curve      clump->n_spheres values
 * @param      clump      what the same run gave
 * @param      run        of its stop rule the least radius is heeded
 * @param      max_voxels as for ms_metrics_compute
 * @return MS_OK; MS_ERR_INTERRUPTED where the run's listener ends one; as ms_generator_run and ms_metrics_compute
 *
 * Cost: one ms_metrics_compute; unless nested, a run and one of those for each number of spheres.
 */
MS_API ms_status ms_curve_compute(ms_score *curve, const ms_clump *clump, const ms_generator *generator,
                                  const ms_run *run, size_t max_voxels, ms_error *err);

/**
 * The same, and the clumps themselves.
 *
 * @param[out]    each    clumps of 1, 2, ... spheres, clump->n_spheres of them, or NULL; of fewer spheres where the
 *                        generator gave fewer than it was asked for. The caller frees each; empty on failure
 * @param[in,out] remarks as many texts, to which is added what the generator remarks on each but the last, which is
 *                        given (ms_generator_keep_remarks); NULL: they go where those of run go
 *
 * Memory: 32 n^2 bytes at the most for n spheres.
 */
MS_API ms_status ms_curve_clumps(ms_score *curve, ms_clump *each, ms_error *remarks, const ms_clump *clump,
                                 const ms_generator *generator, const ms_run *run, size_t max_voxels, ms_error *err);

MS_C_END

#endif
