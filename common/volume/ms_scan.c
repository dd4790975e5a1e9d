#include "ms_scan.h"

#include <stdlib.h>
#include <string.h>

#include "ms_scan_store.h"
#include "ms_volume_table.h"

/* Spacings along x, y and z that were given stand for those of the file. */
static void set_spacing(ms_volume_header *header, const double spacing[3])
{
    for (int f = 0; f < 3 && spacing[0] > 0; f++) {
        header->spacing[f] = spacing[header->axis[f]];
    }
}

/* What the voxels lie in, if that may be mapped. */
static const ms_bytes *find_source(const ms_scan_store *store, const ms_bytes *bytes)
{
    return store->stored.owned.mapped ? &store->stored.owned : store->stored.owned.data ? NULL : bytes;
}

/* The voxels are stored; `bytes` are those of the file or NULL. */
static ms_status finish(ms_scan *scan, const ms_bytes *bytes, const ms_scan_options *options, size_t max_voxels,
                        ms_error *err)
{
    ms_scan_store *store = scan->store;
    const size_t size = store->stored.header.sample.size;
    set_spacing(&store->stored.header, options->spacing);
    store->source = find_source(store, bytes);
    ms_status status = ms_volume_check_geometry(&store->stored.header, store->path, err);
    if (status == MS_OK) {
        status = ms_scan_store_lattice(scan, err);
    }
    if (status == MS_OK && options->values != MS_SCAN_LABELS) {
        status = ms_scan_store_segment(scan, options, max_voxels, err);
    }
    const int64_t *n = store->stored.header.n;
    scan->held = store->label ? sizeof *store->label * (size_t)scan->n[0] * (size_t)scan->n[1] * (size_t)scan->n[2]
                 : store->source && store->source->mapped ? 0
                                                          : size * (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    if (status == MS_OK && store->label) { /* what they were made of is not needed any more */
        ms_volume_stored_free(&store->stored);
        store->source = NULL;
    }
    return status;
}

ms_status ms_scan_store_open(ms_scan *scan, ms_stored *stored, const ms_bytes *bytes, const char *path,
                             const ms_scan_options *options, size_t max_voxels, ms_error *err)
{
    *scan = (ms_scan){.store = calloc(1, sizeof *scan->store)};
    scan->path = scan->store ? scan->store->path = strdup(path) : NULL;
    if (!scan->path) {
        ms_volume_stored_free(stored);
        ms_scan_close(scan);
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to open it", path);
    }
    scan->store->stored = *stored;
    const ms_status status = finish(scan, bytes, options, max_voxels, err);
    if (status != MS_OK) {
        ms_scan_close(scan);
    }
    return status;
}

ms_status ms_scan_parse(ms_scan *scan, const ms_bytes *bytes, const char *path, const ms_scan_options *options,
                        size_t max_voxels, ms_error *err)
{
    ms_stored stored;
    *scan = (ms_scan){0};
    ms_status status = ms_volume_table_parse(&stored, bytes, path, options, max_voxels, err);
    if (status == MS_OK) {
        status = ms_scan_store_open(scan, &stored, bytes, path, options, max_voxels, err);
    }
    if (status == MS_OK) {
        scan->checksum = ms_file_checksum(bytes);
    }
    return status;
}

static ms_status open_folder(ms_scan *scan, const char *path, const ms_scan_options *options, size_t max_voxels,
                             ms_error *err)
{
    ms_stored stored;
    uint64_t checksum;
    ms_status status = ms_volume_table_read_slices(&stored, &checksum, path, max_voxels, err);
    if (status == MS_OK) {
        status = ms_scan_store_open(scan, &stored, NULL, path, options, max_voxels, err);
    }
    if (status == MS_OK) {
        scan->checksum = checksum;
    }
    return status;
}

ms_status ms_scan_open(ms_scan *scan, const char *path, const ms_scan_options *options, size_t max_voxels,
                       ms_error *err)
{
    ms_bytes bytes = {0};
    *scan = (ms_scan){0};
    if (ms_volume_table_is_folder(path)) {
        return open_folder(scan, path, options, max_voxels, err);
    }
    /* Without a format parse says so. */
    ms_status status = ms_volume_is_volume_path(path) ? ms_file_map(&bytes, path, err) : MS_OK;
    if (status == MS_OK) {
        status = ms_scan_parse(scan, &bytes, path, options, max_voxels, err);
    }
    if (status == MS_OK && scan->store->source == &bytes) {
        scan->store->bytes = bytes;
        scan->store->source = &scan->store->bytes;
    } else {
        ms_file_free(&bytes);
    }
    return status;
}

void ms_scan_close(ms_scan *scan)
{
    if (scan->store) {
        for (int a = 0; a < 3; a++) {
            free(scan->store->axis[a].near);
            free(scan->store->axis[a].low);
            free(scan->store->axis[a].high);
            free(scan->store->axis[a].weight);
        }
        ms_volume_stored_free(&scan->store->stored);
        ms_file_free(&scan->store->bytes);
        free(scan->store->label);
        free(scan->store->path);
        free(scan->store);
    }
    *scan = (ms_scan){0};
}
