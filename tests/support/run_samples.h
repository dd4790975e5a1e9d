/** Runs of a generator. */
#ifndef RUN_SAMPLES_H
#define RUN_SAMPLES_H

#include "measure/ms_metrics.h"
#include "ms_generator.h"
#include "test_support.h"

/** @param options "name=value name=value"; a flag may go without a value @param run all but the settings */
static inline ms_status try_run(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator, ms_run run,
                                const char *options, ms_error *err)
{
    ms_settings settings;
    char copy[256];
    snprintf(copy, sizeof copy, "%s", options);
    assert_int_equal(ms_option_settings_init(&settings, generator->options, err), MS_OK);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " ")) {
        char *equals = strchr(word, '=');
        if (equals) {
            *equals = 0;
        }
        assert_int_equal(ms_option_settings_set(&settings, word, equals ? equals + 1 : NULL, err), MS_OK);
    }
    run.settings = &settings;
    const ms_status status = ms_generator_run(clump, reason, generator, &run, err);
    ms_option_settings_free(&settings);
    return status;
}

/** An ms_remark that keeps the last sentence. @param context char[512] */
static inline void keep_remark(void *context, const char *sentence)
{
    snprintf(context, 512, "%s", sentence);
}

/** @param remark, context as in ms_run; may be NULL */
static inline ms_status try_generator(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator,
                                      const ms_target *target, ms_stop stop, const char *options, ms_remark remark,
                                      void *context, ms_error *err)
{
    const ms_run run = {.target = target, .stop = stop, .seed = 1, .remark = remark, .remark_context = context};
    return try_run(clump, reason, generator, run, options, err);
}

/** One that has to succeed. @param[out] reason may be NULL */
static inline ms_clump run_generator(const ms_generator *generator, const ms_target *target, ms_stop stop,
                                     const char *options, ms_stop_reason *reason)
{
    ms_clump clump;
    ms_stop_reason ignored;
    ms_error err;
    if (try_generator(&clump, reason ? reason : &ignored, generator, target, stop, options, NULL, NULL, &err) !=
        MS_OK) {
        fail_msg("%s", err.text);
    }
    return clump;
}

static inline ms_score score_of(const ms_clump *clump, const ms_target *target)
{
    ms_score score;
    ms_error err;
    assert_int_equal(ms_metrics_score_clump(&score, NULL, target, clump, 1u << 28, &err), MS_OK);
    return score;
}

/** A target of n[0] x n[1] x n[2] voxels of size 1, all inside, the centre of the first at 0. */
static inline void make_voxel_box(ms_target *target, const int n[3])
{
    const size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    uint32_t *label = malloc(voxels * sizeof *label);
    ms_error err;
    assert_non_null(label);
    for (size_t v = 0; v < voxels; v++) {
        label[v] = 1;
    }
    const ms_volume box = {.n = {n[0], n[1], n[2]}, .spacing = 1, .label = label};
    assert_int_equal(ms_target_from_volume(target, &box, 0, &err), MS_OK);
    free(label);
}

#endif
