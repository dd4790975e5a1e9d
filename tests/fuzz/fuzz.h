/** What the fuzz targets share: a parser gets the bytes, and its promises are checked. */
#ifndef FUZZ_H
#define FUZZ_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"

/* Ends the run with a stack trace in any build. */
#define FUZZ_REQUIRE(condition) \
    do {                        \
        if (!(condition)) {     \
            __builtin_trap();   \
        }                       \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A copy of exactly the size that a file would have, so that the sanitizer sees every byte read behind it. */
static inline ms_bytes fuzz_bytes(const uint8_t *data, size_t size)
{
    ms_bytes bytes = {.data = malloc(size + 1), .size = size};
    FUZZ_REQUIRE(bytes.data);
    if (size > 0) {
        memcpy(bytes.data, data, size);
    }
    bytes.data[size] = 0;
    return bytes;
}

#endif
