/** Charts of the results of `mskit compare`. */
#ifndef MS_COMPARE_CHARTS_H
#define MS_COMPARE_CHARTS_H

#include <stdio.h>

#include "chart/ms_chart.h"
#include "cli/ms_files.h"
#include "ms_compare_records.h"

/**
 * Draws for each shape, as FOLDER/SHAPE-KIND.svg and .png with data and script beside them, by the rows of the finest
 * resolution:
 * - dice: D by number of spheres;
 * - time: D by time, with the Pareto front, points labelled by their number of spheres;
 * - work: the same by work in a simulation;
 * - normal_median: error of the normals by number of spheres;
 * - inertia, corrected: error of the moments by number of spheres, of the union and with masses by ms_density_solve;
 * - resolution: D by cells at the largest number of spheres, if there are several resolutions.
 *
 * Those that a run before left there are removed.
 *
 * @param folder exists
 * @param words  where it says what it drew
 * @return MS_OK; as ms_files_remove, ms_chart_make
 */
ms_status ms_compare_charts(const ms_compare_records *all, const char *folder, FILE *words, ms_error *err);

/**
 * How the times of a shape were measured: machine, threads, of how many runs they are the medians, and whether others
 * ran beside.
 *
 * @param shape NULL: of all rows
 */
void ms_compare_charts_timing(char *out, size_t size, const ms_compare_record *row, size_t count,
                              const ms_compare_record *shape);

/** Adds the files of all charts that there can be of a shape, by its name (ms_compare_name). */
ms_status ms_compare_charts_list(ms_files *files, const char *folder, const char *shape, ms_error *err);

#endif
