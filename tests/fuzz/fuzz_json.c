/** A fuzz target of the reader of JSON clumps. */
#include "fuzz_clump_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_clump_read(data, size, ms_json_read);
}
