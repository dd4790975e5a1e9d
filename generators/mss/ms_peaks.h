/** Local maxima of a field on a grid, and where they stand between the voxels (MSS 3.3). */
#ifndef MS_PEAKS_H
#define MS_PEAKS_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/** A local maximum, refined along each axis. */
typedef struct ms_peak {
    int voxel[3];    /* (i*, j*, k*): the maximum at voxel resolution */
    double shift[3]; /* refined position minus voxel, each from -1 to 1 (eqs. 12 to 22) */
    double value;    /* of the field, eq. 24, in voxels */
} ms_peak;

/**
 * The voxels of a box that are local maxima: above zero and not below any of their 26
 * neighbours. Plateaus thus appear with all their voxels. Order: by index.
 *
 * @param[out] voxel  indices i + n[0]*(j + n[1]*k); the caller frees it; NULL on failure
 * @param[out] count  how many
 * @param      field  n[0]*n[1]*n[2] values, x fastest; its outermost layer is not looked at
 * @param      lo,hi  the box lo <= (i,j,k) < hi; cut to the inner voxels
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: one pass over the box; all cores.
 */
ms_status ms_peaks_find(size_t **voxel, size_t *count, const float *field, const int n[3], const int lo[3],
                        const int hi[3], ms_error *err);

/**
 * Refines a maximum along each axis by crossing straight lines (eqs. 11 to 24).
 *
 * Where the paper's text breaks mirror symmetry (it takes the left pair of lines when both
 * rise above the voxel) the higher of the two crossings is taken, and none where they are
 * equal: the maximum then lies in the middle, on the voxel.
 *
 * @param voxel at least two layers inside the field, and a maximum of it
 */
void ms_peaks_refine(ms_peak *peak, const float *field, const int n[3], size_t voxel);

/**
 * Another field at a refined maximum, by the same straight lines: the value of E at a
 * maximum of E* (MSS 3.4 iv). Along each axis the lower of the two lines counts, since the
 * field falls away from a ridge on both sides; of the three axes the largest (eq. 24).
 */
double ms_peaks_value(const ms_peak *peak, const float *field, const int n[3]);

MS_C_END

#endif
