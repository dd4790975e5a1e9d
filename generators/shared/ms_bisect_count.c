#include "ms_bisect_count.h"

static int is_reached(ms_stop_reason reason)
{
    return reason != MS_STOP_NOT && reason != MS_STOP_SPHERES && reason != MS_STOP_RADIUS &&
           reason != MS_STOP_EXHAUSTED;
}

/* A number of spheres that is known to be too few, and one that is enough, once there is one. */
typedef struct bracket {
    size_t few, enough;
} bracket;

static void replace_clump(ms_clump *clump, ms_clump *by)
{
    ms_clump_free(clump);
    *clump = *by;
    *by = (ms_clump){0};
}

static ms_status double_count(ms_clump *clump, ms_stop_reason *reason, bracket *n, size_t most,
                              ms_bisect_count_solve solve, void *context, ms_error *err)
{
    ms_status status = MS_OK;
    *n = (bracket){0};
    *reason = MS_STOP_NOT;
    while (status == MS_OK && *reason == MS_STOP_NOT && n->enough < most) {
        ms_clump more = {0};
        n->few = n->enough;
        n->enough = n->enough == 0 ? 1 : n->enough < most / 2 ? 2 * n->enough : most;
        status = solve(context, &more, reason, n->enough, err);
        replace_clump(clump, &more);
    }
    if (*reason == MS_STOP_NOT) {
        *reason = MS_STOP_SPHERES;
    }
    return status;
}

ms_status ms_bisect_count(ms_clump *clump, ms_stop_reason *reason, size_t most, ms_bisect_count_solve solve,
                          void *context, ms_error *err)
{
    bracket n;
    ms_status status = double_count(clump, reason, &n, most, solve, context, err);
    while (status == MS_OK && is_reached(*reason) && n.enough - n.few > 1) {
        const size_t middle = n.few + (n.enough - n.few) / 2;
        ms_clump fewer = {0};
        ms_stop_reason why;
        status = solve(context, &fewer, &why, middle, err);
        if (status == MS_OK && is_reached(why)) {
            replace_clump(clump, &fewer);
            *reason = why;
            n.enough = middle;
        } else {
            n.few = middle;
        }
        ms_clump_free(&fewer);
    }
    return status;
}
