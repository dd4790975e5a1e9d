/** Reads labelled voxel volumes whole: NumPy, MetaImage, NRRD, TIFF, NIfTI; ms_scan.h reads them in parts. */
#ifndef MS_VOLUME_H
#define MS_VOLUME_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"
#include "base/ms_file.h"

MS_C_BEGIN

/** Labels on a regular grid of cubic voxels; 0 is background. */
typedef struct ms_volume {
    int n[3];         /* extents x, y, z; x fastest in memory */
    double spacing;   /* edge of a voxel; 1 where the file does not say */
    double origin[3]; /* centre of voxel (0, 0, 0); 0 where the file does not say */
    int first[3];     /* place of the first voxel of `label`; (0, 0, 0) but for a part of a volume */
    uint32_t *label;  /* n[0]*n[1]*n[2] */
} ms_volume;

/**
 * Reads a volume of labels, strictly. Integers of 1 to 8 bytes whose values fit 32 bits,
 * bools, and floats whose values are all whole numbers; negative values, fractions and NaN are
 * grey values, not labels, and are refused, as are a volume without any label and axes that are not along those of
 * space; ms_scan_open says more. NumPy arrays are indexed [z][y][x] (C order) or [x][y][z] (Fortran order).
 *
 * @param[out] volume the caller frees it; empty on failure
 * @param      path   of a file, or of a folder of TIFF slices
 * @param      max_voxels more are refused before they are unpacked; SIZE_MAX: any number
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_SHAPE without a label; MS_ERR_LIMIT; MS_ERR_NOMEM
 */
MS_API ms_status ms_volume_read(ms_volume *volume, const char *path, size_t max_voxels, ms_error *err);

/** The same from the bytes of a file that was read already; a data file beside it is read from the path's folder. */
MS_API ms_status ms_volume_parse(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels,
                                 ms_error *err);

/**
 * The data file that the header of a volume names.
 *
 * @param[out] data the caller frees it; NULL if the voxels are in the file itself, or if no volume can be read from it
 * @return MS_OK; MS_ERR_NOMEM
 */
MS_API ms_status ms_volume_data_path(char **data, const char *path, ms_error *err);

/** Nonzero if the path ends like a volume that ms_volume_read takes, or is a folder of TIFF slices. */
MS_API int ms_volume_is_volume_path(const char *path);

/** The endings of volume formats, for messages: ".npy, .mhd, ... and .raw". */
MS_API const char *ms_volume_endings(void);

MS_API void ms_volume_free(ms_volume *volume);

MS_C_END

#endif
