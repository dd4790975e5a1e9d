/** The measures by which a union of spheres is judged. */
#ifndef MS_METRICS_H
#define MS_METRICS_H

#include "clump/ms_clump.h"
#include "ms_measure.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/* A field for each measure of MS_MEASURE_LIST, in the struct that its kind says. */
#define MS_SCORE_FIELD_GOAL(name) double name;
#define MS_SCORE_FIELD_UNION(name) double name;
#define MS_SCORE_FIELD_SURFACE(name)
#define MS_SCORE_FIELD_NORMAL(name)
#define MS_SCORE_FIELD_SPHERES(name)
#define MS_SCORE_FIELD_COUNT(name)
#define MS_SCORE_FIELD_DESCRIPTOR(name)
#define MS_SCORE_FIELD(kind, CODE, name, ...) MS_SCORE_FIELD_##kind(name)
#define MS_METRICS_FIELD_GOAL(name)
#define MS_METRICS_FIELD_UNION(name)
#define MS_METRICS_FIELD_SURFACE(name) double name;
#define MS_METRICS_FIELD_NORMAL(name) double name;
#define MS_METRICS_FIELD_SPHERES(name) double name;
#define MS_METRICS_FIELD_COUNT(name) size_t name;
#define MS_METRICS_FIELD_DESCRIPTOR(name) double name;
#define MS_METRICS_FIELD(kind, CODE, name, ...) MS_METRICS_FIELD_##kind(name)

/** Measures of S (target) and U (union) on the grid: eta, dice, ... Inertia and coverage_cut are NAN
 * unless they are asked for (ms_metrics_full_score). */
typedef struct ms_score {
    MS_MEASURE_LIST(MS_SCORE_FIELD)
} ms_score;

struct ms_tally;

/** From the sums over the union (ms_tally.h) and the number of voxels of the target; all but inertia and
 * coverage_cut. */
MS_API ms_score ms_metrics_score(const struct ms_tally *sum, size_t target_voxels);

/** The same with the inertia, which is NAN where the union covers no voxel, and where the target's grid has cut cells
 * coverage_cut. @param grid that of the sums */
MS_API ms_score ms_metrics_full_score(const struct ms_tally *sum, const ms_grid *grid, const ms_target *target);

/** How the inertia of one body differs from that of another, both of unit density. */
typedef struct ms_inertia_error {
    double moment[3]; /* of each principal moment, ascending, relative, signed */
    double weighted;  /* sum |difference| / sum of moments, Yuan's eps_w (section 4) */
    double angle;     /* largest angle between axes of the same rank, degrees, where the moments differ by more than
                         1 % from the next; 0 where no axis is determined */
    double centre;    /* distance of the centroids / radius of the ball of equal volume */
} ms_inertia_error;

/** @return MS_OK; MS_ERR_SHAPE if a body has no volume; as ms_inertia_principal */
MS_API ms_status ms_metrics_compare_inertia(ms_inertia_error *error, const ms_body *body, const ms_body *target,
                                            ms_error *err);

/** All measures of a clump. Lengths are in the unit of the mesh. */
typedef struct ms_metrics {
    size_t spheres;
    ms_score score;
    MS_MEASURE_LIST(MS_METRICS_FIELD) /* protrusion_max, ..., clump_convexity */
    ms_body body;                     /* the union, on the grid */
    ms_inertia_error inertia;         /* of the union against the target */
} ms_metrics;

/**
 * Measures a clump against a target, by the target's voxel rule; coverage_cut is NAN unless the
 * target's grid has cut cells or its count_cut is set: they are cut here then, which takes as long as all else.
 * Where spheres reach beyond
 * the target's grid the union is counted on a larger one. Lengths are in the mesh's unit;
 * protrusion and gap are NAN for a volume, protrusion and normals for an open mesh, the inertia error
 * for spheres so small that they cover no voxel, descriptors as ms_descriptors.h has it.
 *
 * @param[out] curve      scores of the prefixes 1..n_spheres; NULL if not wanted
 * @param      clump      at least one sphere
 * @param      max_voxels the largest grid that may be made
 * @return MS_OK; MS_ERR_ARG for an empty clump; MS_ERR_LIMIT; MS_ERR_NOMEM
 *
 * Cost: one raster of the union, a search per sample of the surfaces (ms_surface.h), the descriptors of the clump, and
 * those of the target, unless ms_descriptors_add has been there before. All cores: those of a mesh, which are work for
 * one, by a thread of its own beside the rest.
 */
MS_API ms_status ms_metrics_compute(ms_metrics *metrics, ms_score *curve, const ms_target *target,
                                    const ms_clump *clump, size_t max_voxels, ms_error *err);

/** Kinds of measures that take their time, as bits. */
#define MS_METRICS_KIND(kind) (1u << MS_MEASURE_KIND_##kind)
#define MS_METRICS_ALL (MS_METRICS_KIND(SURFACE) | MS_METRICS_KIND(NORMAL) | MS_METRICS_KIND(DESCRIPTOR))

/** The same, of those kinds only what is asked for: the others are NAN. @param kinds of MS_METRICS_ALL some */
MS_API ms_status ms_metrics_compute_kinds(ms_metrics *metrics, ms_score *curve, unsigned kinds, const ms_target *target,
                                          const ms_clump *clump, size_t max_voxels, ms_error *err);

/** The same of the measures of S and U alone. @param[out] score zeros on failure */
MS_API ms_status ms_metrics_score_clump(ms_score *score, ms_score *curve, const ms_target *target,
                                        const ms_clump *clump, size_t max_voxels, ms_error *err);

MS_C_END

#endif
