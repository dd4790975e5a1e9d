/** Engines' scripts that insert the mixture of a library. Private to ms_library_write. */
#ifndef MS_LIBRARY_MIXTURE_H
#define MS_LIBRARY_MIXTURE_H

#include "ms_library.h"

/**
 * For each format of engines that mixes kinds of particles, if all the chosen grains have a template of it and masses:
 * copies the templates and writes a script.
 *
 * @param[out] names of the scripts, with commas; `size` bytes
 * @return MS_OK; MS_ERR_ARG for a template whose name no script can hold; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_NOMEM
 */
ms_status ms_library_mixture_write(char *names, size_t size, const ms_library *library, const char *from,
                                   const char *folder, ms_error *err);

#endif
