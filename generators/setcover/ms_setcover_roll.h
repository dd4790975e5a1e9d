/** Where the spheres of many voxels end that are rolled inward, and which of them differ. Private to setcover. */
#ifndef MS_SETCOVER_ROLL_H
#define MS_SETCOVER_ROLL_H

#include <stddef.h>

#include "base/ms_error.h"
#include "mesh/ms_closest.h"

MS_C_BEGIN

/** The lattice of the skeleton: its point q is origin + h times the sum of q[a] axis[a], in the mesh's frame. */
typedef struct ms_setcover_field {
    double origin[3], axis[3][3], h;
    int n[3];
    const float *depth; /* ms_distance of its voxels */
} ms_setcover_field;

/** A sphere on its way to the medial surface, in the mesh's frame and unit. */
typedef struct ms_setcover_start {
    double from[3];              /* where it was rolled from, inside the mesh */
    double nearest[3], distance; /* from there: the nearest place of the mesh, and how far it is */
    double centre[3];            /* about a voxel short of the medial surface, as far as the distance field tells */
    double radius;               /* there, roughly; 0: nothing to be had */
    double scale;                /* side of the largest cells of which it is the largest of those that end there */
} ms_setcover_start;

/**
 * Rolls spheres inward on the distance field, and keeps of those that end in one cell the largest: most voxels of the
 * border of a round body roll to the same few places, and only what is kept needs searches among the faces in the
 * depth, which cost most. The way in is away from the nearest face (ms_closest_distance).
 *
 * @param[in,out] start from is given, the rest is found
 * @param[in,out] count how many; then, how many are kept, at the front in the order of before
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: a search near the surface and some ten places of the field for each. All cores, the same bits at any number.
 */
ms_status ms_setcover_roll(ms_setcover_start *start, size_t *count, const ms_setcover_field *field,
                           const ms_closest *closest, ms_error *err);

MS_C_END

#endif
