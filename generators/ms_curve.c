#include "ms_curve.h"

static int takes_clump(const ms_generator *generator)
{
    int found = 0;
    for (const ms_option *o = generator->options; o->name; o++) {
        found |= o->type == MS_OPTION_CLUMP;
    }
    return found;
}

/* Where a generator gives fewer spheres than asked for, their score stands for both numbers. */
static ms_status run_each(ms_score *curve, const ms_clump *clump, const ms_generator *generator, const ms_run *run,
                          size_t max_voxels, ms_error *err)
{
    ms_settings settings = *run->settings;
    ms_run one = *run;
    ms_clump last = {0};
    const ms_clump *larger = clump;
    ms_metrics metrics;
    ms_stop_reason reason;
    one.settings = &settings;
    one.stop = ms_stop_none();
    ms_status status = ms_metrics_compute(&metrics, NULL, run->target, clump, max_voxels, err);
    for (size_t n = clump->n_spheres; n >= 1 && status == MS_OK; n--) {
        ms_clump next;
        curve[n - 1] = metrics.score;
        if (n == 1) {
            break;
        }
        one.stop.spheres = n - 1;
        if (takes_clump(generator)) {
            settings.clump = *larger;
        }
        status = ms_generator_run(&next, &reason, generator, &one, err);
        ms_clump_free(&last);
        last = next;
        larger = &last;
        if (status == MS_OK) {
            status = ms_metrics_compute(&metrics, NULL, run->target, larger, max_voxels, err);
        }
    }
    ms_clump_free(&last);
    return status;
}

ms_status ms_curve_compute(ms_score *curve, const ms_clump *clump, const ms_generator *generator, const ms_run *run,
                           size_t max_voxels, ms_error *err)
{
    ms_metrics metrics;
    return generator->nested ? ms_metrics_compute(&metrics, curve, run->target, clump, max_voxels, err)
                             : run_each(curve, clump, generator, run, max_voxels, err);
}
