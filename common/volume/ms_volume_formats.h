/** What the readers of volume formats share: one parser per format, and how voxels become labels. Private. */
#ifndef MS_VOLUME_FORMATS_H
#define MS_VOLUME_FORMATS_H

#include "base/ms_text.h"
#include "ms_scan.h"

typedef enum ms_volume_coding { MS_CODING_RAW, MS_CODING_DEFLATE, MS_CODING_TEXT } ms_volume_coding;

/** What the header of any format says; filled by its parser and believed only after the checks of ms_volume_store, and
 * its geometry after those of ms_volume_check_geometry. */
typedef struct ms_volume_header {
    int64_t n[3]; /* along the axes of the file; the first is the fastest in memory */
    double spacing[3];
    int axis[3];      /* 0 for x, 1 for y, 2 for z of space: where each axis of the file leads */
    int mirrored[3];  /* nonzero: it leads there backwards */
    double origin[3]; /* x, y and z of the centre of the first voxel of the file */
    ms_sample sample;
    int big_endian;
    double slope, intercept; /* the value is slope * sample + intercept */
    ms_volume_coding coding;
    size_t max_voxels;
} ms_volume_header;

/** Voxels as they are stored. A zeroed struct is empty. */
typedef struct ms_stored {
    ms_volume_header header;
    const uint8_t *data; /* raw, of as many bytes as the header says; borrowed, or in `owned` */
    ms_bytes owned;      /* what was unpacked, or a data file beside the header */
} ms_stored;

void ms_volume_stored_free(ms_stored *stored);

/**
 * One parser per format, from memory, so that tests and fuzzers need no files.
 *
 * @param[out] stored the caller frees it; empty on failure
 * @param      bytes  of the file, with the 0 byte behind them; may be borrowed
 * @param      path   for messages, and the folder of a separate data file
 * @param      max_voxels more are not unpacked
 * @return as ms_scan_open
 */
typedef ms_status ms_volume_parser(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                                   ms_error *err);
ms_volume_parser ms_volume_parse_npy, ms_volume_parse_mhd, ms_volume_parse_nrrd, ms_volume_parse_nifti;
ms_volume_parser ms_volume_parse_tiff;

/** Adds the one page of a TIFF file, as the next slice. @return as ms_volume_parser; what was there stays */
ms_status ms_volume_tiff_add(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                             ms_error *err);

/** Nonzero if the bytes are a TIFF file of one page. */
int ms_volume_tiff_is_slice(const ms_bytes *bytes);

ms_status ms_volume_parse_raw(ms_stored *stored, const ms_bytes *bytes, const char *path,
                              const ms_scan_options *options, ms_error *err);

/** What the header names as its data file, borrowed; no length without one. @return MS_OK; MS_ERR_FORMAT */
ms_status ms_volume_find_data_mhd(ms_word *file, const ms_bytes *bytes, const char *path, ms_error *err);
ms_status ms_volume_find_data_nrrd(ms_word *file, const ms_bytes *bytes, const char *path, ms_error *err);

/** Nothing known but what the formats say of a missing field: spacing 1, origin 0, axes along those of space, raw,
 * little endian. */
ms_volume_header ms_volume_header_start(size_t max_voxels);

/**
 * Where the axes of the file lead.
 *
 * @param direction of each axis of the file, in space, of any length above 0
 * @return nonzero if they lead along those of space, to 1e-4; zero if they are oblique
 */
int ms_volume_header_set_axes(ms_volume_header *header, const double direction[3][3]);

/**
 * Checks the header against the bytes of its voxels and unpacks them.
 *
 * @param[out] stored the caller frees it; empty on failure
 * @param      data   `size` bytes, all of which the voxels must take; with a 0 byte behind them if they are text;
 *                    borrowed if they are raw
 * @param      path   for messages
 */
ms_status ms_volume_store(ms_stored *stored, const ms_volume_header *header, const uint8_t *data, size_t size,
                          const char *path, ms_error *err);

/** Spacings and origin, once they are those that count. @return MS_OK; MS_ERR_FORMAT */
ms_status ms_volume_check_geometry(const ms_volume_header *header, const char *path, ms_error *err);

/** Nonzero if this machine stores the highest byte first. */
int ms_volume_is_big_endian(void);

/** A stored value as a number. */
double ms_volume_value(const uint8_t *at, const ms_volume_header *header);

/** Bytes of all voxels unpacked. @return MS_OK; MS_ERR_FORMAT; MS_ERR_LIMIT */
ms_status ms_volume_data_size(size_t *size, const ms_volume_header *header, const char *path, ms_error *err);

/**
 * Inflates a zlib or gzip stream that holds exactly `expected` bytes; memory grows with what really comes out.
 *
 * @param[out] out the caller frees it; empty on failure
 */
ms_status ms_volume_inflate(ms_bytes *out, const uint8_t *data, size_t size, size_t expected, const char *path,
                            ms_error *err);

/** The same of any number of bytes up to `most`, with a 0 byte behind them. @return MS_ERR_LIMIT for more */
ms_status ms_volume_gunzip(ms_bytes *out, const ms_bytes *packed, size_t most, const char *path, ms_error *err);

/** The name of the one data file of a header, borrowed; lists and patterns of files are refused. */
ms_status ms_volume_data_file(ms_word *file, ms_text *value, ms_error *err);

/**
 * Maps the data file that the present line of a header names, in the folder of the header or below. A path that leads
 * elsewhere, from the root, by "..", or by a symbolic link, is refused.
 */
ms_status ms_volume_read_beside(ms_bytes *bytes, const ms_word *file, const ms_text *header, ms_error *err);

/** The data file stays open for voxels that lie in it, else it is freed. @return status */
ms_status ms_volume_keep_beside(ms_stored *stored, ms_bytes *beside, ms_status status);

/** The value of one field of a text header, to be scanned on its own. */
ms_text ms_volume_text_of_word(const ms_word *word, const ms_text *from);

/** Reads n integers that fill the value. */
ms_status ms_volume_text_integers(int64_t *values, size_t n, ms_text *text, ms_error *err);

#endif
