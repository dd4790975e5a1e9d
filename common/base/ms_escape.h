/** Text from outside (names of files, labels, options, messages) made safe for the language of the file into which it
 * is written: there it is data, never code. Who writes such text into a file calls one of these; docs/formats.md says
 * what a reader finds. */
#ifndef MS_ESCAPE_H
#define MS_ESCAPE_H

#include <stdio.h>

/**
 * Part of a comment of one line, in whatever language: but for letters, digits and ._-+,=@/ each character becomes '?',
 * for which a shell takes any.
 */
void ms_escape_comment(FILE *stream, const char *text);

/** A word that is a name in an engine's file and of no other use (PFC, Kratos): as in a comment, but '_'. */
void ms_escape_name(FILE *stream, const char *text);

/** A string of gnuplot, in double quotes where it has to be; what means anything there stands as its octal number.
 * Control characters and bytes that are no UTF-8 become '?'. Markup of text remains: what draws it says noenhanced. */
void ms_escape_gnuplot(FILE *stream, const char *text);

/** The same of the name of a file in the folder of the script, and what stands behind it. */
void ms_escape_gnuplot_file(FILE *stream, const char *name, const char *ending);

/** A string in a data file of gnuplot, in double quotes; which it cannot hold, nor a backslash: '?', too. */
void ms_escape_gnuplot_data(FILE *stream, const char *text);

/** A string of Python 3 in single quotes, ASCII; as a path it is that of the bytes, UTF-8 or not. */
void ms_escape_python(FILE *stream, const char *text);

/** A word of a script of LAMMPS or LIGGGHTS, in quotes. The text is one that fits. */
void ms_escape_lammps(FILE *stream, const char *text);

/** Zero if no quotes of such a script can hold it: control characters, both kinds of quotes, bytes that are no UTF-8;
 * of LAMMPS, which replaces or breaks it, whatever is beyond ASCII, too. */
int ms_escape_fits_lammps(const char *text);
int ms_escape_fits_liggghts(const char *text);

/** A field of CSV, in quotes where it has to be. One that a spreadsheet would take for a formula gets an apostrophe in
 * front; control characters, ends of lines among them, and bytes that are no UTF-8 become '?'. */
void ms_escape_csv(FILE *stream, const char *text);

/** The same of a path: "./" instead of the apostrophe, so that it still names the file. */
void ms_escape_csv_path(FILE *stream, const char *text);

/** Text of HTML, in an element or within the quotes of an attribute; control characters and bytes that are no UTF-8
 * become '?'. */
void ms_escape_html(FILE *stream, const char *text);

/** JSON, whole and ASCII, within an HTML script element: what could end the element or begin a comment in it stands as
 * its number, which JSON takes in strings, where alone such signs are. */
void ms_escape_html_json(FILE *stream, const char *json);

/** A word of a POSIX shell, in single quotes where it has to be; no control characters: '?'. */
void ms_escape_shell(FILE *stream, const char *text);

/** For JSON: a copy in which bytes that are no UTF-8 are '?'. The caller frees it; NULL without memory. */
char *ms_escape_utf8(const char *text);

/** In place, the name of a file that is made from another: what is no UTF-8, control characters, what Windows forbids
 * and what a shell minds within quotes become '_', and so does punctuation beyond ASCII. */
void ms_escape_file_name(char *name);

/** The same, and it also ms_escape_fits_lammps. */
void ms_escape_script_name(char *name);

#endif
