/** Envelopes of clump and shape side by side: as text, CSV and JSON. */
#ifndef MS_ENVELOPE_REPORT_H
#define MS_ENVELOPE_REPORT_H

#include <jansson.h>
#include <stdio.h>

#include "contact/ms_envelope.h"

enum { MS_ENVELOPE_MOST = 16 };

/** Of one body, over the radii. */
typedef struct ms_envelope_side {
    double volume;     /* of the body itself; 0: there is none */
    double mean_width; /* of body and envelopes alike */
    ms_envelope envelope[MS_ENVELOPE_MOST];
} ms_envelope_side;

typedef struct ms_envelope_table {
    size_t count;                    /* of radii; 0: not asked for */
    double radius[MS_ENVELOPE_MOST]; /* of the balls, parts of r_eq */
    double r_eq;
    ms_envelope_side clump, shape;
} ms_envelope_table;

/* Volumes over that of the ball of r_eq, widths over its diameter. */
void ms_envelope_report_print(FILE *stream, const ms_envelope_table *table);
void ms_envelope_report_csv(FILE *stream, const ms_envelope_table *table);
/** @return NULL without memory */
json_t *ms_envelope_report_json(const ms_envelope_table *table);

#endif
