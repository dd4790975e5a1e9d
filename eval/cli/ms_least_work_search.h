/** Which numbers of spheres and least radii are tried for the clump of least work. */
#ifndef MS_LEAST_WORK_SEARCH_H
#define MS_LEAST_WORK_SEARCH_H

#include "ms_stop.h"

enum { MS_LEAST_WORK_MOST_RUNS = 12 };

/** A run: what it was asked for, and what it gave. */
typedef struct ms_least_work_try {
    size_t asked;
    double radius;            /* the least one asked for; 0: any */
    size_t spheres;           /* 0: it gave no clump */
    double dice, least, work; /* least: radius of the smallest sphere */
    ms_stop_reason reason;    /* for the caller */
} ms_least_work_try;

/** All runs, in turn. */
typedef struct ms_least_work_tries {
    ms_least_work_try row[MS_LEAST_WORK_MOST_RUNS];
    int count;
    int kept; /* that of least work with D as good as asked; -1: none has */
} ms_least_work_tries;

/** What is sought, where the search begins and what it keeps to. */
typedef struct ms_least_work_bounds {
    double dice, power; /* D to be reached; of the work n (equivalent / least radius)^power */
    size_t first, most; /* numbers of spheres, from 1 on */
    double radius;      /* least radius in any case; 0: none */
    double equivalent;  /* radius of the ball of the shape's volume */
} ms_least_work_bounds;

/** Makes the clump of row[at], whose `asked` and `radius` are set; sets spheres, dice and least, and may set reason. */
typedef ms_status (*ms_least_work_run)(void *context, ms_least_work_try *row, int at, ms_error *err);

/**
 * Tries: first numbers of spheres, from the expected one on, to the least that reaches D (within a twentieth, unless
 * the power is 0); then larger least radii, with more spheres where these cost more D than there is; then fewer.
 *
 * @return MS_OK, also if none reaches it; as `run`
 */
ms_status ms_least_work_search(ms_least_work_tries *tries, const ms_least_work_bounds *bounds, ms_least_work_run run,
                               void *context, ms_error *err);

#endif
