#include "ms_columns.h"

#include <string.h>

static int is_blank_or_quote(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '"';
}

static ms_word trim(const char *start, const char *end)
{
    while (start < end && is_blank_or_quote(*start)) {
        start++;
    }
    while (end > start && is_blank_or_quote(end[-1])) {
        end--;
    }
    return (ms_word){start, (size_t)(end - start)};
}

/* Does a mark stand anywhere in the line? If none does, blanks separate. */
static int has_mark(const ms_word *line, const char *marks)
{
    for (size_t c = 0; c < line->length; c++) {
        if (line->start[c] && strchr(marks, line->start[c])) {
            return 1;
        }
    }
    return 0;
}

size_t ms_columns_split(ms_word name[MS_COLUMNS_MOST], const ms_word *line, char mark)
{
    const char marks[] = {',', ';', mark, 0}, *at = line->start, *end = at + line->length;
    const int by_marks = has_mark(line, marks);
    size_t n = 0;
    while (at < end && n < MS_COLUMNS_MOST) {
        const char *start = at;
        while (at < end && !(*at && strchr(by_marks ? marks : " \t\r", *at))) {
            at++;
        }
        name[n] = trim(start, at);
        n += by_marks || name[n].length > 0;
        at++;
    }
    return n;
}

/* The name is `lower`, alone or before a unit: "radius [mm]". */
static int is_called(const ms_word *name, const char *lower)
{
    size_t length = 0;
    while (length < name->length && !strchr("([", name->start[length])) {
        length++;
    }
    const ms_word word = trim(name->start, name->start + length);
    return ms_text_word_is(&word, lower);
}

static int is_axis(const ms_word *name)
{
    return is_called(name, "x") || is_called(name, "y") || is_called(name, "z");
}

int ms_columns_name_axes(const ms_word *name, size_t n)
{
    size_t run = 0;
    for (size_t c = 0; c < n && run < 3; c++) {
        run = is_axis(&name[c]) ? run + 1 : 0;
    }
    return run == 3;
}

ms_status ms_columns_read(ms_columns *columns, const ms_word *name, size_t n, ms_error *cause)
{
    if (n < 4) {
        return MS_OK;
    }
    const int in_order = is_called(&name[0], "x") && is_called(&name[1], "y") && is_called(&name[2], "z");
    if (ms_columns_name_axes(name, n) && !in_order) {
        return ms_fail(cause, MS_ERR_FORMAT, "x, y, z stand in other columns; the first four must be x, y, z, r");
    }
    if (!is_called(&name[3], "r") && !is_called(&name[3], "rad") && !is_called(&name[3], "radius")) {
        return ms_fail(cause, MS_ERR_FORMAT,
                       "the fourth column is called '%s' and not r, rad or radius; give radii, or begin a line "
                       "that is no header with #",
                       ms_text_quote(&name[3]).text);
    }
    columns->mass |= n > 4 && ms_text_word_is(&name[4], "mass");
    for (size_t c = 4; c < n; c++) {
        if (ms_text_word_is(&name[c], "carrier")) { /* not to be taken for spheres that touch */
            if (c != 6 || !columns->mass) {
                return ms_fail(cause, MS_ERR_FORMAT, "a column 'carrier' must be the seventh, behind mass and density");
            }
            columns->carrier = 1;
        }
    }
    columns->clump |= n > 4 && ms_text_word_is(&name[4], "clumpid");
    return MS_OK;
}
