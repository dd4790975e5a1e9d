/** Private: points spread evenly over a mesh, with the balls inscribed there. */
#ifndef MS_EXPECT_POINTS_H
#define MS_EXPECT_POINTS_H

#include "mesh/ms_closest.h"

/* Balls are sought at each eighth point. */
enum { MS_EXPECT_POINTS = 8192, MS_EXPECT_BALL_STEP = 8 };

/** Each stands for the same area. In the order of a curve that fills space: each k-th point of them is spread evenly,
 * too. One array for each coordinate, since all points are measured against each ball. */
typedef struct ms_expect_points {
    double weight;                                               /* area of each */
    double at[3][MS_EXPECT_POINTS], normal[3][MS_EXPECT_POINTS]; /* outward */
    double radius[MS_EXPECT_POINTS / MS_EXPECT_BALL_STEP]; /* of the largest ball that touches there and lies within */
} ms_expect_points;

/**
 * Points in proportion to area. The normal is the mean over the corners of the triangle, and at a corner that over the
 * triangles there that bend by less than 30 degrees from it: of a smooth body it is that of the body, at an edge that
 * of the face.
 *
 * @param[out] points the radii are left alone
 * @param      step   each step-th point alone is put, from the first on; a part of MS_EXPECT_BALL_STEP
 * @param      mesh   closed, wound outward, area above 0
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: O(triangles log triangles).
 */
ms_status ms_expect_points_spread(ms_expect_points *points, int step, const ms_mesh *mesh, ms_error *err);

/**
 * Finds balls by shrinking: one that touches at a point is cut to that which also passes through the point nearest to
 * its centre, until none is nearer than its radius; first among the points with balls, then by the mesh, above which it
 * may stand by a fifth of its radius. So bumps between the points are passed over, as a sphere of a clump does, and
 * thin walls are not.
 *
 * @param closest of the mesh; NULL: made here
 * @return MS_OK; as ms_closest_build
 * Source: Ma, Bae & Choi, 3D medial axis point approximation using nearest neighbors and the normal field, The Visual
 * Computer 28 (2012) 7. Cost: a million pairs of points, then O(log triangles) for each ball; all cores, the same bits
 * at any number of threads.
 */
ms_status ms_expect_points_inscribe(ms_expect_points *points, const ms_mesh *mesh, const ms_closest *closest,
                                    ms_error *err);

#endif
