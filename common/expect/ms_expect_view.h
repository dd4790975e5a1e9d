/** Private: the points of the surface as a ball sees them. */
#ifndef MS_EXPECT_VIEW_H
#define MS_EXPECT_VIEW_H

#include "ms_expect_points.h"

/* Points that are looked at or passed over together. */
enum { MS_EXPECT_RUN = 32 };

/** Points that follow each other, and a ball about them. */
typedef struct ms_expect_run {
    double centre[3], radius;
    double at[3][MS_EXPECT_RUN], normal[3][MS_EXPECT_RUN];
} ms_expect_run;

/** A level: each `step`-th point, and a ball at each `every`-th of them; for numbers of spheres up to its last, which
 * have from 50 to 400 of these points each. */
typedef struct ms_expect_level {
    int step, every, most; /* most: points that are kept of what a ball sees */
    double last, wall;     /* number of spheres; that where much is lost, as of a thin wall */
    int points, balls;
    double weight;      /* area of a point */
    ms_expect_run *run; /* points / MS_EXPECT_RUN */
} ms_expect_level;

/** A point as a ball sees it. */
typedef struct ms_expect_view {
    double power; /* squared distance to the centre less the squared radius */
    double slope; /* what the surface is off for each unit of that: 1 / twice the height above the centre */
    int point;    /* of the level */
} ms_expect_view;

/**
 * Fills what follows from step and every.
 *
 * @param[in,out] l      its runs are freed by ms_expect_view_close, also on failure
 * @param         points of the level, at least
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_expect_view_open(ms_expect_level *l, const ms_expect_points *points, ms_error *err);
void ms_expect_view_close(ms_expect_level *l);

/**
 * The points that a ball faces, nearest first.
 *
 * @param[out] view   2 * l->most
 * @param      points with their balls
 * @return their number, l->most at the most
 * Cost: O(most log most) and the points nearby.
 */
int ms_expect_view_see(ms_expect_view *view, const ms_expect_points *points, const ms_expect_level *l, int ball);

#endif
