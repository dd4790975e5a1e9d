/** Signed distance to a target's surface, looked up between the nodes of a lattice. */
#ifndef MS_SIGNED_DISTANCE_H
#define MS_SIGNED_DISTANCE_H

#include "ms_target.h"

MS_C_BEGIN

/** What a target keeps of them over its runs. Opaque; threads may share one. */
typedef struct ms_signed_distance_store ms_signed_distance_store;

/** In voxels of the target's grid, as all lengths here; negative inside. A view, to copy and to forget. */
typedef struct ms_signed_distance {
    const ms_target *target; /* borrowed; owns the nodes */
    int step;                /* between nodes */
    int cubic;               /* nonzero: looked up by polynomials exact for parabolas, else linearly */
    int n[3];                /* nodes: node i lies on voxel i * step */
    float *phi;              /* at the nodes, the target's; NAN: not asked for yet */
} ms_signed_distance;

/**
 * The target's field with that step, linear; made on first need and kept until ms_target_free: later runs find the
 * nodes that earlier ones computed. Runs on one target may open it side by side.
 *
 * Of a closed mesh nothing is computed yet: each node is, exactly, when it is first needed, so that
 * only those near the spheres' surfaces ever are. A volume, or a mesh with holes, has only voxels:
 * half a voxel less than the distance to the nearest voxel of the other kind.
 *
 * @param[out] field  empty on failure
 * @param      target made by ms_target_from_mesh or its like, with its distance field
 * @param      step   1 or more; the look-up is off by step^2 / (8 radius of curvature) or so
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: the first time one pass over the nodes, for voxels a distance transform. Memory: 4 / step^3 bytes a voxel.
 */
ms_status ms_signed_distance_open(ms_signed_distance *field, const ms_target *target, int step, ms_error *err);

/**
 * Between nodes by the field's polynomials; beyond the lattice, the value at its border and the way there.
 *
 * Threads may share a field. Cost: 8 loads (cubic: 32), and once per node ms_closest_signed_distance.
 */
double ms_signed_distance_at(const ms_signed_distance *field, const double place[3]);

/** Nonzero if it knows the surface better than voxels do: that of a closed mesh. */
int ms_signed_distance_is_exact(const ms_signed_distance *field);

/** For the target. @param[out] out empty; NULL on failure. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_signed_distance_store_alloc(ms_signed_distance_store **out, ms_error *err);
void ms_signed_distance_store_free(ms_signed_distance_store *store);

MS_C_END

#endif
