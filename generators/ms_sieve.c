#include "ms_sieve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_text.h"
#include "ms_sieve_counts.h"

/* The rows of the file. */
typedef struct sieve_curve {
    size_t count;
    double size[MS_SIEVE_MAX_ROWS], passing[MS_SIEVE_MAX_ROWS];
} sieve_curve;

static ms_status read_sieve_header(ms_text *text, ms_error *err)
{
    ms_word field[2];
    if (!ms_text_seek(text)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: the sieve curve is empty; its first line is size,passing", text->name);
    }
    const ms_word line = ms_text_rest(text);
    return ms_text_split(field, 2, &line) == 2 && ms_text_word_is(&field[0], "size") &&
                   ms_text_word_is(&field[1], "passing")
               ? MS_OK
               : ms_text_fail(err, text, "the header is '%s', not size,passing", ms_text_quote(&line).text);
}

/* What a size and a share are called in messages. */
typedef struct row_quote {
    ms_quote size, passing;
} row_quote;

/* Is the row one that may stand behind those before? Then it does. */
static ms_status add_sieve_row(sieve_curve *curve, double size, double passing, const row_quote *said, ms_error *err)
{
    const size_t at = curve->count;
    if (at == MS_SIEVE_MAX_ROWS) {
        return ms_fail(err, MS_ERR_FORMAT, "more than %d rows", MS_SIEVE_MAX_ROWS);
    }
    if (!(size >= MS_MANIFEST_LEAST_SIZE && size <= MS_MANIFEST_MOST_SIZE)) {
        return ms_fail(err, MS_ERR_FORMAT, "the size '%s' is not a number from %g to %g", said->size.text,
                       MS_MANIFEST_LEAST_SIZE, MS_MANIFEST_MOST_SIZE);
    }
    if (!(passing >= 0 && passing <= 1)) {
        return ms_fail(err, MS_ERR_FORMAT, "the share '%s' is not a number from 0 to 1", said->passing.text);
    }
    if (at > 0 && !(size > curve->size[at - 1] && passing >= curve->passing[at - 1])) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "size %g with share %g stands behind %g with %g; sizes ascend, shares do not fall", size,
                       passing, curve->size[at - 1], curve->passing[at - 1]);
    }
    if (at == 0 && passing > 0) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%g of the mass is finer than the first size; sizes ascend from one that nothing passes",
                       passing);
    }
    curve->size[at] = size;
    curve->passing[at] = passing;
    curve->count++;
    return MS_OK;
}

/* A number, or NAN. */
static double read_number(const ms_word *word)
{
    double number;
    return ms_text_to_double(&number, word) ? number : (double)NAN;
}

static ms_status read_sieve_row(sieve_curve *curve, ms_text *text, ms_error *err)
{
    ms_word field[2];
    ms_error cause;
    const ms_word line = ms_text_rest(text);
    if (ms_text_split(field, 2, &line) != 2) {
        return ms_text_fail(err, text, "'%s' is not a size and a share", ms_text_quote(&line).text);
    }
    const row_quote said = {ms_text_quote(&field[0]), ms_text_quote(&field[1])};
    const ms_status status = add_sieve_row(curve, read_number(&field[0]), read_number(&field[1]), &said, &cause);
    return status == MS_OK ? MS_OK : ms_text_fail(err, text, "%s", cause.text);
}

/* Is the curve whole? */
static ms_status check_sieve_end(const sieve_curve *curve, const char *name, ms_error *err)
{
    const double passing = curve->count > 0 ? curve->passing[curve->count - 1] : 0;
    return passing < 1 ? ms_fail(err, MS_ERR_FORMAT,
                                 "%s: the last size lets %g of the mass pass, not 1; add the size of the largest", name,
                                 passing)
                       : MS_OK;
}

static ms_status read_curve(sieve_curve *curve, const ms_bytes *bytes, const char *path, ms_error *err)
{
    ms_text text;
    if (memchr(bytes->data, 0, bytes->size)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: this is not a text file size,passing", path);
    }
    ms_text_start(&text, bytes, path);
    text.comment = '#';
    ms_status status = read_sieve_header(&text, err);
    while (status == MS_OK && ms_text_seek(&text)) {
        status = read_sieve_row(curve, &text, err);
    }
    return status == MS_OK ? check_sieve_end(curve, path, err) : status;
}

static ms_status take_curve(sieve_curve *curve, const double *size, const double *passing, size_t count, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t r = 0; r < count && status == MS_OK; r++) {
        ms_error cause;
        row_quote said;
        snprintf(said.size.text, sizeof said.size.text, "%g", size[r]);
        snprintf(said.passing.text, sizeof said.passing.text, "%g", passing[r]);
        status = add_sieve_row(curve, size[r], passing[r], &said, &cause);
        if (status != MS_OK) {
            status = ms_fail(err, status, "the sieve curve: row %zu: %s", r, cause.text);
        }
    }
    return status == MS_OK ? check_sieve_end(curve, "the sieve curve", err) : status;
}

/* The mean of size^-3 over the shares from lo to hi. Between two rows size = a exp(L t), t growing with the share from
 * 0 to 1. However small a share and L are, their quotients are numbers. */
static double mean_count(const sieve_curve *curve, double lo, double hi)
{
    double sum = 0;
    for (size_t r = 0; r + 1 < curve->count; r++) {
        const double a = curve->size[r], p = curve->passing[r], span = curve->passing[r + 1] - p;
        const double from = fmax(lo, p), to = fmin(hi, curve->passing[r + 1]);
        if (from < to) {
            const double l = 3 * log1p((curve->size[r + 1] - a) / a), part = l * ((to - from) / span);
            sum += (to - from) / (hi - lo) * pow(a, -3) * exp(-l * ((from - p) / span)) * (-expm1(-part) / part);
        }
    }
    return sum;
}

/* Between these shares. */
static void add_class(ms_sieve *sieve, const sieve_curve *curve, double lo, double hi)
{
    if (lo < hi) {
        const double size = cbrt(1 / mean_count(curve, lo, hi));
        sieve->of[sieve->count++] = (ms_sieve_class){.size = size, .share = hi - lo};
    }
}

static ms_status make_classes(ms_sieve *sieve, const sieve_curve *curve, size_t classes, ms_error *err)
{
    if (classes > MS_SIEVE_MAX_CLASSES) {
        return ms_fail(err, MS_ERR_ARG, "%zu classes of size; %d at most are made", classes, MS_SIEVE_MAX_CLASSES);
    }
    *sieve = (ms_sieve){.of = calloc(classes > 0 ? classes : curve->count, sizeof *sieve->of)};
    if (!sieve->of) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the classes of size");
    }
    for (size_t c = 0; c < classes; c++) {
        add_class(sieve, curve, (double)c / (double)classes, (double)(c + 1) / (double)classes);
    }
    for (size_t r = 0; classes == 0 && r + 1 < curve->count; r++) {
        add_class(sieve, curve, curve->passing[r], curve->passing[r + 1]);
    }
    return MS_OK;
}

/* No rows yet. The caller frees it; NULL without memory. */
static sieve_curve *make_curve(ms_error *err)
{
    sieve_curve *curve = calloc(1, sizeof *curve);
    if (!curve) {
        ms_fail(err, MS_ERR_NOMEM, "no memory for the sieve curve");
    }
    return curve;
}

ms_status ms_sieve_make(ms_sieve *sieve, const double *size, const double *passing, size_t count, size_t classes,
                        ms_error *err)
{
    *sieve = (ms_sieve){0};
    sieve_curve *curve = make_curve(err);
    ms_status status = curve ? take_curve(curve, size, passing, count, err) : MS_ERR_NOMEM;
    if (status == MS_OK) {
        status = make_classes(sieve, curve, classes, err);
    }
    free(curve);
    return status;
}

ms_status ms_sieve_read(ms_sieve *sieve, const char *path, size_t classes, ms_error *err)
{
    ms_bytes bytes;
    *sieve = (ms_sieve){0};
    sieve_curve *curve = make_curve(err);
    ms_status status = curve ? ms_file_read(&bytes, path, err) : MS_ERR_NOMEM;
    if (status == MS_OK) {
        status = read_curve(curve, &bytes, path, err);
        ms_file_free(&bytes);
    }
    if (status == MS_OK) {
        status = make_classes(sieve, curve, classes, err);
    }
    free(curve);
    return status;
}

/* How many of each class there are in all, and what they have of the mass. */
static ms_status count_classes(ms_sieve *sieve, uint64_t particles, ms_error *err)
{
    double sum = 0, *share = malloc(sieve->count * sizeof *share), *mass = malloc(sieve->count * sizeof *mass);
    uint64_t *count = malloc(sieve->count * sizeof *count);
    const int has_memory = share && mass && count;
    for (size_t c = 0; c < sieve->count && has_memory; c++) {
        share[c] = sieve->of[c].share;
        mass[c] = pow(sieve->of[c].size, 3);
    }
    if (has_memory) {
        ms_sieve_counts_round(count, share, mass, sieve->count, particles);
    }
    for (size_t c = 0; c < sieve->count && has_memory; c++) {
        sieve->of[c].count = count[c];
        sum += sieve->of[c].mass = (double)count[c] * mass[c];
    }
    for (size_t c = 0; c < sieve->count && has_memory; c++) {
        sieve->of[c].mass /= sum;
    }
    free(share);
    free(mass);
    free(count);
    return has_memory ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the classes of size");
}

/* A row for each class of a row. @param left of each class */
static ms_status spread_row(ms_manifest *made, const ms_manifest_row *row, const ms_sieve *sieve, uint64_t *left,
                            uint64_t *taken, ms_error *err)
{
    ms_sieve_counts_take(taken, left, sieve->count, row->particles);
    for (size_t c = 0; c < sieve->count; c++) {
        if (taken[c] > 0) {
            ms_manifest_row *kind = &made->row[made->count++];
            *kind = *row;
            kind->path = strdup(row->path);
            kind->particles = taken[c];
            kind->size = sieve->of[c].size;
            if (!kind->path) {
                return ms_fail(err, MS_ERR_NOMEM, "no memory for the kinds of particles");
            }
        }
    }
    return MS_OK;
}

static ms_status spread_rows(ms_manifest *made, const ms_manifest *manifest, const ms_sieve *sieve, ms_error *err)
{
    uint64_t *left = malloc(2 * sieve->count * sizeof *left);
    *made = (ms_manifest){.row = calloc(manifest->count * sieve->count, sizeof *made->row)};
    ms_status status = left && made->row ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the kinds of particles");
    for (size_t c = 0; c < sieve->count && status == MS_OK; c++) {
        left[c] = sieve->of[c].count;
    }
    for (size_t r = 0; r < manifest->count && status == MS_OK; r++) {
        status = spread_row(made, &manifest->row[r], sieve, left, left + sieve->count, err);
    }
    free(left);
    return status;
}

ms_status ms_sieve_apply(ms_manifest *made, ms_sieve *sieve, const ms_manifest *manifest, ms_error *err)
{
    uint64_t particles = 0;
    *made = (ms_manifest){0};
    for (size_t r = 0; r < manifest->count; r++) {
        const uint64_t room = UINT64_MAX - particles;
        particles += manifest->row[r].particles < room ? manifest->row[r].particles : room;
    }
    if (sieve->count == 0 || particles == 0) {
        return ms_fail(err, MS_ERR_ARG, "%s; there is nothing to give sizes to",
                       sieve->count == 0 ? "the sieve has no classes of size" : "the manifest has no particles");
    }
    if (particles > MS_MANIFEST_MAX_PARTICLES || manifest->count > MS_SIEVE_MAX_KINDS / sieve->count) {
        return ms_fail(
            err, MS_ERR_LIMIT,
            "%llu particles of %zu shapes in %zu sizes; with a sieve curve there are %d particles at most, and "
            "%d kinds of them",
            (unsigned long long)particles, manifest->count, sieve->count, MS_MANIFEST_MAX_PARTICLES,
            MS_SIEVE_MAX_KINDS);
    }
    ms_status status = count_classes(sieve, particles, err);
    if (status == MS_OK) {
        status = spread_rows(made, manifest, sieve, err);
    }
    if (status != MS_OK) {
        ms_manifest_free(made);
    }
    return status;
}

void ms_sieve_free(ms_sieve *sieve)
{
    free(sieve->of);
    *sieve = (ms_sieve){0};
}
