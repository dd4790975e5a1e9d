/* From the bytes of a volume file to labels. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_volume_formats.h"

/* Spacings that programs have written with six digits still count as equal. */
#define CUBE_TOLERANCE 1e-5

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
    if (product > header->max_voxels) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "%s: its %lld x %lld x %lld voxels are more than the %zu allowed; crop it, or "
                       "allow more memory",
                       path, (long long)n[0], (long long)n[1], (long long)n[2], header->max_voxels);
    }
    *size = product * header->sample.size;
    return MS_OK;
}

static ms_status check_geometry(const ms_volume_header *header, const char *path, ms_error *err)
{
    for (int axis = 0; axis < 3; axis++) {
        double spacing = header->spacing[axis];
        /* The negations also catch nan. */
        if (!(spacing >= SMALLEST && spacing <= LARGEST) || !(fabs(header->origin[axis]) <= FARTHEST * spacing)) {
            return ms_fail(err, MS_ERR_FORMAT,
                           "%s: along axis %d it has the spacing %g and the origin %g; spacings must be from %g to %g "
                           "and origins within %g voxels; choose another unit or origin",
                           path, axis, spacing, header->origin[axis], SMALLEST, LARGEST, FARTHEST);
        }
        if (!(fabs(spacing - header->spacing[0]) <= CUBE_TOLERANCE * header->spacing[0])) {
            return ms_fail(err, MS_ERR_FORMAT,
                           "%s: its voxels are %g x %g x %g and not cubes; resample it to equal spacings", path,
                           header->spacing[0], header->spacing[1], header->spacing[2]);
        }
    }
    return MS_OK;
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

/* Nonzero if the value is a label: a whole number from 0 to `largest`. */
static int to_label(uint32_t *label, double value, double largest)
{
    if (!(value >= 0.0 && value <= largest && value == floor(value))) {
        return 0;
    }
    *label = (uint32_t)value;
    return 1;
}

static ms_status fail_value(double value, size_t voxel, const ms_volume_header *header, const char *path, ms_error *err)
{
    size_t nx = (size_t)header->n[0];
    size_t ny = (size_t)header->n[1];
    return ms_fail(
        err, MS_ERR_FORMAT,
        "%s: voxel (%zu, %zu, %zu) holds %.9g, which is no label (0, 1, 2, ...%s); segment the grey values first", path,
        voxel % nx, voxel / nx % ny, voxel / nx / ny, value,
        header->sample.kind == MS_SAMPLE_BOOL ? " up to 1 for bool" : " up to 4294967295");
}

static ms_status fill_binary(ms_volume *volume, size_t count, const ms_volume_header *header, const uint8_t *data,
                             const char *path, ms_error *err)
{
    ms_sample sample = header->sample;
    double largest = sample.kind == MS_SAMPLE_BOOL ? 1.0 : (double)UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        uint64_t bits = load_sample(data + i * sample.size, sample.size, header->big_endian);
        if (sample.kind == MS_SAMPLE_UNSIGNED && bits <= UINT32_MAX) {
            volume->label[i] = (uint32_t)bits;
            continue;
        }
        double value = sample_to_double(bits, sample);
        if (!to_label(&volume->label[i], value, largest)) {
            return fail_value(value, i, header, path, err);
        }
    }
    return MS_OK;
}

static ms_status fill_text(ms_volume *volume, size_t count, const ms_volume_header *header, const ms_bytes *data,
                           const char *path, ms_error *err)
{
    ms_text text;
    ms_word word;
    ms_text_start(&text, data, path);
    for (size_t i = 0; i < count; i++) {
        double value;
        if (!ms_text_seek(&text)) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: its data end after %zu of %zu values; save it again", path, i,
                           count);
        }
        ms_text_word(&word, &text);
        if (!ms_text_to_double(&value, &word)) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: value %zu of its data is '%s' and no number; save it again", path,
                           i + 1, ms_text_quote(&word).text);
        }
        if (!to_label(&volume->label[i], value, (double)UINT32_MAX)) {
            return fail_value(value, i, header, path, err);
        }
    }
    if (ms_text_seek(&text)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: more data follow after its %zu values; save it again", path, count);
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

/* The data are unpacked: as many as the header claims, or text. */
static ms_status fill_unpacked(ms_volume *volume, const ms_volume_header *header, const ms_bytes *data,
                               size_t data_size, const char *path, ms_error *err)
{
    size_t count = data_size / header->sample.size;
    int is_text = header->coding == MS_CODING_TEXT;
    /* A value of text takes at least a digit and a blank. */
    if (is_text ? count > data->size / 2 + 1 : data->size != data_size) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: its header claims %lld x %lld x %lld voxels of %zu bytes (%zu) but there are %zu bytes of data; "
            "fetch or save it again",
            path, (long long)header->n[0], (long long)header->n[1], (long long)header->n[2], header->sample.size,
            data_size, data->size);
    }
    volume->label = malloc(count * sizeof *volume->label);
    if (!volume->label) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its %zu voxels; crop it", path, count);
    }
    for (int axis = 0; axis < 3; axis++) {
        volume->n[axis] = (int)header->n[axis];
        volume->origin[axis] = header->origin[axis];
    }
    volume->spacing = header->spacing[0];
    ms_status status = is_text ? fill_text(volume, count, header, data, path, err)
                               : fill_binary(volume, count, header, data->data, path, err);
    return status ? status : check_labels(volume, count, path, err);
}

/* The struct cannot hold borrowed bytes as const; they are not changed. */
static ms_bytes borrow_bytes(const uint8_t *data, size_t size)
{
    ms_bytes bytes = {NULL, size};
    memcpy(&bytes.data, &data, sizeof data);
    return bytes;
}

ms_status ms_volume_fill(ms_volume *volume, const ms_volume_header *header, const uint8_t *data, size_t size,
                         const char *path, ms_error *err)
{
    size_t data_size = 0;
    ms_bytes unpacked = {0};
    ms_bytes borrowed = borrow_bytes(data, size);
    *volume = (ms_volume){0};
    ms_status status = ms_volume_data_size(&data_size, header, path, err);
    if (!status) {
        status = check_geometry(header, path, err);
    }
    if (!status && header->coding == MS_CODING_DEFLATE) {
        status = ms_volume_inflate(&unpacked, data, size, data_size, path, err);
        borrowed = unpacked;
    }
    if (!status) {
        status = fill_unpacked(volume, header, &borrowed, data_size, path, err);
    }
    ms_file_free(&unpacked);
    if (status) {
        ms_volume_free(volume);
    }
    return status;
}

void ms_volume_free(ms_volume *volume)
{
    if (volume) {
        free(volume->label);
        *volume = (ms_volume){0};
    }
}
