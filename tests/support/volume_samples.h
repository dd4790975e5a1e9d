/** A small volume whose three extents differ, and what a parser must say of a sample. */
#ifndef VOLUME_SAMPLES_H
#define VOLUME_SAMPLES_H

#include "reader_samples.h"
#include "volume/ms_scan_store.h"

enum { NX = 2, NY = 3, NZ = 4, N_VOXELS = NX * NY * NZ };

typedef ms_volume_parser volume_parser;

/* No symmetry that would hide two axes in the wrong order; fits into a bool where asked. */
static inline uint32_t known_label(int i, uint32_t largest)
{
    return (uint32_t)(i * i + 3 * i / 5 + 1) % 101 % (largest + 1);
}

/* x fastest; `kind` is i, u, b or f. */
static inline void put_voxels(sample *to, char kind, size_t size, int big_endian, uint32_t largest)
{
    for (int i = 0; i < N_VOXELS; i++) {
        uint32_t label = known_label(i, largest);
        if (kind != 'f') {
            put_integer(to, label, size, big_endian);
        } else if (size == 4) {
            put_float32(to, label, big_endian);
        } else {
            put_float64(to, label, big_endian);
        }
    }
}

/* The labels of what the parser finds. */
static inline ms_status volume_of(ms_volume *volume, volume_parser *parse, const ms_bytes *bytes, const char *path,
                                  const ms_scan_options *options, ms_error *err)
{
    ms_stored stored;
    ms_scan scan = {0};
    *volume = (ms_volume){0};
    ms_status status = parse(&stored, bytes, path, SIZE_MAX, err);
    if (status == MS_OK) {
        status = ms_scan_store_open(&scan, &stored, bytes, path, options, SIZE_MAX, err);
    } else {
        assert_null(stored.data);
        assert_null(stored.owned.data);
    }
    if (status == MS_OK) {
        status = ms_scan_volume(volume, &scan, SIZE_MAX, err);
    }
    ms_scan_close(&scan);
    return status;
}

static inline ms_status parse_volume(ms_volume *volume, volume_parser *parse, const sample *from, const char *path,
                                     ms_error *err)
{
    ms_bytes bytes = copy_bytes(from->data, from->size);
    const ms_scan_options options = ms_scan_defaults();
    const ms_status status = volume_of(volume, parse, &bytes, path, &options, err);
    ms_file_free(&bytes);
    return status;
}

static inline void expect_volume(volume_parser *parse, const sample *from, const char *path, uint32_t largest)
{
    ms_volume volume;
    ms_error err = {{0}};
    if (parse_volume(&volume, parse, from, path, &err) != MS_OK) {
        fail_msg("refused: %s", err.text);
    }
    assert_true(volume.n[0] == NX && volume.n[1] == NY && volume.n[2] == NZ);
    for (int i = 0; i < N_VOXELS; i++) {
        assert_int_equal(volume.label[i], known_label(i, largest));
    }
    ms_volume_free(&volume);
    assert_null(volume.label);
}

static inline void expect_volume_refused(volume_parser *parse, const sample *from, ms_status status,
                                         const char *message)
{
    ms_volume volume;
    ms_error err = {{0}};
    ms_status got = parse_volume(&volume, parse, from, "sample", &err);
    if (got != status) {
        fail_msg("status %d and not %d where \"%s\" was expected: \"%s\"", got, status, message, err.text);
    }
    expect_message(&err, "sample: ");
    expect_message(&err, message);
    assert_null(volume.label);
    assert_int_equal(volume.n[0], 0);
    assert_int_equal(parse_volume(&volume, parse, from, "sample", NULL), status);
}

/** A text that must be refused as malformed, and a part of the message. */
typedef struct refused_header {
    const char *text;
    const char *message;
} refused_header;

static inline void expect_headers_refused(volume_parser *parse, const refused_header *cases, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        sample made = {.size = 0};
        put_text(&made, cases[i].text);
        expect_volume_refused(parse, &made, MS_ERR_FORMAT, cases[i].message);
    }
}

#endif
