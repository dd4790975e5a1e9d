/** The contact sheet of a comparison: a shape and the clumps of each method side by side. */
#ifndef MS_COMPARE_SHEET_H
#define MS_COMPARE_SHEET_H

#include <stdio.h>

#include "cli/ms_files.h"
#include "cli/ms_methods.h"
#include "voxel/ms_target.h"

/** What is on a sheet; all borrowed. */
typedef struct ms_compare_sheet {
    const char *folder, *shape; /* shape: begins the names of its files */
    size_t at;                  /* of the shape among those that clumps of other tools go with */
    const ms_methods *methods;
    const double *asked; /* numbers of spheres, ascending */
    size_t n_asked;
    size_t max_voxels; /* of a grid that a clump is scored on */
} ms_compare_sheet;

/** Keeps a clump for the sheet as FOLDER/SHAPE-METHOD-N.csv. @return as ms_write_clump */
ms_status ms_compare_sheet_keep(const ms_compare_sheet *sheet, const ms_method *method, double asked,
                                const ms_clump *clump, ms_error *err);

/** Removes the one that a run before kept there, so that none stands for a run that fails. @return MS_OK; MS_ERR_IO;
 * MS_ERR_NOMEM */
ms_status ms_compare_sheet_drop(const ms_compare_sheet *sheet, const ms_method *method, double asked, ms_error *err);

/** Where that is; the caller frees it; NULL without memory. */
char *ms_compare_sheet_path(const ms_compare_sheet *sheet, const ms_method *method, double asked, ms_error *err);

/** Adds the files of a sheet, those of its clumps among them. */
ms_status ms_compare_sheet_list(ms_files *files, const ms_compare_sheet *sheet, ms_error *err);

/**
 * Draws FOLDER/SHAPE-sheet.png: the shape, then a column for each method, a row for each number of spheres, four rows
 * at most; under each clump its true number of spheres and its D on the grid of the target. A clump that was not kept,
 * as that of a run that failed, leaves its place empty.
 *
 * @param words where it says what it drew
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM; as ms_chart_draw
 */
ms_status ms_compare_sheet_draw(const ms_compare_sheet *sheet, const ms_target *target, FILE *words, ms_error *err);

#endif
