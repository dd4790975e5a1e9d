#include "ms_stop.h"

#include <math.h>
#include <string.h>

ms_stop ms_stop_none(void)
{
    return (ms_stop){.eta = -1, .dice = -1, .coverage = -1, .inertia = -1, .radius = -1};
}

int ms_stop_is_none(const ms_stop *stop)
{
    return stop->spheres == 0 && stop->radius < 0 && !ms_stop_has_measure(stop);
}

int ms_stop_has_measure(const ms_stop *stop)
{
    return stop->eta >= 0 || stop->dice >= 0 || stop->coverage >= 0 || stop->inertia >= 0;
}

const char *ms_stop_name(ms_stop_reason reason)
{
    switch (reason) {
#define MS_STOP_CASE(code, name) \
    case code:                   \
        return name;
        MS_STOP_LIST(MS_STOP_CASE)
#undef MS_STOP_CASE
    }
    return "unknown";
}

ms_status ms_stop_set(ms_stop *stop, const char *measure, double value, ms_error *err)
{
    const struct {
        const char *name;
        double *value, max;
    } measures[] = {
        {"eta", &stop->eta, 1},
        {"dice", &stop->dice, 1},
        {"coverage", &stop->coverage, 1},
        {"inertia", &stop->inertia, 1},
        {"radius", &stop->radius, HUGE_VAL},
    };
    for (size_t m = 0; m < sizeof measures / sizeof *measures; m++) {
        if (strcmp(measure, measures[m].name) != 0) {
            continue;
        }
        if (!(value >= 0 && value <= measures[m].max) || !isfinite(value)) {
            return ms_fail(err, MS_ERR_ARG, "%s=%g is out of range; give a number from 0%s", measure, value,
                           measures[m].max > 1 ? " up" : " to 1");
        }
        *measures[m].value = value;
        return MS_OK;
    }
    return ms_fail(err, MS_ERR_ARG, "no measure is called '%s'; choose from eta, dice, coverage, inertia, radius",
                   measure);
}

ms_stop_reason ms_stop_reached(const ms_stop *stop, const ms_target *target, const ms_tally *sum, size_t n)
{
    const ms_score score = ms_metrics_score(sum, target->voxels);
    if (stop->spheres && n >= stop->spheres) {
        return MS_STOP_SPHERES;
    }
    if (stop->eta >= 0 && score.eta <= stop->eta) {
        return MS_STOP_ETA;
    }
    if (stop->dice >= 0 && score.dice <= stop->dice) {
        return MS_STOP_DICE;
    }
    if (stop->coverage >= 0 && score.coverage >= stop->coverage) {
        return MS_STOP_COVERAGE;
    }
    if (stop->inertia >= 0) {
        ms_body body;
        ms_inertia_error error;
        ms_tally_body(&body, sum, &target->grid);
        if (ms_metrics_compare_inertia(&error, &body, &target->body, NULL) == MS_OK &&
            error.weighted <= stop->inertia) {
            return MS_STOP_INERTIA;
        }
    }
    return MS_STOP_NOT;
}
