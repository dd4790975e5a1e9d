#include "ms_generator.h"

#include <string.h>

ms_status ms_generator_run(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator, const ms_run *run,
                           ms_error *err)
{
    const ms_stop *stop = &run->stop;
    memset(clump, 0, sizeof *clump);
    *reason = MS_STOP_NOT;
    if (!run->target || (run->settings && run->settings->options != generator->options)) {
        return ms_fail(err, MS_ERR_ARG, "%s needs a target, and settings of its own options only", generator->name);
    }
    if (ms_stop_is_none(stop)) {
        return ms_fail(err, MS_ERR_ARG, "nothing says when to stop; give a number of spheres or a measure");
    }
    if (stop->spheres > MS_CLUMP_MAX_SPHERES) {
        return ms_fail(err, MS_ERR_LIMIT, "%zu spheres are more than %d", stop->spheres, MS_CLUMP_MAX_SPHERES);
    }
    ms_settings defaults = {0};
    ms_run all = *run;
    ms_status status = MS_OK;
    if (!run->settings) {
        status = ms_option_settings_init(&defaults, generator->options, err);
        all.settings = &defaults;
    }
    if (status == MS_OK) {
        status = generator->generate(clump, reason, &all, err);
    }
    ms_option_settings_free(&defaults);
    if (status == MS_OK && clump->n_spheres == 0) {
        status = ms_fail(err, MS_ERR_SHAPE, "%s placed no sphere (%s); use more cells or a smaller least radius",
                         generator->name, ms_stop_name(*reason));
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
    }
    return status;
}
