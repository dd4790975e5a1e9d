/** The files that words of the command line name: files, folders, patterns. */
#ifndef MS_PATHS_H
#define MS_PATHS_H

#include <stddef.h>

#include "base/ms_error.h"

/** A zeroed struct has none. */
typedef struct ms_paths {
    char **path;
    size_t count, capacity;
} ms_paths;

/** Which files are meant, by their name alone. @param in_folder zero of those that fit a pattern */
typedef int (*ms_paths_choice)(const char *name, int in_folder);

/** Meshes and volumes; in a folder no raw file, which is most often the data of a header beside it. */
int ms_paths_is_shape(const char *name, int in_folder);

/**
 * Adds the files that a word names: of a folder, in the order of their names byte by byte; if there is nothing of that
 * name, those that fit it as a pattern (glob), sorted; else the word itself, whatever it is.
 *
 * @param choose of the files of a folder or a pattern
 * @param what   they are, as "mesh and no volume"
 * @return MS_OK; MS_ERR_IO if there is none; MS_ERR_NOMEM
 */
ms_status ms_paths_add(ms_paths *paths, const char *word, ms_paths_choice choose, const char *what, ms_error *err);

void ms_paths_free(ms_paths *paths);

#endif
