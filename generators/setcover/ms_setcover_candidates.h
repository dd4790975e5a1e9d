/** The spheres that setcover chooses from. Private to setcover. */
#ifndef MS_SETCOVER_CANDIDATES_H
#define MS_SETCOVER_CANDIDATES_H

#include <stddef.h>

#include "ms_thinning.h"
#include "voxel/ms_raster.h"
#include "voxel/ms_target.h"

/** Which voxels of the lattice become candidates. */
typedef enum ms_setcover_centres {
    SETCOVER_MEDIAL,   /* of the skeleton, and of the border of the shape, where the skeleton stops short */
    SETCOVER_SKELETON, /* of the skeleton (the paper) */
    SETCOVER_ALL       /* all that are inside (the paper's reference) */
} ms_setcover_centres;

/** Where the centres come from. */
typedef struct ms_setcover_lattice {
    double deq; /* voxels per diameter of the ball of equal volume */
    ms_setcover_centres centres;
    ms_skeleton kind;
    int align; /* nonzero: the lattice lies along the principal axes (2.4) */
    int later; /* nonzero: spheres that end on the medial surface are left to ms_setcover_pool_fit */
} ms_setcover_lattice;

/** The spheres to choose from. */
typedef struct ms_setcover_pool {
    const ms_target *target;
    double step;   /* of the lattice, in the shape's unit */
    ms_ball *ball; /* in voxels of the target's grid, by index on the lattice; of radius 0 while it is not fitted */
    size_t count;
    struct ms_setcover_start *start; /* of each what it is fitted from; NULL: all are fitted */
} ms_setcover_pool;

/**
 * One maximal inscribed sphere for each of the voxels (Yuan 2019, section 3), on a lattice of
 * its own.
 *
 * A closed mesh is voxelised by its voxels' centres; the centres of spheres then move onto the
 * medial surface (ms_medial_sphere), but for SETCOVER_ALL, and radii are the distances to the
 * nearest face. For a curve skeleton SETCOVER_MEDIAL leaves out the border.
 *
 * A volume, or a mesh with holes, has only the target's voxels: the lattice takes every s-th of
 * them (align: those nearest to it), SETCOVER_MEDIAL leaves out the border, centres do not
 * move, and the radius is half a voxel less than the distance to the nearest voxel outside, since the
 * surface lies between the two.
 *
 * @param[out] pool   freed by ms_setcover_pool_free, after a failure, too
 * @param      target borrowed until then
 * @return MS_OK; MS_ERR_LIMIT if the lattice would be larger than the target's grid and than
 *         16 million voxels; MS_ERR_SHAPE if no voxel of it is inside; MS_ERR_NOMEM
 */
ms_status ms_setcover_candidates(ms_setcover_pool *pool, const ms_target *target, const ms_setcover_lattice *lattice,
                                 ms_error *err);

/**
 * Fits those that stand for cells whose side is at least `from` and less than `below`, in the shape's unit. A radius
 * of 0 is left where there is no sphere. All cores, the same bits at any number.
 */
void ms_setcover_pool_fit(const ms_setcover_pool *pool, double from, double below);

/** The maximal sphere where a sphere comes to that is moved along an axis by less than its radius, in voxels. */
ms_ball ms_setcover_pool_move(const ms_setcover_pool *pool, const ms_ball *ball, int axis, double by);

void ms_setcover_pool_free(ms_setcover_pool *pool);

#endif
