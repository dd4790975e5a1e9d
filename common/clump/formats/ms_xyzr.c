/* Spheres as a text of x, y, z, r: CSV, and whatever other tools write. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_text.h"
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

/* Does the header name three columns x, y, z in some order, but not the first three in this one? */
static int header_contradicts(const ms_text *text)
{
    static const char *const NAMES[] = {"x", "y", "z"};
    ms_text ahead = *text;
    ms_word word;
    int in_order = 0; /* the first columns so far are x, y, z */
    int run = 0;      /* columns in a row that are x, y or z */
    for (int column = 0; ms_text_word(&word, &ahead); column++) {
        int name = 0;
        while (name < 3 && !ms_text_word_is(&word, NAMES[name])) {
            name++;
        }
        in_order += name == column && name < 3;
        run = name < 3 ? run + 1 : 0;
        if (run == 3 && in_order < 3) {
            return 1;
        }
    }
    return 0;
}

/* Does the header say that a mass follows the radius? */
static int header_names_mass(const ms_text *text)
{
    ms_text ahead = *text;
    ms_word word;
    int column = 0;
    while (column < 5 && ms_text_word(&word, &ahead)) {
        column++;
    }
    return column == 5 && ms_text_word_is(&word, "mass");
}

/* The masses, as the clump grows. */
typedef struct masses {
    int wanted;
    size_t capacity;
    double *value;
} masses;

static ms_status add_mass(masses *m, const ms_clump *clump, double mass, ms_error *err)
{
    if (clump->n_spheres > m->capacity) {
        double *grown = realloc(m->value, clump->capacity * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the masses of %zu spheres", clump->n_spheres);
        }
        m->value = grown;
        m->capacity = clump->capacity;
    }
    m->value[clump->n_spheres - 1] = mass;
    return MS_OK;
}

static ms_status read_sphere(ms_clump *clump, masses *m, ms_text *text, ms_error *err)
{
    double v[5];
    ms_status status =
        ms_text_doubles(v, m->wanted ? 5 : 4, text, m->wanted ? "a sphere (x y z r mass)" : "a sphere (x y z r)", err);
    if (status != MS_OK) {
        return status;
    }
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[3]) || !(v[3] > 0)) {
        return ms_text_fail(err, text, "sphere (%g, %g, %g) with radius %g; centres must be finite and radii above 0",
                            v[0], v[1], v[2], v[3]);
    }
    const ms_sphere sphere = {.centre = {v[0], v[1], v[2]}, .radius = v[3]};
    status = ms_clump_add(clump, &sphere, err);
    return status == MS_OK && m->wanted ? add_mass(m, clump, v[4], err) : status;
}

static ms_status parse_spheres(ms_clump *clump, masses *m, ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_text text;
    int header_allowed = 1;
    if (memchr(bytes->data, 0, bytes->size)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: this is not a text file of spheres x,y,z,r", name);
    }
    mend_line_ends(bytes);
    ms_text_start(&text, bytes, name);
    text.comment = '#';
    while (ms_text_seek(&text)) {
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
        if (header && header_contradicts(&text)) {
            return ms_text_fail(err, &text,
                                "the header names x, y, z in other columns; the first four must be x, y, z, r");
        }
        m->wanted |= header && header_names_mass(&text);
        ms_status status = header ? MS_OK : read_sphere(clump, m, &text, err);
        if (status != MS_OK) {
            return status;
        }
        ms_text_skip_line(&text);
    }
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: no spheres; give one line x,y,z,r for each", name);
    }
    return MS_OK;
}

ms_status ms_xyzr_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    masses m = {0};
    (void)particle;
    const ms_status status = parse_spheres(clump, &m, bytes, name, err);
    clump->mass = m.value;
    return status;
}

ms_status ms_xyzr_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    (void)err;
    fputs(ms_fields_has_masses(content) ? "x,y,z,r,mass,density\n" : "x,y,z,r\n", stream);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *b = &clump->sphere[s];
        ms_fields_numbers(stream, (const double[]){b->centre[0], b->centre[1], b->centre[2], b->radius}, 4, ",");
        if (ms_fields_has_masses(content)) {
            fputc(',', stream);
            ms_fields_numbers(stream, (const double[]){clump->mass[s], ms_fields_density(content, s)}, 2, ",");
        }
        fputc('\n', stream);
    }
    return MS_OK;
}
