#include "ms_volume_hold.h"

#include <math.h>
#include <stdlib.h>

#include "ms_bulk.h"
#include "ms_dice.h"

/* Of fits, each at one price: at most, and after the price is found; and of the steps of each. */
enum { FITS = 16, LAST_FITS = 6, STEPS = 8 };

/* Part of each step of the fit that is made at first, and in the end. */
static const double FIRST = 0.5, LAST = 0.03;

/* Difference of the volumes, as part of that of the shape, at which the price is found. */
static const double CLOSE = 1e-3;

/* How much shorter steps of the price are after too much volume has become too little, or the other way. */
static const double SHORTER = 0.7;

/* Price at most: at 1 what is outside costs nothing. */
static const double MOST = 0.95;

/* What is known of spheres; |U| in voxels. */
typedef struct state {
    double dice, volume;
} state;

static double find_shape_volume(const ms_target *target)
{
    return target->body.volume / pow(target->grid.h, 3);
}

static ms_status find_state(state *out, const ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err)
{
    ms_ball *all = malloc((8 * count + 1) * sizeof *all);
    if (!all) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    ms_status status = ms_dice_union_volume(&out->volume, all, ms_mirror_expand(all, ball, count, &fit->mirror), err);
    free(all);
    return status == MS_OK ? ms_bulk_dice(&out->dice, ball, count, fit, err) : status;
}

static double find_volume_lack(const state *now, const ms_target *target)
{
    return 1 - now->volume / find_shape_volume(target);
}

/*
 * By how much the price has to rise. Surfaces lie within about 2 m of each other, where m = |S xor U| / A is their mean
 * distance, either way alike: moved outward by x, x / (2 m) more of the surface lies outside than inside, which is at
 * rest at that price, and A x is the volume that was lacking.
 */
static double find_rise(const state *now, const ms_target *target)
{
    const double wanted = find_shape_volume(target), lack = wanted - now->volume;
    const double mismatch = fmax(now->dice * (wanted + now->volume), fabs(lack)); /* |S xor U| is never less */
    return mismatch > 0 ? lack / (2 * mismatch) : 0;
}

/* A search under way. */
typedef struct price_search {
    const ms_run *run; /* is told of each fit */
    ms_surface_fit *fit;
    ms_ball *ball;
    size_t count;
    state now;
    double price, part; /* of the rise, that is made */
} price_search;

/* A fit at the next price. */
static ms_status fit_at_price(price_search *s, double from, double to, ms_error *err)
{
    const double damping[2] = {from, to};
    const ms_target *target = s->run->target;
    const double before = find_volume_lack(&s->now, target);
    ms_status status = ms_generator_stage(s->run, "fit to the volume", (double)NAN, err);
    if (status != MS_OK) {
        return status;
    }
    s->price = fmin(fmax(s->price + s->part * find_rise(&s->now, target), -MOST), MOST);
    s->fit->slant = s->price;
    status = ms_surface_fit_steps(s->fit, s->ball, s->count, STEPS, damping, err);
    s->fit->slant = 0;
    if (status == MS_OK) {
        status = find_state(&s->now, s->ball, s->count, s->fit, err);
    }
    if (find_volume_lack(&s->now, target) * before < 0) {
        s->part *= SHORTER;
    }
    return status;
}

static ms_status seek_price(price_search *s, ms_error *err)
{
    ms_status status = MS_OK;
    for (int f = 0; f < FITS && status == MS_OK && fabs(find_volume_lack(&s->now, s->run->target)) > CLOSE; f++) {
        status = fit_at_price(s, FIRST, FIRST, err);
    }
    for (int f = 0; f < LAST_FITS && status == MS_OK; f++) {
        const double less = (FIRST - LAST) / LAST_FITS, from = FIRST - f * less;
        status = fit_at_price(s, from, from - less, err);
    }
    return status;
}

ms_status ms_volume_hold(ms_ball *ball, size_t count, ms_surface_fit *fit, const ms_run *run, ms_error *err)
{
    price_search s = {.run = run, .fit = fit, .ball = ball, .count = count, .part = 1};
    const ms_status status = find_state(&s.now, ball, count, fit, err);
    s.price = s.now.dice; /* at which D is least (Dinkelbach) */
    return status == MS_OK ? seek_price(&s, err) : status;
}
