/** Volume, centre and inertia tensor of bodies of unit density, and their principal frame. */
#ifndef MS_INERTIA_H
#define MS_INERTIA_H

#include "ms_mesh.h"

/** A body of unit density: mass = volume. */
typedef struct ms_body {
    double volume;
    double centroid[3];
    double inertia[3][3]; /* about the centroid, in the body's input axes; off-diagonals are -sum(x y) */
} ms_body;

/** Principal moments, ascending, and their axes. */
typedef struct ms_principal {
    double moment[3];
    double axis[3][3]; /* axis[m] is the unit vector of moment[m]; right-handed */
} ms_principal;

/**
 * Exact integrals over a closed, outward-wound mesh by the divergence theorem. Summed about
 * the centre of the box, so that a mesh far from the origin keeps its precision.
 *
 * @return MS_OK; MS_ERR_SHAPE if the volume is not above zero (or drowns in rounding)
 * Source: Eberly, Polyhedral Mass Properties (2002). Cost: O(triangles), one pass.
 */
ms_status ms_inertia_mesh(ms_body *body, const ms_mesh *mesh, ms_error *err);

/** Surface area of the mesh. */
double ms_mesh_area(const ms_mesh *mesh);

/**
 * Principal moments and axes by GSL. Sign rule: the component of largest magnitude of the
 * first two axes is positive (the first such where equal within 1e-9), the third axis is
 * their cross product.
 */
ms_status ms_inertia_principal(ms_principal *principal, const double inertia[3][3], ms_error *err);

#endif
