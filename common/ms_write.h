/** Clump files: CSV, JSON and VTK. */
#ifndef MS_WRITE_H
#define MS_WRITE_H

#include <stdio.h>

#include "ms_clump.h"
#include "ms_grid.h"

MS_C_BEGIN

/** A format of clump files. A table of them ends with a NULL name. */
typedef struct ms_format {
    const char *name;    /* what --format takes; also the file ending */
    const char *summary; /* one line */
    /** @param record a JSON object in text that says how the clump came about; NULL without */
    ms_status (*write)(FILE *stream, const ms_clump *clump, const char *record, ms_error *err);
} ms_format;

extern const ms_format ms_formats[];

/** The format of that name, or NULL with a message that lists the names. */
const ms_format *ms_format_find(const char *name, ms_error *err);

/**
 * Writes a clump under a temporary name, then renames it to `path`.
 *
 * @param path   "-" for standard output
 * @param format NULL: by the ending of the path; csv for standard output
 * @param record as above; only JSON keeps it
 * @return MS_OK; MS_ERR_ARG for an unknown ending; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_write_clump(const ms_clump *clump, const char *path, const ms_format *format, const char *record,
                         ms_error *err);

/** Writes a grid as VTK structured points (binary), 1 inside, for ParaView. */
ms_status ms_write_grid(const ms_grid *grid, const char *path, ms_error *err);

MS_C_END

#endif
