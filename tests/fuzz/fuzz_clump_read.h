/** What the fuzz targets of clump formats share. */
#ifndef FUZZ_CLUMP_READ_H
#define FUZZ_CLUMP_READ_H

#include "clump/formats/ms_formats.h"
#include "fuzz.h"

static inline int fuzz_clump_read(const uint8_t *data, size_t size,
                                  ms_status parse(ms_clump *, ms_particle *, ms_bytes *, const char *, ms_error *))
{
    ms_clump clump = {0};
    ms_particle particle = {0};
    ms_error err = {{0}};
    ms_bytes bytes = fuzz_bytes(data, size);
    ms_status status = parse(&clump, &particle, &bytes, "fuzz", &err);
    FUZZ_REQUIRE(status != MS_OK || clump.n_spheres > 0);
    FUZZ_REQUIRE(status == MS_OK || strncmp(err.text, "fuzz: ", 6) == 0);
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_sphere *sphere = &clump.sphere[s];
        FUZZ_REQUIRE(isfinite(sphere->centre[0]) && isfinite(sphere->centre[1]) && isfinite(sphere->centre[2]));
        FUZZ_REQUIRE(isfinite(sphere->radius) && sphere->radius > 0);
    }
    FUZZ_REQUIRE(status != MS_OK || particle.mass == 0 || (particle.mass > 0 && particle.scale > 0));
    ms_clump_free(&clump);
    ms_file_free(&bytes);
    return 0;
}

#endif
