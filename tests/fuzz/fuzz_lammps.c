/** A fuzz target of the reader of LAMMPS molecules. */
#include "fuzz_clump_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_clump_read(data, size, ms_lammps_read);
}
