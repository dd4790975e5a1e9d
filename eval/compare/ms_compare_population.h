/** The shapes of a comparison as one population: what each method does on all of them, at each number of spheres. */
#ifndef MS_COMPARE_POPULATION_H
#define MS_COMPARE_POPULATION_H

#include "ms_compare_records.h"
#include "ms_compare_spread.h"

/**
 * Rows of one resolution by number of spheres, method and shape. A clump of another tool, which was asked for no
 * number, stands at the least number asked for that is not below its own; one of more spheres than all of them, or
 * where no method was asked, stands nowhere.
 */
typedef struct ms_compare_population {
    size_t n_shapes, n_methods, n_numbers;
    const ms_compare_record **shape;  /* the first row of each; all borrowed from the records */
    const ms_compare_record **method; /* likewise */
    double *number;                   /* ascending */
    const ms_compare_record **row;    /* n_numbers x n_methods x n_shapes; NULL without */
    size_t left_out;                  /* clumps that stand nowhere */
} ms_compare_population;

/**
 * @param[out] p     the caller frees it; empty on failure
 * @param      all   borrowed while the population is used
 * @param      cells resolution as the rows have it; "" for volumes
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(rows + shapes^2).
 */
ms_status ms_compare_population_make(ms_compare_population *p, const ms_compare_records *all, const char *cells,
                                     ms_error *err);

void ms_compare_population_free(ms_compare_population *p);

/** What a row has in a column; NAN without row or value. */
double ms_compare_population_value(const ms_compare_population *p, size_t number, size_t method, size_t shape,
                                   ms_column column);

/** Mean and spread over the shapes. @param room n_shapes values */
ms_compare_spread ms_compare_population_spread(const ms_compare_population *p, size_t number, size_t method,
                                               ms_column column, double *room);

/** Nonzero if a run of this number, by its index, had others at work beside it, so that its time says less. */
int ms_compare_population_is_beside(const ms_compare_population *p, size_t number);

/** What times are put over, as in fig. 11 of the MSS paper: the mean time of the first method at the least number of
 * spheres; NAN if it has none. @param room n_shapes values */
double ms_compare_population_time(const ms_compare_population *p, double *room);

/** How a method stands against the others at a number of spheres, by a column of which less is better. */
typedef struct ms_compare_standing {
    size_t shapes;    /* on which it and another one have a value */
    size_t best;      /* of these: no other has less */
    double factor;    /* geometric mean over them of the least of the others over its own; above 1: it is better */
    double low, high; /* the interval of that (ms_compare_spread_interval) */
} ms_compare_standing;

/**
 * @param[out] standing n_methods. A value below 1e-6 counts as 1e-6, so that a D of 0 has a factor
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_compare_population_judge(ms_compare_standing *standing, const ms_compare_population *p, size_t number,
                                      ms_column column, ms_error *err);

#endif
