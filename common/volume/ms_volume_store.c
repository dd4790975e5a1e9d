/* From the bytes of a volume file to voxels as they are stored. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_volume_formats.h"

/* Inertia goes with the fifth power of a length, which must neither overflow nor vanish. */
static const double SMALLEST = 1e-50, LARGEST = 1e50;

/* Of the origin, in voxels: of doubles farther out the last digits no longer tell places within a voxel apart. */
static const double FARTHEST = 1e12;

ms_status ms_volume_data_size(size_t *size, const ms_volume_header *header, const char *path, ms_error *err)
{
    const int64_t *n = header->n;
    size_t product = 1;
    /* No voxel of the stored size nor label of 4 bytes may overflow. */
    size_t limit = SIZE_MAX / (2 * sizeof(uint64_t));
    for (int axis = 0; axis < 3; axis++) {
        if (n[axis] < 1) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: has no voxels: its extents are %lld x %lld x %lld; save it again",
                           path, (long long)n[0], (long long)n[1], (long long)n[2]);
        }
        if (n[axis] > INT_MAX || product > limit / (size_t)n[axis]) {
            return ms_fail(err, MS_ERR_LIMIT, "%s: its header claims %lld x %lld x %lld voxels, too many; crop it",
                           path, (long long)n[0], (long long)n[1], (long long)n[2]);
        }
        product *= (size_t)n[axis];
    }
    /* What is raw is not held. */
    if (header->coding != MS_CODING_RAW && product > header->max_voxels) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "%s: its %lld x %lld x %lld voxels are more than the %zu allowed; crop it, or "
                       "allow more memory",
                       path, (long long)n[0], (long long)n[1], (long long)n[2], header->max_voxels);
    }
    *size = product * header->sample.size;
    return MS_OK;
}

ms_status ms_volume_check_geometry(const ms_volume_header *header, const char *path, ms_error *err)
{
    for (int axis = 0; axis < 3; axis++) {
        const double spacing = header->spacing[axis], origin = header->origin[header->axis[axis]];
        /* The negations also catch nan. */
        if (!(spacing >= SMALLEST && spacing <= LARGEST) || !(fabs(origin) <= FARTHEST * spacing)) {
            return ms_fail(err, MS_ERR_FORMAT,
                           "%s: along axis %d it has the spacing %g and the origin %g; spacings must be from %g to %g "
                           "and origins within %g voxels; choose another unit or origin",
                           path, axis, spacing, origin, SMALLEST, LARGEST, FARTHEST);
        }
    }
    return MS_OK;
}

int ms_volume_is_big_endian(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 0;
}

static uint64_t load_sample(const uint8_t *at, size_t size, int big_endian)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        bits = bits << 8 | at[big_endian ? i : size - 1 - i];
    }
    return bits;
}

static double sample_to_double(uint64_t bits, ms_sample sample)
{
    double wide;
    float narrow;
    uint32_t half = (uint32_t)bits;
    if (sample.kind == MS_SAMPLE_FLOAT && sample.size == 8) {
        memcpy(&wide, &bits, sizeof wide);
        return wide;
    }
    if (sample.kind == MS_SAMPLE_FLOAT) {
        memcpy(&narrow, &half, sizeof narrow);
        return (double)narrow;
    }
    if (sample.kind == MS_SAMPLE_SIGNED) {
        /* The sign bit moves to the top and, dividing, back again. */
        unsigned shift = (unsigned)(64 - 8 * sample.size);
        return (double)((int64_t)(bits << shift) / ((int64_t)1 << shift));
    }
    return (double)bits;
}

double ms_volume_value(const uint8_t *at, const ms_volume_header *header)
{
    const double value = sample_to_double(load_sample(at, header->sample.size, header->big_endian), header->sample);
    return header->slope * value + header->intercept;
}

/* Text becomes doubles. */
static ms_status store_text(ms_stored *stored, size_t count, const ms_bytes *data, const char *path, ms_error *err)
{
    ms_text text;
    ms_word word;
    double value;
    ms_text_start(&text, data, path);
    for (size_t i = 0; i < count; i++) {
        if (!ms_text_seek(&text)) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: its data end after %zu of %zu values; save it again", path, i,
                           count);
        }
        ms_text_word(&word, &text);
        if (!ms_text_to_double(&value, &word)) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: value %zu of its data is '%s' and no number; save it again", path,
                           i + 1, ms_text_quote(&word).text);
        }
        memcpy(stored->owned.data + i * sizeof value, &value, sizeof value);
    }
    if (ms_text_seek(&text)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: more data follow after its %zu values; save it again", path, count);
    }
    stored->header.sample = (ms_sample){MS_SAMPLE_FLOAT, sizeof value};
    stored->header.big_endian = ms_volume_is_big_endian();
    return MS_OK;
}

/* As many bytes as the header claims, or text that may hold as many values. */
static ms_status check_size(const ms_volume_header *header, size_t size, size_t data_size, const char *path,
                            ms_error *err)
{
    const int is_text = header->coding == MS_CODING_TEXT;
    /* A value of text takes at least a digit and a blank. */
    if (is_text ? data_size / header->sample.size <= size / 2 + 1 : size == data_size) {
        return MS_OK;
    }
    return ms_fail(
        err, MS_ERR_FORMAT,
        "%s: its header claims %lld x %lld x %lld voxels of %zu bytes (%zu) but there are %zu bytes of data; "
        "fetch or save it again",
        path, (long long)header->n[0], (long long)header->n[1], (long long)header->n[2], header->sample.size, data_size,
        size);
}

/* The struct cannot hold borrowed bytes as const; they are not changed. */
static ms_bytes borrow_bytes(const uint8_t *data, size_t size)
{
    ms_bytes bytes = {.size = size};
    memcpy(&bytes.data, &data, sizeof data);
    return bytes;
}

static ms_status unpack(ms_stored *stored, const uint8_t *data, size_t size, size_t data_size, const char *path,
                        ms_error *err)
{
    const ms_volume_header *header = &stored->header;
    const size_t count = data_size / header->sample.size;
    if (header->coding == MS_CODING_DEFLATE) {
        return ms_volume_inflate(&stored->owned, data, size, data_size, path, err);
    }
    ms_status status = check_size(header, size, data_size, path, err);
    if (status != MS_OK || header->coding == MS_CODING_RAW) {
        return status;
    }
    stored->owned = (ms_bytes){.data = malloc(count * sizeof(double)), .size = count * sizeof(double)};
    const ms_bytes text = borrow_bytes(data, size);
    return stored->owned.data ? store_text(stored, count, &text, path, err)
                              : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its %zu voxels; crop it", path, count);
}

ms_status ms_volume_store(ms_stored *stored, const ms_volume_header *header, const uint8_t *data, size_t size,
                          const char *path, ms_error *err)
{
    size_t data_size = 0;
    *stored = (ms_stored){.header = *header};
    ms_status status = ms_volume_data_size(&data_size, header, path, err);
    if (!status) {
        status = unpack(stored, data, size, data_size, path, err);
    }
    if (status) {
        ms_volume_stored_free(stored);
        return status;
    }
    stored->data = stored->owned.data ? stored->owned.data : data;
    return MS_OK;
}

ms_status ms_volume_keep_beside(ms_stored *stored, ms_bytes *beside, ms_status status)
{
    if (status == MS_OK && !stored->owned.data) {
        stored->owned = *beside;
    } else {
        ms_file_free(beside);
    }
    return status;
}

void ms_volume_stored_free(ms_stored *stored)
{
    ms_file_free(&stored->owned);
    *stored = (ms_stored){0};
}

void ms_volume_free(ms_volume *volume)
{
    if (volume) {
        free(volume->label);
        *volume = (ms_volume){0};
    }
}
