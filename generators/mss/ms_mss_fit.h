/** The sphere near a maximum that lowers |S xor S~| most. Private to ms_mss. */
#ifndef MS_MSS_FIT_H
#define MS_MSS_FIT_H

#include "ms_mss_open.h"
#include "ms_mss_run.h"

/* Radii that are tried lie no farther than so from E, in voxels of the target. E is to the centre of the nearest
 * background voxel, half a voxel beyond the surface, and spheres that stand out a little lower the mismatch. Farther
 * out is better for few spheres and worse for many, where what the first spheres cover too much cannot be made good. */
static const double MS_MSS_FIT_LEAST = -0.5, MS_MSS_FIT_MOST = 1;

/** A voxel of the target in voxels of a run. */
static inline double ms_mss_fit_unit(const ms_mss_run *m)
{
    return m->coarse ? 1.0 / MS_MSS_COARSE : 1;
}

/**
 * Gives a ball the radius, near E there, by which it gains most.
 *
 * @param e    E at its centre
 * @param open on the lattice of the run
 * @return what it gains, ms_mss_open_gain; 0 if there is no room for one
 */
long ms_mss_fit_radius(ms_ball *ball, double e, const ms_mss_open *open, ms_mss_run *m);

/**
 * Moves a ball's centre by steps along the axes as long as it gains more, each time with the best radius. Where both
 * ways along an axis gain the same it stays, so that mirror images remain mirror images.
 *
 * @param open, m of the target's own lattice
 * @return what it gains then: no less than the ball that was given
 */
long ms_mss_fit_place(ms_ball *ball, const ms_mss_open *open, ms_mss_run *m);

#endif
