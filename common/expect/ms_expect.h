/** The least mismatch D to be expected of a number of spheres, before any clump is made. */
#ifndef MS_EXPECT_H
#define MS_EXPECT_H

#include "base/ms_error.h"
#include "mesh/ms_mesh.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/** Spheres as they are best, or within the shape. */
typedef enum ms_expect_kind { MS_EXPECT_FREE, MS_EXPECT_INSCRIBED } ms_expect_kind;
enum { MS_EXPECT_KINDS = 2, MS_EXPECT_MOST_PAIRS = 128 };

/** A number of spheres and the error expected of them, |S xor U| in volumes of the body. */
typedef struct ms_expect_pair {
    double spheres, error;
    double lost; /* the part of the error where no sphere is worth while */
} ms_expect_pair;

/** By number of spheres, ascending, from none (error and lost 1) on. */
typedef struct ms_expect_curve {
    int count;
    ms_expect_pair pair[MS_EXPECT_MOST_PAIRS];
} ms_expect_curve;

/** What is expected of a shape. */
typedef struct ms_expect {
    ms_expect_curve curve[MS_EXPECT_KINDS];
} ms_expect;

/**
 * The least D known of the bodies of docs/expected.md, those on which nothing was fitted included, was from 1 / this to
 * this times what is expected: from 10 spheres on, and from 100 on.
 */
#define MS_EXPECT_RANGE 1.9
#define MS_EXPECT_RANGE_MANY 1.5

/**
 * An expected least, not a bound: the least error for a price on each sphere, from balls within and the points of the
 * surface that they face; asymptotic in the number of spheres. What the medial axis is like (sheet, curve, both)
 * and what is too thin or too sharp for a sphere follows from the points. docs/expected.md derives it and says where
 * it fails.
 *
 * @param[out] expect zeros on failure
 * @param      mesh   closed, wound outward (ms_mesh_repair), nowhere passing through itself
 * @return MS_OK; MS_ERR_SHAPE as ms_inertia_mesh; MS_ERR_NOMEM
 *
 * Cost: O(triangles log triangles) and some million pairs of a ball and a point; 60 MB; all cores, the same bits at
 * any number of threads.
 */
MS_API ms_status ms_expect_mesh(ms_expect *expect, const ms_mesh *mesh, ms_error *err);

/**
 * The same of voxels: of the surface between them, smoothed over three voxels (surface nets, Gibson 1998).
 *
 * @return as ms_expect_mesh; MS_ERR_SHAPE, too, if nothing is thick enough to be left by the smoothing
 */
MS_API ms_status ms_expect_grid(ms_expect *expect, const ms_grid *grid, ms_error *err);

/**
 * The same for free spheres and numbers about one alone, in a tenth to a half of the time: what ms_expect_dice gives
 * for `spheres` is within 2 % of that of the whole (4 % beyond 170 spheres; 5 % of thin walls where their spheres begin
 * to be worth while). The curve of inscribed spheres is empty.
 *
 * @param target  of a closed mesh that does not pass through itself, or of a volume
 * @param spheres 1 or more
 * @return as ms_expect_mesh or ms_expect_grid
 */
MS_API ms_status ms_expect_near(ms_expect *expect, const ms_target *target, double spheres, ms_error *err);

/** The least mismatch D expected of that many spheres, 1 or more. Beyond some 170 the last slope goes on. */
MS_API double ms_expect_dice(const ms_expect *expect, ms_expect_kind kind, double spheres);

/** The least number of spheres of which that D is expected, at least 1; HUGE_VAL above 10^9. dice is above 0. */
MS_API double ms_expect_spheres(const ms_expect *expect, ms_expect_kind kind, double dice);

/** The least number of spheres with which no more than a tenth of the body is better left without any. */
MS_API double ms_expect_least_spheres(const ms_expect *expect, ms_expect_kind kind);

/** A number of spheres as it may be told: whole, and rounded up to three digits, as none is better known. */
MS_API double ms_expect_round(double spheres);

MS_C_END

#endif
