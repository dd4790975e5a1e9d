/** Volume, centre and inertia tensor of bodies of unit density, and their principal frame. */
#ifndef MS_INERTIA_H
#define MS_INERTIA_H

#include "ms_mesh.h"

MS_C_BEGIN

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
 * the centre of the box, so that a mesh far from the origin keeps its precision. What lies in
 * a mesh more than once counts as often, what is wound inside out negative: ms_solid_mesh
 * takes such bodies for what they are.
 *
 * @param[out] body zeros on failure
 * @param      mesh closed and outward-wound (ms_mesh_repair sees to it); may be empty
 * @return MS_OK; MS_ERR_SHAPE if the volume is not above zero or drowns in rounding, or if a
 *         coordinate is not finite
 *
 * Source: signed tetrahedra from the centre to the triangles, Tonon, Explicit exact formulas
 * for the 3-D tetrahedron inertia tensor, J. Math. Stat. 1 (2005) 8; the same integrals as
 * Eberly, Polyhedral Mass Properties (2002). Cost: O(triangles), one pass.
 */
MS_API ms_status ms_inertia_mesh(ms_body *body, const ms_mesh *mesh, ms_error *err);

/** Adds a part to a body, or with sign -1 takes it away; volume is left. Source: Steiner's theorem. */
MS_API void ms_inertia_add(ms_body *body, const ms_body *part, int sign);

/** Factor that scales a body to the volume of the ball of this diameter. */
MS_API double ms_inertia_factor(const ms_body *body, double size);

/** Scales a body about the origin, in place. */
MS_API void ms_inertia_scale(ms_body *body, double factor);

/** Surface area of the mesh; 0 for an empty one. */
MS_API double ms_mesh_area(const ms_mesh *mesh);

/**
 * Principal moments and axes of body->inertia by GSL (nothing of it that could call its error handler), by rules
 * that leave nothing to chance:
 * - Sign: the component of largest magnitude of the first two axes is positive (the first
 *   such where equal within 1e-9), the third axis is their cross product.
 * - Equal moments: where two agree within 1e-9 of the largest, any axes of their plane would
 *   do. The first of the pair is then along the projection onto that plane of the input's x
 *   axis, or of y where that of x is shorter than 1/2. Three equal moments: the input's axes.
 *   So a ball yields x, y, z; a body of revolution about x yields x, y, z or y, z, x.
 *
 * @param[out] principal zeros on failure
 * @param      body      only its inertia is read; of its two triangles the mean
 * @return MS_OK; MS_ERR_ARG if an element is not finite
 */
MS_API ms_status ms_inertia_principal(ms_principal *principal, const ms_body *body, ms_error *err);

MS_C_END

#endif
