#include "ms_descriptors.h"

#include <math.h>
#include <stdlib.h>

#include "clump/ms_clump_hull.h"
#include "clump/ms_union.h"
#include "mesh/ms_feret.h"
#include "mesh/ms_hull.h"
#include "voxel/ms_grid_hull.h"
#include "voxel/ms_voxel_area.h"

static const double PI = 3.14159265358979323846;

int ms_descriptors_has_hull(void)
{
    return ms_hull_is_built();
}

static ms_descriptors know_nothing(void)
{
    ms_descriptors d;
    d.volume = d.feret[0] = d.feret[1] = d.feret[2] = (double)NAN;
#define FORGET(X, CODE, name, ...) d.name = (double)NAN;
    MS_DESCRIPTOR_LIST(FORGET, )
#undef FORGET
    return d;
}

static void take_volume(ms_descriptors *d, double volume)
{
    d->volume = volume;
    d->equivalent_diameter = cbrt(6 * volume / PI);
}

/* After the volume. */
static void take_area(ms_descriptors *d, double area)
{
    d->area = area;
    d->sphericity = PI * d->equivalent_diameter * d->equivalent_diameter / area;
}

/* An ellipsoid of unit density has the moments V (b^2 + c^2) / 5, ...; so much has the sum of two less the third. */
static ms_status take_principal(ms_descriptors *d, const ms_body *body, ms_error *err)
{
    ms_principal p;
    const ms_status status = ms_inertia_principal(&p, body, err);
    if (status == MS_OK) {
        const double *m = p.moment, a = m[1] + m[2] - m[0], b = m[0] + m[2] - m[1], c = fmax(0, m[0] + m[1] - m[2]);
        d->elongation = sqrt(b / a);
        d->flatness = sqrt(c / b);
    }
    return status;
}

/* Points that span no volume have no hull, which is nothing wrong with the shape. */
static ms_status forgive_flat(ms_status status)
{
    return status == MS_ERR_SHAPE ? MS_OK : status;
}

static ms_status take_feret(ms_descriptors *d, const ms_mesh *hull, double unit, ms_error *err)
{
    double f[3];
    const ms_status status = ms_feret_measure(f, hull, err);
    if (status == MS_OK) {
        for (int a = 0; a < 3; a++) {
            d->feret[a] = f[a] * unit;
        }
        d->feret_elongation = f[1] / f[0];
        d->feret_flatness = f[2] / f[1];
        d->corey = f[2] / sqrt(f[0] * f[1]);
    }
    return forgive_flat(status);
}

/* From the hull, which is freed. */
static ms_status take_hull(ms_descriptors *d, ms_mesh *hull, ms_status status, ms_error *err)
{
    ms_body body;
    if (status == MS_OK) {
        status = take_feret(d, hull, 1, err);
    }
    if (status == MS_OK) {
        status = ms_inertia_mesh(&body, hull, err);
    }
    if (status == MS_OK) {
        d->convexity = d->volume / body.volume;
    }
    ms_mesh_free(hull);
    return forgive_flat(status);
}

static ms_status know(ms_descriptors *out, const ms_descriptors *d, ms_status status)
{
    *out = status == MS_OK ? *d : know_nothing();
    return status;
}

ms_status ms_descriptors_of_mesh(ms_descriptors *out, const ms_mesh *mesh, const ms_solid *solid, ms_error *err)
{
    ms_descriptors d = know_nothing();
    ms_mesh hull;
    ms_status status = MS_OK;
    if (solid) {
        take_volume(&d, solid->body.volume);
        status = take_principal(&d, &solid->body, err);
        if (!solid->overlapping) {
            take_area(&d, ms_mesh_area(mesh));
        }
    }
    if (status == MS_OK && ms_hull_is_built()) {
        status = ms_hull_build(&hull, (const double(*)[3])mesh->vertex, mesh->n_vertices, err);
        status = take_hull(&d, &hull, status, err);
    }
    return know(out, &d, status);
}

/* The area of voxels, where they are enough. */
static ms_status take_voxel_area(ms_descriptors *d, const ms_grid *grid, ms_error *err)
{
    double area;
    ms_status status = MS_OK;
    if (d->equivalent_diameter >= MS_DESCRIPTORS_LEAST_DIAMETER * grid->h) {
        status = ms_voxel_area(&area, grid, err);
        take_area(d, area);
    }
    return status;
}

static ms_status take_grid_hulls(ms_descriptors *d, const ms_grid *grid, ms_error *err)
{
    ms_mesh centres, faces;
    size_t count;
    const ms_status built = ms_grid_hull_build(&centres, &faces, grid, err);
    ms_status status = forgive_flat(built);
    if (status == MS_OK && faces.n_triangles) {
        status = take_feret(d, &faces, grid->h, err);
    }
    if (status == MS_OK && built == MS_OK) {
        status = ms_grid_hull_count(&count, &centres, grid, err);
        d->convexity = (double)ms_grid_count(grid) / (double)count;
    }
    ms_mesh_free(&centres);
    ms_mesh_free(&faces);
    return status;
}

ms_status ms_descriptors_of_grid(ms_descriptors *out, const ms_grid *grid, const ms_body *body, ms_error *err)
{
    ms_descriptors d = know_nothing();
    take_volume(&d, body->volume);
    ms_status status = take_voxel_area(&d, grid, err);
    if (status == MS_OK) {
        status = take_principal(&d, body, err);
    }
    if (status == MS_OK && ms_hull_is_built()) {
        status = take_grid_hulls(&d, grid, err);
    }
    return know(out, &d, status);
}

/* Of an open mesh volume and inertia are those of the voxels. */
ms_status ms_descriptors_of_target(ms_descriptors *out, const ms_target *target, ms_error *err)
{
    if (!target->mesh) {
        return ms_descriptors_of_grid(out, &target->grid, &target->body, err);
    }
    const ms_solid solid = {.body = target->body, .overlapping = target->overlapping || !target->closed};
    ms_descriptors d;
    ms_status status = ms_descriptors_of_mesh(&d, target->mesh, &solid, err);
    if (status == MS_OK && solid.overlapping) {
        status = take_voxel_area(&d, &target->grid, err);
    }
    return know(out, &d, status);
}

ms_status ms_descriptors_of_clump(ms_descriptors *out, const ms_clump *clump, const ms_body *body, ms_error *err)
{
    ms_descriptors d = know_nothing();
    ms_mesh hull;
    double volume, area;
    ms_status status = ms_union_measure(&volume, &area, clump, err);
    if (status == MS_OK) {
        take_volume(&d, volume);
        take_area(&d, area);
    }
    if (status == MS_OK && body->volume > 0) {
        status = take_principal(&d, body, err);
    }
    if (status == MS_OK && ms_hull_is_built()) {
        status = take_hull(&d, &hull, ms_clump_hull_build(&hull, clump, err), err);
    }
    return know(out, &d, status);
}

ms_status ms_descriptors_add(ms_target *target, ms_error *err)
{
    ms_descriptors *d = malloc(sizeof *d);
    if (!d) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the descriptors of the shape");
    }
    const ms_status status = ms_descriptors_of_target(d, target, err);
    if (status != MS_OK) {
        free(d);
        return status;
    }
    target->descriptors = d;
    return MS_OK;
}

double ms_descriptors_voxel_limit(const ms_descriptors *of, double h)
{
    return of->area * h / (4 * of->volume);
}
