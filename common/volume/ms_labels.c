#include "ms_labels.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_SLOTS = 256 };

/* Multiplicative hashing (Knuth, vol. 3, 6.4); n_slots is a power of two. The high bits of the product depend on all
 * of the label, the low ones on its low ones alone. */
static size_t hash_label(const ms_labels *labels, uint32_t label)
{
    const uint32_t product = label * 2654435761u;
    return (size_t)(product ^ product >> 16) & (labels->n_slots - 1);
}

/* Where a label stands or would stand. */
static size_t seek_slot(const ms_labels *labels, uint32_t label)
{
    size_t at = hash_label(labels, label);
    while (labels->slot[at] && labels->entry[labels->slot[at] - 1].label != label) {
        at = (at + 1) & (labels->n_slots - 1);
    }
    return at;
}

/* Twice the slots, at most half of which are taken. */
static ms_status grow_table(ms_labels *labels, ms_error *err)
{
    const size_t slots = labels->n_slots ? 2 * labels->n_slots : FIRST_SLOTS;
    ms_label_entry *entry = realloc(labels->entry, slots / 2 * sizeof *entry);
    labels->entry = entry ? entry : labels->entry;
    uint32_t *slot = calloc(slots, sizeof *slot);
    if (!entry || !slot) {
        free(slot);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu labels", slots / 2);
    }
    free(labels->slot);
    labels->slot = slot;
    labels->n_slots = slots;
    labels->capacity = slots / 2;
    for (size_t e = 0; e < labels->count; e++) {
        slot[seek_slot(labels, labels->entry[e].label)] = (uint32_t)e + 1;
    }
    return MS_OK;
}

/* The entry of a label, a new one with an empty box if there is none; NULL without memory. */
static ms_label_entry *need_entry(ms_labels *labels, uint32_t label, ms_error *err)
{
    size_t at = seek_slot(labels, label);
    if (labels->slot[at]) {
        return &labels->entry[labels->slot[at] - 1];
    }
    if (labels->count == labels->capacity) {
        if (grow_table(labels, err) != MS_OK) {
            return NULL;
        }
        at = seek_slot(labels, label);
    }
    ms_label_entry *entry = &labels->entry[labels->count++];
    *entry = (ms_label_entry){.label = label, .lo = {labels->n[0], labels->n[1], labels->n[2]}};
    labels->slot[at] = (uint32_t)labels->count;
    return entry;
}

/* Voxels from lo to hi of row (y, z). */
static void add_run(ms_label_entry *entry, const int n[3], int lo, int hi, int y, int z)
{
    const int first[3] = {lo, y, z}, last[3] = {hi - 1, y, z};
    entry->voxels += (size_t)(hi - lo);
    for (int a = 0; a < 3; a++) {
        entry->lo[a] = first[a] < entry->lo[a] ? first[a] : entry->lo[a];
        entry->hi[a] = last[a] + 1 > entry->hi[a] ? last[a] + 1 : entry->hi[a];
        entry->cut |= first[a] == 0 || last[a] == n[a] - 1;
    }
}

ms_status ms_labels_begin(ms_labels *labels, const int n[3], ms_error *err)
{
    *labels = (ms_labels){.n = {n[0], n[1], n[2]}};
    const ms_status status = grow_table(labels, err);
    if (status != MS_OK) {
        ms_labels_free(labels);
    }
    return status;
}

ms_status ms_labels_add_slice(ms_labels *labels, const uint32_t *slice, int z, ms_error *err)
{
    const int nx = labels->n[0];
    for (int y = 0; y < labels->n[1]; y++) {
        const uint32_t *row = slice + (size_t)y * (size_t)nx;
        for (int lo = 0, hi; lo < nx; lo = hi) {
            for (hi = lo + 1; hi < nx && row[hi] == row[lo];) {
                hi++;
            }
            ms_label_entry *entry = row[lo] ? need_entry(labels, row[lo], err) : NULL;
            if (entry) {
                add_run(entry, labels->n, lo, hi, y, z);
            } else if (row[lo]) {
                ms_labels_free(labels);
                return MS_ERR_NOMEM;
            }
        }
    }
    return MS_OK;
}

static int compare_labels(const void *a, const void *b)
{
    const uint32_t x = ((const ms_label_entry *)a)->label, y = ((const ms_label_entry *)b)->label;
    return (x > y) - (x < y);
}

void ms_labels_end(ms_labels *labels)
{
    if (labels->count > 0) {
        qsort(labels->entry, labels->count, sizeof *labels->entry, compare_labels);
    }
    free(labels->slot);
    labels->slot = NULL;
    labels->n_slots = 0;
}

ms_status ms_labels_find(ms_labels *labels, const ms_volume *volume, ms_error *err)
{
    const size_t slice = (size_t)volume->n[0] * (size_t)volume->n[1];
    ms_status status = ms_labels_begin(labels, volume->n, err);
    for (int z = 0; z < volume->n[2] && status == MS_OK; z++) {
        status = ms_labels_add_slice(labels, volume->label + (size_t)z * slice, z, err);
    }
    if (status == MS_OK) {
        ms_labels_end(labels);
    }
    return status;
}

static ms_status add_slices(ms_labels *labels, const ms_scan *scan, uint32_t *slice, ms_error *err)
{
    for (int z = 0; z < scan->n[2]; z++) {
        const int lo[3] = {0, 0, z}, hi[3] = {scan->n[0], scan->n[1], z + 1};
        ms_status status = ms_scan_take(slice, scan, lo, hi, err);
        if (status == MS_OK) {
            status = ms_labels_add_slice(labels, slice, z, err);
        }
        if (status != MS_OK) {
            return status;
        }
    }
    ms_labels_end(labels);
    return labels->count ? MS_OK
                         : ms_fail(err, MS_ERR_SHAPE,
                                   "%s: has no label: all %d x %d x %d voxels are 0, background; label the grains",
                                   scan->path, scan->n[0], scan->n[1], scan->n[2]);
}

ms_status ms_labels_find_in_scan(ms_labels *labels, const ms_scan *scan, ms_error *err)
{
    ms_status status = ms_labels_begin(labels, scan->n, err);
    if (status != MS_OK) {
        return status;
    }
    uint32_t *slice = malloc((size_t)scan->n[0] * (size_t)scan->n[1] * sizeof *slice);
    status = slice ? add_slices(labels, scan, slice, err)
                   : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for a slice", scan->path);
    free(slice);
    if (status != MS_OK) {
        ms_labels_free(labels);
    }
    return status;
}

const ms_label_entry *ms_labels_entry(const ms_labels *labels, uint32_t label)
{
    const ms_label_entry key = {.label = label};
    return labels->count ? bsearch(&key, labels->entry, labels->count, sizeof key, compare_labels) : NULL;
}

void ms_labels_free(ms_labels *labels)
{
    free(labels->entry);
    free(labels->slot);
    *labels = (ms_labels){0};
}

/* Room for the box of a label. */
static ms_status make_crop(ms_volume *crop, const ms_label_entry *entry, double spacing, const double origin[3],
                           ms_error *err)
{
    *crop = (ms_volume){.spacing = spacing, .origin = {origin[0], origin[1], origin[2]}};
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        crop->n[a] = entry->hi[a] - entry->lo[a];
        crop->first[a] = entry->lo[a];
        count *= (size_t)crop->n[a];
    }
    crop->label = malloc(count * sizeof *crop->label);
    if (!crop->label) {
        *crop = (ms_volume){0};
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the box of label %lu", (unsigned long)entry->label);
    }
    return MS_OK;
}

ms_status ms_labels_crop(ms_volume *crop, const ms_volume *volume, const ms_label_entry *entry, ms_error *err)
{
    const ms_status status = make_crop(crop, entry, volume->spacing, volume->origin, err);
    const size_t nx = (size_t)crop->n[0], rows = (size_t)crop->n[1] * (size_t)crop->n[2];
    for (size_t r = 0; r < rows && status == MS_OK; r++) {
        const size_t y = (size_t)entry->lo[1] + r % (size_t)crop->n[1],
                     z = (size_t)entry->lo[2] + r / (size_t)crop->n[1];
        const uint32_t *from =
            volume->label + (z * (size_t)volume->n[1] + y) * (size_t)volume->n[0] + (size_t)entry->lo[0];
        for (size_t x = 0; x < nx; x++) {
            crop->label[r * nx + x] = from[x] == entry->label ? entry->label : 0;
        }
    }
    return status;
}

ms_status ms_labels_crop_scan(ms_volume *crop, const ms_scan *scan, const ms_label_entry *entry, ms_error *err)
{
    ms_status status = make_crop(crop, entry, scan->spacing, scan->origin, err);
    if (status == MS_OK) {
        status = ms_scan_take(crop->label, scan, entry->lo, entry->hi, err);
    }
    const size_t count = (size_t)crop->n[0] * (size_t)crop->n[1] * (size_t)crop->n[2];
    for (size_t i = 0; i < count && status == MS_OK; i++) {
        crop->label[i] = crop->label[i] == entry->label ? entry->label : 0;
    }
    if (status != MS_OK) {
        ms_volume_free(crop);
    }
    return status;
}
