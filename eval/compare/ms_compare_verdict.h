/** What a comparison comes to, in a few lines. */
#ifndef MS_COMPARE_VERDICT_H
#define MS_COMPARE_VERDICT_H

#include <stdio.h>

#include "ms_compare_records.h"

/**
 * Says, of the last resolution, which method has the least D at the least, a middle and the largest number of spheres,
 * in how many shapes, and how far the others are behind; and which is the quickest at the largest. Where the interval
 * holds 1, it says that the factor does not tell the methods apart; where it lies below, that who wins most often loses
 * by more than it wins. Says nothing of a single method.
 *
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_compare_verdict_say(FILE *stream, const ms_compare_records *all, ms_error *err);

#endif
