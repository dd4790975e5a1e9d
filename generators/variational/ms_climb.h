/** Inscribed spheres: the way up to the medial axis. Private to variational. */
#ifndef MS_CLIMB_H
#define MS_CLIMB_H

#include "voxel/ms_target.h"

/**
 * Moves an inscribed sphere away from where it touches the surface, as long as it grows by half of what it moves: to
 * the medial axis, not along it.
 *
 * @param[in,out] ball   its centre, inside a closed mesh, in voxels; gets its radius
 * @param         target with its mesh
 * @param         most   it moves by no more at a time, voxels
 * @return the radius where it began
 *
 * Cost: about 5 times ms_closest_distance.
 */
double ms_climb(ms_ball *ball, const ms_target *target, double most);

#endif
