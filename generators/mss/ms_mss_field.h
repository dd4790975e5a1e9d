/** The field E* = E + w (E - E~) of MSS (eq. 25: w = 1), kept up to date as spheres are added. Private to ms_mss. */
#ifndef MS_MSS_FIELD_H
#define MS_MSS_FIELD_H

#include "shared/ms_planes.h"
#include "voxel/ms_raster.h"
#include "voxel/ms_target.h"

typedef struct ms_mss_field {
    const ms_target *target;
    const float *e;      /* E; with planes, no more than the distance to the nearest plane */
    float *own_e;        /* where e is kept if it is not the target's own */
    ms_raster raster;    /* the union of the spheres so far, S~ */
    float weight;        /* w */
    float *star;         /* E*, in voxels */
    float deepest;       /* largest E */
    float deepest_union; /* largest E~ so far; E~ only grows */
    int lo[3], hi[3];    /* box lo <= (i,j,k) < hi in which the last update changed E*; empty: lo = hi */
} ms_mss_field;

/**
 * No spheres yet: w = 1, E~ = 0, E* = 2E; all of it counts as changed.
 *
 * @param settings its planes are walls: E has its maxima on either side
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_mss_field_init(ms_mss_field *field, const ms_target *target, const ms_settings *settings, ms_error *err);

/**
 * Adds spheres to S~ and recomputes E* where that can have changed it.
 * Cost: of a distance transform of the changed part and what surrounds it.
 */
ms_status ms_mss_field_add(ms_mss_field *field, const ms_ball *balls, size_t count, ms_error *err);

/** Changes w; all of E* counts as changed. Cost: a distance transform of the grid. */
ms_status ms_mss_field_set_weight(ms_mss_field *field, float weight, ms_error *err);

void ms_mss_field_free(ms_mss_field *field);

#endif
