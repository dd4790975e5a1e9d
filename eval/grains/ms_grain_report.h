/** The grains of a run as one page: their rows, and their clumps in 3-D. */
#ifndef MS_GRAIN_REPORT_H
#define MS_GRAIN_REPORT_H

#include "ms_grains.h"

/** Clumps on a page; of more grains those of the largest D are taken. */
enum { MS_GRAIN_REPORT_MOST = 500 };

/** Does the run write a format that is read back in the frame of the grain? @return MS_OK; MS_ERR_ARG */
ms_status ms_grain_report_check(const ms_grains *grains, ms_error *err);

/**
 * Writes the page, after ms_grains_make. The clumps are read back from their files, those of runs before, too, and each
 * grain that is shown from its source.
 *
 * @param csv  rows of the run
 * @param argv the command without the program's name
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM; as ms_grain_row_find, ms_grain_source_read, ms_read_clump,
 *         ms_view_scene_write
 */
ms_status ms_grain_report_write(const char *path, const ms_csv *csv, const ms_grains *grains, int argc,
                                char *const *argv, ms_error *err);

#endif
