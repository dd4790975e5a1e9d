/** What a run reads and what it writes beside its clumps, held against each other before the work. */
#ifndef MS_GRAIN_FILES_H
#define MS_GRAIN_FILES_H

#include "ms_grains.h"

/**
 * Are the page and the files of an assembly others than what is read?
 *
 * @param words        of the command line that name the sources
 * @param has_assembly nonzero if there will be one
 * @param page         path of the page (ms_files_take_page); NULL: none
 * @return MS_OK; as ms_files_check
 */
ms_status ms_grain_files_check(const ms_grains *grains, char *const *words, size_t count, int has_assembly,
                               const char *page, ms_error *err);

#endif
