#include "ms_bulk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_connect_hold.h"
#include "ms_dice.h"
#include "ms_gap_hold.h"
#include "ms_prune.h"

/* Voxels that stand for the volume, at most about, and rounds of Lloyd's algorithm: more change little. */
enum { MOST_PLACES = 10000, ROUNDS = 12 };

/* Of the fit with one D, and how often D is looked at again. */
enum { STEPS = 20, TURNS = 5 };

/* The places that stand for a volume; each belongs to the nearest centre. */
typedef struct places {
    size_t count;
    double (*at)[3];
    double *square; /* of the distance to the nearest centre */
    size_t *owner;
} places;

static void free_places(places *p)
{
    free(p->at);
    free(p->square);
    free(p->owner);
}

static ms_status list_places(places *out, const ms_coarse_view *view, ms_error *err)
{
    const ms_grid *grid = &view->grid;
    const size_t all = ms_grid_count(grid), each = all / MOST_PLACES + 1;
    *out = (places){.at = malloc((all / each + 1) * sizeof *out->at),
                    .square = malloc((all / each + 1) * sizeof *out->square),
                    .owner = calloc(all / each + 1, sizeof *out->owner)};
    if (!out->at || !out->square || !out->owner) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the clusters to start from");
    }
    size_t passed = 0;
    for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
        if (grid->inside[v] && passed++ % each == 0) {
            int at[3];
            ms_grid_voxel(at, grid->n, v);
            for (int c = 0; c < 3; c++) {
                out->at[out->count][c] = view->step * at[c];
            }
            out->square[out->count++] = HUGE_VAL;
        }
    }
    return MS_OK;
}

/* Those of a new centre: nearer to it than to their own. */
static void give_nearest(places *p, const double centre[3], size_t which)
{
    for (size_t i = 0; i < p->count; i++) {
        const double square = ms_squared_distance(p->at[i], centre);
        if (square < p->square[i]) {
            p->square[i] = square;
            p->owner[i] = which;
        }
    }
}

/* Each next one is the place that is the farthest from those before. */
static size_t spread_centres(ms_ball *ball, places *p, size_t wanted)
{
    size_t count = 0;
    while (count < wanted && count < p->count) {
        size_t farthest = 0;
        for (size_t i = 1; i < p->count; i++) {
            farthest = p->square[i] > p->square[farthest] ? i : farthest;
        }
        if (!(p->square[farthest] > 0)) {
            break;
        }
        memcpy(ball[count].centre, p->at[farthest], sizeof ball->centre);
        give_nearest(p, ball[count].centre, count);
        count++;
    }
    return count;
}

/* Centroids of the places, and the radii of balls with their second moments, (3/5) R^2. */
static void move_to_centroids(ms_ball *ball, size_t count, const places *p)
{
    for (size_t b = 0; b < count; b++) {
        double sum[3] = {0}, squares = 0, n = 0;
        for (size_t i = 0; i < p->count; i++) {
            if (p->owner[i] == b) {
                for (int c = 0; c < 3; c++) {
                    sum[c] += p->at[i][c];
                }
                squares += ms_dot(p->at[i], p->at[i]);
                n++;
            }
        }
        for (int c = 0; c < 3 && n > 0; c++) {
            ball[b].centre[c] = sum[c] / n;
        }
        const double spread = n > 0 ? squares / n - ms_dot(ball[b].centre, ball[b].centre) : 0;
        ball[b].radius = sqrt(5.0 / 3 * fmax(spread, 0));
    }
}

ms_status ms_bulk_cluster(ms_ball *ball, size_t *count, const ms_coarse_view *volume, size_t wanted, ms_error *err)
{
    places p;
    ms_status status = list_places(&p, volume, err);
    *count = status == MS_OK ? spread_centres(ball, &p, wanted) : 0;
    for (int round = 0; round<ROUNDS && * count> 0; round++) {
        move_to_centroids(ball, *count, &p);
        for (size_t i = 0; i < p.count; i++) {
            p.square[i] = HUGE_VAL;
        }
        for (size_t b = 0; b < *count; b++) {
            give_nearest(&p, ball[b].centre, b);
        }
    }
    free_places(&p);
    return status;
}

ms_status ms_bulk_dice(double *dice, const ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err)
{
    const ms_target *target = fit->field->target;
    ms_ball *all = malloc((8 * count + 1) * sizeof *all);
    if (!all) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    const size_t n = ms_mirror_expand(all, ball, count, &fit->mirror);
    const ms_status status = ms_dice_compute(dice, &target->grid, target->voxels, all, n, err);
    free(all);
    return status;
}

/* Spheres, their D, and that with the price of what of the surface is too far from them. */
typedef struct spheres {
    ms_ball *ball;
    size_t count;
    double dice, cost;
} spheres;

/* Replaces the best ones so far by better ones. */
static ms_status keep_better(spheres *best, const ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err)
{
    double dice;
    const ms_status status = ms_bulk_dice(&dice, ball, count, fit, err);
    const double excess = status == MS_OK && fit->gap ? ms_gap_excess(fit->gap, ball, count) : 0;
    const double cost = dice + MS_GAP_PRICE * excess / (double)fit->field->target->voxels;
    if (status == MS_OK && cost < best->cost) {
        best->dice = dice;
        best->cost = cost;
        best->count = count;
        memcpy(best->ball, ball, count * sizeof *ball);
    }
    return status;
}

/* Has spheres keep to what they are bound to; one that cannot be joined to the others is dropped. */
static ms_status settle_within_bounds(ms_ball *ball, size_t *count, ms_surface_fit *fit, ms_error *err)
{
    double dice;
    ms_bounds_confine(&fit->bounds, fit->field, ball, *count);
    ms_status status = ms_bulk_dice(&dice, ball, *count, fit, err);
    fit->slant = dice;
    if (status == MS_OK && fit->connected) {
        status = ms_connect_fit(ball, *count, fit, err);
    }
    if (status == MS_OK && fit->gap) {
        status = ms_gap_hold(ball, *count, fit, err);
    }
    if (status == MS_OK && fit->connected) {
        status = ms_connect_hold(ball, count, fit, err);
    }
    fit->slant = 0;
    return status;
}

/* Fits for the least D, and keeps what is better than all before, with and without the last fits. */
static ms_status fit_bulk(spheres *best, ms_ball *ball, size_t count, ms_surface_fit *fit, ms_error *err)
{
    static const double DAMPING[TURNS][2] = {{0.8, 0.4}, {0.8, 0.4}, {0.6, 0.3}, {0.5, 0.2}, {0.3, 0.05}};
    const int is_free = !ms_bounds_are_set(&fit->bounds) && !fit->bounds.equal && !fit->gap && !fit->connected;
    ms_status status = MS_OK;
    for (size_t b = 0; b < count; b++) {
        ball[b].radius = fmax(ball[b].radius, fit->bounds.least);
    }
    for (int turn = 0; turn <= TURNS && status == MS_OK; turn++) {
        if (turn > 0) {
            double dice;
            status = ms_bulk_dice(&dice, ball, count, fit, err);
            fit->slant = fmin(dice, best->dice);
        }
        if (turn > 0 && status == MS_OK) {
            status = ms_surface_fit_steps(fit, ball, count, STEPS, DAMPING[turn - 1], err);
            fit->slant = 0;
        }
        if (status == MS_OK && turn == TURNS) {
            status = settle_within_bounds(ball, &count, fit, err);
        }
        if (status == MS_OK && (is_free || turn == TURNS)) {
            status = keep_better(best, ball, count, fit, err);
        }
    }
    return status;
}

/* The given spheres but for those above the number wanted. */
static ms_status take_given(ms_ball *ball, size_t *count, const ms_bulk_other *other, ms_surface_fit *fit,
                            ms_error *err)
{
    ms_status status = MS_OK;
    memcpy(ball, other->given, other->n_given * sizeof *ball);
    *count = other->n_given;
    for (;;) {
        size_t all = 0;
        for (size_t b = 0; b < *count; b++) {
            all += ms_mirror_images(&fit->mirror, &ball[b]);
        }
        if (status != MS_OK || all <= other->wanted) {
            return status;
        }
        fit->slant = 0.5;
        status = ms_prune_cheapest(ball, count, all - other->wanted, other->volume, fit, err);
        fit->slant = 0;
    }
}

/* The spheres that there are, within their bounds: pieces as they are, since fits may pull spheres from where they may
 * be; pieces that are fitted to one; and all fitted for D. */
static ms_status try_first(spheres *best, ms_ball *tried, const ms_ball *first, size_t count, ms_surface_fit *fit,
                           ms_error *err)
{
    size_t n = count;
    memcpy(tried, first, n * sizeof *tried);
    ms_status status = ms_bulk_dice(&best->dice, tried, n, fit, err);
    if (status == MS_OK && fit->connected) {
        status = ms_connect_hold(tried, &n, fit, err);
        status = status == MS_OK ? keep_better(best, tried, n, fit, err) : status;
        n = count;
        memcpy(tried, first, n * sizeof *tried);
    }
    if (status == MS_OK) {
        status = settle_within_bounds(tried, &n, fit, err);
    }
    if (status == MS_OK) {
        status = keep_better(best, tried, n, fit, err);
    }
    return status == MS_OK ? fit_bulk(best, tried, n, fit, err) : status;
}

ms_status ms_bulk_improve(ms_ball *ball, size_t *count, size_t room, const ms_bulk_other *other, ms_surface_fit *fit,
                          ms_error *err)
{
    const int *across = fit->mirror.across;
    const size_t images = (size_t)1 << (across[0] + across[1] + across[2]);
    const size_t clusters = other->wanted > images ? other->wanted / images : 1;
    ms_ball *tried = malloc((room + 1) * sizeof *tried), *first = malloc((room + 1) * sizeof *first);
    spheres best = {ball, *count, 1, HUGE_VAL};
    ms_status status = tried && first ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", room);
    if (status == MS_OK) {
        memcpy(first, ball, *count * sizeof *first);
        status = try_first(&best, tried, first, *count, fit, err);
    }
    if (status == MS_OK) {
        size_t n;
        status = other->given ? take_given(tried, &n, other, fit, err)
                              : ms_bulk_cluster(tried, &n, other->volume, clusters, err);
        if (status == MS_OK) {
            status = fit_bulk(&best, tried, n, fit, err);
        }
    }
    *count = best.count;
    free(first);
    free(tried);
    return status;
}
