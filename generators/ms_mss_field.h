/** The field E* = 2E - E~ of MSS (eq. 25), kept up to date as spheres are added. Private to ms_mss. */
#ifndef MS_MSS_FIELD_H
#define MS_MSS_FIELD_H

#include "ms_raster.h"
#include "ms_target.h"

typedef struct mss_field {
    const ms_target *target;
    ms_raster raster; /* the union of the spheres so far, S~ */
    float *star;      /* E*, in voxels */
    float deepest;    /* largest E */
    int lo[3], hi[3]; /* box lo <= (i,j,k) < hi in which the last update changed E*; empty: lo = hi */
} mss_field;

/** No spheres yet: E~ = 0, E* = 2E; all of it counts as changed. @return MS_OK; MS_ERR_NOMEM */
ms_status mss_field_init(mss_field *field, const ms_target *target, ms_error *err);

/**
 * Adds spheres to S~ and recomputes E* where that can have changed it.
 * Cost: of a distance transform of the changed part and what surrounds it.
 */
ms_status mss_field_add(mss_field *field, const ms_ball *balls, size_t count, ms_error *err);

void mss_field_free(mss_field *field);

#endif
