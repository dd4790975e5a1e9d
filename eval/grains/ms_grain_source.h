/** A file that grains come from: a mesh, which is one grain, or a volume, of which each label is one. */
#ifndef MS_GRAIN_SOURCE_H
#define MS_GRAIN_SOURCE_H

#include <pthread.h>

#include "cli/ms_input.h"
#include "queue/ms_queue.h"
#include "volume/ms_labels.h"

/** One of them. */
typedef struct ms_grain_source {
    char *path;
    double bytes; /* of the file; of one that cannot be read 0 */
    int is_volume;
    /* Of a volume: it is opened when its labels are listed, and again by the first grain that needs it if it was not
     * kept; the last one closes it. Uncompressed voxels are mapped and take no memory but that of a grain's box. */
    uint64_t checksum; /* FNV-1a of the file */
    ms_labels labels;
    ms_input_origin origin;
    ms_scan scan;
    ms_status status; /* of the last reading */
    ms_error *cause;  /* NULL: a mesh, of which there may be a million */
    int is_kept;      /* the scan is open */
    size_t users;     /* grains that are still to need it */
    pthread_mutex_t lock;
} ms_grain_source;

/** Nothing is read yet. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_grain_source_begin(ms_grain_source *source, const char *path, ms_error *err);

/**
 * Opens a volume and lists its labels; what cannot be read has none, and its status says why.
 *
 * @param most bytes that the volume may hold for the grains; if it holds more it is closed again
 */
void ms_grain_source_list(ms_grain_source *source, const ms_input_flags *flags, double most);

/**
 * The shape of a grain, as ms_input_read leaves it: the mesh, or the box of the label's voxels.
 *
 * @param[out] input freed by ms_input_free; empty on failure
 * @param      label 0: a mesh
 * @param      place NULL where no other grain is at work
 * @return MS_OK; as ms_input_read; MS_ERR_SHAPE for a label that is not there; MS_ERR_NOMEM
 */
ms_status ms_grain_source_read(ms_grain_source *source, ms_input *input, uint32_t label, const ms_input_flags *flags,
                               ms_queue_place *place, ms_error *err);

/** A grain that is one of the users is done. */
void ms_grain_source_release(ms_grain_source *source);

void ms_grain_source_end(ms_grain_source *source);

#endif
