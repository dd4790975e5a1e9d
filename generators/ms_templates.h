/** The clumps of 1, 2, ... spheres of one shape, from which a scene takes its template. */
#ifndef MS_TEMPLATES_H
#define MS_TEMPLATES_H

#include "measure/ms_metrics.h"
#include "ms_generator.h"

MS_C_BEGIN

/** A zeroed struct is empty. */
typedef struct ms_templates {
    size_t most;       /* spheres of the largest */
    ms_clump *clump;   /* of 1 .. most spheres; empty where a search has not run them */
    ms_score *score;   /* of each */
    double *dice;      /* D alone; NAN where a search has not run them */
    ms_error *remarks; /* on each, of the method and of a scale far from 1; "" without */
} ms_templates;

/** How they are made. All borrowed. */
typedef struct ms_templates_how {
    const ms_generator *generator;
    const ms_run *run;    /* with the most spheres; of its stop rule the least radius is heeded beside. Its `stage` is
                             told of all runs together, and not of the first, which is a small part of them */
    const ms_body *equal; /* scale each, before it is judged, until its union has this body's volume; NULL: leave it */
    size_t max_voxels;    /* as for ms_metrics_compute */
} ms_templates_how;

/**
 * Those of 1 to the most spheres, or of as many as the method finds room for (ms_curve_clumps). Where it gives fewer
 * spheres than asked for, the better of both clumps stands at their number.
 *
 * @param[out] templates ms_templates_free frees them; empty on failure
 * @return MS_OK; MS_ERR_INTERRUPTED where the run's listener ends a run; as ms_generator_run, ms_curve_clumps,
 *         ms_equal_volume_scale, ms_metrics_compute
 *
 * Cost: a run and ms_curve_clumps; with `equal` as many ms_metrics_compute more.
 */
MS_API ms_status ms_templates_make(ms_templates *templates, const ms_templates_how *how, ms_error *err);

/** Room for a search, nothing run. @param[out] templates as above @param most spheres, at least 1 @return MS_OK;
 * MS_ERR_ARG for none; MS_ERR_NOMEM */
MS_API ms_status ms_templates_alloc(ms_templates *templates, size_t most, ms_error *err);

/**
 * The least number of spheres that reaches a measure, by few runs: from a number that is expected on in steps of a
 * fifth until the value lies between two of them, then by halves. Where each number is a run of its own (not
 * ms_generator_is_nested) that is much less than all of them.
 *
 * @param[in,out] templates of ms_templates_alloc; what a search before has run, for another value of the same measure,
 *                          is not run again
 * @param[out]    reached   the number; one sphere less was run, too, and does not reach it; 0: the most do not
 * @param         first     the number that is expected; any
 * @return as ms_templates_make
 */
MS_API ms_status ms_templates_search(ms_templates *templates, size_t *reached, const ms_templates_how *how,
                                     const ms_measure *measure, double value, size_t first, ms_error *err);

/** The least number of spheres of those that were run that reaches a measure; 0: none does. @param[out] best the best
 * value of those with fewer spheres; NAN where none was run */
MS_API size_t ms_templates_least(double *best, const ms_templates *templates, const ms_measure *measure, double value);

/**
 * Area over volume of a shape, by which a distance of surfaces is a D.
 *
 * @param[out] surface 1 / the unit of the shape
 * @return MS_OK; MS_ERR_SHAPE where the area is not known; as ms_descriptors_of_target
 */
MS_API ms_status ms_templates_surface(double *surface, const ms_target *target, ms_error *err);

/**
 * D of a template whose surface is at a mean distance L from that of its shape, of volume V and area A: the volume
 * between them, some A L, is that of S xor U, and D = |S xor U| / (|S| + |U|), where the latter is some 2 V.
 *
 * @param length  L, in the unit of the shape
 * @param surface of ms_templates_surface
 * @param factor  by which the shape is scaled
 */
MS_API double ms_templates_dice(double length, double surface, double factor);

/** The way back: the mean distance 2 V D / A. */
MS_API double ms_templates_length(double dice, double surface, double factor);

MS_API void ms_templates_free(ms_templates *templates);

MS_C_END

#endif
