/*
 * F.-L. Yuan, Combined 3D thinning and greedy algorithm to approximate realistic particles with
 * corrected mechanical properties, Granular Matter 21 (2019) 19. Section and algorithm numbers
 * are of that paper; docs/methods/setcover.md says what it leaves open and how it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>

#include "ms_setcover_candidates.h"
#include "shared/ms_cover.h"
#include "shared/ms_nested.h"

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

/* What the spheres are chosen from. */
typedef struct setcover_choice {
    ms_cover *cover;
    const ms_ball *candidate;
    int dropped; /* nonzero: some were smaller than the least radius */
} setcover_choice;

/* A step of algorithm 2; ms_nested_choose. */
static ms_status choose_ball(void *context, ms_ball *ball, ms_stop_reason *reason, const ms_raster *placed,
                             ms_error *err)
{
    const setcover_choice *choice = context;
    size_t which;
    (void)placed, (void)err;
    if (ms_cover_next(&which, choice->cover) == 0) {
        *reason = choice->dropped ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    } else {
        *ball = choice->candidate[which];
    }
    return MS_OK;
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
    ms_generator_stage(run, "candidate spheres", (double)NAN);
    ms_status status = ms_setcover_candidates(&candidate, &count, run->target, &lattice, err);
    const size_t found = count;
    if (status == MS_OK) {
        drop_small(candidate, &count, run);
        ms_generator_stage(run, "what each candidate covers", (double)NAN);
        status = ms_cover_build(&cover, &run->target->grid, candidate, count,
                                setcover_option(run, CONNECTED) != 0 ? MS_COVER_CONNECTED : MS_COVER_GROUPED, err);
    }
    if (status == MS_OK) {
        setcover_choice choice = {cover, candidate, count < found};
        status = ms_nested_run(clump, reason, run, choose_ball, &choice, err);
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
    .bytes_per_voxel = 12,
    .options = OPTIONS,
    .generate = generate_by_setcover,
};
