/** The exact Euclidean distance transform (MSS eq. 8). */
#ifndef MS_DISTANCE_H
#define MS_DISTANCE_H

#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/**
 * Distance, in voxels, from each voxel's centre to the nearest background voxel's centre:
 * 0 in the background, INFINITY throughout if there is no background at all. Each value is
 * the rounded root of an exact integer, so that equal distances compare equal.
 *
 * @param[out] distance n[0]*n[1]*n[2] values, x fastest; allocated by the caller (malloc);
 *                      holds integers on the way
 * @param      inside   same extents; nonzero = inside
 * @param      n        extents, each from 1 to 32767
 * @return MS_OK; MS_ERR_ARG; MS_ERR_NOMEM (only lines of the grid are allocated)
 *
 * Source: Meijster, Roerdink & Hesselink 2000 (lower envelopes of parabolas, axis by axis).
 * Cost: O(voxels), two sweeps over memory; all cores; the same bits at any number of threads.
 */
MS_API ms_status ms_distance(float *distance, const uint8_t *inside, const int n[3], ms_error *err);

MS_C_END

#endif
