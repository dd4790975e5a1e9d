/** The exact Euclidean distance transform (MSS eq. 8). */
#ifndef MS_DISTANCE_H
#define MS_DISTANCE_H

#include <stddef.h>
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

/**
 * The same for the voxels of a box alone, from the background of the whole grid given.
 *
 * @param[out] distance where voxel lo goes; those of the box are written, rows apart[0] values apart, planes apart[1]
 * @param      lo,hi    the box lo <= (i,j,k) < hi, not empty, within the grid
 * @return as ms_distance; also MS_ERR_ARG for a box that is no part of the grid
 *
 * Cost: along x of the grid, along y of the box's columns in all planes, along z of its columns; 4 bytes for each voxel
 * of its columns.
 */
MS_API ms_status ms_distance_box(float *distance, const size_t apart[2], const uint8_t *inside, const int n[3],
                                 const int lo[3], const int hi[3], ms_error *err);

MS_C_END

#endif
