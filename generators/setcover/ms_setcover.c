/*
 * F.-L. Yuan, Combined 3D thinning and greedy algorithm to approximate realistic particles with
 * corrected mechanical properties, Granular Matter 21 (2019) 19. Section and algorithm numbers
 * are of that paper; docs/methods/setcover.md says what it leaves open and how it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>

#include "ms_cut_cover.h"
#include "ms_setcover_candidates.h"
#include "shared/ms_cover.h"
#include "shared/ms_nested.h"
#include "voxel/ms_cut_cells.h"

enum { SKELETON, SKELETON_DEQ, CANDIDATES, ALIGN, CONNECTED, COUNT };

enum { COUNT_VOXELS, COUNT_CUT }; /* of COUNT */

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
    [COUNT] =
        {"count", MS_OPTION_CHOICE, COUNT_VOXELS, 0, 0, "voxels|cut", NULL,
         "what a sphere covers: voxels, by their centres, or cells that follow the surface, by the centroids of what "
         "is inside (3.1; the measure coverage_cut)"},
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
    ms_cover *cover;   /* one of these */
    ms_cut_cover *cut; /* the other is NULL */
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
    if (choice->cut ? ms_cut_cover_next(&which, choice->cut) == 0 : ms_cover_next(&which, choice->cover) == 0) {
        *reason = choice->dropped ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    } else {
        *ball = choice->candidate[which];
    }
    return MS_OK;
}

/* Starts to choose, by the count asked for. */
static ms_status start_choice(setcover_choice *choice, ms_cut_cells **cells, size_t count, const ms_run *run,
                              ms_error *err)
{
    const ms_target *target = run->target;
    const ms_cut_cells *cut = target->grid.cells;
    const int connected = setcover_option(run, CONNECTED) != 0;
    if (setcover_option(run, COUNT) == COUNT_VOXELS) {
        return ms_cover_build(&choice->cover, &target->grid, choice->candidate, count,
                              connected ? MS_COVER_CONNECTED : MS_COVER_GROUPED, err);
    }
    ms_status status = MS_OK;
    if (!cut) {
        status = ms_cut_cells_build(cells, &target->grid, target->closed ? target->mesh : NULL, err);
        cut = *cells;
    }
    return status == MS_OK ? ms_cut_cover_build(&choice->cut, cut, choice->candidate, count, connected, err) : status;
}

static ms_status generate_by_setcover(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const ms_setcover_lattice lattice = {.deq = setcover_option(run, SKELETON_DEQ),
                                         .centres = (ms_setcover_centres)setcover_option(run, CANDIDATES),
                                         .kind = (ms_skeleton)setcover_option(run, SKELETON),
                                         .align = setcover_option(run, ALIGN) != 0};
    ms_ball *candidate;
    ms_cut_cells *cells = NULL;
    setcover_choice choice = {0};
    size_t count;
    ms_generator_stage(run, "candidate spheres", (double)NAN);
    ms_status status = ms_setcover_candidates(&candidate, &count, run->target, &lattice, err);
    const size_t found = count;
    if (status == MS_OK) {
        drop_small(candidate, &count, run);
        ms_generator_stage(run, "what each candidate covers", (double)NAN);
        choice = (setcover_choice){.candidate = candidate, .dropped = count < found};
        status = start_choice(&choice, &cells, count, run, err);
    }
    if (status == MS_OK) {
        status = ms_nested_run(clump, reason, run, choose_ball, &choice, err);
    }
    ms_cover_free(choice.cover);
    ms_cut_cover_free(choice.cut);
    ms_cut_cells_free(cells);
    free(candidate);
    return status;
}

const ms_generator ms_generator_setcover = {
    .name = "setcover",
    .summary = "inscribed spheres on the thinned medial surface, each the one that covers most of what is left",
    .source = "F.-L. Yuan, Granular Matter 21 (2019) 19",
    .nested = 1,
    .cut_by = "count",
    .bytes_per_voxel = 17, /* with candidates=all; with those by default less than half */
    .options = OPTIONS,
    .generate = generate_by_setcover,
};
