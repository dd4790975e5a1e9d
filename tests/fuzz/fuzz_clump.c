/** A fuzz target of the reader of clump files. */
#include "clump/formats/ms_clump_parse.h"
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ms_clump clump;
    ms_error err = {{0}};
    ms_bytes bytes = fuzz_bytes(data, size);
    ms_status status = ms_clump_parse(&clump, &bytes, "fuzz", &err);
    FUZZ_REQUIRE((status == MS_OK) == (clump.n_spheres > 0));
    FUZZ_REQUIRE(status == MS_OK || (!clump.sphere && strncmp(err.text, "fuzz: ", 6) == 0));
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_sphere *sphere = &clump.sphere[s];
        FUZZ_REQUIRE(isfinite(sphere->centre[0]) && isfinite(sphere->centre[1]) && isfinite(sphere->centre[2]));
        FUZZ_REQUIRE(isfinite(sphere->radius) && sphere->radius > 0);
    }
    ms_clump_free(&clump);
    ms_file_free(&bytes);
    return 0;
}
