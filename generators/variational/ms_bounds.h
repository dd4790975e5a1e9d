/** What the spheres of a fit have to keep to. Private to variational. */
#ifndef MS_BOUNDS_H
#define MS_BOUNDS_H

#include "shared/ms_planes.h"
#include "voxel/ms_raster.h"
#include "voxel/ms_signed_distance.h"

/** Lengths in voxels. */
typedef struct ms_bounds {
    double least;              /* no radius below this */
    double protrusion;         /* no sphere sticks out by more; HUGE_VAL: no bound */
    int equal;                 /* nonzero: one radius for all */
    const ms_settings *planes; /* those that no sphere crosses; NULL: none */
} ms_bounds;

/** Nonzero if protrusion is bounded or there are planes. */
int ms_bounds_are_set(const ms_bounds *bounds);

/** How far a place on a sphere is beyond the planes, in voxels; -HUGE_VAL if it is not. */
double ms_bounds_beyond_planes(const ms_bounds *bounds, const ms_grid *grid, const double centre[3],
                               const double place[3]);

/**
 * The largest radius allowed about a place: one that sticks out by the bound, or reaches to a plane. HUGE_VAL without.
 * Exact where the target has a closed mesh. Cost: once ms_closest_signed_distance.
 */
double ms_bounds_most_radius(const ms_bounds *bounds, const ms_signed_distance *field, const double centre[3]);

/** Cuts radii to what is allowed, all of them to the same if they are to be equal; to 0 where none is. */
void ms_bounds_confine(const ms_bounds *bounds, const ms_signed_distance *field, ms_ball *ball, size_t count);

#endif
