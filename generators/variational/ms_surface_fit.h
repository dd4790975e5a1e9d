/** Fits spheres to a surface where they are exposed. Private to variational. */
#ifndef MS_SURFACE_FIT_H
#define MS_SURFACE_FIT_H

#include <stdint.h>

#include "ms_bounds.h"
#include "ms_connect.h"
#include "ms_gap.h"
#include "ms_lattice.h"
#include "ms_mirror.h"

/** A fit in progress. */
typedef struct ms_surface_fit {
    const ms_signed_distance *field; /* borrowed */
    ms_bounds bounds;
    ms_mirror mirror;      /* each sphere stands for its images, too; zero: for itself */
    ms_lattice *lattice;   /* borrowed; of the points on each sphere */
    uint64_t seed;         /* of the turns of the points */
    uint64_t turns;        /* made so far */
    const uint8_t *moving; /* for each sphere: 0: it stays where it is; NULL: all move */
    ms_gap *gap;           /* borrowed; spheres are pulled to its places that are too far; NULL: there are none */
    int connected;         /* nonzero: spheres are pulled together until they are one piece */
    double slant;          /* D, below 1: it is |S xor U| - D |U| that is to be least; 0: |S xor U| */
} ms_surface_fit;

/**
 * Moves spheres, `steps` times, towards the least |S xor U|.
 *
 * On each sphere `points` places of a Fibonacci lattice, turned at random for each step. Those
 * inside another sphere are dropped; at each other one, with outward normal u, phi is the signed
 * distance to the surface. The step (dc, dR) minimises the sum of w (phi + u.dc + dR)^2 with
 * w = 1 / max(1/4, |phi|): at rest, the sum of sign(phi) (u, 1) is 0, and that is the derivative of
 * |S xor U| for the sphere (exposed area outside S less exposed area inside S). Places that stick out
 * too much, or lie beyond a plane, weigh a thousand times more; the bound itself is ms_bounds_confine's to keep.
 *
 * @param ball    `count` spheres, in voxels; those on a plane of symmetry stay on it
 * @param damping of the first and of the last step: part of (dc, dR) that is made
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: steps x count x points x neighbours; all cores, the same bits at any number of threads.
 */
ms_status ms_surface_fit_steps(ms_surface_fit *fit, ms_ball *ball, size_t count, int steps, const double damping[2],
                               ms_error *err);

#endif
