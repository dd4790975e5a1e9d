/** How far the results of runs lie apart that should be alike. */
#ifndef MS_STATISTICS_H
#define MS_STATISTICS_H

#include <jansson.h>
#include <stdio.h>

#include "ms_stability.h"

/** Of values; all NAN if there are none. */
typedef struct ms_statistics {
    size_t count;
    double least, median, most;
    double deviation; /* standard deviation, of a sample; 0 of a single value */
} ms_statistics;

/** The runs of one method with one change, on one shape or on all. */
typedef struct ms_statistics_group {
    const char *shape;       /* borrowed; NULL: all */
    const ms_method *method; /* borrowed */
    const ms_change *change;
    size_t runs; /* without the unusable ones */
    size_t failed, shorter, unusable;
    size_t identical;       /* the spheres of the unchanged shape, to the last bit */
    size_t not_reached;     /* of --until-dice */
    ms_statistics dice;     /* D; of all shapes: D over that of the unchanged shape */
    ms_statistics inertia;  /* weighted mean error */
    ms_statistics until;    /* numbers of spheres */
    const char *worst;      /* of all shapes: where D over the unchanged one is largest; NULL without */
    const ms_error *cause;  /* of the first run that failed, or else was unusable; NULL without */
    size_t remarked;        /* of the other runs: the method has a remark on the clump */
    const ms_error *remark; /* the first; NULL without */
} ms_statistics_group;

/**
 * Groups runs.
 *
 * @param[out] groups freed by free(); first those of each shape, in the order of the runs, then those of all shapes if
 *                    there are several
 * @param[out] count  of groups
 * @param      runs   borrowed while the groups are used; those of one group stand together
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_statistics_group_runs(ms_statistics_group **groups, size_t *count, const ms_stability_run *runs,
                                   size_t n_runs, ms_error *err);

/** A table for people; the columns of --until-dice only if `until` is nonzero. */
void ms_statistics_print(FILE *stream, const ms_statistics_group *groups, size_t count, int until);

/** The same for machines; the caller owns it; NULL without memory. */
json_t *ms_statistics_json(const ms_statistics_group *groups, size_t count);

#endif
