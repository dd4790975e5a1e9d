/** A fuzz target of one parser of volumes. */
#ifndef FUZZ_VOLUME_H
#define FUZZ_VOLUME_H

#include "fuzz.h"
#include "volume/ms_volume_formats.h"

typedef ms_status fuzz_volume_parser(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels,
                                     ms_error *err);

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

static inline int fuzz_volume(fuzz_volume_parser *parse, const uint8_t *data, size_t size)
{
    ms_volume volume;
    ms_error err = {{0}};
    ms_bytes bytes = fuzz_bytes(data, size);
    ms_status status = parse(&volume, &bytes, "fuzz", SIZE_MAX, &err);
    if (status == MS_OK) {
        fuzz_check_volume(&volume);
    } else {
        FUZZ_REQUIRE(!volume.label && volume.n[0] == 0);
        FUZZ_REQUIRE(strncmp(err.text, "fuzz: ", 6) == 0);
    }
    ms_volume_free(&volume);
    ms_file_free(&bytes);
    return 0;
}

#endif
