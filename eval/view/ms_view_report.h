/** A page of the results of a run: viewer, a tile for each clump, a table that sorts and filters, charts. */
#ifndef MS_VIEW_REPORT_H
#define MS_VIEW_REPORT_H

#include <stdio.h>

#include "chart/ms_csv.h"

/** Triangles of the shape in each of so many scenes: all shapes together take about 10 MB or less. */
size_t ms_view_report_triangles(size_t scenes);

/**
 * Finds the columns to show by their names; those that the table lacks are passed over.
 *
 * @param[out] shown  room for n_wanted
 * @param      column names of all n_columns
 * @return how many there are
 */
size_t ms_view_report_columns(size_t *shown, const char *const *wanted, size_t n_wanted, const char *const *column,
                              size_t n_columns);

/** What stands on it; all borrowed. */
typedef struct ms_view_report {
    const char *title;
    char *sums; /* lines above the table, which are cut apart; NULL: none */
    int argc;   /* the command, without the program's name */
    char *const *argv;
    const char *const *column; /* names of columns */
    const size_t *shown;       /* which of them */
    size_t n_columns, n_shown;
    const ms_csv *csv;
    const long *scene;        /* of each row, which scene it opens; -1: none */
    const char *const *chart; /* paths of SVG files; of those that are not there the gnuplot script is named */
    size_t n_charts;
} ms_view_report;

/**
 * Writes the page up to its scenes, which follow, with commas between, and then ms_view_page_end.
 * @return MS_OK; MS_ERR_NOMEM; as ms_file_read
 */
ms_status ms_view_report_begin(FILE *stream, const ms_view_report *report, ms_error *err);

#endif
