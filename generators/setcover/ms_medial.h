/** Maximal inscribed spheres of a mesh. */
#ifndef MS_MEDIAL_H
#define MS_MEDIAL_H

#include "mesh/ms_closest.h"

MS_C_BEGIN

/**
 * Moves a point inside a mesh straight away from the nearest face, until the distance to the
 * mesh ceases to rise: onto the medial surface. The sphere about the new point contains the
 * one about the old.
 *
 * Faces whose nearest points lie less than 26 degrees apart, as seen from the centre, count as
 * one smooth surface; else the edges of every facet would have medial surfaces of their own.
 *
 * @param[in,out] centre    inside the mesh
 * @param         radius    the distance to the mesh there, and nearest its nearest point: of ms_closest_distance
 * @param         stride    about as far as the medial surface may be, or farther
 * @param         tolerance how exactly it is found, in the mesh's unit like stride
 * @return the radius: the distance from the new centre to the nearest face
 *
 * Source: the balls that shrink to the medial surface of Ma, Bae & Choi, Vis. Comput. 28 (2012)
 * 7, here from nearest points, so that no normals are needed. Cost: about four times ms_closest_distance, and once
 * more each time that stride has to be doubled.
 */
double ms_medial_sphere(double centre[3], double radius, const double nearest[3], const ms_closest *closest,
                        double stride, double tolerance);

MS_C_END

#endif
