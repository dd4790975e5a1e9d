/*
 * Spheres that minimise what they are judged by, the mismatch |S xor U| (MSS eq. 2): start from a
 * greedy cover with more spheres than asked for, fit their exposed surfaces to the target's, drop the
 * least useful ones, fit again. docs/methods/variational.md derives it.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "clump/ms_union.h"
#include "ms_gap.h"
#include "ms_variational_solve.h"
#include "shared/ms_bisect_count.h"
#include "shared/ms_judge.h"

enum { EFFORT, POINTS, PROTRUSION, GAP, CONNECTED, EQUAL_RADIUS, HOLD_VOLUME, SYMMETRY, PLANES, REFINE };

static const ms_option OPTIONS[] = {
    [EFFORT] = {"effort", MS_OPTION_INTEGER, 0, 0, 3, NULL, NULL,
                "rounds of adding spheres and dropping the least useful ones after the fit: none, 5, 20, 80"},
    [POINTS] = {"points", MS_OPTION_INTEGER, 192, 16, 4096, NULL, NULL, "places on each sphere where it is fitted"},
    [PROTRUSION] = {"protrusion", MS_OPTION_REAL, -1, -1, 1e6, NULL, "voxels",
                    "no sphere sticks out of the shape by more; 0: inscribed; below 0: no bound"},
    [GAP] = {"gap", MS_OPTION_REAL, -1, -1, 1e6, NULL, "voxels",
             "no part of the surface is farther from the spheres; below 0: no bound"},
    [CONNECTED] = {"connected", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL, "the spheres are one piece"},
    [EQUAL_RADIUS] = {"equal-radius", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL, "all spheres of one radius"},
    [HOLD_VOLUME] = {"hold-volume", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
                     "the union has the shape's volume, but for what little is left to scale"},
    [SYMMETRY] = {"symmetry", MS_OPTION_CHOICE, 0, 0, 0, "none|x|y|z|xy|xz|yz|xyz", NULL,
                  "the spheres are mirror images across planes through the centroid, normal to these axes"},
    [PLANES] = {"plane", MS_OPTION_PLANE, 0, 0, 0, NULL, NULL,
                "a,b,c,d: no sphere crosses the plane a x + b y + c z = d; may be repeated"},
    [REFINE] = {"refine", MS_OPTION_CLUMP, 0, 0, 0, NULL, NULL,
                "spheres to start from, of any method: a clump in any format that mskit score reads"},
    {0},
};

/* Of places and radii in the frame of the shape. */
static const double ROUNDING = 1e-9;

/* Of each effort. */
static const int ROUNDS[] = {0, 5, 20, 80};

/* Axes of each choice of symmetry. */
static const int ACROSS[][3] = {{0}, {1}, {0, 1}, {0, 0, 1}, {1, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};

/* The spheres in the frame of the shape, but for those that their bounds leave nothing of. */
static ms_status to_clump(ms_clump *clump, const ms_ball *ball, size_t count, const ms_run *run, ms_error *err)
{
    const double least = fmax(run->stop.radius, 0);
    clump->n_spheres = 0;
    for (size_t b = 0; b < count; b++) {
        ms_sphere sphere = ms_grid_sphere(&run->target->grid, &ball[b]);
        if (fabs(sphere.radius - least) < 1e-12 * least) {
            sphere.radius = least;
        }
        if (!(sphere.radius > 0) || sphere.radius < least) {
            continue;
        }
        ms_status status = ms_clump_add(clump, &sphere, err);
        if (status != MS_OK) {
            return status;
        }
    }
    return MS_OK;
}

/* Why the spheres are enough; MS_STOP_NOT if more are needed. */
static ms_status judge_clump(ms_stop_reason *reason, const ms_clump *clump, size_t asked, const ms_run *run,
                             ms_error *err)
{
    const size_t n = clump->n_spheres;
    ms_ball *ball = malloc((n + 1) * sizeof *ball);
    for (size_t s = 0; ball && s < n; s++) {
        ball[s] = ms_grid_ball(&run->target->grid, &clump->sphere[s]);
    }
    const ms_status status = ball ? ms_judge_union(NULL, reason, run, ball, n, err)
                                  : ms_fail(err, MS_ERR_NOMEM, "no memory to score %zu spheres", n);
    free(ball);
    if (status == MS_OK && *reason == MS_STOP_NOT && n < asked) {
        *reason = run->stop.radius > 0 ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    }
    return status;
}

/* What else binds the spheres would not survive the fit, nor the scaling after it. */
static int can_hold_volume(const ms_settings *settings)
{
    const double *value = settings->value;
    return value[PROTRUSION] < 0 && value[GAP] < 0 && value[CONNECTED] == 0 && settings->n_planes == 0;
}

static ms_variational_settings read_settings(const ms_run *run)
{
    const double *value = run->settings->value;
    const int *across = ACROSS[(int)value[SYMMETRY]];
    ms_variational_settings settings = {.rounds = ROUNDS[(int)value[EFFORT]],
                                        .points = (int)value[POINTS],
                                        .bounds = {.protrusion = value[PROTRUSION] < 0 ? HUGE_VAL : value[PROTRUSION],
                                                   .equal = value[EQUAL_RADIUS] != 0,
                                                   .planes = run->settings},
                                        .gap = value[GAP] < 0 ? HUGE_VAL : value[GAP] * (1 - ROUNDING),
                                        .connected = value[CONNECTED] != 0,
                                        .mirror = {.across = {across[0], across[1], across[2]}},
                                        .refine = &run->settings->clump};
    settings.hold_volume = value[HOLD_VOLUME] != 0 && can_hold_volume(run->settings);
    ms_grid_at(settings.mirror.at, &run->target->grid, run->target->body.centroid);
    return settings;
}

/* Says how far the surface is from the spheres, if that is farther than is allowed. */
static ms_status check_gap(const ms_clump *clump, const ms_run *run, ms_error *err)
{
    const double bound = run->settings->value[GAP];
    ms_ball *ball = malloc((clump->n_spheres + 1) * sizeof *ball);
    double largest = 0;
    if (!ball) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", clump->n_spheres);
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ball[s] = ms_grid_ball(&run->target->grid, &clump->sphere[s]);
    }
    const ms_status status = ms_gap_largest(&largest, NULL, run->target, ball, clump->n_spheres, bound, err);
    if (status == MS_OK && largest > bound) {
        ms_generator_remark(run,
                            "gap=%g cannot be held by %zu spheres within their other bounds: part of the surface is "
                            "%.2f voxels from them, the least that was found; more spheres or a larger protrusion help",
                            bound, clump->n_spheres, largest);
    }
    free(ball);
    return status;
}

/* Says if the spheres are not one piece, or fewer than a number that is asked for so that they are. */
static ms_status check_connected(const ms_clump *clump, const ms_run *run, ms_error *err)
{
    size_t pieces;
    const size_t asked = ms_stop_has_measure(&run->stop) ? 0 : run->stop.spheres;
    const ms_status status = ms_clump_pieces(&pieces, clump, err);
    if (status == MS_OK && pieces > 1) {
        ms_generator_remark(run,
                            "connected cannot be held by %zu spheres within their other bounds: they are in %zu "
                            "pieces; more spheres or a larger protrusion help",
                            clump->n_spheres, pieces);
    } else if (status == MS_OK && clump->n_spheres < asked) {
        ms_generator_remark(run,
                            "%zu of %zu spheres are one piece; what could not be joined to them, or was of no use, is "
                            "left out",
                            clump->n_spheres, asked);
    }
    return status;
}

/* Says how far the volume is from that of the shape, where scaling to it would cost more of D than voxels hide. */
static ms_status check_volume(const ms_clump *clump, const ms_run *run, ms_error *err)
{
    const double told = 0.01;
    double volume = 0, area;
    const ms_status status = ms_union_measure(&volume, &area, clump, err);
    const double part = volume / run->target->body.volume;
    if (status == MS_OK && fabs(part - 1) > told) {
        ms_generator_remark(run,
                            "the fit leaves %zu spheres with %.3g times the volume of the shape, so that the rest is "
                            "left to scaling; more spheres or cells may hold it",
                            clump->n_spheres, part);
    }
    return status;
}

/* Says what of the bounds the spheres do not keep; those that were found on the way do not matter. */
static ms_status tell_shortfalls(const ms_clump *clump, const ms_run *run, ms_error *err)
{
    const ms_variational_settings settings = read_settings(run);
    ms_status status = MS_OK;
    if (settings.gap < HUGE_VAL) {
        status = check_gap(clump, run, err);
    }
    if (status == MS_OK && settings.connected) {
        status = check_connected(clump, run, err);
    }
    return status == MS_OK && settings.hold_volume ? check_volume(clump, run, err) : status;
}

/* Each number of spheres is a run of its own, since the best n spheres are not among the best n + 1. */
static ms_status generate_for(void *context, ms_clump *clump, ms_stop_reason *reason, size_t n, ms_error *err)
{
    const ms_run *run = context;
    const ms_variational_settings settings = read_settings(run);
    ms_ball *ball;
    size_t count;
    ms_status status = ms_variational_solve(&ball, &count, run, &settings, n, err);
    if (status == MS_OK) {
        status = to_clump(clump, ball, count, run, err);
    }
    if (status == MS_OK) {
        status = judge_clump(reason, clump, n, run, err);
    }
    free(ball);
    return status;
}

/* Does a sphere reach a voxel of the shape? One of less than a voxel does if its centre lies in one. */
static int reaches_shape(const ms_sphere *sphere, const ms_grid *grid)
{
    const double half_diagonal = sqrt(3) / 2;
    int lo[3], hi[3];
    const ms_ball ball = ms_grid_ball(grid, sphere);
    const double reach = fmax(ball.radius, half_diagonal);
    for (int a = 0; a < 3; a++) {
        lo[a] = (int)fmin(fmax(ceil(ball.centre[a] - reach), 0), grid->n[a]);
        hi[a] = (int)fmax(fmin(floor(ball.centre[a] + reach), grid->n[a] - 1), -1);
    }
    for (int k = lo[2]; k <= hi[2]; k++) {
        for (int j = lo[1]; j <= hi[1]; j++) {
            for (int i = lo[0]; i <= hi[0]; i++) {
                const double voxel[3] = {i, j, k};
                if (grid->inside[ms_grid_index(grid, i, j, k)] &&
                    ms_squared_distance(ball.centre, voxel) <= reach * reach) {
                    return 1;
                }
            }
        }
    }
    return 0;
}

/* The given spheres that reach the shape; none given is none kept. */
static ms_status keep_given(ms_clump *kept, const ms_run *run, ms_error *err)
{
    const ms_clump *given = &run->settings->clump;
    ms_status status = MS_OK;
    for (size_t s = 0; s < given->n_spheres && status == MS_OK; s++) {
        if (reaches_shape(&given->sphere[s], &run->target->grid)) {
            status = ms_clump_add(kept, &given->sphere[s], err);
        }
    }
    const size_t outside = given->n_spheres - kept->n_spheres;
    if (status != MS_OK || outside == 0) {
        return status;
    }
    if (kept->n_spheres == 0) {
        return ms_fail(err, MS_ERR_ARG, "refine: none of its %zu spheres reaches the shape; check units and frame",
                       given->n_spheres);
    }
    ms_generator_remark(run, "%zu of the %zu spheres of refine lie outside the shape and are left out", outside,
                        given->n_spheres);
    return MS_OK;
}

static ms_status generate_by_variational(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    if (run->settings->n_planes > 0 && run->settings->value[SYMMETRY] != 0) {
        return ms_fail(err, MS_ERR_ARG, "give either planes or a symmetry: a mirror image might cross a plane");
    }
    if (run->settings->value[HOLD_VOLUME] != 0 && !can_hold_volume(run->settings)) {
        ms_generator_remark(run, "the fit does not hold the volume of the shape beside protrusion, gap, connected or "
                                 "planes; the spheres are those without hold-volume");
    }
    const size_t most = run->stop.spheres > 0 ? run->stop.spheres : MS_CLUMP_MAX_SPHERES;
    ms_run each = *run;
    ms_settings settings = *run->settings;
    settings.clump = (ms_clump){0};
    each.settings = &settings;
    ms_status status = keep_given(&settings.clump, run, err);
    if (status == MS_OK) {
        status = ms_stop_has_measure(&run->stop) ? ms_bisect_count(clump, reason, most, generate_for, &each, err)
                                                 : generate_for(&each, clump, reason, most, err);
    }
    if (status == MS_OK && clump->n_spheres > 0) {
        status = tell_shortfalls(clump, run, err);
    }
    ms_clump_free(&settings.clump);
    return status;
}

const ms_generator ms_generator_variational = {
    .name = "variational",
    .summary = "spheres fitted to the surface where they are exposed, so that the mismatch itself is least",
    .source = "mskit (2026); objective: Buchele et al., MSS eq. 2",
    .nested = 0,
    .volume_by = "hold-volume",
    .bytes_per_voxel = 7,
    .bytes_per_square = 60, /* places to start from */
    .kept_bytes = 4.8,      /* signed distances at steps 1, 2, 3 and 4 */
    .options = OPTIONS,
    .generate = generate_by_variational,
};
