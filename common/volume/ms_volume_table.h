/** The table of volume formats: which file is read by which parser. Private. */
#ifndef MS_VOLUME_TABLE_H
#define MS_VOLUME_TABLE_H

#include "ms_volume_formats.h"

/** Voxels from the bytes of a file, by its ending; what is packed (.gz) is unpacked before. */
ms_status ms_volume_table_parse(ms_stored *stored, const ms_bytes *bytes, const char *path,
                                const ms_scan_options *options, size_t max_voxels, ms_error *err);

/** Nonzero if it is a folder of TIFF slices: the first TIFF file in it has one page. */
int ms_volume_table_is_folder(const char *path);

/** Voxels from such a folder; the slices are in the order of the numbers in their names. */
ms_status ms_volume_table_read_slices(ms_stored *stored, uint64_t *checksum, const char *path, size_t max_voxels,
                                      ms_error *err);

#endif
