#include "ms_dice.h"

#include <stdlib.h>
#include <string.h>

#include "clump/ms_union.h"
#include "ms_coverage_count.h"

ms_status ms_dice_union_volume(double *volume, const ms_ball *ball, size_t count, ms_error *err)
{
    ms_clump clump = {0};
    double area;
    ms_status status = MS_OK;
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        ms_sphere sphere = {.radius = ball[b].radius};
        memcpy(sphere.centre, ball[b].centre, sizeof sphere.centre);
        status = ms_clump_add(&clump, &sphere, err);
    }
    if (status == MS_OK) {
        status = ms_union_measure(volume, &area, &clump, err);
    }
    ms_clump_free(&clump);
    return status;
}

ms_status ms_dice_compute(double *dice, const ms_grid *grid, size_t voxels, const ms_ball *ball, size_t count,
                          ms_error *err)
{
    ms_coverage_count o;
    double volume = 0;
    size_t both = 0;
    ms_status status = ms_coverage_count_open(&o, grid, ball, count, err);
    for (size_t v = 0; status == MS_OK && v < ms_grid_voxels(grid); v++) {
        both += o.covers[v] > 0 && grid->inside[v];
    }
    ms_coverage_count_close(&o);
    if (status == MS_OK) {
        status = ms_dice_union_volume(&volume, ball, count, err);
    }
    *dice = status == MS_OK ? 1 - 2 * (double)both / ((double)voxels + volume) : 1;
    return status;
}
