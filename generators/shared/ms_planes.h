/** Planes that no sphere crosses (MSS section 3.5). Private to the generators. */
#ifndef MS_PLANES_H
#define MS_PLANES_H

#include "ms_option.h"
#include "voxel/ms_target.h"

/** How far a place in the mesh's frame is from the nearest plane, in the mesh's unit; HUGE_VAL without planes. */
double ms_planes_distance(const ms_settings *settings, const double place[3]);

/** How far a place is beyond the planes as seen from `from`: at most 0 if it is on the same side of each. */
double ms_planes_beyond(const ms_settings *settings, const double from[3], const double place[3]);

/**
 * E cut down to the distance to the nearest plane, so that it has its maxima on either side.
 *
 * @param[out] e one value for each voxel of the target's grid, in voxels
 *
 * Cost: one pass over the grid; all cores.
 */
void ms_planes_cut(float *e, const ms_target *target, const ms_settings *settings);

#endif
