/** Whole files: read at once, written under a temporary name and renamed. */
#ifndef MS_FILE_H
#define MS_FILE_H

#include <stdint.h>
#include <stdio.h>

#include "ms_error.h"

MS_C_BEGIN

/** The bytes of a file, with a 0 byte behind the last so that text can be scanned. */
typedef struct ms_bytes {
    uint8_t *data;
    size_t size;   /* without the 0 byte */
    size_t mapped; /* bytes of address space that show the file; 0: they are in memory of their own */
} ms_bytes;

/**
 * Reads a regular file whole (a folder, a device or a pipe is refused).
 *
 * @param[out] bytes the caller frees it with ms_file_free; empty on failure
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM
 */
MS_API ms_status ms_file_read(ms_bytes *bytes, const char *path, ms_error *err);

/** The same of the first `most` bytes, or of all if there are fewer. */
MS_API ms_status ms_file_read_start(ms_bytes *bytes, const char *path, size_t most, ms_error *err);

/**
 * The same without reading: its pages are fetched when they are touched and may be dropped again, so that a file can be
 * larger than the memory. Nobody may shorten it meanwhile: a byte that is no longer there ends the program (SIGBUS).
 */
MS_API ms_status ms_file_map(ms_bytes *bytes, const char *path, ms_error *err);

/** Bytes of a mapped file that are not needed soon: their pages leave the memory of this process. */
MS_API void ms_file_unneeded(const ms_bytes *bytes, size_t from, size_t size);

/** Nonzero for "-", which is standard input where a command reads and standard output where it writes. */
MS_API int ms_file_is_standard(const char *path);

/**
 * Reads standard input to its end.
 *
 * @param most bytes that are read at most
 * @return MS_OK; MS_ERR_LIMIT if there are more; MS_ERR_IO; MS_ERR_NOMEM
 */
MS_API ms_status ms_file_read_standard(ms_bytes *bytes, size_t most, ms_error *err);

/** What a file is called in messages: its path, or "standard input". */
MS_API const char *ms_file_name(const char *path);

/** How the name of a file that is made from this one begins: its name without folder and ending, and without the one
 * before .gz; "stdin" for "-". It need not be a name that a file may have (ms_escape_file_name). @param[out] length of
 * it; it ends with no 0 byte */
MS_API const char *ms_file_stem(size_t *length, const char *path);

/** Says why a file cannot be opened and, of one that is not there, which name in its folder is near. @param why errno
 * @return MS_ERR_IO */
MS_API ms_status ms_file_fail_open(ms_error *err, const char *path, int why);

MS_API void ms_file_free(ms_bytes *bytes);

/** FNV-1a of no byte. */
#define MS_FILE_CHECKSUM UINT64_C(14695981039346656037)

/** FNV-1a, 64 bits: names an input in a result so that a run can be repeated. */
MS_API uint64_t ms_file_checksum(const ms_bytes *bytes);

/** The same of several pieces one after the other. @param hash what the piece before gave; of none MS_FILE_CHECKSUM */
MS_API uint64_t ms_file_checksum_add(uint64_t hash, const ms_bytes *bytes);

/** A file being written. "-" is standard output. */
typedef struct ms_output {
    FILE *stream;
    char *path;      /* where it will stand */
    char *temporary; /* where it is written; NULL for standard output */
    size_t noted;    /* for ms_output_discard_all */
} ms_output;

/** Opens a temporary file in the folder of `path`. @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM */
MS_API ms_status ms_output_open(ms_output *output, const char *path, ms_error *err);

/**
 * Ends a file: if `status` is MS_OK and every byte reached the disk it is renamed to its
 * path, else it is removed. Frees the struct in any case.
 *
 * @return `status` if that is not MS_OK; MS_OK; MS_ERR_IO
 */
MS_API ms_status ms_output_close(ms_output *output, ms_status status, ms_error *err);

/** Removes the temporary files of all outputs that are open, as a process does that a signal ends: may be called by the
 * handler of one. Such an output fails when it is closed. */
MS_API void ms_output_discard_all(void);

/**
 * The path of a file that another one names: from the folder of that one, unless it begins at the root.
 *
 * @param name   `length` characters
 * @return the caller frees it; NULL without memory
 */
MS_API char *ms_file_beside(const char *path, const char *name, size_t length);

/** The name of a file without its folders: the path behind its last slash. */
MS_API const char *ms_file_base_name(const char *path);

/** The ending of a path after its last dot, in lower case; "" if none or too long for `out`. */
MS_API void ms_file_ending(char out[16], const char *path);

MS_C_END

#endif
