#include "ms_judge.h"

ms_stop_reason ms_judge_sum(ms_score *score, int *interrupted, const ms_run *run, const ms_tally *sum, size_t n)
{
    const ms_score now = ms_metrics_score(sum, run->target->voxels);
    if (score) {
        *score = now;
    }
    const int is_to_end = run->progress && run->progress(run->progress_context, n, now.dice);
    if (interrupted) {
        *interrupted = is_to_end;
    }
    return ms_stop_reached(&run->stop, run->target, sum, n);
}

ms_status ms_judge_union(ms_score *score, ms_stop_reason *reason, const ms_run *run, const ms_ball *ball, size_t count,
                         ms_error *err)
{
    ms_tally sum;
    *reason = MS_STOP_NOT;
    const ms_status status = ms_raster_union(&sum, &run->target->grid, run->target->rule, ball, count, err);
    if (status == MS_OK) {
        const ms_stop_reason reached = ms_judge_sum(score, NULL, run, &sum, count);
        *reason = count > 0 ? reached : MS_STOP_NOT;
    }
    return status;
}
