#include "ms_particle.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "voxel/ms_raster.h"

/* Of masses and moments, so that what is made of them is a number, too: sums over all particles, time steps. */
static const double LEAST = 1e-290, MOST = 1e290;

static int is_positive(double value)
{
    return isfinite(value) && value >= DBL_MIN;
}

static int is_sound_amount(double value)
{
    return value >= LEAST && value <= MOST;
}

ms_status ms_particle_check(const ms_particle *p, ms_error *err)
{
    const double density = p->density > 0 ? p->density : 1; /* some formats have what is of unit density */
    int is_sound = is_positive(p->scale) && is_sound_amount(p->mass) && is_sound_amount(p->mass / density);
    for (int k = 0; k < 3; k++) {
        is_sound = is_sound && isfinite(p->centre[k]);
        for (int l = 0; l < 3; l++) {
            const double moment = fabs(p->inertia[k][l]);
            is_sound = is_sound && moment <= MOST && moment / density <= MOST &&
                       (k != l || (p->inertia[k][k] >= LEAST && moment / density >= LEAST));
        }
    }
    if (p->density != 0 && !(p->density >= MS_PARTICLE_LEAST_DENSITY && p->density <= MS_PARTICLE_MOST_DENSITY)) {
        return ms_fail(err, MS_ERR_ARG, "a density of %g kg/m^3 is that of no body; it is from %g to %g", p->density,
                       MS_PARTICLE_LEAST_DENSITY, MS_PARTICLE_MOST_DENSITY);
    }
    return is_sound ? MS_OK
                    : ms_fail(err, MS_ERR_ARG,
                              "mass, volume or inertia of the particle is not from %g to %g in SI; check density, "
                              "unit and scale",
                              LEAST, MOST);
}

/* Zeros are left of one that is none. */
static ms_status check_made(ms_particle *particle, ms_error *err)
{
    const ms_status status = ms_particle_check(particle, err);
    if (status != MS_OK) {
        *particle = (ms_particle){0};
    }
    return status;
}

ms_status ms_particle_from_body(ms_particle *particle, const ms_body *body, double density, double scale, ms_error *err)
{
    *particle = (ms_particle){0};
    if (!is_positive(density) || !is_positive(scale) || !is_positive(body->volume)) {
        return ms_fail(err, MS_ERR_ARG, "density %g, scale %g and volume %g must be above 0 and finite", density, scale,
                       body->volume);
    }
    particle->scale = scale;
    particle->density = density;
    particle->mass = density * body->volume * scale * scale * scale;
    for (int i = 0; i < 3; i++) {
        particle->centre[i] = body->centroid[i];
        for (int j = 0; j < 3; j++) {
            particle->inertia[i][j] = density * body->inertia[i][j] * scale * scale * scale * scale * scale;
        }
    }
    return check_made(particle, err);
}

/* Adds the tensor of a solid sphere about the centre, in the clump's unit; nothing is taken away from the diagonal, so
 * that a row of specks has some inertia about its axis. */
static void add_solid(double inertia[3][3], const ms_sphere *sphere, double mass, const double centre[3])
{
    double p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = sphere->centre[k] - centre[k];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        inertia[i][i] += mass * (p[j] * p[j] + p[k] * p[k] + 0.4 * sphere->radius * sphere->radius);
        inertia[j][k] -= mass * p[j] * p[k];
        inertia[k][j] -= mass * p[j] * p[k];
    }
}

ms_status ms_particle_from_spheres(ms_particle *particle, const ms_clump *clump, double scale, ms_error *err)
{
    *particle = (ms_particle){0};
    if (!clump->mass || clump->n_spheres == 0 || !is_positive(scale)) {
        return ms_fail(err, MS_ERR_ARG, "the spheres have no masses to sum, or the scale %g is not above 0", scale);
    }
    for (size_t s = 0; s < ms_clump_count_masses(clump); s++) {
        particle->mass += clump->mass[s];
    }
    for (size_t s = 0; s < ms_clump_count_masses(clump); s++) {
        for (int k = 0; k < 3; k++) {
            particle->centre[k] += clump->mass[s] / particle->mass * clump->sphere[s].centre[k];
        }
    }
    for (size_t s = 0; s < ms_clump_count_masses(clump); s++) {
        add_solid(particle->inertia, &clump->sphere[s], clump->mass[s], particle->centre);
    }
    for (int i = 0; i < 9; i++) {
        particle->inertia[i / 3][i % 3] *= scale * scale;
    }
    particle->scale = scale;
    return check_made(particle, err);
}

double ms_particle_gyration(const ms_particle *p)
{
    return sqrt((p->inertia[0][0] + p->inertia[1][1] + p->inertia[2][2]) / (2 * p->mass)) / p->scale;
}

/* A grid of lattice constant h that holds the spheres. */
static ms_status grid_around(ms_grid *grid, const ms_clump *clump, double h, size_t max_voxels, ms_error *err)
{
    double lo[3], hi[3], origin[3], voxels = 1;
    int n[3];
    ms_clump_box(lo, hi, clump);
    if (!(h > 0) || !isfinite(h)) {
        return ms_fail(
            err, MS_ERR_LIMIT,
            "spheres over %.3g of length have a volume that no number holds; give lengths in a unit in which "
            "they are about 1",
            hi[0] - lo[0]);
    }
    for (int a = 0; a < 3; a++) {
        const double cells = ceil((hi[a] - lo[a]) / h) + 2 * MS_GRID_HULL;
        voxels *= cells;
        if (!(cells <= MS_GRID_MAX_EXTENT) || !(voxels <= (double)max_voxels)) {
            return ms_fail(err, MS_ERR_LIMIT,
                           "the union of the spheres takes a grid of more than %zu voxels; are all spheres of one "
                           "particle?",
                           max_voxels);
        }
        n[a] = (int)cells;
        origin[a] = (lo[a] + hi[a]) / 2 - h * (n[a] - 1) / 2;
    }
    return ms_grid_alloc(grid, n, h, origin, err);
}

static ms_status count_fine_union(ms_body *body, const ms_clump *clump, double h, size_t max_voxels, ms_error *err)
{
    ms_grid grid;
    ms_raster raster;
    ms_tally sum = {0};
    ms_status status = grid_around(&grid, clump, h, max_voxels, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_raster_alloc(&raster, &grid, MS_VOXEL_HALF, err);
    for (size_t s = 0; s < clump->n_spheres && status == MS_OK; s++) {
        const ms_ball ball = ms_grid_ball(&grid, &clump->sphere[s]);
        status = ms_raster_add(&raster, &ball, 1, err);
    }
    for (size_t s = 0; s < clump->n_spheres && status == MS_OK; s++) {
        ms_tally_add(&sum, &raster.tally[s]);
    }
    ms_tally_body(body, &sum, &grid);
    ms_raster_free(&raster);
    ms_grid_free(&grid);
    return status;
}

/* The volume on a first grid says how fine the second must be. */
ms_status ms_particle_union(ms_body *body, const ms_clump *clump, size_t max_voxels, ms_error *err)
{
    enum { FIRST_CELLS = 64, CELLS = 200 };
    double lo[3], hi[3], side = 0, largest = 0;
    *body = (ms_body){0};
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_ARG, "a clump without spheres has no union");
    }
    ms_clump_box(lo, hi, clump);
    for (int a = 0; a < 3; a++) {
        side = fmax(side, hi[a] - lo[a]);
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        largest = fmax(largest, clump->sphere[s].radius);
    }
    ms_status status = count_fine_union(body, clump, fmin(side / FIRST_CELLS, largest / 8), max_voxels, err);
    if (status == MS_OK) {
        status = count_fine_union(body, clump, cbrt(6 * body->volume / acos(-1.0)) / CELLS, max_voxels, err);
    }
    if (status != MS_OK) {
        *body = (ms_body){0};
    }
    return status;
}
