/** What a run was and what it gave, in JSON: enough to repeat it. */
#ifndef MS_RECORD_H
#define MS_RECORD_H

#include <jansson.h>

#include "clump/ms_equal_volume.h"
#include "measure/ms_metrics.h"
#include "ms_generator.h"
#include "ms_input.h"
#include "ms_mass.h"

/** All that a run gave. */
typedef struct ms_result {
    ms_clump clump;
    ms_stop_reason reason;
    ms_metrics metrics;
    ms_mass mass;           /* zeros without --correct */
    ms_equal_volume volume; /* zeros without --equal-volume */
    double generate_seconds, score_seconds;
} ms_result;

/** The options of a generator by name; the caller owns it. */
json_t *ms_record_settings_json(const ms_settings *settings);

/** Generator, options, seed, stop rule, input, scores, times, memory; the caller owns it; NULL without memory. */
json_t *ms_record_json(const ms_generator *generator, const ms_settings *settings, const ms_stop *stop, uint64_t seed,
                       const ms_input *input, const ms_result *result);

#endif
