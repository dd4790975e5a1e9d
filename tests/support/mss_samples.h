/** What the tests of MSS share. */
#ifndef MSS_SAMPLES_H
#define MSS_SAMPLES_H

#include "ms_generator_list.h"
#include "run_samples.h"

typedef struct mss_outcome {
    ms_clump clump;
    ms_stop_reason reason;
} mss_outcome;

static inline mss_outcome run_mss(const ms_target *target, ms_stop stop, const char *options)
{
    mss_outcome o;
    o.clump = run_generator(&ms_generator_mss, target, stop, options, &o.reason);
    return o;
}

static inline ms_stop at_most(size_t spheres)
{
    return (ms_stop){.spheres = spheres};
}

#endif
