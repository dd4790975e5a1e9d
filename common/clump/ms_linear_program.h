/** A linear programme for shares of a whole, with goals met one after the other, by GLPK; and a thread
 * for it, in which other programmes run, too. Private. */
#ifndef MS_LINEAR_PROGRAM_H
#define MS_LINEAR_PROGRAM_H

#include <stddef.h>

#include "base/ms_error.h"

/**
 * Shares m_1..m_n within bounds; equations on them that may be off by a goal's column times a weight.
 */
typedef struct ms_linear_program ms_linear_program;

/** What makes, solves and frees programmes. */
typedef ms_status (*ms_linear_program_work)(void *context, ms_error *err);

/**
 * Does the work in a thread of its own and waits for it. All else here may be called from such work alone: GLPK
 * keeps its memory, its error hook and its terminal settings per thread, so that those of the caller stay as they
 * are, and after an error all of GLPK's memory can be freed without touching a problem of the caller's.
 *
 * @return as the work; MS_ERR_NOMEM; MS_ERR_LIMIT if GLPK was built without thread-local storage
 */
ms_status ms_linear_program_apart(ms_linear_program_work work, void *context, ms_error *err);

/** @return NULL without memory. @param least, most bounds of each share, 0 <= least <= most */
ms_linear_program *ms_linear_program_new(size_t n, int n_goals, double least, double most, ms_error *err);

/**
 * Adds |sum row_s m_s - right| <= weight * goal; goal -1: equal.
 *
 * @param row n coefficients
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_linear_program_equation(ms_linear_program *p, const double *row, double right, int goal, double weight,
                                     ms_error *err);

/**
 * Makes a goal's column least, then holds it there. It may be made least again, when others are held.
 *
 * @param      allowed it is held no lower than here
 * @param[out] value   the least one, 0 or more
 * @return MS_OK; MS_ERR_LIMIT if the simplex method finds no end, from whatever basis and with bounds met to 1e-6
 *         instead of 1e-11: no shares are to be had then; MS_ERR_NOMEM
 */
ms_status ms_linear_program_minimise(ms_linear_program *p, int goal, double allowed, double *value, ms_error *err);

/** Makes the weighted sum of the shares least. No other step follows but this one again. @param weight n values, 0 or
 * more @return as ms_linear_program_minimise */
ms_status ms_linear_program_weigh(ms_linear_program *p, const double *weight, ms_error *err);

/** Makes the smallest share greatest. @return as ms_linear_program_minimise */
ms_status ms_linear_program_spread(ms_linear_program *p, ms_error *err);

/** The shares that the last step found, which had MS_OK. @param[out] share n values */
void ms_linear_program_shares(const ms_linear_program *p, double *share);

void ms_linear_program_free(ms_linear_program *p);

#endif
