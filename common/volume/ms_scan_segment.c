/* From grey values to labels: a threshold, and the components of what is above it. */
#include <math.h>
#include <stdlib.h>

#include "ms_components.h"
#include "ms_otsu.h"
#include "ms_scan_store.h"

enum { BINS = 1 << 16 };

/* Least and largest of the values stored. */
typedef struct grey_range {
    double lo, hi;
} grey_range;

/* What a pass over the voxels as they are stored does with each value. */
typedef struct grey_pass {
    grey_range range;
    uint64_t *bin; /* NULL: the range is sought */
    double first, width;
} grey_pass;

static void take_value(grey_pass *pass, double value)
{
    if (pass->bin) {
        const double at = floor((value - pass->first) / pass->width);
        pass->bin[at < BINS - 1 ? (size_t)fmax(at, 0) : BINS - 1]++;
    } else {
        pass->range.lo = fmin(pass->range.lo, value);
        pass->range.hi = fmax(pass->range.hi, value);
    }
}

static ms_status walk_values(grey_pass *pass, const ms_scan_store *store, ms_error *err)
{
    const ms_volume_header *header = &store->stored.header;
    const size_t size = header->sample.size, slice = (size_t)header->n[0] * (size_t)header->n[1] * size;
    for (int64_t z = 0; z < header->n[2]; z++) {
        const uint8_t *from = store->stored.data + (size_t)z * slice;
        for (const uint8_t *at = from; at < from + slice; at += size) {
            const double value = ms_volume_value(at, header);
            if (!isfinite(value)) {
                size_t p[3];
                ms_scan_store_place(p, store, at);
                return ms_fail(err, MS_ERR_FORMAT,
                               "%s: voxel (%zu, %zu, %zu) holds %g, which is no grey value; replace it by a number",
                               store->path, p[0], p[1], p[2], value);
            }
            take_value(pass, value);
        }
        if (store->source) {
            ms_file_unneeded(store->source, (size_t)(from - store->source->data), slice);
        }
    }
    return MS_OK;
}

/* Whole numbers of no more values than there are bins have a bin each. */
static void set_bins(grey_pass *pass, const ms_volume_header *header)
{
    const grey_range *r = &pass->range;
    if (header->sample.kind != MS_SAMPLE_FLOAT && header->slope == 1 && header->intercept == floor(header->intercept) &&
        r->hi - r->lo < BINS) {
        pass->first = r->lo - 0.5;
        pass->width = 1;
    } else {
        pass->first = r->lo;
        pass->width = (r->hi - r->lo) / BINS;
    }
}

/* Halfway between the classes. */
static ms_status find_otsu(double *threshold, grey_pass *pass, const ms_scan_store *store, ms_error *err)
{
    size_t below = 0, above = 0;
    set_bins(pass, &store->stored.header);
    pass->bin = calloc(BINS, sizeof *pass->bin);
    ms_status status = pass->bin ? walk_values(pass, store, err)
                                 : ms_fail(err, MS_ERR_NOMEM, "%s: no memory to sort its grey values", store->path);
    if (status == MS_OK && !ms_otsu_cut(&below, &above, pass->bin, BINS)) {
        status = ms_fail(err, MS_ERR_SHAPE, "%s: all its voxels hold %g, which no threshold divides; check the file",
                         store->path, pass->range.lo);
    }
    *threshold = pass->first + pass->width * (double)(below + 1 + above) / 2;
    free(pass->bin);
    pass->bin = NULL;
    return status;
}

/* Linear between the centres of stored voxels. */
static double interpolate(const ms_scan_store *store, const int p[3])
{
    double value = 0;
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        size_t at = 0;
        for (int a = 0; a < 3; a++) {
            const ms_scan_axis *axis = &store->axis[a];
            const int is_high = corner >> a & 1;
            weight *= is_high ? axis->weight[p[a]] : 1 - axis->weight[p[a]];
            at += is_high ? axis->high[p[a]] : axis->low[p[a]];
        }
        value += weight > 0 ? weight * ms_volume_value(store->stored.data + at, &store->stored.header) : 0;
    }
    return value;
}

static void mark_above(uint32_t *inside, const ms_scan *scan)
{
    const ms_scan_store *store = scan->store;
    int p[3];
    for (p[2] = 0; p[2] < scan->n[2]; p[2]++) {
        for (p[1] = 0; p[1] < scan->n[1]; p[1]++) {
            const uint8_t *row = store->stored.data + store->axis[1].near[p[1]] + store->axis[2].near[p[2]];
            for (p[0] = 0; p[0] < scan->n[0]; p[0]++) {
                const double value = scan->is_resampled
                                         ? interpolate(store, p)
                                         : ms_volume_value(row + store->axis[0].near[p[0]], &store->stored.header);
                *inside++ = value > scan->threshold;
            }
        }
    }
}

static ms_status make_labels(ms_scan *scan, const grey_range *range, int connectivity, ms_error *err)
{
    ms_scan_store *store = scan->store;
    ms_error cause;
    const size_t count = (size_t)scan->n[0] * (size_t)scan->n[1] * (size_t)scan->n[2];
    size_t components;
    store->label = malloc(count * sizeof *store->label);
    if (!store->label) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the labels of its %zu voxels; crop it", store->path,
                       count);
    }
    mark_above(store->label, scan);
    const ms_status status = ms_components_label(store->label, &components, scan->n, connectivity, &cause);
    if (status != MS_OK) {
        return ms_fail(err, status, "%s: %s", store->path, cause.text);
    }
    if (components == 0) {
        return ms_fail(err, MS_ERR_SHAPE, "%s: no voxel is above %g; its values are from %g to %g", store->path,
                       scan->threshold, range->lo, range->hi);
    }
    return MS_OK;
}

ms_status ms_scan_store_segment(ms_scan *scan, const ms_scan_options *options, size_t max_voxels, ms_error *err)
{
    grey_pass pass = {.range = {HUGE_VAL, -HUGE_VAL}};
    ms_status status = ms_scan_store_check_count(scan, max_voxels, err);
    if (status == MS_OK) {
        status = walk_values(&pass, scan->store, err);
    }
    scan->threshold = options->threshold;
    if (status == MS_OK && options->values == MS_SCAN_OTSU) {
        status = find_otsu(&scan->threshold, &pass, scan->store, err);
    }
    return status == MS_OK ? make_labels(scan, &pass.range, options->connectivity, err) : status;
}
