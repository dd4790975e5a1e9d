/** The body that a closed mesh bounds, also where its surface passes through itself. */
#ifndef MS_SOLID_H
#define MS_SOLID_H

#include "mesh/ms_inertia.h"
#include "mesh/ms_mesh.h"

MS_C_BEGIN

typedef struct ms_solid {
    ms_body body;
    int overlapping;   /* the surface passes through itself: the body is that of the union */
    int touches;       /* parts of the surface meet that are not joined there */
    double more_often; /* volume that the integrals over the mesh have more than once, each time but the first */
    double inside_out; /* volume that they have negative */
} ms_solid;

/** Below this part of the volume nothing overlaps: so much is the rounding of bodies that touch. */
#define MS_SOLID_OVERLAP 1e-5

/**
 * Volume, centre and inertia of the points with a positive winding number, which are the ones
 * that ms_voxelize fills: bodies that overlap unite, and what is wound inside out is empty.
 *
 * They are the exact integrals of ms_inertia_mesh, less what these count more than once or
 * negative. Such parts are looked for where the surface meets itself (ms_mesh_touch), and
 * measured by 1024 x 1024 rays along x through the box, whose lengths in them are exact to
 * 2e-6 of it. The lattice of the rays is a little oblique to y and z, so that a face along an
 * axis lies between rays in all proportions. Where there are no such parts the integrals stay
 * as they are, to the last bit. Volume and centre are good to about 1e-5 to 1e-4 (of the volume, of
 * the radius of gyration); the tests hold them, and the inertia, to 2e-4, where
 * what overlaps is 80 rays wide.
 *
 * @param[out] solid zeros on failure
 * @param      mesh  closed and wound outward (ms_mesh_repair)
 * @return MS_OK; as ms_inertia_mesh, ms_mesh_touch; MS_ERR_NOMEM
 *
 * Cost: that of ms_mesh_touch, and where the surface meets itself of a million rays; the
 * same bits at any number of threads.
 */
MS_API ms_status ms_solid_mesh(ms_solid *solid, const ms_mesh *mesh, ms_error *err);

MS_C_END

#endif
