/** Changes of a mesh that should not matter: motions, noise, other triangles of the same surface, another order. */
#ifndef MS_PERTURB_H
#define MS_PERTURB_H

#include <stdint.h>

#include "clump/ms_clump.h"
#include "mesh/ms_mesh.h"

MS_C_BEGIN

/** A rigid motion: x goes to turn x + shift. */
typedef struct ms_motion {
    double turn[3][3]; /* orthogonal, determinant 1 */
    double shift[3];   /* in the mesh's unit */
} ms_motion;

/* Turns that map the axes onto the axes: the rotations of the cube. */
enum { MS_MOTION_AXIS_TURNS = 24 };

/** Leaves everything where it is. */
ms_motion ms_perturb_motion_none(void);

/** One of the rotations of the cube; 0 leaves everything where it is. Exact. @param which 0 to 23 */
ms_motion ms_perturb_motion_axis_turn(int which);

/**
 * A random rotation, uniform over all of them.
 *
 * @param[out] motion without a shift
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: unit quaternions uniform on the sphere of four dimensions (gsl_ran_dir_nd).
 */
ms_status ms_perturb_motion_random_turn(ms_motion *motion, uint64_t seed, ms_error *err);

/** Moves the vertices. */
void ms_perturb_motion_apply(ms_mesh *mesh, const ms_motion *motion);

/** Moves the centres of the spheres back, undoing ms_perturb_motion_apply: exactly where turn and sums are exact. */
void ms_perturb_motion_undo(ms_clump *clump, const ms_motion *motion);

/** A copy of its own. @param[out] out the caller frees it; empty on failure @return MS_OK; MS_ERR_ARG; MS_ERR_NOMEM */
ms_status ms_perturb_copy(ms_mesh *out, const ms_mesh *mesh, ms_error *err);

/**
 * Roughens the surface: each vertex moves along its normal (mean of its triangles', weighted by area) by a random
 * length, uniform within +- amplitude. Vertices without a normal stay. Where the amplitude is more than half the
 * thickness of the body, its surface cuts itself.
 *
 * @param amplitude in the mesh's unit, 0 or more
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(triangles)
 */
ms_status ms_perturb_noise(ms_mesh *mesh, double amplitude, uint64_t seed, ms_error *err);

/**
 * Cuts each triangle in four at the middles of its edges: the same surface, four times the triangles.
 *
 * @param[out] out  the caller frees it; empty on failure
 * @param      mesh its corners exist
 * @return MS_OK; MS_ERR_LIMIT beyond 2^32 vertices; MS_ERR_NOMEM. Cost: O(triangles log triangles)
 */
ms_status ms_perturb_refine(ms_mesh *out, const ms_mesh *mesh, ms_error *err);

/**
 * Coarsens by clustering: the vertices in one cell of a cubic lattice about the middle of the box become their mean,
 * triangles within a cell vanish, and what is left is mended (ms_mesh_repair).
 *
 * @param[out] out    the caller frees it; empty on failure
 * @param[out] report what is left; it need not be closed
 * @param      cell   edge of the cells, above 0, in the mesh's unit
 * @return MS_OK; MS_ERR_ARG; MS_ERR_SHAPE if nothing is left; as ms_mesh_repair; MS_ERR_NOMEM
 *
 * Source: Rossignac & Borrel, Multi-resolution 3D approximations for rendering complex scenes, in: Modeling in
 * Computer Graphics (1993) 455. Cost: O(vertices log vertices).
 */
ms_status ms_perturb_decimate(ms_mesh *out, ms_mesh_report *report, const ms_mesh *mesh, double cell, ms_error *err);

/** Lists vertices and triangles in a random order, each triangle from a random one of its corners. @return MS_OK;
 * MS_ERR_NOMEM */
ms_status ms_perturb_order(ms_mesh *mesh, uint64_t seed, ms_error *err);

/** Takes away a random part of the triangles, at least one and not all. @param part of 1 @return MS_OK; MS_ERR_NOMEM */
ms_status ms_perturb_open(ms_mesh *mesh, double part, uint64_t seed, ms_error *err);

MS_C_END

#endif
