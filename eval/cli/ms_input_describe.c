#include <omp.h>

#include "measure/ms_descriptors.h"
#include "ms_input.h"

ms_status ms_input_describe(ms_input *input, ms_error *err)
{
    const double start = omp_get_wtime();
    const ms_status status = ms_descriptors_add(&input->target, err);
    input->describe_seconds = omp_get_wtime() - start;
    return status;
}
