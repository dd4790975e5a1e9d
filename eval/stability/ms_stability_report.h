/** A stability run as one page: all rows, the charts, and clumps in 3-D. */
#ifndef MS_STABILITY_REPORT_H
#define MS_STABILITY_REPORT_H

#include "ms_stability_walk.h"

/** What it is made of. Everything is borrowed. */
typedef struct ms_stability_report {
    const ms_stability_plan *plan; /* with its clumps kept */
    const ms_stability_run *run;
    size_t n_runs;
    const ms_csv *csv;  /* their rows */
    const char *charts; /* folder of the charts; NULL: none */
    int argc;           /* the command, without the program's name */
    char *const *argv;
} ms_stability_report;

/**
 * Writes the page. Of each shape and method two clumps stand on it: that of the unchanged shape, and that of the
 * largest D. A clump of a run before, which --resume took from its row, is not known.
 *
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM; as ms_stability_read_shape, ms_view_scene_write
 */
ms_status ms_stability_report_write(const char *path, const ms_stability_report *report, ms_error *err);

#endif
