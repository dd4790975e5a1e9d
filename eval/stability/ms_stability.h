/** What a method gives for a shape that was changed in a way that should not matter. */
#ifndef MS_STABILITY_H
#define MS_STABILITY_H

#include <stdio.h>

#include "cli/ms_input.h"
#include "cli/ms_methods.h"
#include "measure/ms_metrics.h"
#include "ms_change.h"

/** How a run ended. */
#define MS_OUTCOME_LIST(X)                                                  \
    X(OK, "ok")             /* as many spheres as asked for */              \
    X(SHORT, "short")       /* fewer: the method found no place for more */ \
    X(FAILED, "failed")     /* the method gave nothing */                   \
    X(UNUSABLE, "unusable") /* the changed shape is no body, or its grid too large: no word on the method */

#define MS_OUTCOME_ENUM(code, name) MS_OUTCOME_##code,
typedef enum ms_outcome { MS_OUTCOME_LIST(MS_OUTCOME_ENUM) MS_OUTCOMES } ms_outcome;
#undef MS_OUTCOME_ENUM

/** What the runs of a method on a shape share. Everything is borrowed. */
typedef struct ms_stability {
    const ms_input *input; /* unchanged, with its target: the judge of all runs */
    const ms_method *method;
    size_t spheres;
    double until_dice; /* 0: not asked for */
    uint64_t seed;
    int threads;
    int runs; /* levels of each change */
    const ms_input_flags *flags;
} ms_stability;

/** A run. What it did not get to is NAN or 0. */
typedef struct ms_stability_run {
    const char *shape;       /* borrowed */
    const ms_method *method; /* borrowed */
    uint64_t shape_checksum;
    const ms_change *change;
    int number; /* from 1 */
    double level;
    uint64_t seed;
    double voxel_size;
    double misfit; /* of the changed shape and its voxels: ms_target_misfit */
    int threads;
    size_t asked;
    double until_dice; /* 0: not asked for */
    ms_outcome outcome;
    ms_stop_reason reason;
    ms_metrics metrics;   /* against the unchanged shape, of the spheres moved back */
    size_t spheres_until; /* number with which the method met the mismatch asked for; 0: not with 10 times `asked` */
    double seconds;       /* of the method */
    uint64_t checksum;    /* of the spheres, moved back */
    ms_error cause;       /* "" unless failed or unusable */
} ms_stability_run;

/**
 * Changes the shape, runs the method on it, moves the spheres back and judges them on the grid of the unchanged shape.
 * A failure is a result: it stands in the run.
 *
 * @param number from 1 to ms_change_runs
 */
void ms_stability_try(ms_stability_run *run, const ms_stability *s, const ms_change *change, int number);

/** What a method is called in tables: NAME or NAME:OPTIONS, cut if it is long. */
typedef struct ms_label {
    char text[128];
} ms_label;

ms_label ms_stability_label(const ms_method *method);

/** Nonzero if it gave spheres, which were judged. */
int ms_stability_gave(const ms_stability_run *run);

/**
 * The run on the unchanged shape by the same method: those of a shape and method begin with it.
 * @param run one of the array `runs`
 * @return NULL if it gave no spheres
 */
const ms_stability_run *ms_stability_unchanged(const ms_stability_run *runs, const ms_stability_run *run);

/** The columns of the CSV, and a run as its row, without the end of the line. */
void ms_stability_header(FILE *stream);
void ms_stability_row(FILE *stream, const ms_stability_run *run);

#endif
