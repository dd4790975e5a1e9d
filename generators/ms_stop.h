/** The one stop rule of all generators: any of several measures, whichever is reached first. */
#ifndef MS_STOP_H
#define MS_STOP_H

#include <stddef.h>

#include "measure/ms_metrics.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/* Why a run ended; the names are those that --until takes, but for those that only a method can say. */
#define MS_STOP_LIST(X)                 \
    X(MS_STOP_NOT, "not")               \
    X(MS_STOP_SPHERES, "spheres")       \
    X(MS_STOP_ETA, "eta")               \
    X(MS_STOP_DICE, "dice")             \
    X(MS_STOP_COVERAGE, "coverage")     \
    X(MS_STOP_INERTIA, "inertia")       \
    X(MS_STOP_RADIUS, "radius")         \
    X(MS_STOP_OFF_VOLUME, "off-volume") \
    X(MS_STOP_EXHAUSTED, "exhausted")

#define MS_STOP_ENUM(code, name) code,
typedef enum ms_stop_reason { MS_STOP_LIST(MS_STOP_ENUM) } ms_stop_reason;
#undef MS_STOP_ENUM

/** What a run has to reach. A measure below 0 is not asked for. */
typedef struct ms_stop {
    size_t spheres;  /* at most this many; 0: no bound */
    double eta;      /* eta at most */
    double dice;     /* D at most */
    double coverage; /* coverage at least */
    double inertia;  /* weighted mean error of the principal moments (Yuan 4) at most */
    double radius;   /* no sphere smaller than this, in the mesh's unit */
} ms_stop;

/** Nothing asked for. */
ms_stop ms_stop_none(void);

/** Nonzero if nothing is asked for, so that nothing would end a run. */
int ms_stop_is_none(const ms_stop *stop);

/** Nonzero if a measure has to be reached, and not only a number or a radius. */
int ms_stop_has_measure(const ms_stop *stop);

/** "eta", "exhausted", ... */
const char *ms_stop_name(ms_stop_reason reason);

/**
 * Sets one measure by its name.
 * @return MS_OK; MS_ERR_ARG for an unknown name or a value out of range, with the names
 */
ms_status ms_stop_set(ms_stop *stop, const char *measure, double value, ms_error *err);

/**
 * Is a union of n spheres good enough? Whether a next sphere would be too small is the
 * generator's to see.
 *
 * @param sum of the tallies of the n spheres
 * @return the first reason in the order of the list; MS_STOP_NOT
 */
ms_stop_reason ms_stop_reached(const ms_stop *stop, const ms_target *target, const ms_tally *sum, size_t n);

MS_C_END

#endif
