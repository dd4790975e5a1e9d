/** Makes the union of the spheres one piece. Private to variational. */
#ifndef MS_CONNECT_H
#define MS_CONNECT_H

#include "ms_mirror.h"
#include "voxel/ms_target.h"

/** A sphere that is to come nearer to another piece, or to the plane beyond which its image is. */
typedef struct ms_tie {
    size_t ball;
    double normal[3]; /* of length 1, towards the other */
    double away;      /* what is its part of the way: half, or all of it to a plane; voxels */
} ms_tie;

/**
 * Lists the ties: the links of the shortest tree that joins all spheres (Prim) whose two spheres do not overlap by half
 * a voxel, from either end; and for each plane of symmetry, unless a sphere reaches beyond it by half of that, the
 * nearest one. If there are none, spheres and images are one piece: a path through the images is one through the
 * spheres themselves once it is folded at the planes.
 *
 * @param[out] tie   the caller frees it
 * @param[out] ties  how many
 * @param      ball  `count` spheres without mirror images, above the planes; those of radius 0 are none
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: Prim, Bell System Technical Journal 36 (1957) 1389. Cost: O(count^2).
 */
ms_status ms_connect_find(ms_tie **tie, size_t *ties, const ms_ball *ball, size_t count, const ms_mirror *mirror,
                          ms_error *err);

/** Leaves the piece of the largest spheres (sum of volumes) alone. @return, cost: as ms_connect_find */
ms_status ms_connect_keep_largest(ms_ball *ball, size_t *count, ms_error *err);

#endif
