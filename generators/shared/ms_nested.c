#include "ms_nested.h"

#include "ms_judge.h"

ms_status ms_nested_accept(ms_clump *clump, ms_stop_reason *reason, ms_tally *sum, const ms_run *run,
                           const ms_ball *ball, const ms_tally *adds, ms_error *err)
{
    const ms_sphere sphere = ms_grid_sphere(&run->target->grid, ball);
    int interrupted;
    const ms_status status = ms_clump_add(clump, &sphere, err);
    if (status == MS_OK) {
        ms_tally_add(sum, adds);
        *reason = ms_judge_sum(NULL, &interrupted, run, sum, clump->n_spheres);
        if (interrupted && *reason == MS_STOP_NOT) {
            *reason = MS_STOP_INTERRUPTED;
        }
    }
    return status;
}

ms_status ms_nested_run(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_nested_choose choose,
                        void *context, ms_error *err)
{
    ms_raster raster;
    ms_tally sum = {0};
    ms_ball ball;
    ms_status status = ms_raster_alloc(&raster, &run->target->grid, run->target->rule, err);
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        if (clump->n_spheres == MS_CLUMP_MAX_SPHERES) {
            *reason = MS_STOP_SPHERES; /* as many as a clump can have */
            break;
        }
        status = choose(context, &ball, reason, &raster, err);
        if (status != MS_OK || *reason != MS_STOP_NOT) {
            break;
        }
        status = ms_raster_add(&raster, &ball, 1, err);
        if (status == MS_OK) {
            status = ms_nested_accept(clump, reason, &sum, run, &ball, &raster.tally[raster.n_balls - 1], err);
        }
    }
    ms_raster_free(&raster);
    return status;
}
