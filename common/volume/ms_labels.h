/** Which labels a volume holds: one pass tells voxels, box and border of each. */
#ifndef MS_LABELS_H
#define MS_LABELS_H

#include "ms_scan.h"

MS_C_BEGIN

/** One label. */
typedef struct ms_label_entry {
    uint32_t label; /* above 0 */
    size_t voxels;
    int lo[3], hi[3]; /* box lo <= (i, j, k) < hi */
    int cut;          /* nonzero: a voxel lies on the border of the volume, which may have cut the grain */
} ms_label_entry;

/** All labels of a volume, ascending. A zeroed struct is empty. */
typedef struct ms_labels {
    ms_label_entry *entry;
    size_t count;
    size_t capacity; /* of entry */
    uint32_t *slot;  /* entries by hash, 0 for none, else 1 + index; while they are collected */
    size_t n_slots;  /* a power of two */
    int n[3];        /* extents of the whole volume */
} ms_labels;

/**
 * The labels of a volume.
 *
 * @param[out] labels the caller frees it; empty on failure
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: one pass over the volume, a look-up for each run of equal voxels along x; the number of labels otherwise.
 */
MS_API ms_status ms_labels_find(ms_labels *labels, const ms_volume *volume, ms_error *err);

/** The same piece by piece, for volumes that are not in memory at once: begin, then each slice (n[0]*n[1] voxels at
 * height z), then end. On failure the labels are empty. */
MS_API ms_status ms_labels_begin(ms_labels *labels, const int n[3], ms_error *err);
MS_API ms_status ms_labels_add_slice(ms_labels *labels, const uint32_t *slice, int z, ms_error *err);
MS_API void ms_labels_end(ms_labels *labels);

/** The same of a volume that is on the disk; a slice at a time is in memory. @return also as ms_scan_take; MS_ERR_SHAPE
 * without a label */
MS_API ms_status ms_labels_find_in_scan(ms_labels *labels, const ms_scan *scan, ms_error *err);

/** The entry of a label; NULL if the volume has no voxel of it. Cost: O(log labels). */
MS_API const ms_label_entry *ms_labels_entry(const ms_labels *labels, uint32_t label);

MS_API void ms_labels_free(ms_labels *labels);

/**
 * The voxels of a label alone, all others 0, as a volume of the size of its box.
 *
 * @param[out] crop the caller frees it; its `first` is where the box lies; empty on failure
 * @return MS_OK; MS_ERR_NOMEM
 */
MS_API ms_status ms_labels_crop(ms_volume *crop, const ms_volume *volume, const ms_label_entry *entry, ms_error *err);

/** The same of a volume that is on the disk, of which that box alone is read. @return also as ms_scan_take */
MS_API ms_status ms_labels_crop_scan(ms_volume *crop, const ms_scan *scan, const ms_label_entry *entry, ms_error *err);

MS_C_END

#endif
