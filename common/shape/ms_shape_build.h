/** Private to the shapes: the ways in which their meshes are laid out, and their makers. */
#ifndef MS_SHAPE_BUILD_H
#define MS_SHAPE_BUILD_H

#include "mesh/ms_mesh.h"

/** Unit ball on an octahedral grid: n segments along a quarter turn. */
ms_status ms_shape_unit_ball(ms_mesh *mesh, int n, ms_error *err);

/** Multiplies the coordinates. */
void ms_shape_scale(ms_mesh *mesh, double x, double y, double z);

/** Turns a body about z into one about x, by a cyclic change of names, which is exact. */
void ms_shape_z_to_x(ms_mesh *mesh);

/** Half a section through a body of revolution about z: points (radius, z), top to bottom. */
typedef struct ms_profile {
    double (*point)[2];
    int n, capacity;
} ms_profile;

/** Room for `capacity` points, of which the first is (0, z_top). */
ms_status ms_shape_profile_begin(ms_profile *profile, int capacity, double z_top, ms_error *err);

/** Appends a straight line in equal segments. More points than the capacity are not taken. */
void ms_shape_profile_line(ms_profile *profile, double radius, double z, int segments);

/** A circle about (0, centre_z); angles run from the +z axis towards the radius. */
typedef struct ms_arc {
    double centre_z, radius, from, to;
} ms_arc;

/** Appends an arc in equal segments; its last point is (radius, z) to the bit. */
void ms_shape_profile_arc(ms_profile *profile, ms_arc arc, double radius, double z, int segments);

/** Appends the mirror image of a profile whose last point lies at z = 0. */
void ms_shape_profile_mirror(ms_profile *profile);

void ms_shape_profile_free(ms_profile *profile);

/**
 * Turns a profile about z. The mirror planes through the z axis (and z = 0 where the profile
 * is its own mirror image) hold to the bit.
 *
 * @param[out] mesh   empty on failure
 * @param      around segments around the axis, a multiple of 8
 */
ms_status ms_shape_revolve(ms_mesh *mesh, const ms_profile *profile, int around, ms_error *err);

/** Ring about z of radius `ring`, tube of radius `tube`; both turns have `around` segments. */
ms_status ms_shape_ring(ms_mesh *mesh, double ring, double tube, int around, ms_error *err);

/* The makers and exact volumes of the kinds, for the table in ms_shape.c. */
#define MS_SHAPE_MAKER(kind)                                                      \
    ms_status ms_shape_##kind(ms_mesh *mesh, const double *value, ms_error *err); \
    double ms_shape_##kind##_volume(const double *value);

MS_SHAPE_MAKER(ball)
MS_SHAPE_MAKER(ellipsoid)
MS_SHAPE_MAKER(hollow)
MS_SHAPE_MAKER(tablet)
MS_SHAPE_MAKER(torus)
MS_SHAPE_MAKER(needle)
MS_SHAPE_MAKER(cylinder)
MS_SHAPE_MAKER(cone)
MS_SHAPE_MAKER(dumbbell)
MS_SHAPE_MAKER(bowl)
MS_SHAPE_MAKER(cross)
MS_SHAPE_MAKER(cube)
MS_SHAPE_MAKER(box)
MS_SHAPE_MAKER(tetrahedron)
MS_SHAPE_MAKER(octahedron)
MS_SHAPE_MAKER(grain)
#undef MS_SHAPE_MAKER

#endif
