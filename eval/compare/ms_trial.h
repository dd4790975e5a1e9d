/** A method tried on a shape: its clumps of several sizes, how long they took, how good they are. */
#ifndef MS_TRIAL_H
#define MS_TRIAL_H

#include "cli/ms_input.h"
#include "ms_compare.h"
#include "ms_generator.h"

/** What is tried. */
typedef struct ms_trial_run {
    const ms_generator *generator;
    const ms_settings *settings;
    uint64_t seed;
    int repeats;         /* times are the medians of as many runs */
    int beside;          /* other runs at the same time, which share the memory that can be measured */
    const size_t *asked; /* numbers of spheres, ascending; more than one of a nested generator only */
    size_t n_asked;
    double min_radius; /* 0: none */
    const char *title; /* begins the line of progress on a terminal */
} ms_trial_run;

/** What it gave. */
typedef struct ms_trial {
    ms_clump clump; /* of the largest number */
    ms_stop_reason reason;
    ms_error remarks;          /* of the method on it; "" without */
    double *seconds;           /* for each number: until there were as many spheres; of the largest the whole run */
    double *fastest, *slowest; /* of the runs of which that is the median; within `seconds` */
    double memory;             /* largest resident memory of the runs, kB; NAN where other runs were beside it */
} ms_trial;

/**
 * Runs the generator to the largest number of spheres.
 *
 * @param[out] trial freed by ms_trial_free; empty on failure
 * @return MS_OK; as ms_generator_run
 */
ms_status ms_trial_make(ms_trial *trial, const ms_trial_run *run, const ms_target *target, ms_error *err);

void ms_trial_free(ms_trial *trial);

/**
 * Judges the first spheres of a clump: all measures, the masses (ms_density_solve) and the times of both.
 *
 * @param[out] row  the columns of measures; on failure some are empty
 * @param      n    at most clump->n_spheres
 * @return MS_OK; as ms_metrics_compute and ms_density_solve
 */
ms_status ms_trial_judge(ms_compare_row *row, const ms_clump *clump, size_t n, const ms_target *target,
                         size_t max_voxels, ms_error *err);

#endif
