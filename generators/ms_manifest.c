#include "ms_manifest.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_choice.h"
#include "base/ms_text.h"

enum { SHAPE, COUNT, TOLERANCE, SIZE, COLUMNS };

/* Which column stands where. */
typedef struct manifest_header {
    int count, column[COLUMNS];
} manifest_header;

/* Shape and count, then what is asked for of the rest, each once, in any order. */
static int know_header(manifest_header *header, const ms_word field[COLUMNS])
{
    static const char *const NAMES[COLUMNS] = {"shape", "count", "tolerance", "size"};
    int seen[COLUMNS] = {0};
    for (int c = 0; c < header->count; c++) {
        int name = 0;
        while (name < COLUMNS && !ms_text_word_is(&field[c], NAMES[name])) {
            name++;
        }
        if (name == COLUMNS || seen[name] || (c <= COUNT && name != c)) {
            return 0;
        }
        seen[name] = 1;
        header->column[c] = name;
    }
    return 1;
}

static ms_status read_manifest_header(manifest_header *header, ms_text *text, ms_error *err)
{
    ms_word field[COLUMNS] = {{0}};
    if (!ms_text_seek(text)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: the manifest is empty; its first line is shape,count", text->name);
    }
    const ms_word line = ms_text_rest(text);
    header->count = ms_text_split(field, COLUMNS, &line);
    return header->count >= 2 && header->count <= COLUMNS && know_header(header, field)
               ? MS_OK
               : ms_text_fail(err, text, "the header is '%s', not shape,count with tolerance, size or both behind it",
                              ms_text_quote(&line).text);
}

/* Sizes are alike, or there is none. */
static int is_same_size(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static ms_status check_row(const ms_manifest *manifest, const ms_manifest_row *row, const ms_text *text, ms_error *err)
{
    const char *path = row->path;
    for (const ms_manifest_row *before = manifest->row; before < row; before++) {
        if (strcmp(before->path, path) == 0 && is_same_size(before->size, row->size)) {
            return ms_text_fail(err, text, "%.180s stands twice%s; add up the counts", path,
                                isnan(row->size) ? "" : " in this size");
        }
    }
    if (ms_file_is_standard(path)) {
        return ms_text_fail(err, text, "a manifest names files and not standard input");
    }
    if (access(path, R_OK) == 0) {
        return MS_OK;
    }
    const int why = errno;
    return ms_text_fail(err, text, "%.180s cannot be read: %s%s", path, strerror(why),
                        why == ENOENT ? ms_choice_file_hint(path).text : "");
}

static ms_status read_count(uint64_t *particles, const ms_word *word, const ms_text *text, ms_error *err)
{
    int64_t count;
    if (!ms_text_to_integer(&count, word) || count < 1 || count > MS_MANIFEST_MAX_PARTICLES) {
        return ms_text_fail(err, text, "the count '%s' is not a whole number from 1 to %d", ms_text_quote(word).text,
                            MS_MANIFEST_MAX_PARTICLES);
    }
    *particles = (uint64_t)count;
    return MS_OK;
}

static ms_status read_tolerance(double *tolerance, const ms_word *word, const ms_text *text, ms_error *err)
{
    *tolerance = (double)NAN;
    if (word->length > 0 && (!ms_text_to_double(tolerance, word) || !(*tolerance >= 0 && *tolerance <= 1))) {
        return ms_text_fail(err, text, "the tolerance '%s' is not a number from 0 to 1", ms_text_quote(word).text);
    }
    return MS_OK;
}

static ms_status read_size(double *size, const ms_word *word, const ms_text *text, ms_error *err)
{
    *size = (double)NAN;
    if (word->length > 0 &&
        (!ms_text_to_double(size, word) || !(*size >= MS_MANIFEST_LEAST_SIZE && *size <= MS_MANIFEST_MOST_SIZE))) {
        return ms_text_fail(err, text, "the size '%s' is not a number from %g to %g", ms_text_quote(word).text,
                            MS_MANIFEST_LEAST_SIZE, MS_MANIFEST_MOST_SIZE);
    }
    return MS_OK;
}

/* What stands behind the shape. */
static ms_status read_numbers(ms_manifest_row *row, const ms_word field[COLUMNS], const ms_text *text, ms_error *err)
{
    ms_status status = read_count(&row->particles, &field[COUNT], text, err);
    if (status == MS_OK) {
        status = read_tolerance(&row->tolerance, &field[TOLERANCE], text, err);
    }
    return status == MS_OK ? read_size(&row->size, &field[SIZE], text, err) : status;
}

/* Adds a row; on failure what it holds is freed with the manifest. */
static ms_status read_manifest_row(ms_manifest *manifest, const manifest_header *header, ms_text *text, ms_error *err)
{
    ms_word field[COLUMNS] = {{0}}, by_name[COLUMNS] = {{0}};
    const ms_word line = ms_text_rest(text);
    const int fields = ms_text_split(field, COLUMNS, &line), columns = header->count;
    if (memchr(line.start, '"', line.length)) {
        return ms_text_fail(err, text, "a quotation mark; names with commas or quotation marks are not taken");
    }
    if (fields != columns || field[SHAPE].length == 0) {
        return ms_text_fail(err, text, "'%s' is not a shape and %d more columns, as the header says",
                            ms_text_quote(&line).text, columns - 1);
    }
    if (manifest->count == MS_MANIFEST_MAX_SHAPES) {
        return ms_text_fail(err, text, "more than %d shapes", MS_MANIFEST_MAX_SHAPES);
    }
    for (int c = 0; c < columns; c++) {
        by_name[header->column[c]] = field[c];
    }
    ms_manifest_row *row = &manifest->row[manifest->count];
    row->path = ms_file_beside(text->name, field[SHAPE].start, field[SHAPE].length);
    if (!row->path) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu shapes", manifest->count + 1);
    }
    manifest->count++;
    const ms_status status = read_numbers(row, by_name, text, err);
    return status == MS_OK ? check_row(manifest, row, text, err) : status;
}

static ms_status parse(ms_manifest *manifest, const ms_bytes *bytes, const char *path, ms_error *err)
{
    ms_text text;
    manifest_header header = {0};
    if (memchr(bytes->data, 0, bytes->size)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: this is not a text file shape,count", path);
    }
    ms_text_start(&text, bytes, path);
    text.comment = '#';
    ms_status status = read_manifest_header(&header, &text, err);
    while (status == MS_OK && ms_text_seek(&text)) {
        status = read_manifest_row(manifest, &header, &text, err);
    }
    if (status == MS_OK && manifest->count == 0) {
        status = ms_fail(err, MS_ERR_FORMAT, "%s: no shape stands below the header", path);
    }
    return status;
}

ms_status ms_manifest_read(ms_manifest *manifest, const char *path, ms_error *err)
{
    ms_bytes bytes;
    *manifest = (ms_manifest){.row = calloc(MS_MANIFEST_MAX_SHAPES, sizeof *manifest->row)};
    ms_status status =
        manifest->row ? ms_file_read(&bytes, path, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for the manifest");
    if (status == MS_OK) {
        status = parse(manifest, &bytes, path, err);
        ms_file_free(&bytes);
    }
    if (status != MS_OK) {
        ms_manifest_free(manifest);
    }
    return status;
}

ms_status ms_manifest_of_shape(ms_manifest *manifest, const char *shape, uint64_t particles, ms_error *err)
{
    *manifest = (ms_manifest){.row = calloc(1, sizeof *manifest->row), .count = 1};
    char *path = strdup(shape);
    if (!manifest->row || !path) {
        free(path);
        free(manifest->row);
        *manifest = (ms_manifest){0};
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the shape %s", shape);
    }
    manifest->row[0] = (ms_manifest_row){path, particles, (double)NAN, (double)NAN};
    return MS_OK;
}

ms_manifest_name ms_manifest_name_row(const ms_manifest_row *row)
{
    ms_manifest_name name;
    const int length = snprintf(name.text, sizeof name.text, "%.460s", row->path);
    if (!isnan(row->size)) {
        snprintf(name.text + length, sizeof name.text - (size_t)length, ", size %g", row->size);
    }
    return name;
}

size_t ms_manifest_first(const ms_manifest *manifest, size_t row)
{
    size_t first = 0;
    while (first < row && strcmp(manifest->row[first].path, manifest->row[row].path) != 0) {
        first++;
    }
    return first;
}

int ms_manifest_has_sizes(const ms_manifest *manifest)
{
    int has = 0;
    for (size_t r = 0; r < manifest->count; r++) {
        has |= !isnan(manifest->row[r].size);
    }
    return has;
}

void ms_manifest_free(ms_manifest *manifest)
{
    for (size_t r = 0; r < manifest->count; r++) {
        free(manifest->row[r].path);
    }
    free(manifest->row);
    *manifest = (ms_manifest){0};
}
