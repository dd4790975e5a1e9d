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

/* Of the fit with one D, how often D is looked at again, and after how many times only the better start goes on. */
enum { STEPS = 20, TURNS = 5, RACE = 2 };

/* D from which surfaces are so far apart that coarser nodes will do: until it is known which start goes on, those at
 * so many voxels; then every second one. */
static const double ROUGH = 0.2;
enum { RACE_STEP = 4 };

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

static ms_status measure_start(spheres *s, const ms_surface_fit *fit, ms_error *err)
{
    const ms_status status = ms_bulk_dice(&s->dice, s->ball, s->count, fit, err);
    const double excess = status == MS_OK && fit->gap ? ms_gap_excess(fit->gap, s->ball, s->count) : 0;
    s->cost = s->dice + MS_GAP_PRICE * excess / (double)fit->field->target->voxels;
    return status;
}

static void copy_balls(spheres *to, const spheres *from)
{
    const spheres copy = {to->ball, from->count, from->dice, from->cost};
    memcpy(to->ball, from->ball, from->count * sizeof *from->ball);
    *to = copy;
}

static void keep_better(spheres *best, const spheres *s)
{
    if (s->cost < best->cost) {
        copy_balls(best, s);
    }
}

/* Has spheres keep to what they are bound to; one that cannot be joined to the others is dropped. */
static ms_status settle_within_bounds(spheres *s, ms_surface_fit *fit, ms_error *err)
{
    ms_bounds_confine(&fit->bounds, fit->field, s->ball, s->count);
    ms_status status = ms_bulk_dice(&fit->slant, s->ball, s->count, fit, err);
    if (status == MS_OK && fit->connected) {
        status = ms_connect_fit(s->ball, s->count, fit, err);
    }
    if (status == MS_OK && fit->gap) {
        status = ms_gap_hold(s->ball, s->count, fit, err);
    }
    if (status == MS_OK && fit->connected) {
        status = ms_connect_hold(s->ball, &s->count, fit, err);
    }
    fit->slant = 0;
    return status == MS_OK ? measure_start(s, fit, err) : status;
}

/* Nothing is to be held that a fit may lose. */
static int is_free(const ms_surface_fit *fit)
{
    return !ms_bounds_are_set(&fit->bounds) && !fit->bounds.equal && !fit->gap && !fit->connected;
}

/* Fits for the least D in the turns from..to-1, by a field that is coarse while the surfaces are far apart. */
static ms_status fit_turns(spheres *best, spheres *s, int from, int to, ms_surface_fit *fit, ms_error *err)
{
    static const double DAMPING[TURNS][2] = {{0.8, 0.4}, {0.8, 0.4}, {0.6, 0.3}, {0.5, 0.2}, {0.3, 0.05}};
    const ms_signed_distance *fine = fit->field;
    ms_signed_distance rough = *fine;
    ms_status status = MS_OK;
    if (is_free(fit) && s->dice >= ROUGH && ms_signed_distance_is_exact(fine)) {
        status = ms_signed_distance_open(&rough, fine->target, from == 0 ? RACE_STEP : 2 * fine->step, err);
    }
    fit->field = &rough;
    for (int turn = from; turn < to && status == MS_OK; turn++) {
        fit->slant = fmin(s->dice, best->dice);
        status = ms_surface_fit_steps(fit, s->ball, s->count, STEPS, DAMPING[turn], err);
        fit->slant = 0;
        if (status == MS_OK) {
            status = measure_start(s, fit, err);
        }
        if (status == MS_OK && is_free(fit)) {
            keep_better(best, s);
        }
    }
    fit->field = fine;
    return status;
}

/* The first turns, after which it is known which start is better. */
static ms_status begin_start(spheres *best, spheres *s, ms_surface_fit *fit, ms_error *err)
{
    for (size_t b = 0; b < s->count; b++) {
        s->ball[b].radius = fmax(s->ball[b].radius, fit->bounds.least);
    }
    const ms_status status = measure_start(s, fit, err);
    if (status == MS_OK && is_free(fit)) {
        keep_better(best, s);
    }
    return status == MS_OK ? fit_turns(best, s, 0, RACE, fit, err) : status;
}

static ms_status finish_start(spheres *best, spheres *s, ms_surface_fit *fit, ms_error *err)
{
    ms_status status = fit_turns(best, s, RACE, TURNS, fit, err);
    if (status == MS_OK && !is_free(fit)) {
        status = settle_within_bounds(s, fit, err);
    }
    if (status == MS_OK) {
        keep_better(best, s);
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
 * be; and pieces that are fitted to one. */
static ms_status settle_given(spheres *best, spheres *s, const spheres *first, ms_surface_fit *fit, ms_error *err)
{
    ms_status status = MS_OK;
    if (fit->connected) {
        copy_balls(s, first);
        status = ms_connect_hold(s->ball, &s->count, fit, err);
        status = status == MS_OK ? measure_start(s, fit, err) : status;
        if (status == MS_OK) {
            keep_better(best, s);
        }
    }
    copy_balls(s, first);
    if (status == MS_OK) {
        status = settle_within_bounds(s, fit, err);
    }
    if (status == MS_OK) {
        keep_better(best, s);
    }
    return status;
}

/* All of it. @param one, another  room for the spheres of both starts */
static ms_status race_starts(spheres *best, spheres *one, spheres *another, const ms_bulk_other *other,
                             ms_surface_fit *fit, ms_error *err)
{
    const int *across = fit->mirror.across;
    const size_t images = (size_t)1 << (across[0] + across[1] + across[2]);
    ms_status status = measure_start(best, fit, err);
    copy_balls(another, best);
    best->cost = HUGE_VAL; /* not within bounds as yet */
    if (status == MS_OK) {
        status = settle_given(best, one, another, fit, err);
    }
    if (status == MS_OK) {
        status = begin_start(best, one, fit, err);
    }
    if (status == MS_OK && !is_free(fit)) { /* what the bounds cost is known in the end alone */
        status = finish_start(best, one, fit, err);
        one->cost = HUGE_VAL;
    }
    if (status == MS_OK) {
        status = other->given ? take_given(another->ball, &another->count, other, fit, err)
                              : ms_bulk_cluster(another->ball, &another->count, other->volume,
                                                other->wanted > images ? other->wanted / images : 1, err);
    }
    if (status == MS_OK) {
        status = begin_start(best, another, fit, err);
    }
    return status == MS_OK ? finish_start(best, another->cost < one->cost ? another : one, fit, err) : status;
}

ms_status ms_bulk_improve(ms_ball *ball, size_t *count, size_t room, const ms_bulk_other *other, ms_surface_fit *fit,
                          ms_error *err)
{
    spheres best = {.ball = ball, .count = *count}, one = {.ball = malloc((room + 1) * sizeof *ball)},
            another = {.ball = malloc((room + 1) * sizeof *ball)};
    const ms_status status = one.ball && another.ball ? race_starts(&best, &one, &another, other, fit, err)
                                                      : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", room);
    *count = best.count;
    free(one.ball);
    free(another.ball);
    return status;
}
