/** Private: the least error for a price on each sphere, which is the least error for a number of them. */
#ifndef MS_EXPECT_PRICE_H
#define MS_EXPECT_PRICE_H

#include "ms_expect.h"
#include "ms_expect_points.h"

/**
 * What is expected of numbers of spheres, for both kinds.
 *
 * @param[out] expect zeros before
 * @param      points with their balls
 * @param      volume of the body
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: 4 million pairs of a ball and a point at each of three levels at the most; all cores, the same bits at any
 * number of threads.
 */
ms_status ms_expect_price_curves(ms_expect *expect, const ms_expect_points *points, double volume, ms_error *err);

#endif
