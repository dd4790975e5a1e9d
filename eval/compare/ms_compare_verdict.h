/** What a comparison comes to, in a few lines. */
#ifndef MS_COMPARE_VERDICT_H
#define MS_COMPARE_VERDICT_H

#include <stdio.h>

#include "ms_compare_records.h"

/**
 * Says, of the last resolution, which method has the least D at the least, a middle and the largest number of spheres,
 * in how many shapes, and how far the others are behind; and which is the quickest at the largest. Where the interval
 * reaches 1 or below, it says that the methods cannot be told apart. Says nothing of a single method.
 *
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_compare_verdict_say(FILE *stream, const ms_compare_records *all, ms_error *err);

#endif
