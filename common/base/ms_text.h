/** Scans text formats: words, numbers and line numbers. Private to the readers. */
#ifndef MS_TEXT_H
#define MS_TEXT_H

#include "ms_file.h"

/** Where a scan stands. */
typedef struct ms_text {
    const char *at;
    const char *end;  /* a 0 byte stands here */
    const char *name; /* of the file, for messages */
    size_t line;      /* of `at`, from 1 */
    char comment;     /* begins a comment up to the end of the line; 0 for none */
    int joins_lines;  /* a backslash at the end of a line joins it to the next */
} ms_text;

/** A run of characters without blanks; borrowed from the text. */
typedef struct ms_word {
    const char *start;
    size_t length;
} ms_word;

/** A printable copy of a word for messages, shortened. */
typedef struct ms_quote {
    char text[40];
} ms_quote;

/** Begins at the first byte, behind a byte order mark if there is one. The bytes are borrowed. */
void ms_text_start(ms_text *text, const ms_bytes *bytes, const char *name);

/** The next word of this line. @return 0 if there is none, and the scan stays on the line */
int ms_text_word(ms_word *word, ms_text *text);

/** Moves to the next word, over ends of lines. @return 0 at the end of the text */
int ms_text_seek(ms_text *text);

/** Moves to the end of the line, over what is left of it. */
void ms_text_skip_line(ms_text *text);

/** What is left of this line, without the blanks around it; comments and joints are not looked for. */
ms_word ms_text_rest(ms_text *text);

/** Cuts a line at its commas, without the blanks around each field. @return how many fields there are, of which the
 * first `most` are kept */
int ms_text_split(ms_word *field, int most, const ms_word *line);

/** Reads n numbers that stand on this line; `what` names them in the message. @return MS_OK; MS_ERR_FORMAT */
ms_status ms_text_doubles(double *values, size_t n, ms_text *text, const char *what, ms_error *err);

/** @return MS_OK if no word is left on this line; MS_ERR_FORMAT */
ms_status ms_text_end_line(ms_text *text, ms_error *err);

/** Writes "file: line n: ...; what to do". @return MS_ERR_FORMAT */
ms_status ms_text_fail(ms_error *err, const ms_text *text, const char *format, ...) MS_PRINTF(3, 4);

/** Nonzero if the word is `lower`, whatever its case. */
int ms_text_word_is(const ms_word *word, const char *lower);
ms_quote ms_text_quote(const ms_word *word);

/**
 * A decimal number as C writes it in the "C" locale, correctly rounded, whatever locale is
 * set; inf and nan are numbers, hexadecimal ones are not. The word is the whole number.
 * @return 0 if it is not one
 */
int ms_text_to_double(double *value, const ms_word *word);

/** A number as text. */
typedef struct ms_number {
    char text[32];
} ms_number;

/** The shortest of 15 to 17 digits that restores the double, with a point whatever the locale. */
ms_number ms_text_of_number(double value);

/** An integer with an optional sign, of at most 18 digits. @return 0 if it is not one */
int ms_text_to_integer(int64_t *value, const ms_word *word);

#endif
