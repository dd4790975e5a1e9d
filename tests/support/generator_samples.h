/* The plainest nested method there is: a sphere at the deepest voxel that none covers yet. */
#ifndef GENERATOR_SAMPLES_H
#define GENERATOR_SAMPLES_H

#include "shared/ms_nested.h"

/* ms_nested_choose; of equal depths the lowest voxel. */
static ms_status choose_deepest(void *context, ms_ball *ball, ms_stop_reason *reason, const ms_raster *placed,
                                ms_error *err)
{
    const ms_run *run = context;
    const ms_grid *grid = &run->target->grid;
    const size_t voxels = ms_grid_voxels(grid), nx = (size_t)grid->n[0], ny = (size_t)grid->n[1];
    size_t best = voxels;
    (void)err;
    for (size_t v = 0; v < voxels; v++) {
        if (grid->inside[v] && placed->first[v] >= placed->n_balls &&
            (best == voxels || run->target->distance[v] > run->target->distance[best])) {
            best = v;
        }
    }
    if (best == voxels) {
        *reason = MS_STOP_EXHAUSTED;
        return MS_OK;
    }
    *ball = (ms_ball){{(double)(best % nx), (double)(best / nx % ny), (double)(best / nx / ny)},
                      (double)run->target->distance[best]};
    if (ball->radius * grid->h < run->stop.radius) {
        *reason = MS_STOP_RADIUS;
    }
    return MS_OK;
}

static ms_status generate_deepest(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    ms_run own = *run;
    return ms_nested_run(clump, reason, run, choose_deepest, &own, err);
}

static const ms_option DEEPEST_OPTIONS[] = {{0}};

static const ms_generator deepest_generator = {
    .name = "deepest",
    .summary = "a sphere at the deepest voxel that none covers yet",
    .source = "none: to compare with",
    .nested = 1,
    .baseline = 1,
    .options = DEEPEST_OPTIONS,
    .generate = generate_deepest,
};

#endif
