/** Nearest point on a mesh, by a hierarchy of bounding boxes. */
#ifndef MS_CLOSEST_H
#define MS_CLOSEST_H

#include "mesh/ms_mesh.h"

MS_C_BEGIN

/** Opaque; read-only after building, so that threads may share one. */
typedef struct ms_closest ms_closest;

/**
 * @param[out] out  freed by ms_closest_free; NULL on failure
 * @param      mesh borrowed: must outlive *out and not change
 * @return MS_OK; MS_ERR_ARG if the mesh is empty; MS_ERR_NOMEM
 * Cost: O(triangles log triangles).
 */
MS_API ms_status ms_closest_build(ms_closest **out, const ms_mesh *mesh, ms_error *err);

/**
 * Distance from a point to the nearest face, edge or vertex, in the mesh's unit.
 *
 * @param[out] nearest the point on the mesh; may be NULL
 * @param      at_most points as far as this or farther are of no interest: then at_most is
 *             returned and nearest is left alone; HUGE_VAL for no bound
 * Source: nearest point of a triangle, Ericson, Real-Time Collision Detection (2005), 5.1.5.
 * Cost: O(log triangles) typical.
 */
MS_API double ms_closest_distance(double nearest[3], const ms_closest *closest, const double point[3], double at_most);

/**
 * Signed distance from a point to a closed, outward-wound mesh: negative inside. Where the
 * nearest point is on an edge or a vertex, the normals of its faces, weighted with their
 * angles there, tell the side.
 *
 * Source: Baerentzen & Aanaes, IEEE TVCG 11 (2005) 243. Cost: about 1.5 times ms_closest_distance.
 */
MS_API double ms_closest_signed_distance(const ms_closest *closest, const double point[3]);

/**
 * The same, and the outward normal of the mesh where it is nearest: that of the face, on an edge or a vertex the mean
 * of its faces', weighted as above.
 *
 * @param[out] normal not of length 1; zeros where faces without area meet; may be NULL
 */
MS_API double ms_closest_signed_normal(double normal[3], const ms_closest *closest, const double point[3]);

/**
 * The same where the distance is known: that of ms_closest_distance, to the last bit. Cost: half of it, or less.
 */
MS_API double ms_closest_side(double normal[3], const ms_closest *closest, const double point[3], double distance);

MS_API void ms_closest_free(ms_closest *closest);

MS_C_END

#endif
