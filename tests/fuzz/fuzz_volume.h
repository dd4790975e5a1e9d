/** A fuzz target of one parser of volumes. */
#ifndef FUZZ_VOLUME_H
#define FUZZ_VOLUME_H

#include "fuzz.h"
#include "volume/ms_scan_store.h"

static inline void fuzz_check_volume(const ms_volume *volume)
{
    uint32_t largest = 0;
    FUZZ_REQUIRE(volume->n[0] > 0 && volume->n[1] > 0 && volume->n[2] > 0);
    FUZZ_REQUIRE(isfinite(volume->spacing) && volume->spacing > 0.0);
    size_t count = (size_t)volume->n[0] * (size_t)volume->n[1] * (size_t)volume->n[2];
    for (size_t i = 0; i < count; i++) {
        largest = volume->label[i] > largest ? volume->label[i] : largest;
    }
    FUZZ_REQUIRE(largest > 0);
    for (int axis = 0; axis < 3; axis++) {
        FUZZ_REQUIRE(isfinite(volume->origin[axis]));
    }
}

/* What a file claims must not fill the memory of the fuzzer. */
enum { FUZZ_VOXELS = 1 << 22 };

/* Labels, or grey values that become labels, of what the parser found, which is taken over. */
static inline ms_status fuzz_take_volume(ms_volume *volume, ms_stored *stored, const ms_bytes *bytes,
                                         ms_scan_values values, ms_error *err)
{
    ms_scan scan;
    ms_scan_options options = ms_scan_defaults();
    options.values = values;
    ms_status status = ms_scan_store_open(&scan, stored, bytes, "fuzz", &options, FUZZ_VOXELS, err);
    if (status == MS_OK) {
        status = ms_scan_volume(volume, &scan, FUZZ_VOXELS, err);
    }
    ms_scan_close(&scan);
    return status;
}

static inline int fuzz_volume(ms_volume_parser *parse, const uint8_t *data, size_t size)
{
    for (ms_scan_values values = MS_SCAN_LABELS; values <= MS_SCAN_OTSU; values++) {
        ms_volume volume = {0};
        ms_stored stored;
        ms_error err = {{0}};
        ms_bytes bytes = fuzz_bytes(data, size);
        ms_status status = parse(&stored, &bytes, "fuzz", FUZZ_VOXELS, &err);
        if (status == MS_OK) {
            status = fuzz_take_volume(&volume, &stored, &bytes, values, &err);
        } else {
            FUZZ_REQUIRE(!stored.data && !stored.owned.data);
        }
        if (status == MS_OK) {
            fuzz_check_volume(&volume);
        } else {
            FUZZ_REQUIRE(!volume.label && volume.n[0] == 0);
            FUZZ_REQUIRE(strncmp(err.text, "fuzz: ", 6) == 0);
        }
        ms_volume_free(&volume);
        ms_file_free(&bytes);
    }
    return 0;
}

#endif
