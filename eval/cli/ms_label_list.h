/** The labels of a volume, for people and for machines. */
#ifndef MS_LABEL_LIST_H
#define MS_LABEL_LIST_H

#include <jansson.h>
#include <stdio.h>

#include "volume/ms_labels.h"

/** A label and how many pieces that touch nowhere its voxels are in. */
typedef struct ms_label_row {
    const ms_label_entry *entry;  /* borrowed */
    size_t pieces, largest_piece; /* the latter in voxels */
} ms_label_row;

/**
 * Counts the pieces of each label.
 *
 * @param[out] row labels->count rows, freed by free(); NULL on failure
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: the boxes of all labels together.
 */
ms_status ms_label_list_make(ms_label_row **row, const ms_labels *labels, const ms_scan *scan, ms_error *err);

/** A line each: label, voxels, box in voxels, pieces, whether the border cuts it. */
void ms_label_list_print(FILE *stream, const ms_label_row *row, size_t count);

/** An array of objects; boxes in voxels, lo <= (i, j, k) < hi. The caller owns it. */
json_t *ms_label_list_json(const ms_label_row *row, size_t count);

#endif
