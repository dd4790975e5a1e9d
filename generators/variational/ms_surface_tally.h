/** The mismatch and what spheres are worth, by their exposed surface. Private to variational. */
#ifndef MS_SURFACE_TALLY_H
#define MS_SURFACE_TALLY_H

#include "ms_surface_fit.h"

/** What one sphere stands for; for one of its images. */
typedef struct ms_surface_worth {
    double loss; /* by how much |S xor U| grows without it, voxels; what lies below the surface of others is not seen */
    double mismatch; /* that at its exposed surface, voxels */
} ms_surface_worth;

/**
 * Where the surfaces of spheres and shape are less than a voxel apart, a count of voxels is chance; integrals over the
 * exposed surface are not: |S xor U| is that of |phi|, phi being the signed distance to the shape. Without a sphere,
 * the union retreats to where the others begin below its exposed surface: what lies between is lost where it is inside
 * S, and gained outside.
 *
 * @param[out] each     of each sphere; may be NULL
 * @param[out] mismatch |S xor U|, voxels, where no part of S is far from the spheres; may be NULL
 * @param      which    for each sphere: 0: it is not looked at, and nothing is written of it; NULL: all are, as they
 *                      have to be for the mismatch
 * @param      fit      its lattice is not turned
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: that of a step of the fit, about four times over; all cores, the same bits at any number of threads.
 */
ms_status ms_surface_tally(ms_surface_worth *each, double *mismatch, const uint8_t *which, const ms_surface_fit *fit,
                           const ms_ball *ball, size_t count, ms_error *err);

#endif
