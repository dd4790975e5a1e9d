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
 * Cost: 2560 balls, each with the points about it, at three levels; all cores, the same bits at any number of threads.
 */
ms_status ms_expect_price_curves(ms_expect *expect, const ms_expect_points *points, double volume, ms_error *err);

/**
 * The same for free spheres and numbers about `spheres` alone, at the one level that it belongs to.
 *
 * @param points each ms_expect_price_step(spheres)-th will do
 */
ms_status ms_expect_price_near(ms_expect_curve *curve, const ms_expect_points *points, double volume, double spheres,
                               ms_error *err);

int ms_expect_price_step(double spheres);

#endif
