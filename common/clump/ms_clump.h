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
 * zeroed struct is an empty clump. */
typedef struct ms_clump {
    size_t n_spheres, capacity;
    ms_sphere *sphere;
    double *mass; /* of each sphere, kg; NULL where no one has set it (ms_density_solve) */
} ms_clump;

/**
 * Appends a sphere. Masses hold for the spheres there were: they are dropped.
 * @return MS_OK; MS_ERR_LIMIT above MS_CLUMP_MAX_SPHERES; MS_ERR_NOMEM
 */
MS_API ms_status ms_clump_add(ms_clump *clump, const ms_sphere *sphere, ms_error *err);

/** Room for the mass of each sphere, their values undefined. @return MS_OK; MS_ERR_NOMEM */
MS_API ms_status ms_clump_alloc_masses(ms_clump *clump, ms_error *err);

/** Number of pieces: spheres that overlap belong together. Cost: O(n^2). */
MS_API ms_status ms_clump_pieces(size_t *pieces, const ms_clump *clump, ms_error *err);

/** Box around the spheres; the clump is not empty. */
MS_API void ms_clump_box(double lo[3], double hi[3], const ms_clump *clump);

/** Smallest radius; the clump is not empty. */
MS_API double ms_clump_smallest_radius(const ms_clump *clump);

MS_API void ms_clump_free(ms_clump *clump);

MS_C_END

#endif
