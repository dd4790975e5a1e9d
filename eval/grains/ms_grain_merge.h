/** The tables of all parts of a run, joined into one. */
#ifndef MS_GRAIN_MERGE_H
#define MS_GRAIN_MERGE_H

#include <stddef.h>

#include "base/ms_error.h"

/**
 * Joins the tables grains-K-of-N.csv of folders into FOLDER/grains.csv, with rows in the order of the grains. Parts
 * must be of one run (grains and flags: the column `run`) and complete: 1 to N each once, and every grain once. Files
 * stay where they are; of parts in other folders the table names them from its own folder on. FOLDER is made if it is
 * not there. Cost: the tables are held in memory; rows times log(parts).
 *
 * @return MS_OK; MS_ERR_ARG for parts that are missing, do not fit together or lack rows, and where the table of
 *         another run would be replaced; MS_ERR_IO, also for a part that another process is still writing;
 *         MS_ERR_FORMAT; MS_ERR_NOMEM
 */
ms_status ms_grain_merge(const char *folder, char *const *parts, size_t count, ms_error *err);

#endif
