/** What the benchmarks share. */
#ifndef BENCH_SUPPORT_H
#define BENCH_SUPPORT_H

#include "shape/ms_shape.h"

/** The grain of `mskit shape grain`: as large as a ball of radius 1. */
static inline ms_status make_grain(ms_mesh *mesh, ms_error *err)
{
    double value[MS_SHAPE_MAX_PARAMETERS];
    const ms_shape_kind *kind = ms_shape_find("grain", err);
    for (size_t p = 0; kind && kind->parameters[p].name; p++) {
        value[p] = kind->parameters[p].fallback;
    }
    return kind ? ms_shape_make(mesh, kind, value, err) : MS_ERR_ARG;
}

#endif
