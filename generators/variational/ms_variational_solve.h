/** The stages of variational for one number of spheres. Private to it. */
#ifndef MS_VARIATIONAL_SOLVE_H
#define MS_VARIATIONAL_SOLVE_H

#include "ms_generator.h"
#include "ms_surface_fit.h"

typedef struct ms_variational_settings {
    int rounds;       /* of adding spheres and dropping others after the fit */
    int points;       /* per sphere */
    ms_bounds bounds; /* `least` is found from the stop rule */
    double gap;       /* no part of the surface is to be farther from the spheres, voxels; HUGE_VAL: no bound */
    int connected;    /* nonzero: one piece */
    int hold_volume;  /* nonzero: |U| = |S| */
    ms_mirror mirror;
    const ms_clump *refine; /* spheres to start from; empty: none */
} ms_variational_settings;

/**
 * Places up to n spheres so that |S xor U| is least.
 *
 * @param[out] ball  in voxels of the target's grid, mirror images among them; the caller frees it
 * @param[out] count n; fewer where no other inscribed sphere covers anything, where spheres came to be of no use,
 *                   or where n cannot be made of whole sets of mirror images
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT
 */
ms_status ms_variational_solve(ms_ball **ball, size_t *count, const ms_run *run,
                               const ms_variational_settings *settings, size_t n, ms_error *err);

#endif
