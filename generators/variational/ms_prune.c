#include "ms_prune.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_surface_tally.h"

/* Voxels of the view up to which a count says less than the exposed surface. */
static const double FEW = 100;

/* Spheres whose centres are nearer than this part of the sum of their radii are not dropped at once. In a sheet of many
 * nearly all overlap, but each bears the surface of the few about it alone. */
static const double CLOSE = 0.3;

/* A sphere is idle whose loss is less than this part of the mismatch that is a sphere's share. */
static const double IDLE = 0.05;

/* Counts all spheres and their images on the grid; `all` is how many there are. */
static ms_status count_all(ms_coverage_count *out, size_t *all, const ms_ball *ball, size_t count,
                           const ms_coarse_view *view, const ms_mirror *m, ms_error *err)
{
    ms_ball *image = malloc((8 * count + 1) * sizeof *image);
    if (!image) {
        *out = (ms_coverage_count){0};
        return ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", count);
    }
    *all = ms_mirror_expand(image, ball, count, m);
    for (size_t i = 0; i < *all; i++) {
        image[i] = ms_coarse_view_ball(view, &image[i]);
    }
    const ms_status status = ms_coverage_count_open(out, &view->grid, image, *all, err);
    free(image);
    return status;
}

/* Takes away a sphere and its images; returns by how much the mismatch grows. */
static int64_t take_away(ms_coverage_count *o, ms_ball image[8], size_t *images, const ms_ball *ball,
                         const ms_coarse_view *view, const ms_mirror *m)
{
    const int64_t before = o->mismatch;
    *images = ms_mirror_expand(image, ball, 1, m);
    for (size_t i = 0; i < *images; i++) {
        image[i] = ms_coarse_view_ball(view, &image[i]);
        ms_coverage_count_remove(o, &image[i]);
    }
    return o->mismatch - before;
}

static void put_back(ms_coverage_count *o, const ms_ball image[8], size_t images)
{
    for (size_t i = 0; i < images; i++) {
        ms_coverage_count_add(o, &image[i]);
    }
}

/* What the mismatch would grow by without each sphere, by voxels of the view; of images together, for each of them: as
 * they overlap. */
static ms_status count_losses(double *loss, const ms_ball *ball, size_t count, const ms_coarse_view *view,
                              const ms_mirror *m, ms_error *err)
{
    ms_coverage_count o;
    size_t all = 0;
    const ms_status status = count_all(&o, &all, ball, count, view, m, err);
    const size_t alone = status == MS_OK && all == count ? count : 0;
    const size_t paired = status == MS_OK && all > count ? count : 0;
#pragma omp parallel for schedule(dynamic, 4)
    for (size_t b = 0; b < alone; b++) {
        const ms_ball coarse = ms_coarse_view_ball(view, &ball[b]);
        loss[b] = (double)ms_coverage_count_loss(&o, &coarse);
    }
    for (size_t b = 0; b < paired; b++) {
        ms_ball image[8];
        size_t images;
        loss[b] = (double)take_away(&o, image, &images, &ball[b], view, m);
        put_back(&o, image, images);
        loss[b] /= (double)images;
    }
    ms_coverage_count_close(&o);
    return status;
}

/* Does the exposed surface tell losses better than voxels? Not of spheres whose own images cover them. */
static int is_surface_sharper(const ms_surface_fit *fit)
{
    const int *across = fit->mirror.across;
    return ms_signed_distance_is_exact(fit->field) && !(across[0] || across[1] || across[2]);
}

/* What the surface would come to be too far without each. */
static ms_status add_gap_losses(double *loss, const ms_ball *ball, size_t count, const ms_surface_fit *fit,
                                ms_error *err)
{
    double *far = malloc((count + 1) * sizeof *far);
    if (!far) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", count);
    }
    ms_gap_losses(far, fit->gap, ball, count);
    for (size_t b = 0; b < count; b++) {
        loss[b] += MS_GAP_PRICE * far[b];
    }
    free(far);
    return MS_OK;
}

/* By the exposed surface instead, where a loss is less than that: elsewhere voxels say enough. All, with a slant. */
static ms_status sharpen_losses(double *loss, double than, const ms_ball *ball, size_t count, const ms_surface_fit *fit,
                                ms_error *err)
{
    ms_surface_worth *fine = malloc((count + 1) * sizeof *fine);
    uint8_t *few = malloc(count + 1);
    ms_status status = fine && few ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", count);
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        few[b] = fit->slant > 0 || fabs(loss[b]) < than;
    }
    if (status == MS_OK) {
        status = ms_surface_tally(fine, NULL, few, fit, ball, count, err);
    }
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        loss[b] = few[b] ? fine[b].loss : loss[b];
    }
    free(few);
    free(fine);
    return status;
}

/* The same in voxels of the target; where few are counted, by the exposed surface. */
static ms_status find_losses(double *loss, const ms_ball *ball, size_t count, const ms_coarse_view *view,
                             const ms_surface_fit *fit, ms_error *err)
{
    const double cell = (double)view->step * view->step * view->step;
    ms_status status = count_losses(loss, ball, count, view, &fit->mirror, err);
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        loss[b] *= cell;
    }
    if (status == MS_OK && is_surface_sharper(fit)) {
        status = sharpen_losses(loss, FEW * cell, ball, count, fit, err);
    }
    return status == MS_OK && fit->gap ? add_gap_losses(loss, ball, count, fit, err) : status;
}

static void move_nearest_onto_plane(ms_ball *ball, size_t count, const ms_mirror *m)
{
    size_t nearest = 0;
    int axis = -1;
    double least = HUGE_VAL, part;
    for (size_t b = 0; b < count; b++) {
        const int across = ms_mirror_nearest(&part, m, &ball[b]);
        if (part < least) {
            least = part;
            axis = across;
            nearest = b;
        }
    }
    if (axis >= 0) {
        ball[nearest].centre[axis] = m->at[axis];
    }
}

static int are_close(const ms_ball *a, const ms_ball *b)
{
    const double reach = CLOSE * (a->radius + b->radius);
    return ms_squared_distance(a->centre, b->centre) < reach * reach;
}

/* The cheapest sphere that is close to none of those dropped already and has no more than that many images. */
static size_t find_cheapest(const ms_ball *ball, size_t count, const double *loss, size_t images, const ms_mirror *m,
                            const ms_ball *dropped, size_t n_dropped)
{
    size_t best = SIZE_MAX;
    for (size_t b = 0; b < count; b++) {
        int passed = (best != SIZE_MAX && loss[b] >= loss[best]) || ms_mirror_images(m, &ball[b]) > images;
        for (size_t d = 0; d < n_dropped && !passed; d++) {
            passed = are_close(&ball[b], &dropped[d]);
        }
        if (!passed) {
            best = b;
        }
    }
    return best;
}

ms_status ms_prune_cheapest(ms_ball *ball, size_t *count, size_t most, const ms_coarse_view *view,
                            const ms_surface_fit *fit, ms_error *err)
{
    const ms_mirror *m = &fit->mirror;
    ms_ball *dropped = malloc((most + 1) * sizeof *dropped);
    double *loss = malloc((*count + 1) * sizeof *loss);
    size_t n_dropped = 0, gone = 0, b;
    ms_status status = dropped && loss ? find_losses(loss, ball, *count, view, fit, err)
                                       : ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", *count);
    while (status == MS_OK && gone < most &&
           (b = find_cheapest(ball, *count, loss, most - gone, m, dropped, n_dropped)) != SIZE_MAX) {
        dropped[n_dropped++] = ball[b];
        gone += ms_mirror_images(m, &ball[b]);
        ball[b] = ball[--*count];
        loss[b] = loss[*count];
    }
    if (status == MS_OK && gone == 0) {
        move_nearest_onto_plane(ball, *count, m);
    }
    free(dropped);
    free(loss);
    return status;
}

/* Once; a sphere that stays may become idle when a later one goes. Where what the surface would come to be too far has
 * a say (NULL: it has none), one at most, as each may stand in for another. Returns how many went. */
static size_t drop_idle(ms_ball *ball, size_t *count, ms_coverage_count *o, const ms_surface_worth *worth, double least,
                        const double *far, const ms_coarse_view *view, const ms_mirror *m)
{
    size_t kept = 0;
    for (size_t b = 0; b < *count; b++) {
        ms_ball image[8];
        size_t images;
        if (worth[b].loss > least || (far && (far[b] > 0 || kept < b))) {
            ball[kept++] = ball[b];
        } else if (take_away(o, image, &images, &ball[b], view, m) > 0) {
            put_back(o, image, images);
            ball[kept++] = ball[b];
        }
    }
    const size_t gone = *count - kept;
    *count = kept;
    return gone;
}

/* By voxels; where the surface is known better than by them, also by what is exposed. */
ms_status ms_prune_idle(ms_ball *ball, size_t *count, const ms_surface_fit *fit, ms_error *err)
{
    const ms_coarse_view whole = {.step = 1, .grid = fit->field->target->grid}; /* borrows the voxels */
    ms_surface_worth *worth = calloc(*count + 1, sizeof *worth);
    double mismatch = 0, *far = malloc((*count + 1) * sizeof *far);
    size_t all, gone = 1;
    ms_coverage_count o = {0};
    ms_status status = worth && far ? count_all(&o, &all, ball, *count, &whole, &fit->mirror, err)
                                    : ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", *count);
    while (status == MS_OK && gone > 0) {
        if (is_surface_sharper(fit)) {
            status = ms_surface_tally(worth, &mismatch, NULL, fit, ball, *count, err);
        }
        const double least = IDLE * mismatch / (double)*count;
        memset(far, 0, *count * sizeof *far);
        if (status == MS_OK && fit->gap) {
            status = add_gap_losses(far, ball, *count, fit, err);
        }
        gone =
            status == MS_OK ? drop_idle(ball, count, &o, worth, least, fit->gap ? far : NULL, &whole, &fit->mirror) : 0;
    }
    ms_coverage_count_close(&o);
    free(far);
    free(worth);
    return status;
}
