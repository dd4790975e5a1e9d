/** How many spheres it takes to reach a measure, for methods whose spheres for n are not among those for n + 1. */
#ifndef MS_BISECT_COUNT_H
#define MS_BISECT_COUNT_H

#include "ms_generator.h"

MS_C_BEGIN

/**
 * Makes the clump of at most n spheres.
 *
 * @param[out] clump  empty on entry
 * @param[out] reason MS_STOP_NOT: more spheres are needed; MS_STOP_RADIUS or MS_STOP_EXHAUSTED: more
 *                    would not help; any other: they are enough
 */
typedef ms_status (*ms_bisect_count_solve)(void *context, ms_clump *clump, ms_stop_reason *reason, size_t n,
                                           ms_error *err);

/**
 * Doubles the number of spheres until it is enough, then halves the step between the last that was not and
 * the first that was. Were the measure to rise with every sphere, that would be the least number.
 *
 * @param most no more spheres than this: the run ends with MS_STOP_SPHERES
 * @return MS_OK; as solve
 */
ms_status ms_bisect_count(ms_clump *clump, ms_stop_reason *reason, size_t most, ms_bisect_count_solve solve,
                          void *context, ms_error *err);

MS_C_END

#endif
