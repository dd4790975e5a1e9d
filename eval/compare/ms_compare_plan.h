/** What a comparison consists of, in the order of its rows. */
#ifndef MS_COMPARE_PLAN_H
#define MS_COMPARE_PLAN_H

#include "chart/ms_csv.h"
#include "expect/ms_expect.h"
#include "ms_compare.h"
#include "ms_compare_walk.h"
#include "queue/ms_shared_input.h"

/** A shape at a resolution. */
typedef struct ms_compare_stage {
    const char *shape;
    size_t at;    /* of the shape among all */
    double cells; /* NAN for a volume */
    ms_shared_input shared;
    ms_expect expect; /* of the shape, once a run has needed it; empty if nothing can be expected of it */
    int is_expected;
} ms_compare_stage;

/** A run of a method on it, which gives one row or several. Without a method: the contact sheet of the shape. */
typedef struct ms_compare_run {
    ms_compare_stage *stage;
    const ms_method *method;
    const double *asked; /* count numbers of spheres */
    size_t count, there; /* rows; those of them, the first ones, that were there before */
} ms_compare_run;

typedef struct ms_compare_plan {
    ms_compare_stage *stage;
    ms_compare_run *run;
    size_t n_stages, n_runs, n_rows; /* rows of all runs */
} ms_compare_plan;

/**
 * Lists shapes, resolutions, methods and numbers in a fixed order. Runs of which all rows are there already are left
 * out.
 *
 * @param[out] plan freed by ms_compare_plan_free; empty on failure
 * @param      csv  rows that are there must be the first rows of this comparison
 * @return MS_OK; MS_ERR_ARG for rows of another comparison; MS_ERR_NOMEM
 */
ms_status ms_compare_plan_make(ms_compare_plan *plan, const ms_comparison *comparison, const ms_csv *csv,
                               ms_error *err);

void ms_compare_plan_free(ms_compare_plan *plan);

/** A row with what was asked for. @param checksum text of that of the shape, borrowed */
ms_compare_row ms_compare_plan_row(const ms_comparison *comparison, const ms_compare_stage *stage,
                                   const ms_method *method, double asked, const char *checksum);

/** The text of a shape's checksum. */
void ms_compare_plan_checksum(char out[20], uint64_t checksum);

#endif
