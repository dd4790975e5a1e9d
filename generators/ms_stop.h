/** The one stop rule of all generators: any of several measures, whichever is reached first. */
#ifndef MS_STOP_H
#define MS_STOP_H

#include <stddef.h>

#include "measure/ms_metrics.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/* Of the measures (MS_MEASURE_LIST) those that can be asked for: a reason to stop, and a field of ms_stop, for each. */
#define MS_STOP_REASON_GOAL(CODE, name) MS_STOP_##CODE,
#define MS_STOP_REASON_UNION(CODE, name)
#define MS_STOP_REASON_SURFACE(CODE, name)
#define MS_STOP_REASON_NORMAL(CODE, name)
#define MS_STOP_REASON_SPHERES(CODE, name)
#define MS_STOP_REASON_COUNT(CODE, name)
#define MS_STOP_REASON_DESCRIPTOR(CODE, name)
#define MS_STOP_REASON(kind, CODE, name, ...) MS_STOP_REASON_##kind(CODE, name)
#define MS_STOP_FIELD_GOAL(name) double name;
#define MS_STOP_FIELD_UNION(name)
#define MS_STOP_FIELD_SURFACE(name)
#define MS_STOP_FIELD_NORMAL(name)
#define MS_STOP_FIELD_SPHERES(name)
#define MS_STOP_FIELD_COUNT(name)
#define MS_STOP_FIELD_DESCRIPTOR(name)
#define MS_STOP_FIELD(kind, CODE, name, ...) MS_STOP_FIELD_##kind(name)

/** Why a run ended: MS_STOP_ETA, ... for a measure that was reached; those behind MS_STOP_RADIUS only a run can say. */
typedef enum ms_stop_reason {
    MS_STOP_NOT,
    MS_STOP_SPHERES,
    MS_MEASURE_LIST(MS_STOP_REASON) /* in the order of the table */
    MS_STOP_RADIUS,
    MS_STOP_OFF_VOLUME,
    MS_STOP_EXHAUSTED,
    MS_STOP_INTERRUPTED /* by ms_progress */
} ms_stop_reason;

/**
 * What a run has to reach. What is 0 is not asked for, so that a zeroed struct asks for nothing and {.spheres = 10} for
 * ten spheres and nothing else. A mismatch of exactly 0 is asked for by a value below that of one voxel, as 1e-9.
 */
typedef struct ms_stop {
    size_t spheres;                /* at most this many */
    double radius;                 /* no sphere smaller than this, in the mesh's unit */
    MS_MEASURE_LIST(MS_STOP_FIELD) /* eta, dice, coverage, ...: as good as this */
} ms_stop;

/** Nonzero if nothing is asked for, so that nothing would end a run. */
MS_API int ms_stop_is_none(const ms_stop *stop);

/** Nonzero if a measure has to be reached, and not only a number or a radius. */
MS_API int ms_stop_has_measure(const ms_stop *stop);

/** What is asked of a measure; 0 if nothing is. */
MS_API double ms_stop_asked(const ms_stop *stop, const ms_measure *measure);

/** "eta", "exhausted", ...: the names that --until takes, but for those that only a method can say. */
MS_API const char *ms_stop_name(ms_stop_reason reason);

/**
 * Sets one measure, or the radius, by its name.
 *
 * @param value above 0; of a measure up to 1
 * @return MS_OK; MS_ERR_ARG for an unknown name or a value out of range, with the names
 */
MS_API ms_status ms_stop_set(ms_stop *stop, const char *measure, double value, ms_error *err);

/**
 * Is a union of n spheres good enough? Whether a next sphere would be too small is the
 * generator's to see.
 *
 * @param sum of the tallies of the n spheres
 * @return the first reason in the order of the list; MS_STOP_NOT
 */
MS_API ms_stop_reason ms_stop_reached(const ms_stop *stop, const ms_target *target, const struct ms_tally *sum,
                                      size_t n);

MS_C_END

#endif
