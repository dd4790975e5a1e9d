/** The fields of MSS, E and E~ (eqs. 8, 25), the latter kept up to date as spheres are added. Private to ms_mss. */
#ifndef MS_MSS_FIELD_H
#define MS_MSS_FIELD_H

#include "shared/ms_planes.h"
#include "voxel/ms_raster.h"
#include "voxel/ms_target.h"

/** The voxels lo <= (i,j,k) < hi. */
typedef struct ms_mss_box {
    int lo[3], hi[3];
} ms_mss_box;

typedef struct ms_mss_field {
    const ms_target *target;
    const float *e;       /* E; with planes, no more than the distance to the nearest plane */
    float *own_e;         /* where e is kept if it is not the target's own */
    ms_raster raster;     /* the union of the spheres so far, S~ */
    float weight;         /* w of E* = E + w (E - E~); eq. 25: 1. The caller's to set */
    float *within;        /* E~, in voxels: exact roots, so that equal distances compare equal */
    float deepest;        /* largest E */
    float deepest_within; /* at least the largest E~; E~ only grows */
    uint8_t *covered;     /* by S~ */
    uint8_t *stale;       /* of each block (ms_distance_blocks): the update under way can change E~ */
    ms_mss_box *changed;  /* where the last update can have changed E~ */
    size_t n_changed, room;
} ms_mss_field;

/**
 * E, and room for spheres; w = 1.
 *
 * @param settings its planes are walls: E has its maxima on either side
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_mss_field_init(ms_mss_field *field, const ms_target *target, const ms_settings *settings, ms_error *err);

/**
 * E~ of the spheres that are in the raster by now; all of the grid counts as changed. To be called once, before
 * ms_mss_field_add.
 *
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_mss_field_start(ms_mss_field *field, ms_error *err);

/**
 * Adds spheres to S~ and brings E~ up to date where they can have changed it.
 * Cost: a look at the voxels no farther from the new spheres than the largest E~; ms_distance_blocks of those that had
 * their nearest background among what is covered now.
 */
ms_status ms_mss_field_add(ms_mss_field *field, const ms_ball *balls, size_t count, ms_error *err);

/** Counts all of the grid as changed, as after a change of w. */
ms_status ms_mss_field_touch_all(ms_mss_field *field, ms_error *err);

/** E* of a voxel. */
static inline float ms_mss_field_star(const ms_mss_field *field, size_t voxel)
{
    return (1 + field->weight) * field->e[voxel] - field->weight * field->within[voxel];
}

/** A box with `margin` voxels more on each side, cut to the grid. */
ms_mss_box ms_mss_field_grow(const ms_mss_box *box, int margin, const int n[3]);

void ms_mss_field_free(ms_mss_field *field);

#endif
