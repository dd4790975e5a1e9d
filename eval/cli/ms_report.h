/** Scores and properties as tables for people and as JSON for machines. */
#ifndef MS_REPORT_H
#define MS_REPORT_H

#include <jansson.h>
#include <stdio.h>

#include "clump/ms_equal_volume.h"
#include "measure/ms_metrics.h"
#include "ms_input.h"

/** All measures of a clump, a line each. */
void ms_report_metrics(FILE *stream, const ms_metrics *metrics, const ms_target *target);

/** What --equal-volume did; nothing where it was not asked for. */
void ms_report_equal_volume(FILE *stream, const ms_equal_volume *done);

/** On stderr, where it scaled by more than a tenth: then spheres lie off the shape. @param name of shape or clump */
void ms_report_equal_volume_remark(const char *name, const ms_equal_volume *done);

/** As ms_report_equal_volume; NULL where it was not asked for. */
json_t *ms_report_equal_volume_json(const ms_equal_volume *done);

/** The same as a JSON object; the caller owns it. Measures that do not apply are null. */
json_t *ms_report_metrics_json(const ms_metrics *metrics);

/** The measures of ms_score alone, and the number of spheres; the caller owns it. */
json_t *ms_report_score_json(const ms_score *score, size_t spheres);

/** An object to which values were added: NULL, and the object freed, if one of them failed for lack of memory. */
json_t *ms_report_whole(json_t *object, int failed);

/** Scores of clumps of 1 to count spheres as CSV: n, the measures with `curve`, coverage_cut if it was counted. */
void ms_report_curve(FILE *stream, const ms_score *curve, size_t count);

/** Path, checksum, grid and rule of the input; the caller owns it. */
json_t *ms_report_input_json(const ms_input *input);

/** What was mended in a mesh; the caller owns it. */
json_t *ms_report_mending_json(const ms_mesh_report *report);

/** Volume, centroid, inertia, principal moments and axes; the caller owns it. */
json_t *ms_report_body_json(const ms_body *body, const ms_principal *principal);

/** A number, or null if it is not finite. */
json_t *ms_report_number(double value);

/** Text that need not be UTF-8, as a path (ms_escape_utf8). */
json_t *ms_report_text(const char *text);

/** Prints and frees a JSON value, indented. @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM if it is NULL */
ms_status ms_report_print(FILE *stream, json_t *value, ms_error *err);

#endif
