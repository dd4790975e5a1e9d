/** What a method gives for a shape that was changed in a way that should not matter. */
#ifndef MS_STABILITY_H
#define MS_STABILITY_H

#include <stdio.h>

#include "cli/ms_input.h"
#include "cli/ms_methods.h"
#include "measure/ms_metrics.h"
#include "ms_change.h"
#include "queue/ms_queue.h"

/** How a run ended. */
#define MS_OUTCOME_LIST(X)                                                  \
    X(OK, "ok")             /* as many spheres as asked for */              \
    X(SHORT, "short")       /* fewer: the method found no place for more */ \
    X(FAILED, "failed")     /* the method gave nothing */                   \
    X(UNUSABLE, "unusable") /* the changed shape is no body, or its grid too large: no word on the method */

#define MS_OUTCOME_ENUM(code, name) MS_OUTCOME_##code,
typedef enum ms_outcome { MS_OUTCOME_LIST(MS_OUTCOME_ENUM) MS_OUTCOMES } ms_outcome;
#undef MS_OUTCOME_ENUM

/** What a run takes place with. Everything is borrowed. */
typedef struct ms_stability {
    const ms_input *input; /* of the shape, unchanged, with its target: the judge of all runs */
    uint64_t seed;         /* of all runs */
    const ms_input_flags *flags;
    ms_queue_place *place;
    int keep; /* nonzero: the clump stays with the run */
} ms_stability;

/** A run: what it is, and what it gave. What it did not get to is NAN or 0. */
typedef struct ms_stability_run {
    const char *shape;       /* borrowed */
    const ms_method *method; /* borrowed */
    const char *flags;       /* borrowed: what was said of shape and grid, for the row */
    uint64_t shape_checksum;
    double shortest_side; /* of the shape's box */
    const ms_change *change;
    int number; /* from 1 */
    double level;
    uint64_t seed;
    double voxel_size;
    double misfit;       /* of the changed shape and its voxels: ms_target_misfit */
    int threads, beside; /* of this run; other runs at the same time */
    size_t asked;
    double min_radius, until_dice; /* 0: not asked for */
    ms_outcome outcome;
    ms_stop_reason reason;
    ms_metrics metrics;   /* against the unchanged shape, of the spheres moved back */
    size_t spheres_until; /* number with which the method met the mismatch asked for; 0: not with 10 times `asked` */
    double seconds;       /* of the method */
    uint64_t checksum;    /* of the spheres, moved back */
    ms_clump clump;       /* these, where they are kept; ms_stability_free */
    ms_error cause;       /* why it failed or is unusable; of the others what the method remarks; "" without */
} ms_stability_run;

/**
 * Changes the shape, runs the method on it, moves the spheres back and judges them on the grid of the unchanged shape.
 * A failure is a result: it stands in the run.
 *
 * @param[in,out] run shape, method, change, number, level and what is asked for; gets all else
 */
void ms_stability_try(ms_stability_run *run, const ms_stability *s);

/** Frees the clumps that runs have kept. */
void ms_stability_free(ms_stability_run *run, size_t count);

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

/** A run as its row in the CSV, without the end of the line; NULL: the names of the columns. The caller frees it; NULL
 * without memory. */
char *ms_stability_line(const ms_stability_run *run);

/**
 * Takes what a run gave from its row: outcome, D, inertia error, n_until, checksum and cause.
 *
 * @param[in,out] run what it is, which the row must say, too
 * @return MS_OK; MS_ERR_ARG for a row of another run, MS_ERR_FORMAT for one that is damaged, a sentence that follows
 *         "line N"; MS_ERR_NOMEM
 */
ms_status ms_stability_read_row(ms_stability_run *run, const char *row, ms_error *err);

#endif
