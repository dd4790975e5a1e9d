#include "ms_envelope_report.h"

#include <math.h>

#include "chart/ms_csv.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"

static const double PI = 3.14159265358979323846;

/* What is said of a body: X(name, value), where t is the table, r a radius of it and ball the volume of find_ball. */
#define MS_ENVELOPE_COLUMNS(X, name, side)                \
    X(name "_volume", (side).volume / ball)               \
    X(name "_envelope", (side).envelope[r].volume / ball) \
    X(name "_error", (side).envelope[r].error / ball)     \
    X(name "_width", (side).mean_width / (2 * t->r_eq))

static double find_ball(const ms_envelope_table *t)
{
    return 4 * PI / 3 * pow(t->r_eq, 3);
}

static void print_side(FILE *stream, const char *name, const ms_envelope_table *t, const ms_envelope_side *side)
{
    const double ball = find_ball(t);
    for (size_t r = 0; r < t->count; r++) {
        const ms_envelope *e = &side->envelope[r];
        fprintf(stream, "  %-8s %-8.4g %9.5f %10.5f  %.1e %11.5f\n", name, t->radius[r], side->volume / ball,
                e->volume / ball, e->error / ball, side->mean_width / (2 * t->r_eq));
    }
}

void ms_envelope_report_print(FILE *stream, const ms_envelope_table *t)
{
    fputs("\n  envelope of a ball   volume   envelope  error    mean width\n  of       radius\n", stream);
    print_side(stream, "clump", t, &t->clump);
    if (t->shape.volume > 0) {
        print_side(stream, "shape", t, &t->shape);
    }
    fputs("  (radius in r_eq, volumes over that of the ball of r_eq, width over its diameter)\n", stream);
}

void ms_envelope_report_csv(FILE *stream, const ms_envelope_table *t)
{
#define NAME(name, value) "," name
    fputs("radius" MS_ENVELOPE_COLUMNS(NAME, "clump", t->clump) MS_ENVELOPE_COLUMNS(NAME, "shape", t->shape) "\n",
          stream);
#undef NAME
    const double ball = find_ball(t);
    const int has_shape = t->shape.volume > 0;
    for (size_t r = 0; r < t->count; r++) {
        fprintf(stream, "%.9g", t->radius[r]);
#define PUT(name, value) ms_csv_put_number(stream, value);
        MS_ENVELOPE_COLUMNS(PUT, "clump", t->clump)
#undef PUT
#define PUT(name, value) ms_csv_put_number(stream, has_shape ? (value) : (double)NAN);
        MS_ENVELOPE_COLUMNS(PUT, "shape", t->shape)
#undef PUT
        fputc('\n', stream);
    }
}

json_t *ms_envelope_report_json(const ms_envelope_table *t)
{
    json_t *list = json_array();
    const double ball = find_ball(t);
    for (size_t r = 0; r < t->count; r++) {
        json_t *row = json_pack("{s:f}", "radius", t->radius[r]);
#define SET(name, value) ms_json_object_set(&row, name, ms_report_number(value));
        MS_ENVELOPE_COLUMNS(SET, "clump", t->clump)
        if (t->shape.volume > 0) {
            MS_ENVELOPE_COLUMNS(SET, "shape", t->shape)
        }
#undef SET
        ms_json_object_append(&list, row);
    }
    return json_pack("{s:o}", "envelopes", list);
}
