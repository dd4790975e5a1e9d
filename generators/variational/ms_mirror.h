/** Planes of symmetry: a sphere stands for itself and its mirror images. Private to variational. */
#ifndef MS_MIRROR_H
#define MS_MIRROR_H

#include "voxel/ms_raster.h"

/** One plane across each axis, or none. A sphere whose centre lies just on a plane is its own image. */
typedef struct ms_mirror {
    int across[3]; /* nonzero: there is a plane */
    double at[3];  /* where, in voxels */
} ms_mirror;

/** Images of one sphere, itself among them: 1, 2, 4 or 8. */
size_t ms_mirror_images(const ms_mirror *m, const ms_ball *ball);

/**
 * The images of `count` spheres.
 *
 * @param[out] all room for 8 times as many; the spheres themselves come first
 * @return how many
 */
size_t ms_mirror_expand(ms_ball *all, const ms_ball *ball, size_t count, const ms_mirror *m);

/** Nonzero if the centre lies just on the plane across an axis. */
int ms_mirror_holds(const ms_mirror *m, const ms_ball *ball, int axis);

/** Moves a centre to the upper side of each plane, and onto it if it is nearer than that part of the radius. */
void ms_mirror_fold(ms_ball *ball, const ms_mirror *m, double part);

/** How far the centre is from the nearest plane that it is not on, as part of the radius; its axis, or -1. */
int ms_mirror_nearest(double *part, const ms_mirror *m, const ms_ball *ball);

#endif
