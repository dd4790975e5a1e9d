/** A page of the results of a run: viewer, a tile for each clump, a table that sorts and filters, charts. */
#ifndef MS_VIEW_REPORT_H
#define MS_VIEW_REPORT_H

#include <stdio.h>

#include "chart/ms_csv.h"

/** What stands on it; all borrowed. */
typedef struct ms_view_report {
    const char *title;
    int argc; /* the command, without the program's name */
    char *const *argv;
    const char *const *column; /* names of columns */
    const size_t *shown;       /* which of them */
    size_t n_columns, n_shown;
    const ms_csv *csv;
    const long *scene;        /* of each row, which scene it opens; -1: none */
    const char *const *chart; /* paths of SVG files; those that are not there are left out */
    size_t n_charts;
} ms_view_report;

/**
 * Writes the page up to its scenes, which follow, with commas between, and then ms_view_page_end.
 * @return MS_OK; MS_ERR_NOMEM; as ms_file_read
 */
ms_status ms_view_report_begin(FILE *stream, const ms_view_report *report, ms_error *err);

#endif
