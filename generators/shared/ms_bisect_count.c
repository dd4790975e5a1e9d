#include "ms_bisect_count.h"

static int is_reached(ms_stop_reason reason)
{
    return reason != MS_STOP_NOT && reason != MS_STOP_SPHERES && reason != MS_STOP_RADIUS &&
           reason != MS_STOP_EXHAUSTED;
}

static void replace(ms_clump *clump, ms_clump *by)
{
    ms_clump_free(clump);
    *clump = *by;
    *by = (ms_clump){0};
}

static ms_status double_up(ms_clump *clump, ms_stop_reason *reason, size_t *few, size_t *enough, size_t most,
                           ms_bisect_count_solve solve, void *context, ms_error *err)
{
    ms_status status = MS_OK;
    *few = *enough = 0;
    *reason = MS_STOP_NOT;
    while (status == MS_OK && *reason == MS_STOP_NOT && *enough < most) {
        ms_clump more = {0};
        *few = *enough;
        *enough = *enough == 0 ? 1 : *enough < most / 2 ? 2 * *enough : most;
        status = solve(context, &more, reason, *enough, err);
        replace(clump, &more);
    }
    if (*reason == MS_STOP_NOT) {
        *reason = MS_STOP_SPHERES;
    }
    return status;
}

ms_status ms_bisect_count(ms_clump *clump, ms_stop_reason *reason, size_t most, ms_bisect_count_solve solve,
                          void *context, ms_error *err)
{
    size_t few, enough;
    ms_status status = double_up(clump, reason, &few, &enough, most, solve, context, err);
    while (status == MS_OK && is_reached(*reason) && enough - few > 1) {
        const size_t middle = few + (enough - few) / 2;
        ms_clump fewer = {0};
        ms_stop_reason why;
        status = solve(context, &fewer, &why, middle, err);
        if (status == MS_OK && is_reached(why)) {
            replace(clump, &fewer);
            *reason = why;
            enough = middle;
        } else {
            few = middle;
        }
        ms_clump_free(&fewer);
    }
    return status;
}
