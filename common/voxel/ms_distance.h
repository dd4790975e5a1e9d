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

/* Voxels of a block: those i with the same i / MS_DISTANCE_BLOCK of a row. */
enum { MS_DISTANCE_BLOCK = 16 };

/**
 * The same for some blocks alone, for an update: the others' distances are left as they are.
 *
 * @param wanted one for each block, those of a row one after the other, then rows, then planes; nonzero: write it
 *
 * Cost: for each column of blocks, along x and y of the planes within reach of what is wanted (no farther than the
 * background of the wanted voxels' own rows), along z of the lines with wanted voxels; 64 bytes for each row of these.
 */
MS_API ms_status ms_distance_blocks(float *distance, const uint8_t *inside, const int n[3], const uint8_t *wanted,
                                    ms_error *err);

MS_C_END

#endif
