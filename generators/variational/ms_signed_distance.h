/** Signed distance to a target's surface, looked up between the nodes of a lattice. */
#ifndef MS_SIGNED_DISTANCE_H
#define MS_SIGNED_DISTANCE_H

#include "voxel/ms_target.h"

MS_C_BEGIN

/** In voxels of the target's grid, as all lengths here; negative inside. */
typedef struct ms_signed_distance {
    const ms_target *target; /* borrowed */
    int step;                /* between nodes */
    int cubic;               /* nonzero: looked up by cubic polynomials, else linearly */
    int n[3];                /* nodes: node i lies on voxel i * step */
    float *phi;              /* at the nodes; NAN: not asked for yet */
} ms_signed_distance;

/**
 * Of a closed mesh nothing is computed yet: each node is, exactly, when it is first needed, so that
 * only those near the spheres' surfaces ever are. A volume, or a mesh with holes, has only voxels:
 * half a voxel less than the distance to the nearest voxel of the other kind.
 *
 * @param[out] field the caller frees it; empty on failure
 * @param      step  1 or more; the look-up is off by step^2 / (8 radius of curvature) or so
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: one pass over the nodes; for voxels a distance transform.
 */
ms_status ms_signed_distance_alloc(ms_signed_distance *field, const ms_target *target, int step, ms_error *err);

/**
 * Linear between nodes; beyond the lattice, the value at its border and the way there.
 *
 * Threads may share a field. Cost: 8 loads, and once per node ms_closest_signed_distance.
 */
double ms_signed_distance_at(const ms_signed_distance *field, const double place[3]);

/** Nonzero if it knows the surface better than voxels do: that of a closed mesh. */
int ms_signed_distance_is_exact(const ms_signed_distance *field);

void ms_signed_distance_free(ms_signed_distance *field);

MS_C_END

#endif
