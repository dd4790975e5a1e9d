#include "ms_label_list.h"

#include <stdlib.h>

#include "ms_json_object.h"
#include "voxel/ms_target.h"

static ms_status count_pieces(ms_label_row *row, const ms_scan *scan, ms_error *err)
{
    ms_volume crop;
    ms_target target;
    ms_status status = ms_labels_crop_scan(&crop, scan, row->entry, err);
    if (status == MS_OK) {
        status = ms_target_voxels_from_volume(&target, &crop, row->entry->label, err);
        ms_volume_free(&crop);
    }
    if (status == MS_OK) {
        row->pieces = target.pieces;
        row->largest_piece = target.largest_piece;
        ms_target_free(&target);
    }
    return status;
}

ms_status ms_label_list_make(ms_label_row **row, const ms_labels *labels, const ms_scan *scan, ms_error *err)
{
    *row = calloc(labels->count + 1, sizeof **row);
    ms_status status = *row ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu labels", labels->count);
    for (size_t l = 0; l < labels->count && status == MS_OK; l++) {
        (*row)[l].entry = &labels->entry[l];
        status = count_pieces(&(*row)[l], scan, err);
    }
    if (status != MS_OK) {
        free(*row);
        *row = NULL;
    }
    return status;
}

void ms_label_list_print(FILE *stream, const ms_label_row *row, size_t count)
{
    fprintf(stream, "%10s %12s %20s %17s %7s  %s\n", "label", "voxels", "box from", "box size", "pieces", "border");
    for (size_t l = 0; l < count; l++) {
        const ms_label_entry *e = row[l].entry;
        char from[48], size[48];
        snprintf(from, sizeof from, "%d,%d,%d", e->lo[0], e->lo[1], e->lo[2]);
        snprintf(size, sizeof size, "%d,%d,%d", e->hi[0] - e->lo[0], e->hi[1] - e->lo[1], e->hi[2] - e->lo[2]);
        fprintf(stream, "%10lu %12zu %20s %17s %7zu  %s\n", (unsigned long)e->label, e->voxels, from, size,
                row[l].pieces, e->cut ? "cuts it" : "");
    }
}

json_t *ms_label_list_json(const ms_label_row *row, size_t count)
{
    json_t *list = json_array();
    for (size_t l = 0; l < count; l++) {
        const ms_label_entry *e = row[l].entry;
        ms_json_object_append(&list, json_pack("{s:I,s:I,s:[i,i,i],s:[i,i,i],s:I,s:I,s:b}", "label",
                                               (json_int_t)e->label, "voxels", (json_int_t)e->voxels, "box_lo",
                                               e->lo[0], e->lo[1], e->lo[2], "box_hi", e->hi[0], e->hi[1], e->hi[2],
                                               "pieces", (json_int_t)row[l].pieces, "largest_piece",
                                               (json_int_t)row[l].largest_piece, "cut_by_border", e->cut != 0));
    }
    return list;
}
