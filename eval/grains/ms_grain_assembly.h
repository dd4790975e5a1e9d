/** The clumps of a run back in their places: where they overlap, and files of the whole packing. */
#ifndef MS_GRAIN_ASSEMBLY_H
#define MS_GRAIN_ASSEMBLY_H

#include "cli/ms_files.h"
#include "ms_grains.h"

/** What came of it. Depths are over the equivalent radius of the smaller of two grains. */
typedef struct ms_grain_assembly {
    size_t clumps, without;         /* in it; of grains that have none */
    size_t neighbours, overlapping; /* pairs in assembly.csv; those that overlap */
    double median, most;            /* depth of those that overlap; 0 without */
    double volume;                  /* of all spheres' unions, over that before they were shrunk */
} ms_grain_assembly;

/**
 * Can there be one of these grains, in these formats?
 *
 * @return MS_OK; MS_ERR_ARG for grains of several frames and formats that are not read back
 */
ms_status ms_grain_assembly_check(const ms_grains *grains, ms_error *err);

/** Adds what is written: assembly.csv and the packings. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_grain_assembly_list(ms_files *files, const ms_grains *grains, ms_error *err);

/**
 * Reads all clumps of a complete table back from their files and writes beside the table assembly.csv, a row for each
 * pair of clumps that overlap or are nearer than a tenth of the smaller radius, and, for each format of the run that
 * has one, the packing. The same whether rows are of this run or were there.
 *
 * @param[out] sum
 * @param      csv          the table, with all its rows
 * @param      most_overlap clumps shrink until no depth is above it; 0: they stay
 * @return MS_OK; MS_ERR_ARG for a table without masses or with other ones; MS_ERR_LIMIT as
 *         ms_packing_shrink; MS_ERR_SHAPE where no grain has a clump; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_NOMEM
 */
ms_status ms_grain_assembly_write(ms_grain_assembly *sum, const ms_csv *csv, const ms_grains *grains,
                                  double most_overlap, ms_error *err);

#endif
