#include "ms_grain_manifest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_text.h"
#include "chart/ms_csv.h"

/* What a column is. */
typedef enum manifest_column { COLUMN_SHAPE, COLUMN_LABEL, COLUMN_PASSED_OVER, COLUMN_FLAG } manifest_column;

typedef struct manifest_reader {
    const char *path;
    size_t line, columns;
    char *name[MS_GRAIN_MANIFEST_COLUMNS];
    manifest_column column[MS_GRAIN_MANIFEST_COLUMNS];
} manifest_reader;

static manifest_column know_column(const char *name)
{
    if (strcmp(name, "shape") == 0) {
        return COLUMN_SHAPE;
    }
    if (strcmp(name, "label") == 0) {
        return COLUMN_LABEL;
    }
    return strcmp(name, "count") == 0 || strcmp(name, "tolerance") == 0 ? COLUMN_PASSED_OVER : COLUMN_FLAG;
}

/* Takes the blanks off both ends, in place. */
static char *trim(char *field)
{
    field += strspn(field, " \t");
    for (size_t n = strlen(field); n > 0 && strchr(" \t\r", field[n - 1]); n--) {
        field[n - 1] = '\0';
    }
    return field;
}

static ms_status read_header(manifest_reader *m, char *line, ms_error *err)
{
    int has_shape = 0;
    m->columns = ms_csv_split(m->name, MS_GRAIN_MANIFEST_COLUMNS, line);
    if (m->columns == 0 || m->columns > MS_GRAIN_MANIFEST_COLUMNS) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: line %zu is no header of 1 to %d columns", m->path, m->line,
                       MS_GRAIN_MANIFEST_COLUMNS);
    }
    for (size_t c = 0; c < m->columns; c++) {
        m->name[c] = trim(m->name[c]);
        m->column[c] = know_column(m->name[c]);
        has_shape |= m->column[c] == COLUMN_SHAPE;
    }
    return has_shape ? MS_OK
                     : ms_fail(err, MS_ERR_FORMAT,
                               "%s: line %zu: no column is called shape; the header names the columns, as "
                               "shape,label,spheres",
                               m->path, m->line);
}

static ms_status read_label(uint32_t *label, const manifest_reader *m, const char *text, ms_error *err)
{
    int64_t value;
    const ms_word word = {text, strlen(text)};
    *label = 0;
    if (word.length == 0) {
        return MS_OK;
    }
    if (!ms_text_to_integer(&value, &word) || value < 1 || value > UINT32_MAX) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: line %zu: the label '%.40s' is no whole number from 1 to %lu", m->path,
                       m->line, text, (unsigned long)UINT32_MAX);
    }
    *label = (uint32_t)value;
    return MS_OK;
}

/* The fields of a row; its path is still that of the file. */
static ms_status read_fields(ms_grain_manifest_row *row, const manifest_reader *m, char **field, ms_error *err)
{
    ms_status status = MS_OK;
    *row = (ms_grain_manifest_row){.line = m->line, .name = m->path};
    for (size_t c = 0; c < m->columns && status == MS_OK; c++) {
        const char *text = trim(field[c]);
        if (m->column[c] == COLUMN_SHAPE) {
            row->path = text;
        } else if (m->column[c] == COLUMN_LABEL) {
            status = read_label(&row->label, m, text, err);
        } else if (m->column[c] == COLUMN_FLAG && text[0]) {
            row->flag[row->n_flags] = m->name[c];
            row->value[row->n_flags++] = text;
        }
    }
    if (status == MS_OK && !row->path[0]) {
        status = ms_fail(err, MS_ERR_FORMAT, "%s: line %zu names no shape", m->path, m->line);
    }
    return status;
}

static ms_status read_row(const manifest_reader *m, char *line,
                          ms_status (*take)(void *context, const ms_grain_manifest_row *row, ms_error *err),
                          void *context, ms_error *err)
{
    char *field[MS_GRAIN_MANIFEST_COLUMNS];
    ms_grain_manifest_row row;
    if (ms_csv_split(field, MS_GRAIN_MANIFEST_COLUMNS, line) != m->columns) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: line %zu has not the %zu fields of the header", m->path, m->line,
                       m->columns);
    }
    ms_status status = read_fields(&row, m, field, err);
    if (status != MS_OK) {
        return status;
    }
    char *path = ms_file_beside(m->path, row.path, strlen(row.path));
    row.path = path;
    status = path ? take(context, &row, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for the rows of %s", m->path);
    free(path);
    return status;
}

static ms_status read_lines(manifest_reader *m, char *text,
                            ms_status (*take)(void *context, const ms_grain_manifest_row *row, ms_error *err),
                            void *context, ms_error *err)
{
    ms_status status = MS_OK;
    size_t rows = 0;
    for (char *line = text, *next; line && status == MS_OK; line = next) {
        next = strchr(line, '\n');
        if (next) {
            *next++ = '\0';
        }
        m->line++;
        char *start = trim(line);
        if (*start == '\0' || *start == '#') {
            continue;
        }
        status = m->columns ? read_row(m, start, take, context, err) : read_header(m, start, err);
        rows++;
    }
    return status == MS_OK && rows < 2 ? ms_fail(err, MS_ERR_FORMAT, "%s: no shape stands below a header", m->path)
                                       : status;
}

ms_status ms_grain_manifest_read(char **text, const char *path,
                                 ms_status (*take)(void *context, const ms_grain_manifest_row *row, ms_error *err),
                                 void *context, ms_error *err)
{
    static const char MARK[] = "\xEF\xBB\xBF"; /* of byte order */
    manifest_reader m = {.path = path};
    ms_bytes bytes;
    *text = NULL;
    const ms_status status = ms_file_read(&bytes, path, err);
    if (status != MS_OK) {
        return status;
    }
    if (memchr(bytes.data, 0, bytes.size)) {
        ms_file_free(&bytes);
        return ms_fail(err, MS_ERR_FORMAT, "%s: this is no text file with a header like shape,label", path);
    }
    *text = (char *)bytes.data; /* a 0 byte stands behind it */
    return read_lines(&m, *text + (strncmp(*text, MARK, 3) == 0 ? 3 : 0), take, context, err);
}

ms_status ms_grain_manifest_apply(ms_grain_how *how, const ms_grain_how *all, const ms_grain_manifest_row *row,
                                  ms_error *err)
{
    ms_error cause;
    ms_status status = MS_OK;
    *how = *all;
    how->recipe.generator = NULL; /* what follows from the wishes follows anew */
    memset(&how->recipe.settings, 0, sizeof how->recipe.settings);
    for (size_t f = 0; f < row->n_flags && status == MS_OK; f++) {
        int taken = 0;
        status = ms_grain_how_flag(&taken, how, row->flag[f], row->value[f], &cause);
        ms_grain_how_note(how, row->flag[f], row->value[f]);
        if (!taken) {
            status = ms_fail(&cause, MS_ERR_ARG, "there is no flag --%.40s for the column of that name", row->flag[f]);
        }
    }
    status = status == MS_OK ? ms_grain_how_resolve(how, &cause) : status;
    return status == MS_OK ? MS_OK
                           : ms_fail(err, status == MS_ERR_NOMEM ? status : MS_ERR_FORMAT, "%s: line %zu: %s",
                                     row->name, row->line, cause.text);
}
