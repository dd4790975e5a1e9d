#include <gsl/gsl_math.h>
#include <math.h>

#include "mesh/ms_inertia.h"
#include "ms_shape_build.h"

/* Segments around the axis: about four times those of a quarter turn, a multiple of 8. */
static int around_of(double fineness)
{
    return 8 * ((int)fineness / 2 + (int)fineness % 2);
}

/* Straight lines of a section need no division for their shape; they get some so that the
   mesh's vertices are spread over the surface. */
static int line_of(double fineness)
{
    return (int)fineness / 4 + 1;
}

static ms_status revolve_and_free(ms_mesh *mesh, ms_profile *profile, double fineness, ms_error *err)
{
    ms_status status = ms_shape_revolve(mesh, profile, around_of(fineness), err);
    ms_shape_profile_free(profile);
    return status;
}

/* value: band_radius, band_height, cap_height, fineness */
ms_status ms_shape_tablet(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double radius = value[0];
    double half_band = value[1] / 2;
    double cap = value[2];
    if (cap > radius) {
        return ms_fail(err, MS_ERR_ARG, "cap_height = %g must not be above band_radius = %g", cap, radius);
    }
    /* Sphere through the band's rim and the top. */
    double sphere = (radius * radius + cap * cap) / (2 * cap);
    ms_arc arc = {.centre_z = half_band + cap - sphere, .radius = sphere, .from = 0, .to = 2 * atan2(cap, radius)};
    /* As many segments as bring the chords of the arc as near to it as those around the band. */
    int segments = (int)ceil(value[3] * arc.to / M_PI_2 * sqrt(sphere / radius));
    ms_profile profile;
    ms_status status = ms_shape_profile_begin(&profile, 2 * (segments + line_of(value[3])) + 1, half_band + cap, err);
    if (status != MS_OK) {
        return status;
    }
    ms_shape_profile_arc(&profile, arc, radius, half_band, segments);
    ms_shape_profile_line(&profile, radius, 0, line_of(value[3]));
    ms_shape_profile_mirror(&profile);
    return revolve_and_free(mesh, &profile, value[3], err);
}

double ms_shape_tablet_volume(const double *value)
{
    double r = value[0];
    double h = value[2];
    return M_PI * r * r * value[1] + M_PI * h * (3 * r * r + h * h) / 3;
}

/* value: R, r, fineness */
ms_status ms_shape_torus(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    if (value[1] >= value[0]) {
        return ms_fail(err, MS_ERR_ARG, "the tube's radius r = %g must be below the ring's radius R = %g", value[1],
                       value[0]);
    }
    return ms_shape_ring(mesh, value[0], value[1], around_of(value[2]), err);
}

double ms_shape_torus_volume(const double *value)
{
    return 2 * gsl_pow_2(M_PI * value[1]) * value[0];
}

/* value: length, r, fineness */
ms_status ms_shape_needle(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double r = value[1];
    double half = value[0] / 2 - r;
    if (!(half > 0)) {
        return ms_fail(err, MS_ERR_ARG, "length = %g must be above 2 r = %g, its two round ends", value[0], 2 * r);
    }
    int turn = (int)value[2];
    ms_profile profile;
    ms_status status = ms_shape_profile_begin(&profile, 4 * turn + 1, half + r, err);
    if (status != MS_OK) {
        return status;
    }
    ms_shape_profile_arc(&profile, (ms_arc){.centre_z = half, .radius = r, .from = 0, .to = M_PI_2}, r, half, turn);
    ms_shape_profile_line(&profile, r, 0, turn);
    ms_shape_profile_mirror(&profile);
    status = revolve_and_free(mesh, &profile, value[2], err);
    ms_shape_z_to_x(mesh);
    return status;
}

double ms_shape_needle_volume(const double *value)
{
    double r = value[1];
    return M_PI * r * r * (value[0] - 2 * r) + 4.0 / 3.0 * M_PI * r * r * r;
}

/* value: r, h, fineness */
ms_status ms_shape_cylinder(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    int line = line_of(value[2]);
    ms_profile profile;
    ms_status status = ms_shape_profile_begin(&profile, 4 * line + 1, value[1] / 2, err);
    if (status != MS_OK) {
        return status;
    }
    ms_shape_profile_line(&profile, value[0], value[1] / 2, line);
    ms_shape_profile_line(&profile, value[0], 0, line);
    ms_shape_profile_mirror(&profile);
    return revolve_and_free(mesh, &profile, value[2], err);
}

double ms_shape_cylinder_volume(const double *value)
{
    return M_PI * value[0] * value[0] * value[1];
}

/* value: r, h, fineness */
ms_status ms_shape_cone(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    int line = line_of(value[2]);
    ms_profile profile;
    /* The centre of mass, a quarter of the height above the base, is the origin. */
    ms_status status = ms_shape_profile_begin(&profile, 3 * line + 1, 0.75 * value[1], err);
    if (status != MS_OK) {
        return status;
    }
    ms_shape_profile_line(&profile, value[0], -0.25 * value[1], 2 * line);
    ms_shape_profile_line(&profile, 0, -0.25 * value[1], line);
    return revolve_and_free(mesh, &profile, value[2], err);
}

double ms_shape_cone_volume(const double *value)
{
    return M_PI * value[0] * value[0] * value[1] / 3;
}

/* value: R, distance, neck, fineness */
ms_status ms_shape_dumbbell(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double ball = value[0];
    double neck = value[2];
    double half = value[1] / 2;
    if (neck >= ball) {
        return ms_fail(err, MS_ERR_ARG, "the neck's radius neck = %g must be below the balls' radius R = %g", neck,
                       ball);
    }
    double shoulder = sqrt(ball * ball - neck * neck);
    if (half <= shoulder) {
        return ms_fail(err, MS_ERR_ARG,
                       "distance = %g leaves no neck between balls of radius R = %g; it must be above %g", value[1],
                       ball, 2 * shoulder);
    }
    ms_arc arc = {.centre_z = half, .radius = ball, .from = 0, .to = M_PI - asin(neck / ball)};
    int segments = (int)ceil(value[3] * arc.to / M_PI_2);
    ms_profile profile;
    ms_status status = ms_shape_profile_begin(&profile, 2 * (segments + line_of(value[3])) + 1, half + ball, err);
    if (status != MS_OK) {
        return status;
    }
    ms_shape_profile_arc(&profile, arc, neck, half - shoulder, segments);
    ms_shape_profile_line(&profile, neck, 0, line_of(value[3]));
    ms_shape_profile_mirror(&profile);
    status = revolve_and_free(mesh, &profile, value[3], err);
    ms_shape_z_to_x(mesh);
    return status;
}

double ms_shape_dumbbell_volume(const double *value)
{
    double ball = value[0];
    double neck = value[2];
    double shoulder = sqrt(ball * ball - neck * neck);
    double cap = ball - shoulder;
    double cap_volume = M_PI * cap * cap * (3 * ball - cap) / 3;
    double neck_volume = M_PI * neck * neck * (value[1] - 2 * shoulder);
    return 2 * (4.0 / 3.0 * M_PI * ball * ball * ball - cap_volume) + neck_volume;
}

/* Along the axis. On failure the mesh is freed. */
static ms_status move_to_centre(ms_mesh *mesh, ms_error *err)
{
    ms_body body;
    const ms_status status = ms_inertia_mesh(&body, mesh, err);
    if (status != MS_OK) {
        ms_mesh_free(mesh);
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        mesh->vertex[v][2] -= body.centroid[2];
    }
    return status;
}

/* value: R, wall, fineness */
ms_status ms_shape_bowl(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    const double outer = value[0], inner = outer - value[1];
    if (!(inner > 0)) {
        return ms_fail(err, MS_ERR_ARG, "wall = %g must be below the radius R = %g", value[1], outer);
    }
    const int turn = (int)value[2];
    ms_profile profile;
    ms_status status = ms_shape_profile_begin(&profile, 2 * turn + 2, -inner, err);
    if (status != MS_OK) {
        return status;
    }
    ms_shape_profile_arc(&profile, (ms_arc){.radius = inner, .from = M_PI, .to = M_PI_2}, inner, 0, turn);
    ms_shape_profile_line(&profile, outer, 0, 1);
    ms_shape_profile_arc(&profile, (ms_arc){.radius = outer, .from = M_PI_2, .to = M_PI}, 0, -outer, turn);
    status = revolve_and_free(mesh, &profile, value[2], err);
    return status == MS_OK ? move_to_centre(mesh, err) : status;
}

double ms_shape_bowl_volume(const double *value)
{
    return 2.0 / 3.0 * M_PI * (gsl_pow_3(value[0]) - gsl_pow_3(value[0] - value[1]));
}
