/** A particle dragged over another, face on face: the friction that bumps of the spheres add. */
#ifndef MS_SLED_H
#define MS_SLED_H

#include "ms_touch.h"

/** A place of two faces. */
typedef struct ms_sled_place {
    ms_touch_place at;
    double way[3]; /* along which the second one is dragged, at right angles to at.u, of length 1 */
} ms_sled_place;

/**
 * T/N where these pairs touch, of a body that keeps its orientation and is dragged slowly: each pair pushes with
 * root(radius) overlap^(3/2) along its normal and rubs with mu of that against its motion, which is along the way and,
 * as the load stays, up or down.
 *
 * @param[out] slope tan t, of the path of the body
 * @return INFINITY where it is jammed
 */
double ms_sled_ratio(double *slope, const ms_touch_pair *pair, size_t count, const ms_sled_place *place,
                     double friction);

/**
 * @param[out] sled     one for each friction; NAN where no place is left
 * @param      friction `n_frictions` of them
 * @param      face     what of each of the two bodies points to the other
 * @param      overlap  the largest, in the body's unit
 * @param      places   how many are drawn: any yaw and way, offsets up to half of r_eq
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(places n^2), the same bits at any number of threads
 */
ms_status ms_sled_drag(ms_sled *sled, const double *friction, size_t n_frictions, const ms_support *body,
                       const double face[3], double r_eq, double overlap, size_t places, unsigned long seed,
                       ms_error *err);

#endif
