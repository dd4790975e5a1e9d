/*
 * F.-L. Yuan, Combined 3D thinning and greedy algorithm to approximate realistic particles with
 * corrected mechanical properties, Granular Matter 21 (2019) 19. Section and algorithm numbers
 * are of that paper; docs/methods/setcover.md says what it leaves open and how it was decided.
 */
#include "ms_setcover.h"

#include <math.h>
#include <stdlib.h>

#include "ms_setcover_candidates.h"
#include "shared/ms_cover.h"

enum { SKELETON, SKELETON_DEQ, CANDIDATES, ALIGN, CONNECTED };

static const ms_option OPTIONS[] = {
    [SKELETON] = {"skeleton", MS_OPTION_CHOICE, MS_SKELETON_SURFACE, 0, 0, "surface|curve", NULL,
                  "what thinning keeps: surfaces, or curves only (2.3: for shapes around a curve, and against noise)"},
    [SKELETON_DEQ] = {"skeleton-deq", MS_OPTION_REAL, 60, 5, 2000, NULL, "voxels",
                      "size of the skeleton's voxels: diameter of the ball of equal volume / this"},
    [CANDIDATES] = {"candidates", MS_OPTION_CHOICE, SETCOVER_MEDIAL, 0, 0, "medial|skeleton|all", NULL,
                    "spheres to choose from: of the skeleton's voxels and, rolled inward, of the border's; of the "
                    "skeleton's alone (the paper); of all voxels inside (the paper's reference)"},
    [ALIGN] = {"align", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
               "thin along the shape's principal axes (2.4); the clump stays in the frame of the shape"},
    [CONNECTED] = {"connected", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
                   "every sphere overlaps one before it, so that the first k are one piece for any k"},
    {0},
};

static double setcover_option(const ms_run *run, int which)
{
    return run->settings->value[which];
}

/* Drops the candidates that the stop rule calls too small. */
static void drop_small(ms_ball *candidate, size_t *count, const ms_run *run)
{
    const double least = run->stop.radius / run->target->grid.h;
    size_t kept = 0;
    for (size_t c = 0; c < *count; c++) {
        if (!(candidate[c].radius < least)) {
            candidate[kept++] = candidate[c];
        }
    }
    *count = kept;
}

/* Takes one sphere. */
static ms_status accept(ms_clump *clump, ms_stop_reason *reason, ms_tally *sum, ms_raster *raster, const ms_ball *ball,
                        const ms_run *run, ms_error *err)
{
    ms_sphere sphere;
    ms_target_from_voxels(sphere.centre, &sphere.radius, &run->target->grid, ball->centre, ball->radius);
    ms_status status = ms_clump_add(clump, &sphere, err);
    if (status == MS_OK) {
        status = ms_raster_add(raster, ball, 1, err);
    }
    if (status == MS_OK) {
        ms_tally_add(sum, &raster->tally[raster->n_balls - 1]);
        *reason = ms_stop_reached(&run->stop, run->target, sum, clump->n_spheres);
        if (run->progress) {
            run->progress(run->progress_context, clump->n_spheres, ms_metrics_score(sum, run->target->voxels).dice);
        }
    }
    return status;
}

/* Algorithm 2, until the stop rule holds. */
static ms_status cover_greedily(ms_clump *clump, ms_stop_reason *reason, ms_cover *cover, const ms_ball *candidate,
                                const ms_run *run, ms_error *err)
{
    ms_raster raster;
    ms_tally sum = {0};
    size_t which;
    ms_status status = ms_raster_alloc(&raster, &run->target->grid, run->target->rule, err);
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        if (clump->n_spheres == MS_CLUMP_MAX_SPHERES) {
            *reason = MS_STOP_SPHERES; /* as many as a clump can have */
        } else if (ms_cover_next(&which, cover) == 0) {
            *reason = MS_STOP_EXHAUSTED;
        } else {
            status = accept(clump, reason, &sum, &raster, &candidate[which], run, err);
        }
    }
    ms_raster_free(&raster);
    return status;
}

static ms_status generate_by_setcover(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const ms_setcover_lattice lattice = {.deq = setcover_option(run, SKELETON_DEQ),
                                         .centres = (ms_setcover_centres)setcover_option(run, CANDIDATES),
                                         .kind = (ms_skeleton)setcover_option(run, SKELETON),
                                         .align = setcover_option(run, ALIGN) != 0};
    ms_ball *candidate;
    ms_cover *cover = NULL;
    size_t count;
    ms_status status = ms_setcover_candidates(&candidate, &count, run->target, &lattice, err);
    const size_t found = count;
    if (status == MS_OK) {
        drop_small(candidate, &count, run);
        status =
            ms_cover_build(&cover, &run->target->grid, candidate, count, setcover_option(run, CONNECTED) != 0, err);
    }
    if (status == MS_OK) {
        status = cover_greedily(clump, reason, cover, candidate, run, err);
    }
    if (*reason == MS_STOP_EXHAUSTED && count < found) {
        *reason = MS_STOP_RADIUS;
    }
    ms_cover_free(cover);
    free(candidate);
    return status;
}

const ms_generator ms_generator_setcover = {
    .name = "setcover",
    .summary = "inscribed spheres on the thinned medial surface, each the one that covers most of what is left",
    .source = "F.-L. Yuan, Granular Matter 21 (2019) 19",
    .nested = 1,
    .options = OPTIONS,
    .generate = generate_by_setcover,
};
