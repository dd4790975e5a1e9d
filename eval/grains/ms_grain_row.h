/** The rows of grains.csv: one for each grain. */
#ifndef MS_GRAIN_ROW_H
#define MS_GRAIN_ROW_H

#include <stdio.h>

#include "cli/ms_record.h"
#include "ms_grain_list.h"

/** How it went with a grain. */
#define MS_GRAIN_STATUS_LIST(X)               \
    X(OK, "ok")                               \
    X(LEFT_OUT, "left-out") /* by a filter */ \
    X(FAILED, "failed")     /* no clump, or one that is not written */

#define MS_GRAIN_ENUM(code, name) MS_GRAIN_##code,
typedef enum ms_grain_status { MS_GRAIN_STATUS_LIST(MS_GRAIN_ENUM) MS_GRAIN_STATUSES } ms_grain_status;
#undef MS_GRAIN_ENUM

/** Where a grain is: the frame of its template in that of its source. NAN where it is not known. */
typedef struct ms_grain_place {
    double mass, moment[3]; /* of the template, SI; NAN without masses */
    double centre[3];       /* of mass, in the unit of the source */
    double turn[4];         /* quaternion w, x, y, z: source = centre + turn of the template / scale */
} ms_grain_place;

/** What is told of a grain. What it did not get to is NAN, 0 or "". */
typedef struct ms_grain_row {
    size_t number, count; /* from 1; of all grains */
    uint64_t run;         /* ms_grain_list_checksum */
    const ms_grain *grain;
    uint64_t checksum; /* of its file */
    ms_grain_status status;
    const char *ending;      /* of the first of its files */
    const ms_result *result; /* NULL without */
    double pieces, voxel_size, volume;
    ms_grain_place place;
    double seconds; /* of all that was done for it */
    int beside;     /* other grains at the same time */
    ms_error cause; /* of a grain with a clump: what is remarked on it; "" without */
} ms_grain_row;

/** A row as a line of CSV without its end; NULL: the names of the columns. The caller frees it; NULL without memory. */
char *ms_grain_row_line(const ms_grain_row *row);

/**
 * What a line that was there says: how it went, and with how many spheres.
 *
 * @param[out] is_remarked nonzero if there is a clump, and the method has a remark on it
 * @return MS_OK; MS_ERR_FORMAT for a line that is no row
 */
ms_status ms_grain_row_read(ms_grain_status *status, int *is_remarked, double *spheres, const char *line,
                            ms_error *err);

/** A line that was there, as far as it says where its clump is. */
typedef struct ms_grain_found {
    ms_grain_status status;
    double number;
    char source[512]; /* as it was given */
    double label;     /* NAN: a mesh */
    char file[512];   /* from the folder of the table */
    double volume;    /* NAN: not known */
    ms_grain_place place;
} ms_grain_found;

/** @return MS_OK; MS_ERR_FORMAT for a line that is no row */
ms_status ms_grain_row_find(ms_grain_found *found, const char *line, ms_error *err);

/** The path of a clump without the ending of the run's first format, which its row has, so that another one can be put
 * there. The caller frees it; NULL without memory. */
char *ms_grain_row_stem(const ms_grain_found *found, const char *ending);

/** What a line that was there has in a column; NAN if that is empty. @return MS_OK; MS_ERR_FORMAT for a line that is no
 * row */
ms_status ms_grain_row_number(double *value, const char *column, const char *line, ms_error *err);

/** How its line begins: all that was asked for, with the comma behind it. Likewise. */
char *ms_grain_row_key(const ms_grain_row *row);

/** Where the files of a grain stand: FOLDER/PART/NAME, PART the number of its thousand, without ending. */
void ms_grain_row_path(char *out, size_t size, const char *folder, const ms_grain_row *row);

#endif
