#include "ms_stop.h"

#include <math.h>
#include <string.h>

#include "base/ms_choice.h"
#include "voxel/ms_tally.h"

/* A measure that can be asked for. */
typedef struct stop_goal {
    ms_measure_code measure;
    ms_stop_reason reason;
    size_t offset; /* in ms_stop */
} stop_goal;

#define GOAL_GOAL(CODE, name) {MS_MEASURE_##CODE, MS_STOP_##CODE, offsetof(ms_stop, name)},
#define GOAL_UNION(CODE, name)
#define GOAL_SURFACE(CODE, name)
#define GOAL_NORMAL(CODE, name)
#define GOAL_SPHERES(CODE, name)
#define GOAL_COUNT(CODE, name)
#define GOAL_DESCRIPTOR(CODE, name)
#define GOAL(kind, CODE, name, ...) GOAL_##kind(CODE, name)
static const stop_goal GOALS[] = {MS_MEASURE_LIST(GOAL)};
enum { N_GOALS = sizeof GOALS / sizeof *GOALS };

static double get_asked(const ms_stop *stop, const stop_goal *goal)
{
    double value;
    memcpy(&value, (const char *)stop + goal->offset, sizeof value);
    return value;
}

int ms_stop_is_none(const ms_stop *stop)
{
    return stop->spheres == 0 && !(stop->radius > 0) && !ms_stop_has_measure(stop);
}

int ms_stop_has_measure(const ms_stop *stop)
{
    int any = 0;
    for (size_t g = 0; g < N_GOALS; g++) {
        any |= get_asked(stop, &GOALS[g]) > 0;
    }
    return any;
}

double ms_stop_asked(const ms_stop *stop, const ms_measure *measure)
{
    for (size_t g = 0; g < N_GOALS; g++) {
        if (&ms_measures[GOALS[g].measure] == measure) {
            return get_asked(stop, &GOALS[g]);
        }
    }
    return 0;
}

const char *ms_stop_name(ms_stop_reason reason)
{
    static const char *const NAMES[] = {[MS_STOP_NOT] = "not",
                                        [MS_STOP_SPHERES] = "spheres",
                                        [MS_STOP_RADIUS] = "radius",
                                        [MS_STOP_OFF_VOLUME] = "off-volume",
                                        [MS_STOP_EXHAUSTED] = "exhausted",
                                        [MS_STOP_INTERRUPTED] = "interrupted"};
    for (size_t g = 0; g < N_GOALS; g++) {
        if (GOALS[g].reason == reason) {
            return ms_measures[GOALS[g].measure].name;
        }
    }
    return (size_t)reason < sizeof NAMES / sizeof *NAMES ? NAMES[reason] : "unknown";
}

static ms_status check_radius(double value, ms_error *err)
{
    return value > 0 && isfinite(value)
               ? MS_OK
               : ms_fail(err, MS_ERR_ARG, "radius=%g is out of range; give a number above 0", value);
}

static ms_status check_goal(const ms_measure *measure, double value, ms_error *err)
{
    return value > 0 && value <= 1
               ? MS_OK
               : ms_fail(err, MS_ERR_ARG, "%s=%g is out of range; give a number above 0, up to 1%s", measure->name,
                         value, measure->better == MS_BETTER_LESS ? "; 1e-9 asks for an exact match" : "");
}

ms_status ms_stop_set(ms_stop *stop, const char *measure, double value, ms_error *err)
{
    ms_choice choice = {.typed = measure};
    for (size_t g = 0; g < N_GOALS; g++) {
        const ms_measure *goal = &ms_measures[GOALS[g].measure];
        if (ms_choice_offer(&choice, goal->name)) {
            const ms_status status = check_goal(goal, value, err);
            if (status == MS_OK) {
                memcpy((char *)stop + GOALS[g].offset, &value, sizeof value);
            }
            return status;
        }
    }
    if (ms_choice_offer(&choice, "radius")) {
        const ms_status status = check_radius(value, err);
        stop->radius = status == MS_OK ? value : stop->radius;
        return status;
    }
    return ms_choice_fail(&choice, err, "no measure is called '%s'", measure);
}

ms_stop_reason ms_stop_reached(const ms_stop *stop, const ms_target *target, const ms_tally *sum, size_t n)
{
    if (stop->spheres && n >= stop->spheres) {
        return MS_STOP_SPHERES;
    }
    if (!ms_stop_has_measure(stop)) {
        return MS_STOP_NOT;
    }
    /* the inertia takes the axes of the union, and few ask for it */
    const ms_score score = stop->inertia > 0 || stop->coverage_cut > 0
                               ? ms_metrics_full_score(sum, &target->grid, target)
                               : ms_metrics_score(sum, target->voxels);
    for (size_t g = 0; g < N_GOALS; g++) {
        const ms_measure *measure = &ms_measures[GOALS[g].measure];
        const double asked = get_asked(stop, &GOALS[g]);
        if (asked > 0 && ms_measure_is_reached(measure, measure->of_score(&score), asked)) {
            return GOALS[g].reason;
        }
    }
    return MS_STOP_NOT;
}
