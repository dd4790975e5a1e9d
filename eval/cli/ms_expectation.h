/** The least mismatch to be expected of a shape that was read: what is said of it. */
#ifndef MS_EXPECTATION_H
#define MS_EXPECTATION_H

#include <jansson.h>
#include <stdio.h>

#include "expect/ms_expect.h"
#include "measure/ms_metrics.h"
#include "ms_input.h"

/**
 * What is expected of a shape: of a mesh by its triangles, of a volume by the voxels of its target.
 *
 * @param input with its target if it is a volume
 * @return MS_OK; MS_ERR_SHAPE for a mesh that is open or passes through itself; as ms_expect_mesh and ms_expect_grid
 */
ms_status ms_expectation_find(ms_expect *expect, const ms_input *input, ms_error *err);

/** The same, but a shape of which nothing can be expected is none that fails: its curves are empty. */
ms_status ms_expectation_try(ms_expect *expect, const ms_input *input, ms_error *err);

/**
 * The same for numbers of spheres about one alone, by ms_expect_near.
 *
 * @param input with its target
 */
ms_status ms_expectation_near(ms_expect *expect, const ms_input *input, size_t spheres, ms_error *err);

/** By what factor D is above what is expected: a line for people, nothing for empty curves. */
void ms_expectation_say(FILE *stream, const ms_expect *expect, const ms_metrics *metrics);

/** The same as a JSON object, null for empty curves; the caller owns it. */
json_t *ms_expectation_factor_json(const ms_expect *expect, const ms_metrics *metrics);

/** D expected of that many spheres; NAN for empty curves. */
double ms_expectation_dice(const ms_expect *expect, size_t spheres);

/** Number of spheres of which that D is expected; NAN for empty curves. */
double ms_expectation_spheres(const ms_expect *expect, double dice);

/** Tables for people: D by number of spheres, and numbers by D. */
void ms_expectation_print(FILE *stream, const ms_expect *expect);

/** The same as a JSON object; the caller owns it. */
json_t *ms_expectation_json(const ms_expect *expect);

/**
 * Says on stderr, if value and range both have it so, that n spheres are hopeless, and how many would do, for which
 * all that is expected is computed; nothing for empty curves.
 *
 * @param expect of ms_expectation_near for n
 * @return as ms_expectation_find
 */
ms_status ms_expectation_warn(const ms_expect *expect, const ms_input *input, size_t n, ms_error *err);

#endif
