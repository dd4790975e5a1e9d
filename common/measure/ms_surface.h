/** How a clump's surface lies to that of a shape: how far it stands out, how far the shape does, how it is inclined. */
#ifndef MS_SURFACE_H
#define MS_SURFACE_H

#include "clump/ms_clump_near.h"
#include "ms_normals.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/** Distances over a surface, counted 0 where it does not stand out. */
typedef struct ms_standout {
    double max; /* largest */
    double rms; /* root of the mean square over the whole surface */
} ms_standout;

/**
 * The exposed surface of the spheres (what lies in no other sphere): how far it is outside the mesh, and the angle
 * between its normal and that of the shape where that is nearest. Sampled by a Fibonacci lattice on each sphere, about
 * one point for each 4 h^2, 32 to 1000 of them.
 *
 * @param[out] protrusion of a closed mesh; NULL: not wanted
 * @param[out] normals    of a closed mesh or a volume, points nearer to sharp edges than the least radius apart; NULL:
 *                        not wanted
 * @return MS_OK; MS_ERR_NOMEM; as ms_normals_open. Cost: a search of the mesh per sample, without the normals per
 *         sample near or outside the surface; all cores, the same bits at any number of threads.
 */
ms_status ms_surface_exposed(ms_standout *protrusion, ms_normals *normals, const ms_target *target,
                             const ms_clump_near *near, ms_error *err);

/**
 * The surface of the mesh outside all spheres, by the distance to the nearest sphere.
 * Sampled at one point or more in each triangle, about one for each 4 h^2, and for the
 * largest distance at the vertices too.
 *
 * @return MS_OK; MS_ERR_NOMEM. Cost: some spheres per sample; threads as above.
 */
ms_status ms_surface_gap(ms_standout *out, const ms_target *target, const ms_clump_near *near, ms_error *err);

MS_C_END

#endif
