/** Volumes as input: their flags, and how their voxels became labels. */
#ifndef MS_INPUT_VOLUME_H
#define MS_INPUT_VOLUME_H

#include <jansson.h>

#include "volume/ms_labels.h"

/* clang-format off */
#define MS_INPUT_VOLUME_FLAGS \
    {"label", 0, "L", "the label of a volume to take"}, \
    {"threshold", 0, "T", "grey values above T are grains; the labels are their connected components"}, \
    {"otsu", 0, NULL, "the same with Otsu's threshold"}, \
    {"connectivity", 0, "6|18|26", "voxels of one component share faces, or edges, or corners (26)"}, \
    {"voxel-spacing", 0, "X,Y,Z", "edges of a voxel of a volume, in place of those of its file"}, \
    {"raw-size", 0, "X,Y,Z", "voxels of a raw file along its axes, the fastest first"}, \
    {"raw-type", 0, "TYPE", "of a raw file: u, i or f, bits, be if the highest byte comes first: u8, u16, f32be"}, \
    {"raw-skip", 0, "BYTES", "of a raw file, before its voxels (0)"}
/* clang-format on */

/** Takes a flag if it is one of MS_INPUT_VOLUME_FLAGS but --label. @param[out] taken 0 if it is not */
ms_status ms_input_volume_flag(int *taken, ms_scan_options *options, const char *name, const char *value,
                               ms_error *err);

/** Where labels come from. */
typedef struct ms_input_origin {
    ms_scan_values values;
    double threshold; /* of grey values */
    int connectivity;
    int is_resampled;
    double stored_spacing[3]; /* of the file, if voxels are not its own */
    int largest_piece;        /* nonzero: of the label the largest piece alone was taken */
} ms_input_origin;

/**
 * Opens a volume and lists its labels; says on stderr if voxels were resampled or grey values divided.
 *
 * @param[out] scan, labels the caller closes and frees them; empty on failure
 * @return as ms_scan_open, ms_labels_find_in_scan
 */
ms_status ms_input_volume_open(ms_scan *scan, ms_labels *labels, ms_input_origin *origin, const char *path,
                               const ms_scan_options *options, size_t max_voxels, ms_error *err);

/** For the record: what there is to say of the origin, as keys; none for the labels of the file itself. */
json_t *ms_input_volume_json(const ms_input_origin *origin);

#endif
