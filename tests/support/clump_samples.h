/** Targets and clumps for tests. */
#ifndef CLUMP_SAMPLES_H
#define CLUMP_SAMPLES_H

#include "grid_samples.h"
#include "measure/ms_metrics.h"
#include "voxel/ms_target.h"

/** Room for whatever a test may ask for. */
enum { MANY_VOXELS = 1 << 26 };

static inline ms_target target_of(const ms_mesh *mesh, double h, ms_voxel_rule rule)
{
    ms_target target;
    ms_error err = {{0}};
    if (ms_target_from_mesh(&target, mesh, 1, h, rule, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return target;
}

static inline void add_sphere(ms_clump *clump, double x, double y, double z, double radius)
{
    const ms_sphere sphere = {{x, y, z}, radius};
    assert_int_equal(ms_clump_add(clump, &sphere, NULL), MS_OK);
}

/** The measures of one sphere; of a whole clump below. */
static inline ms_metrics measure(const ms_target *target, const ms_clump *clump, ms_score *curve)
{
    ms_metrics metrics;
    ms_error err = {{0}};
    if (ms_metrics_compute(&metrics, curve, target, clump, MANY_VOXELS, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return metrics;
}

static inline ms_metrics measure_sphere(const ms_target *target, double x, double y, double z, double radius)
{
    ms_clump clump = {0};
    add_sphere(&clump, x, y, z, radius);
    const ms_metrics metrics = measure(target, &clump, NULL);
    ms_clump_free(&clump);
    return metrics;
}

static inline double ball_volume(double radius)
{
    return 4.0 / 3 * pi * radius * radius * radius;
}

#endif
