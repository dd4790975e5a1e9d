/* Labels of a box of voxels, from where they are stored. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_scan_store.h"

void ms_scan_store_place(size_t place[3], const ms_scan_store *store, const uint8_t *at)
{
    size_t voxel = (size_t)(at - store->stored.data) / store->stored.header.sample.size;
    for (int f = 0; f < 3; f++) {
        place[f] = voxel % (size_t)store->stored.header.n[f];
        voxel /= (size_t)store->stored.header.n[f];
    }
}

static ms_status fail_value(double value, const uint8_t *at, const ms_scan_store *store, ms_error *err)
{
    size_t p[3];
    ms_scan_store_place(p, store, at);
    return ms_fail(err, MS_ERR_FORMAT,
                   "%s: voxel (%zu, %zu, %zu) holds %.9g, which is no label (0, 1, 2, ...%s); make labels of grey "
                   "values by a threshold, or otsu, or by a program for images",
                   store->path, p[0], p[1], p[2], value,
                   store->stored.header.sample.kind == MS_SAMPLE_BOOL ? " up to 1 for bool" : " up to 4294967295");
}

/* Values that are labels as they stand: unsigned, in the order of bytes of this machine, one behind the other. */
static void widen(uint32_t *label, const uint8_t *at, size_t count, size_t size)
{
    if (size == 1) {
        for (size_t i = 0; i < count; i++) {
            label[i] = at[i];
        }
    } else if (size == 2) {
        for (size_t i = 0; i < count; i++) {
            uint16_t value;
            memcpy(&value, at + 2 * i, sizeof value);
            label[i] = value;
        }
    } else {
        memcpy(label, at, 4 * count);
    }
}

static int are_plain(const ms_scan_store *store)
{
    const ms_volume_header *h = &store->stored.header;
    return h->sample.kind == MS_SAMPLE_UNSIGNED && h->sample.size <= 4 && store->axis[0].step == h->sample.size &&
           (h->sample.size == 1 || h->big_endian == ms_volume_is_big_endian()) && h->slope == 1 && h->intercept == 0;
}

/* Any others, checked one by one. */
static ms_status convert(uint32_t *label, const uint8_t *row, int lo, int hi, const ms_scan_store *store, ms_error *err)
{
    const ms_volume_header *header = &store->stored.header;
    const double largest = header->sample.kind == MS_SAMPLE_BOOL ? 1.0 : (double)UINT32_MAX;
    for (int x = lo; x < hi; x++) {
        const uint8_t *at = row + store->axis[0].near[x];
        const double value = ms_volume_value(at, header);
        if (!(value >= 0.0 && value <= largest && value == floor(value))) {
            return fail_value(value, at, store, err);
        }
        label[x - lo] = (uint32_t)value;
    }
    return MS_OK;
}

/* Voxels lo <= x < hi of a row. */
static ms_status take_row(uint32_t *label, const ms_scan *scan, int lo, int hi, int y, int z, ms_error *err)
{
    const ms_scan_store *store = scan->store;
    const size_t count = (size_t)(hi - lo);
    if (store->label) {
        const size_t row = (size_t)z * (size_t)scan->n[1] + (size_t)y;
        memcpy(label, store->label + row * (size_t)scan->n[0] + (size_t)lo, count * sizeof *label);
        return MS_OK;
    }
    const uint8_t *row = store->stored.data + store->axis[1].near[y] + store->axis[2].near[z];
    if (are_plain(store)) {
        widen(label, row + store->axis[0].near[lo], count, store->stored.header.sample.size);
        return MS_OK;
    }
    return convert(label, row, lo, hi, store, err);
}

/* The pages of a slice of the file are not needed any more, if they are mapped. */
static void drop_slice(const ms_scan *scan, const int lo[3], const int hi[3], int z)
{
    const ms_scan_store *store = scan->store;
    const ms_scan_axis *axis = store->axis;
    if (store->source && !store->label && axis[0].step && axis[0].step < axis[1].step && axis[1].step < axis[2].step) {
        const size_t first = axis[0].near[lo[0]] + axis[1].near[lo[1]],
                     last = axis[0].near[hi[0] - 1] + axis[1].near[hi[1] - 1];
        const size_t begin = (size_t)(store->stored.data - store->source->data) + axis[2].near[z];
        ms_file_unneeded(store->source, begin + first, last - first + store->stored.header.sample.size);
    }
}

ms_status ms_scan_take(uint32_t *label, const ms_scan *scan, const int lo[3], const int hi[3], ms_error *err)
{
    for (int z = lo[2]; z < hi[2]; z++) {
        for (int y = lo[1]; y < hi[1]; y++) {
            const ms_status status = take_row(label, scan, lo[0], hi[0], y, z, err);
            if (status != MS_OK) {
                return status;
            }
            label += hi[0] - lo[0];
        }
        drop_slice(scan, lo, hi, z);
    }
    return MS_OK;
}

static ms_status check_labels(const ms_volume *volume, size_t count, const char *path, ms_error *err)
{
    for (size_t i = 0; i < count; i++) {
        if (volume->label[i] != 0) {
            return MS_OK;
        }
    }
    return ms_fail(err, MS_ERR_SHAPE, "%s: has no label: all %d x %d x %d voxels are 0, background; label the grains",
                   path, volume->n[0], volume->n[1], volume->n[2]);
}

ms_status ms_scan_store_check_count(const ms_scan *scan, size_t max_voxels, ms_error *err)
{
    const int *n = scan->n;
    const size_t nx = (size_t)n[0], ny = (size_t)n[1], nz = (size_t)n[2];
    const size_t most = max_voxels < SIZE_MAX / sizeof(uint64_t) ? max_voxels : SIZE_MAX / sizeof(uint64_t);
    if (nx <= most && ny <= most / nx && nz <= most / nx / ny) {
        return MS_OK;
    }
    return ms_fail(err, MS_ERR_LIMIT,
                   "%s: its %d x %d x %d voxels are more than the %zu allowed; crop it, or allow more memory",
                   scan->store->path, n[0], n[1], n[2], max_voxels);
}

ms_status ms_scan_volume(ms_volume *volume, const ms_scan *scan, size_t max_voxels, ms_error *err)
{
    const size_t count = (size_t)scan->n[0] * (size_t)scan->n[1] * (size_t)scan->n[2];
    *volume = (ms_volume){.spacing = scan->spacing};
    memcpy(volume->n, scan->n, sizeof volume->n);
    memcpy(volume->origin, scan->origin, sizeof volume->origin);
    ms_status status = ms_scan_store_check_count(scan, max_voxels, err);
    if (status == MS_OK) {
        volume->label = malloc(count * sizeof *volume->label);
        status = volume->label ? ms_scan_take(volume->label, scan, (const int[3]){0, 0, 0}, scan->n, err)
                               : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its %zu voxels; crop it",
                                         scan->store->path, count);
    }
    if (status == MS_OK) {
        status = check_labels(volume, count, scan->store->path, err);
    }
    if (status != MS_OK) {
        ms_volume_free(volume);
    }
    return status;
}
