/** What the tests of variational share. */
#ifndef VARIATIONAL_SAMPLES_H
#define VARIATIONAL_SAMPLES_H

#include "support/run_samples.h"

#include <stdlib.h>

#include "base/ms_vector.h"
#include "ms_generator_list.h"

static inline double uniform(double from, double to)
{
    return from + (to - from) * rand() / RAND_MAX;
}

static inline ms_clump generate_by(const ms_generator *generator, const ms_target *target, size_t n,
                                   const char *const *options)
{
    ms_settings settings;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    assert_int_equal(ms_option_settings_init(&settings, generator->options, &err), MS_OK);
    for (; options && options[0]; options += 2) {
        assert_int_equal(ms_option_settings_set(&settings, options[0], options[1], &err), MS_OK);
    }
    ms_run run = {.target = target, .settings = &settings, .seed = 3};
    run.stop.spheres = n;
    if (ms_generator_run(&clump, &reason, generator, &run, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    ms_option_settings_free(&settings);
    return clump;
}

static inline ms_clump generate(const ms_target *target, size_t n, const char *const *options)
{
    return generate_by(&ms_generator_variational, target, n, options);
}

static inline double dice_of(const ms_target *target, const ms_clump *clump)
{
    return score_of(clump, target).dice;
}

static inline void write_clump(const char *path, const ms_clump *clump)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *sphere = &clump->sphere[s];
        fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", sphere->centre[0], sphere->centre[1], sphere->centre[2],
                sphere->radius);
    }
    fclose(file);
}

/* |S xor U| by voxels' centres, by brute force. */
static inline int64_t brute_mismatch(const ms_grid *grid, const ms_ball *ball, size_t count)
{
    int64_t sum = 0;
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                const double p[3] = {i, j, k};
                int covered = 0;
                for (size_t b = 0; b < count; b++) {
                    covered |= ms_squared_distance(p, ball[b].centre) <= ball[b].radius * ball[b].radius;
                }
                sum += covered != grid->inside[ms_grid_index(grid, i, j, k)];
            }
        }
    }
    return sum;
}

static inline int set_up(void **state)
{
    static ms_mesh mesh;
    static ms_target target;
    make_shape(&mesh, "grain", "");
    make_target(&target, &mesh, 40, MS_VOXEL_CENTRE);
    *state = &target;
    return 0;
}

static inline int tear_down(void **state)
{
    ms_target *target = *state;
    ms_mesh mesh = *target->mesh;
    ms_target_free(target);
    ms_mesh_free(&mesh);
    return 0;
}

#endif
