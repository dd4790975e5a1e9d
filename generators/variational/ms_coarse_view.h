/** A target seen coarsely: every step-th of its voxels. Private to variational. */
#ifndef MS_COARSE_VIEW_H
#define MS_COARSE_VIEW_H

#include "ms_mirror.h"
#include "voxel/ms_raster.h"
#include "voxel/ms_target.h"

/** Voxel i of the view lies on voxel i * step of the target. */
typedef struct ms_coarse_view {
    const ms_target *target; /* borrowed */
    const float *distance;   /* as the target's, or less where spheres have to be smaller; borrowed */
    int step;
    ms_grid grid;
} ms_coarse_view;

/**
 * @param[out] view  the caller frees it; empty on failure
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_coarse_view_make(ms_coarse_view *view, const ms_target *target, const float *distance, int step,
                              ms_error *err);

/** Leaves in its grid only what is above each plane of symmetry. */
void ms_coarse_view_keep_upper(ms_coarse_view *view, const ms_mirror *m);

/** A sphere in voxels of the view, from one in the target's; and back. */
ms_ball ms_coarse_view_ball(const ms_coarse_view *view, const ms_ball *ball);
ms_ball ms_coarse_view_target_ball(const ms_coarse_view *view, const ms_ball *ball);

void ms_coarse_view_free(ms_coarse_view *view);

#endif
