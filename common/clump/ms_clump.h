/** Clumps: ordered sets of overlapping spheres that stand for one particle. */
#ifndef MS_CLUMP_H
#define MS_CLUMP_H

#include <stddef.h>

#include "base/ms_error.h"
#include "base/ms_sphere.h"

MS_C_BEGIN

/* As many as a union on a grid can number (ms_raster.h). */
enum { MS_CLUMP_MAX_SPHERES = 65534 };

/** Spheres in the order in which they matter, in the unit and frame of the input shape. A
 * zeroed struct is an empty clump.
 *
 * Carriers (ms_carriers.h) stand behind the spheres and have mass alone: whatever goes over n_spheres, which is all
 * that measures, touches or draws a clump, does not see them. */
typedef struct ms_clump {
    size_t n_spheres, capacity;
    size_t n_carriers; /* sphere[n_spheres] and those behind it */
    ms_sphere *sphere;
    double *mass; /* of each sphere and carrier, kg; NULL where no one has set it (ms_density_solve) */
} ms_clump;

/**
 * Appends a sphere. Masses and carriers hold for the spheres there were: they are dropped.
 * @return MS_OK; MS_ERR_LIMIT above MS_CLUMP_MAX_SPHERES; MS_ERR_NOMEM
 */
MS_API ms_status ms_clump_add(ms_clump *clump, const ms_sphere *sphere, ms_error *err);

/** Appends a carrier. Masses are dropped. @return as ms_clump_add, of spheres and carriers together */
MS_API ms_status ms_clump_add_carrier(ms_clump *clump, const ms_sphere *carrier, ms_error *err);

/** Drops carriers and masses. */
MS_API void ms_clump_drop_masses(ms_clump *clump);

/** How many have a mass: spheres and carriers. */
MS_API size_t ms_clump_count_masses(const ms_clump *clump);

/** Room for the mass of each sphere and carrier, their values undefined. @return MS_OK; MS_ERR_NOMEM */
MS_API ms_status ms_clump_alloc_masses(ms_clump *clump, ms_error *err);

/** Number of pieces: spheres that overlap belong together. Cost: O(n^2). */
MS_API ms_status ms_clump_pieces(size_t *pieces, const ms_clump *clump, ms_error *err);

/** Box around the spheres; the clump is not empty. */
MS_API void ms_clump_box(double lo[3], double hi[3], const ms_clump *clump);

/**
 * The spheres scaled about the origin; not masses and carriers.
 *
 * @param[out] scaled the caller frees it; empty on failure
 * @return MS_OK; MS_ERR_NOMEM
 */
MS_API ms_status ms_clump_scale(ms_clump *scaled, const ms_clump *clump, double factor, ms_error *err);

/** Smallest radius; the clump is not empty. */
MS_API double ms_clump_smallest_radius(const ms_clump *clump);

MS_API void ms_clump_free(ms_clump *clump);

MS_C_END

#endif
