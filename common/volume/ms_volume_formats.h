/** What the readers of volume formats share: one parser per format, and how voxels become labels. Private. */
#ifndef MS_VOLUME_FORMATS_H
#define MS_VOLUME_FORMATS_H

#include "base/ms_text.h"
#include "ms_volume.h"

/**
 * One parser per format, from memory, so that tests and fuzzers need no files.
 *
 * @param[out] volume the caller frees it; empty on failure
 * @param      bytes  of the file, with the 0 byte behind them
 * @param      path   for messages, and the folder of a separate data file
 * @param      max_voxels more are refused before they are unpacked
 * @return as ms_volume_read
 */
ms_status ms_volume_parse_npy(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels,
                              ms_error *err);
ms_status ms_volume_parse_mhd(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels,
                              ms_error *err);
ms_status ms_volume_parse_nrrd(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels,
                               ms_error *err);

/** What the header names as its data file, borrowed; no length without one. @return MS_OK; MS_ERR_FORMAT */
ms_status ms_volume_find_data_mhd(ms_word *file, const ms_bytes *bytes, const char *path, ms_error *err);
ms_status ms_volume_find_data_nrrd(ms_word *file, const ms_bytes *bytes, const char *path, ms_error *err);

typedef enum ms_sample_kind { MS_SAMPLE_BOOL, MS_SAMPLE_UNSIGNED, MS_SAMPLE_SIGNED, MS_SAMPLE_FLOAT } ms_sample_kind;

/** How one voxel is stored. */
typedef struct ms_sample {
    ms_sample_kind kind;
    size_t size; /* bytes: 1, 2, 4 or 8; 0 while it is not known */
} ms_sample;

typedef enum ms_volume_coding { MS_CODING_RAW, MS_CODING_DEFLATE, MS_CODING_TEXT } ms_volume_coding;

/** What the header of any format says; filled by its parser and believed only after the checks of ms_volume_fill. */
typedef struct ms_volume_header {
    int64_t n[3]; /* x fastest in memory */
    double spacing[3];
    double origin[3];
    ms_sample sample;
    int big_endian;
    ms_volume_coding coding;
    size_t max_voxels;
} ms_volume_header;

/** Nothing known but what the formats say of a missing field: spacing 1, origin 0, raw, little endian. */
ms_volume_header ms_volume_header_start(size_t max_voxels);

/**
 * Checks the header against the bytes of its voxels and turns them into labels.
 *
 * @param[out] volume the caller frees it; empty on failure
 * @param      data   `size` bytes, all of which the voxels must take; with a 0 byte behind them if they are text
 * @param      path   for messages
 */
ms_status ms_volume_fill(ms_volume *volume, const ms_volume_header *header, const uint8_t *data, size_t size,
                         const char *path, ms_error *err);

/** Bytes of all voxels unpacked. @return MS_OK; MS_ERR_FORMAT; MS_ERR_LIMIT */
ms_status ms_volume_data_size(size_t *size, const ms_volume_header *header, const char *path, ms_error *err);

/**
 * Inflates a zlib or gzip stream that holds exactly `expected` bytes; memory grows with what really comes out.
 *
 * @param[out] out the caller frees it; empty on failure
 */
ms_status ms_volume_inflate(ms_bytes *out, const uint8_t *data, size_t size, size_t expected, const char *path,
                            ms_error *err);

/** The name of the one data file of a header, borrowed; lists and patterns of files are refused. */
ms_status ms_volume_data_file(ms_word *file, ms_text *value, ms_error *err);

/** Its path, in the folder of the header; the caller frees it; NULL without memory. */
char *ms_volume_path_beside(const ms_word *file, const char *header);

/**
 * Reads the data file that the present line of a header names, in the folder of the header or below. A path that leads
 * elsewhere, from the root, by "..", or by a symbolic link, is refused.
 */
ms_status ms_volume_read_beside(ms_bytes *bytes, const ms_word *file, const ms_text *header, ms_error *err);

/** The value of one field of a text header, to be scanned on its own. */
ms_text ms_volume_text_of_word(const ms_word *word, const ms_text *from);

/** Reads n integers that fill the value. */
ms_status ms_volume_text_integers(int64_t *values, size_t n, ms_text *text, ms_error *err);

#endif
