/** What a scan is made of: voxels as they are stored, and where those of the grid lie among them. Private. */
#ifndef MS_SCAN_STORE_H
#define MS_SCAN_STORE_H

#include "ms_volume_formats.h"

/** Along one axis of space, for each of its n places: bytes from the first stored voxel. */
typedef struct ms_scan_axis {
    size_t *near;   /* of the voxel whose centre is nearest */
    size_t *low;    /* of the last one at or below, */
    size_t *high;   /* of the one behind it, */
    double *weight; /* and how far towards that, 0 to 1 */
    size_t step;    /* bytes from one place to the next; 0 where that differs, or is backwards */
} ms_scan_axis;

typedef struct ms_scan_store {
    char *path;
    ms_bytes bytes;         /* of the file, if they are the scan's own */
    const ms_bytes *source; /* what the voxels lie in and may be mapped; NULL: they are in memory */
    ms_stored stored;
    ms_scan_axis axis[3];
    uint32_t *label; /* that were made from grey values, x fastest; else NULL */
} ms_scan_store;

/**
 * A scan of voxels that a parser found.
 *
 * @param stored taken over, on failure as well
 * @param bytes  what it may lie in, borrowed; NULL: it is in memory of its own
 */
ms_status ms_scan_store_open(ms_scan *scan, ms_stored *stored, const ms_bytes *bytes, const char *path,
                             const ms_scan_options *options, size_t max_voxels, ms_error *err);

/** Puts a grid of cubes over the stored voxels. @return MS_OK; MS_ERR_LIMIT; MS_ERR_NOMEM */
ms_status ms_scan_store_lattice(ms_scan *scan, ms_error *err);

/** Makes labels from grey values. @return MS_OK; MS_ERR_FORMAT; MS_ERR_SHAPE; MS_ERR_LIMIT; MS_ERR_NOMEM */
ms_status ms_scan_store_segment(ms_scan *scan, const ms_scan_options *options, size_t max_voxels, ms_error *err);

/** @return MS_OK; MS_ERR_LIMIT if the scan has more voxels than that */
ms_status ms_scan_store_check_count(const ms_scan *scan, size_t max_voxels, ms_error *err);

/** Where a byte of the stored voxels lies, for messages. @param[out] place in the order of the file's axes */
void ms_scan_store_place(size_t place[3], const ms_scan_store *store, const uint8_t *at);

#endif
