#include "ms_curve.h"

#include <stdlib.h>
#include <string.h>

#include "voxel/ms_cut_cells.h"

static int takes_clump(const ms_generator *generator)
{
    int found = 0;
    for (const ms_option *o = generator->options; o->name; o++) {
        found |= o->type == MS_OPTION_CLUMP;
    }
    return found;
}

static ms_status copy_spheres(ms_clump *copy, const ms_clump *clump, size_t count, ms_error *err)
{
    memset(copy, 0, sizeof *copy);
    copy->sphere = malloc((count + 1) * sizeof *copy->sphere);
    if (!copy->sphere) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    memcpy(copy->sphere, clump->sphere, count * sizeof *copy->sphere);
    copy->n_spheres = copy->capacity = count;
    return MS_OK;
}

static void free_clumps(ms_clump *each, size_t count)
{
    for (size_t n = 0; n < count; n++) {
        ms_clump_free(&each[n]);
    }
}

/* What a run for one number of spheres has of that for all; it says no stage: the share told is that of all runs. */
static ms_run copy_for_one(const ms_run *run, const ms_settings *settings)
{
    ms_run one = *run;
    one.settings = settings;
    one.stop = (ms_stop){.radius = run->stop.radius};
    one.stage = NULL;
    return one;
}

/*
 * A run for each number of spheres, from the largest down. Where a generator gives fewer spheres than asked for, their
 * score stands for both numbers. Without `each` a clump is freed when the next has started from it.
 */
static ms_status run_each(ms_score *curve, ms_clump *each, ms_error *remarks, const ms_clump *clump,
                          const ms_generator *generator, const ms_run *run, size_t max_voxels, ms_error *err)
{
    ms_settings defaults = {0}, settings;
    ms_run one = copy_for_one(run, &settings);
    ms_clump last = {0};
    const ms_clump *larger = clump;
    ms_score score;
    ms_status status = ms_option_settings_init(&defaults, generator->options, err);
    settings = run->settings ? *run->settings : defaults;
    if (status == MS_OK) {
        status = ms_metrics_score_clump(&score, NULL, run->target, clump, max_voxels, err);
    }
    for (size_t n = clump->n_spheres; n >= 1 && status == MS_OK; n--) {
        ms_clump next;
        curve[n - 1] = score;
        if (each) {
            status = copy_spheres(&each[n - 1], larger, larger->n_spheres, err);
        }
        if (n == 1 || status != MS_OK) {
            break;
        }
        one.stop.spheres = n - 1;
        if (remarks) {
            ms_generator_keep_remarks(&one, &remarks[n - 2]);
        }
        if (takes_clump(generator)) {
            settings.clump = *larger;
        }
        const double share = (double)(clump->n_spheres - n) / (double)clump->n_spheres;
        status = ms_generator_stage(run, "curve", share, err);
        if (status != MS_OK) {
            break;
        }
        status = ms_generator_run_whole(&next, generator, &one, err);
        ms_clump_free(&last);
        last = next;
        larger = &last;
        if (status == MS_OK) {
            status = ms_metrics_score_clump(&score, NULL, run->target, larger, max_voxels, err);
        }
    }
    ms_clump_free(&last);
    ms_option_settings_free(&defaults);
    return status;
}

static ms_status take_prefixes(ms_score *curve, ms_clump *each, const ms_clump *clump, const ms_run *run,
                               size_t max_voxels, ms_error *err)
{
    ms_score score;
    ms_status status = ms_metrics_score_clump(&score, curve, run->target, clump, max_voxels, err);
    for (size_t n = 1; each && n <= clump->n_spheres && status == MS_OK; n++) {
        status = copy_spheres(&each[n - 1], clump, n, err);
    }
    return status;
}

ms_status ms_curve_clumps(ms_score *curve, ms_clump *each, ms_error *remarks, const ms_clump *clump,
                          const ms_generator *generator, const ms_run *run, size_t max_voxels, ms_error *err)
{
    ms_run all = *run;
    ms_target cut = *run->target;
    ms_cut_cells *cells = NULL;
    ms_status status = MS_OK;
    if (each) {
        memset(each, 0, clump->n_spheres * sizeof *each);
    }
    if (cut.count_cut && !cut.grid.cells) { /* once for all scores */
        status = ms_cut_cells_build(&cells, &cut.grid, cut.closed ? cut.mesh : NULL, err);
        cut.grid.cells = cells;
        all.target = &cut;
    }
    if (status == MS_OK) {
        status = ms_generator_is_nested(generator, run->settings)
                     ? take_prefixes(curve, each, clump, &all, max_voxels, err)
                     : run_each(curve, each, remarks, clump, generator, &all, max_voxels, err);
    }
    ms_cut_cells_free(cells);
    if (each && status != MS_OK) {
        free_clumps(each, clump->n_spheres);
    }
    return status;
}

ms_status ms_curve_compute(ms_score *curve, const ms_clump *clump, const ms_generator *generator, const ms_run *run,
                           size_t max_voxels, ms_error *err)
{
    return ms_curve_clumps(curve, NULL, NULL, clump, generator, run, max_voxels, err);
}
