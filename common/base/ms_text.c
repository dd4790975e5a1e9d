#include "ms_text.h"

#include <stdarg.h>
#include <string.h>

void ms_text_start(ms_text *text, const ms_bytes *bytes, const char *name)
{
    const char *start = (const char *)bytes->data;
    *text = (ms_text){.at = start, .end = start + bytes->size, .name = name, .line = 1};
    if (bytes->size >= 3 && memcmp(start, "\xEF\xBB\xBF", 3) == 0) {
        text->at += 3;
    }
}

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* The length of a backslash with the end of line behind it, or 0. */
static size_t line_joint(const ms_text *text, const char *at)
{
    if (!text->joins_lines || *at != '\\') {
        return 0;
    }
    /* Reading one byte on is safe: a 0 byte stands at the end. */
    if (at[1] == '\n') {
        return 2;
    }
    return at[1] == '\r' && at[2] == '\n' ? 3 : 0;
}

static void skip_blanks(ms_text *text)
{
    const char *at = text->at;
    while (at < text->end) {
        size_t joint;
        if (is_blank(*at)) {
            at++;
        } else if (text->comment && *at == text->comment) {
            const char *newline = memchr(at, '\n', (size_t)(text->end - at));
            at = newline ? newline : text->end;
        } else if ((joint = line_joint(text, at)) > 0) {
            at += joint;
            text->line++;
        } else {
            break;
        }
    }
    text->at = at;
}

int ms_text_word(ms_word *word, ms_text *text)
{
    skip_blanks(text);
    const char *at = text->at;
    while (at < text->end && *at != '\n' && !is_blank(*at) && !line_joint(text, at)) {
        at++;
    }
    *word = (ms_word){text->at, (size_t)(at - text->at)};
    text->at = at;
    return word->length > 0;
}

int ms_text_seek(ms_text *text)
{
    for (;;) {
        skip_blanks(text);
        if (text->at == text->end) {
            return 0;
        }
        if (*text->at != '\n') {
            return 1;
        }
        text->at++;
        text->line++;
    }
}

void ms_text_skip_line(ms_text *text)
{
    ms_word word;
    while (ms_text_word(&word, text)) {
    }
}

/* Takes the blanks off both ends. */
static ms_word trim_blanks(const char *start, const char *stop)
{
    while (start < stop && is_blank(*start)) {
        start++;
    }
    while (stop > start && is_blank(stop[-1])) {
        stop--;
    }
    return (ms_word){start, (size_t)(stop - start)};
}

ms_word ms_text_rest(ms_text *text)
{
    const char *start = text->at;
    const char *newline = memchr(start, '\n', (size_t)(text->end - start));
    text->at = newline ? newline : text->end;
    return trim_blanks(start, text->at);
}

int ms_text_split(ms_word *field, int most, const ms_word *line)
{
    const char *at = line->start, *end = line->start + line->length;
    for (int fields = 0;; fields++) {
        const char *comma = memchr(at, ',', (size_t)(end - at));
        if (fields < most) {
            field[fields] = trim_blanks(at, comma ? comma : end);
        }
        if (!comma) {
            return fields + 1;
        }
        at = comma + 1;
    }
}

ms_status ms_text_doubles(double *values, size_t n, ms_text *text, const char *what, ms_error *err)
{
    for (size_t i = 0; i < n; i++) {
        ms_word word;
        if (!ms_text_word(&word, text)) {
            return ms_text_fail(err, text, "%s needs %zu numbers but the line has %zu", what, n, i);
        }
        if (!ms_text_to_double(&values[i], &word)) {
            return ms_text_fail(err, text, "%s has '%s' where a number belongs", what, ms_text_quote(&word).text);
        }
    }
    return MS_OK;
}

ms_status ms_text_end_line(ms_text *text, ms_error *err)
{
    ms_word word;
    if (ms_text_word(&word, text)) {
        return ms_text_fail(err, text, "'%s' stands where the line should end", ms_text_quote(&word).text);
    }
    return MS_OK;
}

ms_status ms_text_fail(ms_error *err, const ms_text *text, const char *format, ...)
{
    char detail[256];
    va_list args;
    va_start(args, format);
    vsnprintf(detail, sizeof detail, format, args);
    va_end(args);
    return ms_fail(err, MS_ERR_FORMAT, "%s: line %zu: %s; correct the line or export the file again", text->name,
                   text->line, detail);
}
