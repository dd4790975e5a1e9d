/** A CSV file that grows row by row, so that a run that is killed can be taken up again. */
#ifndef MS_CSV_H
#define MS_CSV_H

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/ms_error.h"

/** An open file. Rows are text without the end of the line. */
typedef struct ms_csv {
    const char *path; /* borrowed */
    int fd;
    off_t size;
    size_t n_rows;
    char **row; /* those that were there and those added; without the header */
} ms_csv;

/**
 * Makes the file with its header, or takes up one that is there: what stands behind its last whole line is cut off.
 * Until it is closed, another run that opens it fails.
 *
 * @param[out] csv    closed by ms_csv_close in any case
 * @param      path   a regular file; borrowed
 * @param      header first line; columns separated by commas, none quoted
 * @param      resume nonzero: the file may exist already
 * @return MS_OK; MS_ERR_IO, also where its file system knows no locks; MS_ERR_FORMAT if the file has another header, or
 *         rows of other lengths; MS_ERR_NOMEM
 */
ms_status ms_csv_open(ms_csv *csv, const char *path, const char *header, int resume, ms_error *err);

/**
 * Reads the rows of a file that is finished or at rest; it is not touched, and closed already.
 *
 * @param[out] csv its rows; ms_csv_close in any case
 * @return as ms_csv_open; MS_ERR_IO for a file that another run is writing
 */
ms_status ms_csv_read(ms_csv *csv, const char *path, const char *header, ms_error *err);

/** Adds a row; it is on the disk then. On failure the rows before it stand. @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM */
ms_status ms_csv_add(ms_csv *csv, const char *row, ms_error *err);

void ms_csv_close(ms_csv *csv);

/**
 * Cuts a row into its fields, in place, and takes the quotes off.
 * @return how many there are, even if that is more than `most`; 0 if a quote is not closed
 */
size_t ms_csv_split(char **field, size_t most, char *row);

/** A comma and the number; nothing behind the comma if it is not finite. */
void ms_csv_put_number(FILE *stream, double value);

/** What a field holds; NAN where it is empty or no number. */
double ms_csv_number(const char *field);

#endif
