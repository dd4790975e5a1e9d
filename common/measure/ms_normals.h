/** Private: angles between the exposed surface of spheres and the surface of a shape. */
#ifndef MS_NORMALS_H
#define MS_NORMALS_H

#include "mesh/ms_closest.h"
#include "voxel/ms_target.h"

/** Faces of a mesh that turn by more than this, in degrees, meet at a sharp edge: the usual feature angle. */
#define MS_NORMALS_SHARP 30

/** Degrees, weighted by area. NAN where there is no such surface. */
typedef struct ms_normals {
    double median, most;           /* half and 95 % of the surface are below it; without what is near sharp edges */
    double edge_part;              /* the part of the surface that is near sharp edges */
    double edge_median, edge_most; /* of that part */
} ms_normals;

/** Normals of a shape. */
typedef struct ms_normals_shape {
    const ms_target *target; /* borrowed */
    double near;             /* nearer to a sharp edge than this is apart */
    ms_mesh edges;           /* the sharp ones; none of a volume */
    ms_closest *closest;     /* on them; NULL without any */
} ms_normals_shape;

/**
 * @param[out] shape  freed by ms_normals_free; empty on failure
 * @param      target of a closed mesh or a volume
 * @param      near   in the mesh's unit
 * @return MS_OK; as ms_mesh_sharp_edges, ms_closest_build. Cost: O(triangles log triangles), of a volume none
 */
ms_status ms_normals_open(ms_normals_shape *shape, const ms_target *target, double near, ms_error *err);

/** Bins of 0.01 degrees. Area in whole parts of any unit, so that every order of adding gives the same. */
enum { MS_NORMALS_BINS = 18000 };
typedef struct ms_normals_tally {
    uint64_t area[2][MS_NORMALS_BINS]; /* [1]: near sharp edges */
} ms_normals_tally;

/**
 * Adds a point of the exposed surface.
 *
 * Cost: two searches of a mesh; of a volume 1728 voxels and, outside, all that are nearer than its surface.
 *
 * @param point  in the mesh's frame
 * @param normal of the sphere there, of length 1
 * @return the signed distance from a mesh, negative inside; NAN for a volume
 */
double ms_normals_add(ms_normals_tally *tally, const ms_normals_shape *shape, const double point[3],
                      const double normal[3], uint64_t area);

/** Adds all of another. */
void ms_normals_join(ms_normals_tally *tally, const ms_normals_tally *other);

/** What was tallied; angles to 0.01 degrees. */
ms_normals ms_normals_read(const ms_normals_tally *tally);

void ms_normals_free(ms_normals_shape *shape);

#endif
