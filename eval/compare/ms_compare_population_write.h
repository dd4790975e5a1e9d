/** The tables and charts of a population of shapes. */
#ifndef MS_COMPARE_POPULATION_WRITE_H
#define MS_COMPARE_POPULATION_WRITE_H

#include "cli/ms_files.h"
#include "ms_compare_records.h"

/**
 * Writes into a folder:
 * - population.csv: a row for each resolution, method, number of spheres and quantity: mean and quartiles over shapes;
 * - best.csv: a row for each resolution, number of spheres, of D and time, and method: ms_compare_standing;
 * - population.json: both;
 * - population-KIND.svg and .png with data and script beside them, of the last resolution: mean and a band from
 *   quartile to quartile by number of spheres; KIND is dice, time (normalised) or another measure that has a chart.
 * Says so on standard output.
 *
 * @param folder exists
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM; as ms_chart_draw, when all tables are written
 */
ms_status ms_compare_population_write(const ms_compare_records *all, const char *folder, FILE *words, ms_error *err);

/** Adds all files that it may write. */
ms_status ms_compare_population_list(ms_files *files, const char *folder, ms_error *err);

#endif
