/** The files that a command reads and those that it writes, held against each other before the work: no input is
 * written over, and no output by another. A file is one file however it is spelt. */
#ifndef MS_FILES_H
#define MS_FILES_H

#include <stddef.h>

#include "base/ms_error.h"

typedef enum ms_file_use {
    MS_FILE_READ,
    MS_FILE_WRITTEN, /* is tried: can it be made? */
    MS_FILE_LATER,   /* the same, not tried: its folder may be still to be made */
    MS_FILE_FRAME,   /* likewise: that beside templates of one clump, which may be written with each of them */
    MS_FILE_FOLDER   /* made for the check, and removed behind it */
} ms_file_use;

/** One of them. */
typedef struct ms_file {
    char *path; /* as it was given */
    char *key;  /* the same for the same file */
    ms_file_use use;
} ms_file;

/** A zeroed struct has none. */
typedef struct ms_files {
    ms_file *file;
    size_t count, capacity;
} ms_files;

/** Nonzero for standard output, a device or a pipe: it holds nothing that could be lost. */
int ms_files_is_stream(const char *path);

/** Takes the path of a page, as of --report. @return MS_OK; MS_ERR_ARG for another ending than .html, and a stream */
ms_status ms_files_take_page(const char **page, const char *flag, const char *path, ms_error *err);

/**
 * Standard input can be read once: refuses "-" as more than one of the files that a command reads.
 *
 * @param path NULL for one that is not given
 * @return MS_OK; MS_ERR_ARG
 */
ms_status ms_files_check_standard(const char *const *path, size_t count, ms_error *err);

/** Adds a file; standard output, devices and pipes are passed over. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_files_add(ms_files *files, const char *path, ms_file_use use, ms_error *err);

/**
 * Makes a folder that outputs will stand in, if it is not there, so that those in it can be tried. ms_files_free
 * removes it again if it is empty then: a command that is refused leaves no folder behind, and what is written makes
 * its folder itself (ms_files_make_folder).
 *
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_files_add_folder(ms_files *files, const char *path, ms_error *err);

/** Makes a folder, if it is not there; the one above it exists. @return MS_OK; MS_ERR_IO */
ms_status ms_files_make_folder(const char *path, ms_error *err);

/** Adds FOLDER/NAMEENDING as MS_FILE_LATER for each of a NULL-ended list of endings. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_files_add_charts(ms_files *files, const char *folder, const char *name, const char *const *endings,
                              ms_error *err);

/** Adds a shape that is read, and the data file that its header names, if it does. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_files_add_shape(ms_files *files, const char *path, ms_error *err);

/**
 * Those of one ending, in their order.
 *
 * @param[out] path their paths, borrowed from `files`; the caller frees the array; NULL on failure
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_files_with_ending(const char ***path, size_t *count, const ms_files *files, const char *ending,
                               ms_error *err);

/**
 * Is each output another file than all inputs and outputs, and can it be made? A regular file that is there may be
 * replaced.
 *
 * @return MS_OK; MS_ERR_ARG; MS_ERR_IO
 * Cost: O(files log files).
 */
ms_status ms_files_check(ms_files *files, ms_error *err);

/**
 * Removes the files that a run before left there, so that none stands for one that this run does not write. Frees the
 * list in any case.
 *
 * @param status of listing them: nothing is removed unless it is MS_OK
 * @return `status` if that is not MS_OK; MS_OK; MS_ERR_IO
 */
ms_status ms_files_remove(ms_files *files, ms_status status, ms_error *err);

void ms_files_free(ms_files *files);

#endif
