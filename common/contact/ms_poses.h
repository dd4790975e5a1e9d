/** Poses of rest: minima of the support function, where the centre of mass lies lowest over a plane. */
#ifndef MS_POSES_H
#define MS_POSES_H

#include "ms_contact.h"
#include "ms_directions.h"

/** h of each direction. @param[out] height one each; the caller allocates. Cost: O(directions count), all cores */
void ms_poses_heights(double *height, const ms_support *body, const ms_directions *directions);

/** Mean distance of two parallel planes that hold the body between them: twice the mean of h. */
double ms_poses_mean_width(const double *height, const ms_directions *directions);

/** Root of the mean square of the difference of two support functions. */
double ms_poses_rms(const double *a, const double *b, const ms_directions *directions);

/**
 * Minima of h that are deeper than `depth`, lowest first. Each direction of the lattice belongs to the minimum that
 * the steepest way along the lattice leads to; a minimum less deep goes to the deeper one behind its lowest pass. The
 * places of the minima are refined to rounding, passes and shares are good to the lattice.
 *
 * @param[out] pose   malloc'ed, the caller frees it; NULL on failure
 * @param[out] count  1 at least
 * @param      height of ms_poses_heights
 * @param      depth  in the body's unit, above 0
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: persistence of minima, Edelsbrunner & Harer, Computational Topology (2010), VII.1.
 * Cost: O(directions log directions), and some hundred h for each minimum of the lattice
 */
ms_status ms_poses_find(ms_pose **pose, size_t *count, const ms_support *body, const ms_directions *directions,
                        const double *height, double depth, ms_error *err);

#endif
