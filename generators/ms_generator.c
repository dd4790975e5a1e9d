#include "ms_generator.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "voxel/ms_cut_cells.h"
#include "voxel/ms_raster.h"

ms_status ms_generator_stage(const ms_run *run, const char *stage, double share, ms_error *err)
{
    return run->stage && run->stage(run->stage_context, stage, share)
               ? ms_fail(err, MS_ERR_INTERRUPTED, "interrupted at: %s", stage)
               : MS_OK;
}

void ms_generator_remark(const ms_run *run, const char *format, ...)
{
    char sentence[512];
    va_list args;
    if (!run->remark) {
        return;
    }
    va_start(args, format);
    vsnprintf(sentence, sizeof sentence, format, args);
    va_end(args);
    run->remark(run->remark_context, sentence);
}

static void keep_remark(void *context, const char *sentence)
{
    ms_error_add(context, sentence);
}

void ms_generator_keep_remarks(ms_run *run, ms_error *kept)
{
    run->remark = keep_remark;
    run->remark_context = kept;
}

/* The diagonal of a voxel: a ball of this radius holds all of the one that its centre lies in. */
static const double DIAGONAL = 1.7320508075688773;

/* Is the voxel that a ball's centre lies in covered for sure, and of the shape? */
static int covers_own_voxel(const ms_ball *ball, const ms_grid *grid)
{
    int voxel[3];
    for (int a = 0; a < 3; a++) {
        const double at = rint(ball->centre[a]);
        if (!(at >= 0 && at < grid->n[a])) {
            return 0;
        }
        voxel[a] = (int)at;
    }
    return ball->radius > DIAGONAL && isfinite(ball->radius) &&
           grid->inside[ms_grid_index(grid, voxel[0], voxel[1], voxel[2])];
}

/* Spheres of less than half a voxel may hold its centre, by which methods choose, and yet be nothing by the rule that
 * scores them. Ends at the first sphere that covers a voxel of the shape. */
static ms_status check_coverage(const ms_clump *clump, const char *name, const ms_run *run, ms_error *err)
{
    const ms_grid *grid = &run->target->grid;
    ms_raster raster;
    double largest = 0;
    int64_t covered = 0;
    const ms_ball one = ms_grid_ball(grid, &clump->sphere[0]);
    if (covers_own_voxel(&one, grid)) {
        return MS_OK; /* as nearly always */
    }
    ms_status status = ms_raster_alloc(&raster, grid, run->target->rule, err);
    for (size_t s = 0; s < clump->n_spheres && covered == 0 && status == MS_OK; s++) {
        const ms_ball ball = ms_grid_ball(grid, &clump->sphere[s]);
        largest = fmax(largest, ball.radius);
        status = ms_raster_add(&raster, &ball, 1, err);
        covered = status == MS_OK ? raster.tally[s].inside : 0;
    }
    ms_raster_free(&raster);
    return status != MS_OK || covered > 0
               ? status
               : ms_fail(err, MS_ERR_SHAPE,
                         "%s: its %zu spheres, of %.2g voxels at most, cover no voxel of the shape; use more cells",
                         name, clump->n_spheres, largest);
}

int ms_generator_is_nested(const ms_generator *generator, const ms_settings *settings)
{
    if (!generator->unnested_by || !settings) {
        return generator->nested;
    }
    const ms_option *flag = ms_option_find(generator->options, generator->unnested_by);
    return generator->nested && settings->value[flag - generator->options] == 0;
}

ms_target_need ms_generator_need(const ms_generator *generator, const ms_settings *settings, int cut)
{
    const ms_option *choice =
        generator->cut_by && settings ? ms_option_find(generator->options, generator->cut_by) : NULL;
    const double own = generator->bytes_per_voxel;
    ms_target_need need = {own > 0 ? own : MS_TARGET_METHOD_BYTES, generator->bytes_per_square};
    if (cut || (choice && settings->value[choice - generator->options] != 0)) {
        need.voxel += MS_CUT_VOXEL_BYTES;
        need.square += MS_CUT_SQUARE_BYTES;
    }
    return need;
}

static ms_status check_run(const ms_generator *generator, const ms_run *run, ms_error *err)
{
    const ms_stop *stop = &run->stop;
    if (!run->target || (run->settings && run->settings->options != generator->options)) {
        return ms_fail(err, MS_ERR_ARG, "%s needs a target, and settings of its own options only", generator->name);
    }
    if (ms_stop_is_none(stop)) {
        return ms_fail(err, MS_ERR_ARG, "nothing says when to stop; give a number of spheres or a measure");
    }
    if (stop->spheres > MS_CLUMP_MAX_SPHERES) {
        return ms_fail(err, MS_ERR_LIMIT, "%zu spheres are more than %d", stop->spheres, MS_CLUMP_MAX_SPHERES);
    }
    return MS_OK;
}

ms_status ms_generator_run(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator, const ms_run *run,
                           ms_error *err)
{
    memset(clump, 0, sizeof *clump);
    *reason = MS_STOP_NOT;
    ms_status status = check_run(generator, run, err);
    if (status != MS_OK) {
        return status;
    }
    ms_settings defaults = {0};
    ms_run all = *run;
    ms_target cut = *run->target;
    ms_cut_cells *cells = NULL;
    if (run->stop.coverage_cut > 0 && !cut.grid.cells) {
        status = ms_cut_cells_build(&cells, &cut.grid, cut.closed ? cut.mesh : NULL, err);
        cut.grid.cells = cells;
        all.target = &cut;
    }
    if (status == MS_OK && !run->settings) {
        status = ms_option_settings_init(&defaults, generator->options, err);
        all.settings = &defaults;
    }
    if (status == MS_OK) {
        status = generator->generate(clump, reason, &all, err);
    }
    ms_option_settings_free(&defaults);
    ms_cut_cells_free(cells);
    if (status == MS_OK && clump->n_spheres == 0) {
        status = ms_fail(err, MS_ERR_SHAPE, "%s placed no sphere (%s); use more cells or a smaller least radius",
                         generator->name, ms_stop_name(*reason));
    }
    if (status == MS_OK) {
        status = check_coverage(clump, generator->name, run, err);
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
    }
    return status;
}

ms_status ms_generator_run_whole(ms_clump *clump, const ms_generator *generator, const ms_run *run, ms_error *err)
{
    ms_stop_reason reason;
    const ms_status status = ms_generator_run(clump, &reason, generator, run, err);
    if (status != MS_OK || reason != MS_STOP_INTERRUPTED) {
        return status;
    }
    const size_t spheres = clump->n_spheres;
    ms_clump_free(clump);
    return ms_fail(err, MS_ERR_INTERRUPTED, "interrupted at %zu spheres", spheres);
}
