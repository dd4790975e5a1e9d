/** Directions spread over the sphere, and which are next to each other. */
#ifndef MS_DIRECTIONS_H
#define MS_DIRECTIONS_H

#include "mesh/ms_mesh.h"

/** A lattice on the unit sphere. */
typedef struct ms_directions {
    size_t count;
    double (*u)[3];         /* of length 1; the vertices of the mesh */
    double *weight;         /* part of the sphere that each stands for; their sum is 1 */
    uint32_t *start, *next; /* those next to u[i] are next[start[i]] ... next[start[i + 1] - 1] */
    double spacing;         /* angle between neighbours, about */
    ms_mesh mesh;
} ms_directions;

/**
 * The vertices of an octahedral grid.
 *
 * @param[out] directions ms_directions_free frees it; empty on failure
 * @param      fineness   segments along a quarter turn: 4 fineness^2 + 2 directions
 * @return MS_OK; as ms_shape_make
 */
ms_status ms_directions_make(ms_directions *directions, int fineness, ms_error *err);

void ms_directions_free(ms_directions *directions);

/** Two directions at right angles to u and to each other; with u they are right-handed. */
void ms_directions_tangents(double one[3], double other[3], const double u[3]);

#endif
