/** Support function of a body: how far it reaches from its centre of mass along a direction. */
#ifndef MS_SUPPORT_H
#define MS_SUPPORT_H

#include "clump/ms_clump.h"
#include "mesh/ms_mesh.h"
#include "voxel/ms_grid.h"

MS_C_BEGIN

/** Spheres about the centre of mass, which lies at the origin; those of a polyhedron have no radius. */
typedef struct ms_support {
    size_t count;
    ms_sphere *sphere;
} ms_support;

/**
 * The spheres of a clump; not its carriers, which touch nothing.
 *
 * @param[out] body   ms_support_free frees it; empty on failure
 * @param      centre of mass, in the unit and frame of the clump
 * @return MS_OK; MS_ERR_ARG for an empty clump; MS_ERR_NOMEM
 */
MS_API ms_status ms_support_from_clump(ms_support *body, const ms_clump *clump, const double centre[3], ms_error *err);

/**
 * The vertices of a mesh, likewise; those of its hull alone, on which nothing else depends, where this build can make
 * hulls.
 *
 * @return MS_OK; MS_ERR_ARG for a mesh without vertices; MS_ERR_SHAPE for one that spans no volume; MS_ERR_NOMEM
 */
MS_API ms_status ms_support_from_mesh(ms_support *body, const ms_mesh *mesh, const double centre[3], ms_error *err);

/**
 * The hull of the centres of the outer faces of voxels, likewise.
 *
 * @return MS_OK; MS_ERR_SHAPE if no voxel is inside; MS_ERR_ARG if this build cannot make hulls; MS_ERR_NOMEM
 */
MS_API ms_status ms_support_from_grid(ms_support *body, const ms_grid *grid, const double centre[3], ms_error *err);

/** h(u), the greatest c.u + r; exact. @param u of length 1. Cost: O(count) */
MS_API double ms_support_height(const ms_support *body, const double u[3]);

MS_API void ms_support_free(ms_support *body);

MS_C_END

#endif
