#include "ms_clump.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "voxel/ms_raster.h"

_Static_assert((int)MS_CLUMP_MAX_SPHERES <= (int)MS_RASTER_MAX_BALLS, "every clump can be counted on a grid");

/* Puts a sphere behind the first `at`. */
static ms_status append(ms_clump *clump, size_t at, const ms_sphere *sphere, ms_error *err)
{
    if (at == MS_CLUMP_MAX_SPHERES) {
        return ms_fail(err, MS_ERR_LIMIT, "a clump cannot have more than %d spheres", MS_CLUMP_MAX_SPHERES);
    }
    if (at == clump->capacity) {
        const size_t capacity = 2 * clump->capacity + 16;
        ms_sphere *grown = realloc(clump->sphere, capacity * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", capacity);
        }
        clump->sphere = grown;
        clump->capacity = capacity;
    }
    clump->sphere[at] = *sphere;
    free(clump->mass);
    clump->mass = NULL;
    return MS_OK;
}

ms_status ms_clump_add(ms_clump *clump, const ms_sphere *sphere, ms_error *err)
{
    const ms_status status = append(clump, clump->n_spheres, sphere, err);
    if (status == MS_OK) {
        clump->n_spheres++;
        clump->n_carriers = 0;
    }
    return status;
}

ms_status ms_clump_add_carrier(ms_clump *clump, const ms_sphere *carrier, ms_error *err)
{
    const ms_status status = append(clump, ms_clump_count_masses(clump), carrier, err);
    clump->n_carriers += status == MS_OK;
    return status;
}

void ms_clump_drop_masses(ms_clump *clump)
{
    clump->n_carriers = 0;
    free(clump->mass);
    clump->mass = NULL;
}

size_t ms_clump_count_masses(const ms_clump *clump)
{
    return clump->n_spheres + clump->n_carriers;
}

ms_status ms_clump_alloc_masses(ms_clump *clump, ms_error *err)
{
    const size_t n = ms_clump_count_masses(clump);
    double *mass = realloc(clump->mass, (n + 1) * sizeof *mass);
    if (!mass) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the masses of %zu spheres", n);
    }
    clump->mass = mass;
    return MS_OK;
}

static int do_spheres_overlap(const ms_sphere *a, const ms_sphere *b)
{
    const double reach = a->radius + b->radius;
    return ms_squared_distance(a->centre, b->centre) < reach * reach;
}

ms_status ms_clump_pieces(size_t *pieces, const ms_clump *clump, ms_error *err)
{
    /* Flood: the spheres before `done` have met all others, those before `reached` are in a
     * piece already met. */
    const size_t n = clump->n_spheres;
    size_t done = 0, reached = 0;
    size_t *order = malloc((n + 1) * sizeof *order);
    *pieces = 0;
    if (!order) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to connect %zu spheres", n);
    }
    for (size_t i = 0; i < n; i++) {
        order[i] = i;
    }
    while (done < n) {
        if (done == reached) {
            reached++;
            ++*pieces;
        }
        for (size_t at = reached; at < n; at++) {
            if (do_spheres_overlap(&clump->sphere[order[done]], &clump->sphere[order[at]])) {
                const size_t swap = order[at];
                order[at] = order[reached];
                order[reached++] = swap;
            }
        }
        done++;
    }
    free(order);
    return MS_OK;
}

void ms_clump_box(double lo[3], double hi[3], const ms_clump *clump)
{
    for (int a = 0; a < 3; a++) {
        lo[a] = HUGE_VAL;
        hi[a] = -HUGE_VAL;
        for (size_t s = 0; s < clump->n_spheres; s++) {
            lo[a] = fmin(lo[a], clump->sphere[s].centre[a] - clump->sphere[s].radius);
            hi[a] = fmax(hi[a], clump->sphere[s].centre[a] + clump->sphere[s].radius);
        }
    }
}

ms_status ms_clump_scale(ms_clump *scaled, const ms_clump *clump, double factor, ms_error *err)
{
    ms_status status = MS_OK;
    *scaled = (ms_clump){0};
    for (size_t s = 0; s < clump->n_spheres && status == MS_OK; s++) {
        ms_sphere sphere = clump->sphere[s];
        for (int k = 0; k < 3; k++) {
            sphere.centre[k] *= factor;
        }
        sphere.radius *= factor;
        status = ms_clump_add(scaled, &sphere, err);
    }
    if (status != MS_OK) {
        ms_clump_free(scaled);
    }
    return status;
}

double ms_clump_smallest_radius(const ms_clump *clump)
{
    double least = HUGE_VAL;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        least = fmin(least, clump->sphere[s].radius);
    }
    return least;
}

void ms_clump_free(ms_clump *clump)
{
    if (clump) {
        free(clump->sphere);
        free(clump->mass);
        memset(clump, 0, sizeof *clump);
    }
}
