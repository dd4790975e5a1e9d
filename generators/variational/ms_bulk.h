/** Few large spheres for a shape of which inscribed ones cover next to nothing. Private to variational. */
#ifndef MS_BULK_H
#define MS_BULK_H

#include "ms_coarse_view.h"
#include "ms_surface_fit.h"

/** What there is beside the spheres of the inscribed cover. All borrowed. */
typedef struct ms_bulk_other {
    const ms_ball *given; /* spheres to start from; NULL: clusters of the volume instead */
    size_t n_given;
    const ms_coarse_view *volume; /* what stands in its grid; above all planes of symmetry */
    size_t wanted;                /* spheres, mirror images among them */
} ms_bulk_other;

/** D of spheres and their images. @return, cost: as ms_dice_compute */
ms_status ms_bulk_dice(double *dice, const ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err);

/**
 * Spheres in the place of clusters of the volume: k-means (Lloyd) of its voxels, begun with those that are the farthest
 * from one another; each radius is that of the ball with the cluster's second moment.
 *
 * @param[out] ball  in voxels of the target's grid; room for `wanted`
 * @param[out] count `wanted`, or fewer where there are not as many voxels
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: Lloyd, IEEE Trans. Inf. Theory 28 (1982) 129. Cost: 10^5 distances for each sphere.
 */
ms_status ms_bulk_cluster(ms_ball *ball, size_t *count, const ms_coarse_view *volume, size_t wanted, ms_error *err);

/**
 * Fits spheres so that D itself is least, of which |S xor U| is the numerator alone. Where D is far from 0 that is not
 * the same: the best spheres of a thin wall are so thick that |U| = 2 |S|. D = |S xor U| / (|S| + |U|) is least where
 * |S xor U| - D |U| is, D being the least one, which is sought by turns. Both the spheres and others (large ones in the
 * place of clusters of the volume, or those given) are fitted for 40 steps, and the better ones for 60 more, within
 * bounds all of them. The best of all that were found are kept.
 *
 * @param[in,out] ball  `count` spheres, in voxels
 * @param         room  for spheres in ball: as many as are wanted or given
 * @return MS_OK; MS_ERR_NOMEM. D, and the price of what of the surface is too far, are together never larger than
 * before
 *
 * Source: Dinkelbach, Management Science 13 (1967) 492. Cost: 140 steps of the fit (within bounds 200)
 * and some ten times ms_dice_compute.
 */
ms_status ms_bulk_improve(ms_ball *ball, size_t *count, size_t room, const ms_bulk_other *other, ms_surface_fit *fit,
                          ms_error *err);

#endif
