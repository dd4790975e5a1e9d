/** The measures by which a union of spheres is judged. */
#ifndef MS_METRICS_H
#define MS_METRICS_H

#include "clump/ms_clump.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/** Measures of S (target) and U (union) on the grid. */
typedef struct ms_score {
    double eta;        /* sum |S-U| / sum S          MSS eq. 7 */
    double dice;       /* 1 - 2 sum SU / (sum S + sum U), the mismatch D   MSS eq. 27 */
    double coverage;   /* sum SU / sum S             Yuan's V_cl/V_p */
    double overshoot;  /* sum U(1-S) / sum S */
    double off_volume; /* sum U / sum S              Westbrink eq. 2 */
    double inertia;    /* weighted mean error of the principal moments, Yuan 4; NAN unless ms_metrics_compute set it */
} ms_score;

/** From the sums over the union and the number of voxels of the target; all but the inertia. */
ms_score ms_metrics_score(const ms_tally *sum, size_t target_voxels);

/** How the inertia of one body differs from that of another, both of unit density. */
typedef struct ms_inertia_error {
    double moment[3]; /* of each principal moment, ascending, relative, signed */
    double weighted;  /* sum |difference| / sum of moments, Yuan's eps_w (section 4) */
    double angle;     /* largest angle between axes of the same rank, degrees, where the moments differ by more than
                         1 % from the next; 0 where no axis is determined */
    double centre;    /* distance of the centroids / radius of the ball of equal volume */
} ms_inertia_error;

/** @return MS_OK; MS_ERR_SHAPE if a body has no volume; as ms_inertia_principal */
ms_status ms_metrics_compare_inertia(ms_inertia_error *error, const ms_body *body, const ms_body *target,
                                     ms_error *err);

/** All measures of a clump. */
typedef struct ms_metrics {
    size_t spheres;
    ms_score score;
    double protrusion_max,
        protrusion_rms;           /* of exposed sphere surface outside the mesh; rms over all exposed surface */
    double gap_max, gap_rms;      /* of mesh surface outside all spheres; rms over all mesh surface */
    double smallest_radius_ratio; /* smallest radius / radius of the ball of the target's volume */
    size_t pieces;                /* 1: connected */
    ms_body body;                 /* the union, on the grid */
    ms_inertia_error inertia;     /* of the union against the target */
} ms_metrics;

/**
 * Measures a clump against a target, by the target's voxel rule. Where spheres reach beyond
 * the target's grid the union is counted on a larger one. Lengths are in the mesh's unit;
 * protrusion and gap are NAN for a volume, protrusion for an open mesh too, the inertia error
 * for spheres so small that they cover no voxel.
 *
 * @param[out] curve      scores of the prefixes 1..n_spheres; NULL if not wanted
 * @param      clump      at least one sphere
 * @param      max_voxels the largest grid that may be made
 * @return MS_OK; MS_ERR_ARG for an empty clump; MS_ERR_LIMIT; MS_ERR_NOMEM
 *
 * Cost: one raster of the union, and a search per sample of the surfaces (ms_surface.h).
 */
ms_status ms_metrics_compute(ms_metrics *metrics, ms_score *curve, const ms_target *target, const ms_clump *clump,
                             size_t max_voxels, ms_error *err);

MS_C_END

#endif
