#include "ms_compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_text.h"
#include "cli/ms_files.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"

#define COLUMN_NAME(code, name) [MS_COLUMN_##code] = (name),
static const char *const NAMES[] = {MS_COLUMN_LIST_BEFORE(COLUMN_NAME) MS_COLUMN_LIST_BEHIND(COLUMN_NAME)};
#undef COLUMN_NAME

const char *ms_compare_column(int column)
{
    if (NAMES[column]) {
        return NAMES[column];
    }
    const ms_measure *measure = &ms_measures[column - MS_COLUMN_MEASURES];
    return ms_measure_column(measure, measure->in_compare);
}

ms_compare_row ms_compare_empty(void)
{
    ms_compare_row row;
    for (int c = 0; c < MS_COLUMNS; c++) {
        row.text[c] = NULL;
        row.number[c] = (double)NAN;
    }
    return row;
}

/* Options begin with a letter; those of a clump are its file. */
static int is_path(int column)
{
    return column == MS_COLUMN_SHAPE || column == MS_COLUMN_OPTIONS;
}

/* The first fields of a row, a comma behind each but the last of all. */
static char *make_text(const ms_compare_row *row, int columns)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    for (int c = 0; c < columns; c++) {
        if (row->text[c]) {
            (is_path(c) ? ms_escape_csv_path : ms_escape_csv)(stream, row->text[c]);
        } else if (isfinite(row->number[c])) {
            fputs(ms_text_of_number(row->number[c]).text, stream);
        }
        if (c < MS_COLUMNS - 1) {
            putc(',', stream);
        }
    }
    return fclose(stream) == 0 ? text : NULL;
}

char *ms_compare_header(void)
{
    ms_compare_row names;
    for (int c = 0; c < MS_COLUMNS; c++) {
        names.text[c] = ms_compare_column(c);
    }
    return make_text(&names, MS_COLUMNS);
}

char *ms_compare_line(const ms_compare_row *row)
{
    return make_text(row, MS_COLUMNS);
}

char *ms_compare_key(const ms_compare_row *row)
{
    return make_text(row, MS_COLUMN_SPHERES);
}

static int is_text(int column)
{
    static const int TEXTS[] = {MS_COLUMN_SHAPE,   MS_COLUMN_CHECKSUM, MS_COLUMN_GENERATOR,
                                MS_COLUMN_OPTIONS, MS_COLUMN_FLAGS,    MS_COLUMN_STOPPED,
                                MS_COLUMN_MACHINE, MS_COLUMN_VERSION,  MS_COLUMN_CAUSE};
    for (size_t t = 0; t < sizeof TEXTS / sizeof *TEXTS; t++) {
        if (TEXTS[t] == column) {
            return 1;
        }
    }
    return 0;
}

static json_t *field_json(int column, const char *field)
{
    const ms_word word = {field, strlen(field)};
    int64_t whole;
    double number;
    if (word.length == 0) {
        return json_null();
    }
    if (!is_text(column) && ms_text_to_integer(&whole, &word)) {
        return json_integer((json_int_t)whole);
    }
    if (!is_text(column) && ms_text_to_double(&number, &word)) {
        return ms_report_number(number);
    }
    return ms_report_text(field); /* of a number that someone has spoilt, too */
}

static json_t *row_json(const char *row)
{
    char *field[MS_COLUMNS], *copy = strdup(row);
    json_t *json = copy && ms_csv_split(field, MS_COLUMNS, copy) == MS_COLUMNS ? json_object() : NULL;
    for (int c = 0; c < MS_COLUMNS && json; c++) {
        ms_json_object_set(&json, ms_compare_column(c), field_json(c, field[c]));
    }
    free(copy);
    return json;
}

json_t *ms_compare_json(char *const *row, size_t count)
{
    json_t *list = json_array();
    for (size_t r = 0; r < count; r++) {
        ms_json_object_append(&list, row_json(row[r]));
    }
    return list;
}

void ms_compare_name(char *out, size_t size, const char *shape, const char *label)
{
    size_t length;
    const char *stem = ms_file_stem(&length, shape);
    snprintf(out, size, "%.*s%s%s", (int)length, stem, label[0] ? "-" : "", label);
    ms_escape_file_name(out);
}
