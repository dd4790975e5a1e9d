/** A volume file as it lies on the disk: labels are taken slice by slice or box by box, never held all at once. */
#ifndef MS_SCAN_H
#define MS_SCAN_H

#include "ms_volume.h"

MS_C_BEGIN

/** How a voxel is stored. */
typedef enum ms_sample_kind { MS_SAMPLE_BOOL, MS_SAMPLE_UNSIGNED, MS_SAMPLE_SIGNED, MS_SAMPLE_FLOAT } ms_sample_kind;
typedef struct ms_sample {
    ms_sample_kind kind;
    size_t size; /* bytes: 1, 2, 4 or 8; 0 while it is not known */
} ms_sample;

/** What voxels hold: labels, or grey values that become labels. */
typedef enum ms_scan_values {
    MS_SCAN_LABELS,
    MS_SCAN_THRESHOLD, /* what is above a number is inside; its components are the labels */
    MS_SCAN_OTSU       /* the same, the number is Otsu's */
} ms_scan_values;

/** What a file does not say of itself. */
typedef struct ms_scan_options {
    ms_scan_values values;
    double threshold;
    int connectivity;  /* of components: 6, 18 or 26 neighbours */
    double spacing[3]; /* edges of a voxel along x, y and z in place of those of the file; 0: as the file says */
    /* A raw file has no header. */
    int64_t raw_n[3]; /* extents, x fastest; 0: not known */
    ms_sample raw_sample;
    int raw_big_endian;
    int64_t raw_skip; /* bytes before the voxels */
} ms_scan_options;

/** Labels, 26 neighbours, all else unknown. */
MS_API ms_scan_options ms_scan_defaults(void);

/** u8, i16, u32be, f32le, ...: kind, bits, and byte order, little where it is missing. @return MS_OK; MS_ERR_ARG */
MS_API ms_status ms_scan_raw_type(ms_sample *sample, int *big_endian, const char *text, ms_error *err);

/** One of them. A zeroed struct is empty. Reading from it changes nothing: threads may do so at once. */
typedef struct ms_scan {
    int n[3];                 /* extents along x, y and z of space */
    double spacing;           /* edge of a voxel, which is a cube */
    double origin[3];         /* centre of voxel (0, 0, 0) */
    double stored_spacing[3]; /* along x, y and z */
    int is_resampled;         /* nonzero: stored_spacing are not equal, and voxels are not those of the file */
    uint64_t checksum;        /* FNV-1a of the file; of a folder, of its slices one after the other */
    double threshold;         /* of grey values, with which labels were made */
    size_t held;              /* bytes in memory; those of a mapped file are not */
    const char *path;
    struct ms_scan_store *store;
} ms_scan;

/**
 * Opens a volume. Uncompressed voxels of .npy, .mhd, .mha, .nrrd, .nhdr, .nii and .raw stay on the disk and are mapped
 * (ms_file_map: the file may not be shortened meanwhile); what is packed, text, or TIFF is unpacked in its own type;
 * of grey values the labels are held, 4 bytes a voxel.
 *
 * Axes are put in the order and direction of x, y and z of the file's own space. Voxels that are not cubes (to 1e-5)
 * are replaced by cubes of their shortest edge over the same box, centred: labels by the nearest voxel's, grey values
 * by linear interpolation between centres, before they become labels.
 *
 * @param[out] scan       closed by ms_scan_close; empty on failure
 * @param      path       of a file, or of a folder of TIFF slices, ordered by the numbers in their names
 * @param      max_voxels more are not unpacked, and not made from grey values; SIZE_MAX: any number
 * @return as ms_volume_read; whether all values are labels is seen when they are taken
 */
MS_API ms_status ms_scan_open(ms_scan *scan, const char *path, const ms_scan_options *options, size_t max_voxels,
                              ms_error *err);

/** The same from the bytes of a file, which are borrowed until it is closed. */
MS_API ms_status ms_scan_parse(ms_scan *scan, const ms_bytes *bytes, const char *path, const ms_scan_options *options,
                               size_t max_voxels, ms_error *err);

/**
 * The labels of voxels lo <= (x, y, z) < hi.
 *
 * @param[out] label x fastest; the caller allocates
 * @return MS_OK; MS_ERR_FORMAT where a value is no label
 */
MS_API ms_status ms_scan_take(uint32_t *label, const ms_scan *scan, const int lo[3], const int hi[3], ms_error *err);

/** All of them as a volume. @return as ms_scan_take; MS_ERR_LIMIT; MS_ERR_NOMEM; MS_ERR_SHAPE without a label */
MS_API ms_status ms_scan_volume(ms_volume *volume, const ms_scan *scan, size_t max_voxels, ms_error *err);

MS_API void ms_scan_close(ms_scan *scan);

/** Nonzero if the path ends like a volume that says itself what it holds, which .raw and .raw.gz do not. */
MS_API int ms_scan_has_header(const char *path);

MS_C_END

#endif
