/** A manifest of grains: a CSV file of shapes, labels, and what is special about each. */
#ifndef MS_GRAIN_MANIFEST_H
#define MS_GRAIN_MANIFEST_H

#include "ms_grain_how.h"

enum { MS_GRAIN_MANIFEST_COLUMNS = 32 };

/** A row of it. */
typedef struct ms_grain_manifest_row {
    const char *path; /* of the shape, as it can be opened */
    uint32_t label;   /* 0: none is given */
    size_t line;      /* from 1 */
    const char *name; /* of the manifest */
    size_t n_flags;   /* columns that are flags, where the row has a value */
    const char *flag[MS_GRAIN_MANIFEST_COLUMNS], *value[MS_GRAIN_MANIFEST_COLUMNS];
} ms_grain_manifest_row;

/**
 * Reads a manifest and tells of each row. Paths are relative to its folder; empty lines and lines that begin with '#'
 * are passed over; fields with commas stand in quotes.
 *
 * @param[out] text what flags and values point into; the caller frees it when they are used no more, whatever is
 *                  returned; NULL if there is none
 * @param      take told of each row
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT with the line; MS_ERR_NOMEM; as take
 */
ms_status ms_grain_manifest_read(char **text, const char *path,
                                 ms_status (*take)(void *context, const ms_grain_manifest_row *row, ms_error *err),
                                 void *context, ms_error *err);

/**
 * What a row says, on top of what is said of all.
 *
 * @param[out] how resolved; ms_grain_how_free in any case
 * @return MS_OK; MS_ERR_FORMAT with the line
 */
ms_status ms_grain_manifest_apply(ms_grain_how *how, const ms_grain_how *all, const ms_grain_manifest_row *row,
                                  ms_error *err);

#endif
