/* Spheres as a text of x, y, z, r: CSV, and whatever other tools write. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_text.h"
#include "ms_columns.h"
#include "ms_fields.h"
#include "ms_formats.h"

static int is_mark(char c)
{
    return c == ',' || c == ';';
}

static int is_between(char c)
{
    return is_mark(c) || c == ' ' || c == '\t' || c == '\r';
}

/*
 * Other tools write commas, semicolons, tabs or blanks: in one line all become blanks.
 * Returns what is wrong with its first four columns, NULL if nothing is: an empty one, or the
 * decimal commas of many a spreadsheet, would shift the numbers without notice.
 */
static const char *separate_columns(char *at, const char *end)
{
    const char *flaw = NULL;
    char kind = ' '; /* the mark between the first two columns; blank where there is none */
    for (int column = 0; column < 4 || at < end; column++) {
        char mark = ' ';
        int marks = at < end && is_mark(*at); /* nothing stands before the first mark */
        while (at < end && !is_between(*at)) {
            at++;
        }
        for (; at < end && is_between(*at); at++) {
            if (is_mark(*at)) {
                marks++;
                mark = *at;
                *at = ' ';
            }
        }
        kind = column == 0 ? mark : kind;
        if (column < 3 && marks > 1) {
            flaw = "one of the first four columns is empty";
        } else if (!flaw && at < end && mark != kind && (column < 3 || (column == 3 && mark == ','))) {
            flaw = "commas and other separators are mixed; write decimal points, and one kind of separator";
        }
    }
    return flaw;
}

/* Separates the columns of the line at which the text stands, up to its comment. */
static const char *separate_line(ms_bytes *bytes, const ms_text *text)
{
    char *start = (char *)bytes->data + (text->at - (const char *)bytes->data);
    const size_t left = (size_t)(text->end - text->at);
    const char *newline = memchr(start, '\n', left), *end = newline ? newline : start + left;
    const char *comment = memchr(start, '#', (size_t)(end - start));
    return separate_columns(start, comment ? comment : end);
}

/* Old files end their lines by a carriage return alone. */
static void mend_line_ends(ms_bytes *bytes)
{
    for (size_t at = 0; at + 1 < bytes->size; at++) {
        if (bytes->data[at] == '\r' && bytes->data[at + 1] != '\n') {
            bytes->data[at] = '\n';
        }
    }
}

static int line_is_empty(const ms_text *text)
{
    ms_text ahead = *text;
    ms_word word;
    return !ms_text_word(&word, &ahead);
}

/* A line that begins like a number is no header, even if its first number is misspelt. */
static int begins_with_number(const ms_text *text)
{
    ms_text ahead = *text;
    ms_word word;
    double value;
    return ms_text_word(&word, &ahead) && (strchr("+-.0123456789", *word.start) || ms_text_to_double(&value, &word));
}

/* What is known of the columns, and the masses, as the clump grows. */
typedef struct table {
    ms_columns columns;
    ms_word clump; /* the id of the first sphere's clump */
    size_t capacity;
    double *mass;
} table;

static ms_status add_mass(table *t, const ms_clump *clump, double mass, ms_error *err)
{
    const size_t n = ms_clump_count_masses(clump);
    if (n > t->capacity) {
        double *grown = realloc(t->mass, clump->capacity * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the masses of %zu spheres", n);
        }
        t->mass = grown;
        t->capacity = clump->capacity;
    }
    t->mass[n - 1] = mass;
    return MS_OK;
}

/* Spheres of several clumps are no clump. */
static ms_status check_clump_id(table *t, ms_text *text, ms_error *err)
{
    ms_word id;
    if (!ms_text_word(&id, text)) {
        return MS_OK;
    }
    t->clump = t->clump.length > 0 ? t->clump : id;
    if (id.length != t->clump.length || memcmp(id.start, t->clump.start, id.length) != 0) {
        return ms_text_fail(err, text, "this sphere is of clump %s, those before of clump %s; keep the spheres of one",
                            ms_text_quote(&id).text, ms_text_quote(&t->clump).text);
    }
    return MS_OK;
}

static ms_status read_sphere(ms_clump *clump, table *t, ms_text *text, ms_error *err)
{
    double v[7] = {0};
    const int mass = t->columns.mass, carrier = t->columns.carrier;
    ms_status status = ms_text_doubles(v,
                                       carrier ? 7
                                       : mass  ? 5
                                               : 4,
                                       text,
                                       carrier ? "a sphere (x y z r mass density carrier)"
                                       : mass  ? "a sphere (x y z r mass)"
                                               : "a sphere (x y z r)",
                                       err);
    if (status != MS_OK) {
        return status;
    }
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[3]) || !(v[3] > 0)) {
        return ms_text_fail(err, text, "sphere (%g, %g, %g) with radius %g; centres must be finite and radii above 0",
                            v[0], v[1], v[2], v[3]);
    }
    const ms_sphere sphere = {.centre = {v[0], v[1], v[2]}, .radius = v[3]};
    if ((v[6] != 0 && v[6] != 1) || (v[6] == 0 && clump->n_carriers > 0)) {
        return ms_text_fail(err, text, "the column 'carrier' is 0 for spheres, and 1 for carriers, behind all spheres");
    }
    status = v[6] == 1 ? ms_clump_add_carrier(clump, &sphere, err) : ms_clump_add(clump, &sphere, err);
    if (status == MS_OK && t->columns.clump) {
        status = check_clump_id(t, text, err);
    }
    return status == MS_OK && mass ? add_mass(t, clump, v[4], err) : status;
}

/* Takes the names of the columns from a line; the text stands on it, for messages. */
static ms_status read_names(table *t, const ms_word *name, size_t n, const ms_text *text, ms_error *err)
{
    ms_error cause;
    const ms_status status = ms_columns_read(&t->columns, name, n, &cause);
    return status == MS_OK ? MS_OK : ms_text_fail(err, text, "%s", cause.text);
}

/* The columns that a comment names: "# x y z r", of YADE "#format x_y_z_r_clumpId"; 0 if it names none. */
static size_t split_comment(ms_word name[MS_COLUMNS_MOST], const ms_word *line)
{
    static const char YADE[] = "#format ";
    const size_t head = sizeof YADE - 1;
    const ms_word first = {line->start, head < line->length ? head : line->length};
    const int yade = ms_text_word_is(&first, YADE);
    const ms_word rest = {line->start + (yade ? head : 1), line->length - (yade ? head : 1)};
    const size_t n = ms_columns_split(name, &rest, yade ? '_' : 0);
    return ms_columns_name_axes(name, n) ? n : 0;
}

/* Many a tool names the columns in a comment above them. Masses take a header of their own. */
static ms_status read_comments(table *t, ms_text text, ms_error *err)
{
    ms_word line = ms_text_rest(&text), name[MS_COLUMNS_MOST];
    while (text.at < text.end && (line.length == 0 || line.start[0] == '#')) {
        const size_t n = line.length > 0 ? split_comment(name, &line) : 0;
        const ms_status status = read_names(t, name, n, &text, err);
        if (status != MS_OK) {
            return status;
        }
        text.at++;
        text.line++;
        line = ms_text_rest(&text);
    }
    t->columns.mass = 0;
    return MS_OK;
}

/* The line at which the text stands, up to its comment. */
static ms_word peek_line(const ms_text *text)
{
    ms_text ahead = *text;
    ms_word line = ms_text_rest(&ahead);
    const char *comment = memchr(line.start, '#', line.length);
    line.length = comment ? (size_t)(comment - line.start) : line.length;
    return line;
}

static ms_status read_spheres(ms_clump *clump, table *t, ms_bytes *bytes, ms_text text, ms_error *err)
{
    int header_allowed = 1;
    while (ms_text_seek(&text)) {
        ms_word name[MS_COLUMNS_MOST];
        const ms_word line = peek_line(&text);
        const size_t n = header_allowed ? ms_columns_split(name, &line, 0) : 0; /* before its marks are blanked */
        const int first_is_empty = is_mark(*text.at);
        const char *flaw = separate_line(bytes, &text);
        if (line_is_empty(&text)) {
            continue;
        }
        const int header = header_allowed && !begins_with_number(&text);
        header_allowed = 0;
        if (flaw && (!header || first_is_empty)) { /* a nameless first column holds numbers of rows */
            return ms_text_fail(err, &text, "%s", flaw);
        }
        ms_status status = header ? read_names(t, name, n, &text, err) : read_sphere(clump, t, &text, err);
        if (status != MS_OK) {
            return status;
        }
        ms_text_skip_line(&text);
    }
    return MS_OK;
}

static ms_status parse_spheres(ms_clump *clump, table *t, ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_text text;
    if (memchr(bytes->data, 0, bytes->size)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: this is not a text file of spheres x,y,z,r", name);
    }
    mend_line_ends(bytes);
    ms_text_start(&text, bytes, name);
    ms_status status = read_comments(t, text, err);
    text.comment = '#';
    if (status == MS_OK) {
        status = read_spheres(clump, t, bytes, text, err);
    }
    if (status == MS_OK && clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: no spheres; give one line x,y,z,r for each", name);
    }
    return status;
}

ms_status ms_xyzr_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    table t = {0};
    (void)particle;
    const ms_status status = parse_spheres(clump, &t, bytes, name, err);
    clump->mass = t.mass;
    return status;
}

ms_status ms_xyzr_read_yade(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    table t = {.columns = {.clump = 1}};
    (void)particle;
    const ms_status status = parse_spheres(clump, &t, bytes, name, err);
    clump->mass = t.mass;
    return status;
}

ms_status ms_xyzr_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    const size_t n = ms_fields_count(content);
    (void)err;
    fputs("x,y,z,r", stream);
    fputs(ms_fields_has_masses(content) ? ",mass,density" : "", stream);
    fputs(n > clump->n_spheres ? ",carrier\n" : "\n", stream);
    for (size_t s = 0; s < n; s++) {
        const ms_sphere *b = &clump->sphere[s];
        ms_fields_numbers(stream, (const double[]){b->centre[0], b->centre[1], b->centre[2], b->radius}, 4, ",");
        if (ms_fields_has_masses(content)) {
            fputc(',', stream);
            ms_fields_numbers(stream, (const double[]){clump->mass[s], ms_fields_density(content, s)}, 2, ",");
        }
        fputs(n == clump->n_spheres ? "\n" : s < clump->n_spheres ? ",0\n" : ",1\n", stream);
    }
    return MS_OK;
}
