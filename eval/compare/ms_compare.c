#include "ms_compare.h"

#include <math.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_text.h"
#include "cli/ms_files.h"

#define COLUMN_NAME(code, name) [MS_COLUMN_##code] = (name),
static const char *const NAMES[] = {MS_COLUMN_LIST_BEFORE(COLUMN_NAME) MS_COLUMN_LIST_BEHIND(COLUMN_NAME)};
#undef COLUMN_NAME

static const char *name_column(int column)
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
        names.text[c] = name_column(c);
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

void ms_compare_name(char *out, size_t size, const char *shape, const char *label)
{
    size_t length;
    const char *stem = ms_files_stem(&length, shape);
    snprintf(out, size, "%.*s%s%s", (int)length, stem, label[0] ? "-" : "", label);
    ms_escape_file_name(out);
}
