#include "ms_escape.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The character that begins here, of 1 to 4 bytes; length 0 if the byte begins none (RFC 3629). */
typedef struct character {
    uint32_t code;
    size_t length;
} character;

static character read_character(const char *text)
{
    static const uint32_t LEAST[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *byte = (const unsigned char *)text;
    if (byte[0] < 0x80) {
        return (character){byte[0], 1};
    }
    const size_t length = byte[0] >= 0xf0 ? 4 : byte[0] >= 0xe0 ? 3 : 2;
    uint32_t code = byte[0] & (0xffu >> (length + 1));
    for (size_t k = 1; k < length; k++) {
        if ((byte[k] & 0xc0) != 0x80) {
            return (character){0, 0};
        }
        code = code << 6 | (byte[k] & 0x3fu);
    }
    const int valid = byte[0] >= 0xc0 && byte[0] < 0xf8 && code >= LEAST[length] && code <= 0x10ffff &&
                      !(code >= 0xd800 && code <= 0xdfff);
    return valid ? (character){code, length} : (character){0, 0};
}

/* Neither a byte that is no UTF-8 nor one that moves the cursor, ends a line or turns the direction of writing. */
static int is_printable(character c)
{
    return c.length > 0 && c.code >= ' ' && !(c.code >= 0x7f && c.code < 0xa0) &&
           !(c.code >= 0x2028 && c.code <= 0x202e) && !(c.code >= 0x2066 && c.code <= 0x2069);
}

/* Beyond ASCII: letters of any script, and no blanks, modifiers, punctuation or signs, some of which look like those of
 * ASCII. */
static int is_foreign_letter(character c)
{
    return c.code > 0xa0 && !(c.code >= 0x2b0 && c.code < 0x370) && !(c.code >= 0x2000 && c.code < 0x2c00) &&
           !(c.code >= 0x3000 && c.code < 0x3040) && !(c.code >= 0xfe00 && c.code < 0x10000) && c.code < 0xe0000;
}

static int is_plain(character c)
{
    const int is_letter = (c.code >= 'a' && c.code <= 'z') || (c.code >= 'A' && c.code <= 'Z');
    const int is_sign = c.code > 0 && c.code < 0x80 && strchr("0123456789._-+,=@/", (int)c.code) != NULL;
    return c.length > 0 && (is_letter || is_sign || is_foreign_letter(c));
}

/* Writes what is allowed as it is, and for each other character or byte the substitute. */
static void put_allowed(FILE *stream, const char *text, int (*is_allowed)(character c), char substitute)
{
    while (*text) {
        const character c = read_character(text);
        if (is_allowed(c)) {
            fwrite(text, 1, c.length, stream);
        } else {
            putc(substitute, stream);
        }
        text += c.length ? c.length : 1;
    }
}

void ms_escape_comment(FILE *stream, const char *text)
{
    put_allowed(stream, text, is_plain, '?');
}

void ms_escape_name(FILE *stream, const char *text)
{
    put_allowed(stream, text, is_plain, '_');
}

static int is_plain_of_gnuplot(character c)
{
    return (is_plain(c) && c.code != '@') || (c.code > 0 && c.code < 0x80 && strchr(" ()|:", (int)c.code));
}

static int is_all_plain(const char *text)
{
    while (*text) {
        const character c = read_character(text);
        if (!is_plain_of_gnuplot(c)) {
            return 0;
        }
        text += c.length;
    }
    return 1;
}

static void put_gnuplot(FILE *stream, const char *text)
{
    while (*text) {
        const character c = read_character(text);
        if (!is_printable(c)) {
            putc('?', stream);
        } else if (is_plain_of_gnuplot(c) || c.code >= 0x80) {
            fwrite(text, 1, c.length, stream);
        } else {
            fprintf(stream, "\\%03o", (unsigned)c.code);
        }
        text += c.length ? c.length : 1;
    }
}

/* Single quotes will not do for all: gnuplot 5.4 takes a doubled one in front for the end of the string. */
void ms_escape_gnuplot(FILE *stream, const char *text)
{
    const char quote = is_all_plain(text) ? '\'' : '"';
    putc(quote, stream);
    put_gnuplot(stream, text);
    putc(quote, stream);
}

/* Names that begin with a sign can be pipes, arrays or functions. */
void ms_escape_gnuplot_file(FILE *stream, const char *name, const char *ending)
{
    const char quote = is_all_plain(name) ? '\'' : '"';
    fprintf(stream, "%c./", quote);
    put_gnuplot(stream, name);
    put_gnuplot(stream, ending);
    putc(quote, stream);
}

static int is_datum(character c)
{
    return is_printable(c) && c.code != '"' && c.code != '\\';
}

void ms_escape_gnuplot_data(FILE *stream, const char *text)
{
    putc('"', stream);
    put_allowed(stream, text, is_datum, '?');
    putc('"', stream);
}

/* Python keeps a byte that is no UTF-8 as U+DC00 and the byte. */
void ms_escape_python(FILE *stream, const char *text)
{
    putc('\'', stream);
    while (*text) {
        const character c = read_character(text);
        if (c.length == 1 && c.code >= ' ' && c.code < 0x7f) {
            fprintf(stream, c.code == '\'' || c.code == '\\' ? "\\%c" : "%c", (char)c.code);
        } else if (c.length > 0) {
            fprintf(stream, "\\U%08lx", (unsigned long)c.code);
        } else {
            fprintf(stream, "\\udc%02x", (unsigned)(unsigned char)*text);
        }
        text += c.length ? c.length : 1;
    }
    putc('\'', stream);
}

void ms_escape_lammps(FILE *stream, const char *text)
{
    const char quote = strchr(text, '"') ? '\'' : '"';
    fprintf(stream, "%c%s%c", quote, text, quote);
}

/* Is each character allowed, and one kind of quotes free? */
static int fits_quotes(const char *text, int (*is_allowed)(character c))
{
    int fits = !(strchr(text, '"') && strchr(text, '\''));
    while (*text && fits) {
        const character c = read_character(text);
        fits = is_allowed(c);
        text += c.length;
    }
    return fits;
}

int ms_escape_fits_liggghts(const char *text)
{
    return fits_quotes(text, is_printable);
}

/* LAMMPS replaces or breaks what is beyond it. */
static int is_ascii(character c)
{
    return is_printable(c) && c.code < 0x80;
}

int ms_escape_fits_lammps(const char *text)
{
    return fits_quotes(text, is_ascii);
}

/* Does a spreadsheet take it for a formula? */
static int is_formula(const char *text)
{
    return *text && strchr("=+-@", *text);
}

/* One character in double quotes, which doubled stand for themselves. */
static size_t put_doubling(FILE *stream, const char *text)
{
    const character c = read_character(text);
    if (*text == '"') {
        putc('"', stream);
    }
    if (is_printable(c)) {
        fwrite(text, 1, c.length, stream);
    } else {
        putc('?', stream);
    }
    return c.length ? c.length : 1;
}

static void put_field(FILE *stream, const char *before, const char *text)
{
    const int is_quoted = strpbrk(text, ",\" ") != NULL;
    fputs(is_quoted ? "\"" : "", stream);
    fputs(before, stream);
    while (*text) {
        text += put_doubling(stream, text);
    }
    fputs(is_quoted ? "\"" : "", stream);
}

void ms_escape_csv(FILE *stream, const char *text)
{
    put_field(stream, is_formula(text) ? "'" : "", text);
}

void ms_escape_csv_path(FILE *stream, const char *text)
{
    put_field(stream, is_formula(text) ? "./" : "", text);
}

void ms_escape_html(FILE *stream, const char *text)
{
    while (*text) {
        const character c = read_character(text);
        if (!is_printable(c)) {
            putc('?', stream);
        } else if (c.code < 0x80 && strchr("<>&\"'`", (int)c.code)) {
            fprintf(stream, "&#%u;", (unsigned)c.code);
        } else {
            fwrite(text, 1, c.length, stream);
        }
        text += c.length ? c.length : 1;
    }
}

void ms_escape_html_json(FILE *stream, const char *json)
{
    for (; *json; json++) {
        if (strchr("<>&", *json)) {
            fprintf(stream, "\\u%04x", (unsigned)*json);
        } else {
            putc(*json, stream);
        }
    }
}

/* What no shell minds, and what does not end its quotes. */
static int is_bare(const char *text)
{
    int bare = *text != '\0';
    while (*text && bare) {
        const character c = read_character(text);
        bare = is_plain(c) && c.code < 0x80;
        text += c.length;
    }
    return bare;
}

void ms_escape_shell(FILE *stream, const char *text)
{
    const char *quote = is_bare(text) ? "" : "'";
    fputs(quote, stream);
    while (*text) {
        const character c = read_character(text);
        if (*text == '\'') {
            fputs("'\\''", stream);
        } else if (is_printable(c)) {
            fwrite(text, 1, c.length, stream);
        } else {
            putc('?', stream);
        }
        text += c.length ? c.length : 1;
    }
    fputs(quote, stream);
}

char *ms_escape_utf8(const char *text)
{
    char *copy = strdup(text);
    for (char *at = copy; at && *at;) {
        const character c = read_character(at);
        if (c.length == 0) {
            *at = '?';
        }
        at += c.length ? c.length : 1;
    }
    return copy;
}

static int is_of_file_name(character c)
{
    return is_printable(c) && (c.code < 0x80 ? !strchr("\"$`\\<>|*?:/", (int)c.code) : is_foreign_letter(c));
}

static void substitute(char *name, int (*is_allowed)(character c))
{
    char *to = name;
    while (*name) {
        const character c = read_character(name);
        if (is_allowed(c)) {
            memmove(to, name, c.length);
            to += c.length;
        } else {
            *to++ = '_';
        }
        name += c.length ? c.length : 1;
    }
    *to = '\0';
}

void ms_escape_file_name(char *name)
{
    substitute(name, is_of_file_name);
}

static int is_of_script(character c)
{
    return is_ascii(c) && is_of_file_name(c);
}

void ms_escape_script_name(char *name)
{
    substitute(name, is_of_script);
}
