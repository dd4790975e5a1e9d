/*
 * F.-L. Yuan, Combined 3D thinning and greedy algorithm to approximate realistic particles with
 * corrected mechanical properties, Granular Matter 21 (2019) 19. Section and algorithm numbers
 * are of that paper; docs/methods/setcover.md says what it leaves open and how it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>

#include "ms_cut_cover.h"
#include "ms_setcover_choice.h"
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
static int drop_small(ms_setcover_pool *pool, double least)
{
    const size_t found = pool->count;
    size_t kept = 0;
    for (size_t c = 0; c < found; c++) {
        if (!(pool->ball[c].radius < least)) {
            pool->ball[kept++] = pool->ball[c];
        }
    }
    pool->count = kept;
    return kept < found;
}

/* What the spheres are chosen from. */
typedef struct setcover_choice {
    ms_setcover_pool pool;
    ms_cover *cover;         /* by voxels */
    ms_setcover_choice fine; /* of a pool with starts */
    ms_cut_cells *cells;     /* made here; or NULL */
    ms_cut_cover *cut;       /* by cells; or NULL */
    int dropped;             /* nonzero: some were smaller than the least radius */
} setcover_choice;

/* A step of algorithm 2; ms_nested_choose. */
static ms_status choose_ball(void *context, ms_ball *ball, ms_stop_reason *reason, const ms_raster *placed,
                             ms_error *err)
{
    setcover_choice *choice = context;
    size_t which, found;
    (void)placed, (void)err;
    if (choice->pool.start) {
        found = ms_setcover_choose(ball, &choice->fine);
    } else {
        found = choice->cut ? ms_cut_cover_next(&which, choice->cut) > 0 : ms_cover_next(&which, choice->cover);
        *ball = found ? choice->pool.ball[which] : *ball;
    }
    if (!found) {
        *reason = choice->dropped || choice->fine.dropped ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    }
    return MS_OK;
}

/* Starts to choose by voxels. */
static ms_status start_by_voxels(setcover_choice *choice, const ms_run *run, double least, ms_error *err)
{
    const ms_setcover_pool *pool = &choice->pool;
    const ms_cover_rule rule = pool->start                            ? MS_COVER_ADMITTED
                               : setcover_option(run, CONNECTED) != 0 ? MS_COVER_CONNECTED
                                                                      : MS_COVER_GROUPED;
    const ms_status status = ms_cover_build(&choice->cover, &run->target->grid, pool->ball, pool->count, rule, err);
    if (status == MS_OK && pool->start) {
        choice->fine = ms_setcover_choice_start(pool, choice->cover, least);
    }
    return status;
}

/* Starts to choose by cells. */
static ms_status start_by_cells(setcover_choice *choice, const ms_run *run, ms_error *err)
{
    const ms_target *target = run->target;
    ms_status status = MS_OK;
    if (!target->grid.cells) {
        status = ms_cut_cells_build(&choice->cells, &target->grid, target->closed ? target->mesh : NULL, err);
    }
    const ms_cut_cells *cells = choice->cells ? choice->cells : target->grid.cells;
    return status == MS_OK ? ms_cut_cover_build(&choice->cut, cells, choice->pool.ball, choice->pool.count,
                                                setcover_option(run, CONNECTED) != 0, err)
                           : status;
}

/* Whether spheres are chosen from coarse to fine, and moved on the medial surface, if there is a closed mesh. */
static int is_coarse_to_fine(const ms_run *run)
{
    return setcover_option(run, COUNT) == COUNT_VOXELS && setcover_option(run, CONNECTED) == 0 &&
           setcover_option(run, CANDIDATES) == SETCOVER_MEDIAL && setcover_option(run, SKELETON) == MS_SKELETON_SURFACE;
}

static ms_status generate_by_setcover(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const int by_voxels = setcover_option(run, COUNT) == COUNT_VOXELS;
    const ms_setcover_lattice lattice = {.deq = setcover_option(run, SKELETON_DEQ),
                                         .centres = (ms_setcover_centres)setcover_option(run, CANDIDATES),
                                         .kind = (ms_skeleton)setcover_option(run, SKELETON),
                                         .align = setcover_option(run, ALIGN) != 0,
                                         .later = is_coarse_to_fine(run)};
    setcover_choice choice = {0};
    ms_status status = ms_generator_stage(run, "candidate spheres", (double)NAN, err);
    if (status == MS_OK) {
        status = ms_setcover_candidates(&choice.pool, run->target, &lattice, err);
    }
    if (status == MS_OK) {
        status = ms_generator_stage(run, "what each candidate covers", (double)NAN, err);
    }
    if (status == MS_OK) {
        const double least = run->stop.radius / run->target->grid.h;
        choice.dropped = !choice.pool.start && drop_small(&choice.pool, least);
        status = by_voxels ? start_by_voxels(&choice, run, least, err) : start_by_cells(&choice, run, err);
    }
    if (status == MS_OK) {
        status = ms_nested_run(clump, reason, run, choose_ball, &choice, err);
    }
    ms_cover_free(choice.cover);
    ms_cut_cover_free(choice.cut);
    ms_cut_cells_free(choice.cells);
    ms_setcover_pool_free(&choice.pool);
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
