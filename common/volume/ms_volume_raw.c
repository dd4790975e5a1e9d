/* Voxels without a header: what they are is said beside the file. */
#include <string.h>

#include "ms_volume_formats.h"

ms_scan_options ms_scan_defaults(void)
{
    return (ms_scan_options){.connectivity = 26};
}

ms_status ms_scan_raw_type(ms_sample *sample, int *big_endian, const char *text, ms_error *err)
{
    static const struct {
        const char *name;
        ms_sample sample;
    } types[] = {
        {"u8", {MS_SAMPLE_UNSIGNED, 1}},  {"i8", {MS_SAMPLE_SIGNED, 1}},    {"u16", {MS_SAMPLE_UNSIGNED, 2}},
        {"i16", {MS_SAMPLE_SIGNED, 2}},   {"u32", {MS_SAMPLE_UNSIGNED, 4}}, {"i32", {MS_SAMPLE_SIGNED, 4}},
        {"u64", {MS_SAMPLE_UNSIGNED, 8}}, {"i64", {MS_SAMPLE_SIGNED, 8}},   {"f32", {MS_SAMPLE_FLOAT, 4}},
        {"f64", {MS_SAMPLE_FLOAT, 8}},
    };
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        const size_t length = strlen(types[i].name);
        const char *order = text + length;
        if (strncmp(text, types[i].name, length) == 0 &&
            (!*order || strcmp(order, "le") == 0 || strcmp(order, "be") == 0)) {
            *sample = types[i].sample;
            *big_endian = *order == 'b';
            return MS_OK;
        }
    }
    return ms_fail(
        err, MS_ERR_ARG,
        "'%.40s' is no type of voxels; it is u, i or f and 8, 16, 32 or 64, with be behind it if the highest "
        "byte comes first, as u16 or f32be",
        text);
}

ms_status ms_volume_parse_raw(ms_stored *stored, const ms_bytes *bytes, const char *path,
                              const ms_scan_options *options, ms_error *err)
{
    ms_volume_header header = ms_volume_header_start(SIZE_MAX);
    size_t voxels = 0;
    *stored = (ms_stored){0};
    if (options->raw_n[0] == 0 || options->raw_sample.size == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: has no header; say what it holds (raw-size X,Y,Z and raw-type, as u16)",
                       path);
    }
    memcpy(header.n, options->raw_n, sizeof header.n);
    header.sample = options->raw_sample;
    header.big_endian = options->raw_big_endian;
    const ms_status status = ms_volume_data_size(&voxels, &header, path, err);
    if (status != MS_OK) {
        return status;
    }
    const size_t skip = (size_t)options->raw_skip;
    if (skip > bytes->size || bytes->size - skip != voxels) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: %lld x %lld x %lld voxels of %zu bytes behind %zu others would be %zu bytes and the file has "
            "%zu; check raw-size, raw-type and raw-skip",
            path, (long long)header.n[0], (long long)header.n[1], (long long)header.n[2], header.sample.size, skip,
            voxels + skip, bytes->size);
    }
    return ms_volume_store(stored, &header, bytes->data + skip, voxels, path, err);
}
