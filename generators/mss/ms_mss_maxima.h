/** The local maxima of E* = E + w (E - E~), found in boxes (MSS 3.3, 3.4 iii). Private to ms_mss. */
#ifndef MS_MSS_MAXIMA_H
#define MS_MSS_MAXIMA_H

#include "ms_mss_field.h"
#include "ms_peaks.h"

typedef struct ms_mss_maximum {
    size_t voxel; /* the maximum at voxel resolution */
    ms_peak peak; /* between the voxels */
} ms_mss_maximum;

/**
 * The maxima of E* where E~ was changed. A maximum and its place depend on the voxels up to two away, so that those
 * in the changed boxes grown by two (ms_mss_maxima_is_stale) replace what was there before.
 *
 * @param[out] found the caller frees it; NULL on failure; each maximum once
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: two passes over the boxes; a slab of E* at a time; all cores.
 */
ms_status ms_mss_maxima_find(ms_mss_maximum **found, size_t *count, const ms_mss_field *field, ms_error *err);

/** Is a voxel where the maxima are found anew? */
int ms_mss_maxima_is_stale(const ms_mss_field *field, size_t voxel);

#endif
