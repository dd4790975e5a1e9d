#include "ms_expect_price.h"

#include <math.h>
#include <stdlib.h>

#include "ms_expect_view.h"

enum { KINDS = MS_EXPECT_KINDS, FREE = MS_EXPECT_FREE };

/* A point of which another ball is cheaper by this part is served by that one: less is the noise of counting points. */
static const double CHEAPER = 0.3;

typedef ms_expect_level level;
typedef ms_expect_view view;

/* What a ball costs that serves its first k + 1 points, by error summed over points. */
typedef struct offer {
    int count, neighbours;
    double radius;
    double *error[KINDS]; /* most */
    double *middle;       /* most: power of the best sphere about the centre */
    view *neighbour;      /* those of the points that have balls, nearest first; point: the ball */
} offer;

/* Sums of errors over the first points, for the sphere that is best for just these (the weighted median of their
 * powers), and for the largest that none of the points lies in: that through the nearest. */
static void sum_errors(offer *o, const view *v)
{
    double slopes = 0, all = 0, slopes_below = 0, below = 0;
    int middle = 0;
    for (int k = 0; k < o->count; k++) {
        slopes += v[k].slope;
        all += v[k].slope * v[k].power;
        while (middle < k && slopes_below + v[middle].slope <= slopes / 2) {
            slopes_below += v[middle].slope;
            below += v[middle].slope * v[middle].power;
            middle++;
        }
        o->middle[k] = v[middle].power;
        o->error[FREE][k] = all - 2 * below - v[middle].power * (slopes - 2 * slopes_below);
        o->error[!FREE][k] = all - v[0].power * slopes;
    }
}

static void make_offer(offer *o, view *v, const ms_expect_points *points, const level *l, int ball)
{
    o->radius = points->radius[ball * l->every * l->step / MS_EXPECT_BALL_STEP];
    o->count = ms_expect_view_see(v, points, l, ball);
    sum_errors(o, v);
    o->neighbours = 0;
    for (int k = 0; k < o->count; k++) {
        if (v[k].point % l->every == 0) {
            o->neighbour[o->neighbours] = v[k];
            o->neighbour[o->neighbours++].point /= l->every;
        }
    }
}

/* What is best at a price. */
typedef struct choice {
    double value; /* price and error, for each point served */
    double middle;
    int served; /* points; 0: none */
} choice;

/* At a lower price no more points are best than at a higher one, `most`. price: of a sphere, in the error of a point */
static choice choose(const offer *o, int kind, double price, int most)
{
    choice best = {.value = HUGE_VAL};
    for (int k = 0; k < o->count && k < most; k++) {
        const double value = price + o->error[kind][k];
        if (value < best.value * (k + 1)) {
            best.value = value / (k + 1);
            best.served = k + 1;
        }
    }
    if (kind == FREE && best.served > 0) {
        best.middle = o->middle[best.served - 1];
    }
    return best;
}

/* Where another ball's offer is better for the point of a ball, that one's. */
static void offer_to_neighbours(choice *low, const offer *o, const choice *own)
{
    for (int k = 0; k < o->neighbours; k++) {
        const double error = fabs(o->neighbour[k].power - own->middle) * o->neighbour[k].slope;
        if (error > 2 * own->value && k >= own->served) {
            return;
        }
        choice *c = &low[o->neighbour[k].point];
        const double value = error > own->value ? error : own->value;
        if (value < c->value) {
            *c = (choice){value, 0, error > own->value ? 0 : own->served};
        }
    }
}

/* The pair that belongs to a price; see docs/expected.md. depth: of a column above a ball, in its radii. */
static ms_expect_pair settle(choice *own, choice *low, const offer *o, const level *l, int kind, double price,
                             double depth)
{
    double spheres = 0, error = 0, lost = 0, all = 0;
#pragma omp parallel for schedule(static)
    for (int b = 0; b < l->balls; b++) {
        own[b] = choose(&o[b], kind, price, own[b].served);
        low[b] = (choice){.value = HUGE_VAL};
    }
    for (int b = 0; b < l->balls; b++) {
        offer_to_neighbours(low, &o[b], &own[b]);
    }
    for (int b = 0; b < l->balls; b++) {
        const choice *c = low[b].value < (1 - CHEAPER) * own[b].value ? &low[b] : &own[b];
        const double nothing = depth * o[b].radius;
        all += nothing;
        if (nothing <= c->value) {
            error += nothing;
            lost += nothing;
        } else {
            error += c->value;
            spheres += c->served > 0 ? 1.0 / c->served : 0;
        }
    }
    error -= price * spheres;
    return (ms_expect_pair){spheres * l->every, error / all, lost / all};
}

typedef struct store {
    offer *offer;
    double *sums;
    view *neighbours;
    choice *choice;
} store;

static void free_store(store *r)
{
    free(r->offer);
    free(r->sums);
    free(r->neighbours);
    free(r->choice);
}

static ms_status alloc_store(store *r, const level *l, ms_error *err)
{
    const size_t balls = (size_t)l->balls, most = (size_t)l->most;
    *r = (store){malloc(balls * sizeof *r->offer), malloc(balls * most * (KINDS + 1) * sizeof *r->sums),
                 malloc(balls * most * sizeof *r->neighbours), malloc(2 * balls * sizeof *r->choice)};
    if (!r->offer || !r->sums || !r->neighbours || !r->choice) {
        free_store(r);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for what is expected of %d balls", l->balls);
    }
    for (size_t b = 0; b < balls; b++) {
        double *sums = r->sums + b * most * (KINDS + 1);
        r->offer[b] =
            (offer){.error = {sums, sums + most}, .middle = sums + 2 * most, .neighbour = r->neighbours + b * most};
    }
    return MS_OK;
}

static ms_status make_offers(offer *o, const ms_expect_points *points, const level *l, ms_error *err)
{
    int failed = 0;
#pragma omp parallel
    {
        view *v = malloc(2 * (size_t)l->most * sizeof *v);
        if (!v) {
#pragma omp atomic write
            failed = 1;
        }
#pragma omp for schedule(dynamic, 16)
        for (int b = 0; b < l->balls; b++) {
            if (v) {
                make_offer(&o[b], v, points, l, b);
            }
        }
        free(v);
    }
    return failed ? ms_fail(err, MS_ERR_NOMEM, "no memory for the views of %d points", l->most) : MS_OK;
}

static ms_status open_level(store *r, level *l, const ms_expect_points *points, ms_error *err)
{
    ms_status status = ms_expect_view_open(l, points, err);
    if (status == MS_OK && (status = alloc_store(r, l, err)) == MS_OK &&
        (status = make_offers(r->offer, points, l, err)) != MS_OK) {
        free_store(r);
    }
    ms_expect_view_close(l);
    return status;
}

/* How deep columns are for all of them to make up the volume; in radii of their balls. */
static double column_depth(const store *r, const level *l, double volume)
{
    double sum = 0;
    for (int b = 0; b < l->balls; b++) {
        sum += r->offer[b].radius;
    }
    return fmin(1, volume / (l->weight * l->points) * l->balls / sum);
}

static void reset_choices(store *r, const level *l)
{
    for (int b = 0; b < l->balls; b++) {
        r->choice[b].served = l->most;
    }
}

static const double STEP = 1.4, LEAST_PRICE = 1e-12; /* from a price to the next; in volumes */

/* Prices from high to low until there are too many spheres for the level, or enough. from: a price in error, and the
 * last one */
static void add_pairs(ms_expect_curve *curve, double *from, store *r, const level *l, int kind, double volume,
                      double enough)
{
    const double depth = column_depth(r, l, volume);
    reset_choices(r, l);
    for (double price = *from; curve->count < MS_EXPECT_MOST_PAIRS && price > LEAST_PRICE * volume; price /= STEP) {
        const ms_expect_pair pair =
            settle(r->choice, r->choice + l->balls, r->offer, l, kind, price / l->weight, depth);
        if (pair.spheres > l->last && (pair.lost < 0.02 || pair.spheres > l->wall)) {
            return;
        }
        *from = price;
        if (pair.spheres > curve->pair[curve->count - 1].spheres) {
            curve->pair[curve->count++] = pair;
        }
        if (pair.spheres >= enough) {
            return;
        }
    }
}

/* A price at which there are fewer spheres, in long strides. */
static double find_price(store *r, const level *l, int kind, double volume, double spheres)
{
    static const double STRIDE = 5.4; /* STEP^5 */
    const double depth = column_depth(r, l, volume);
    double price = volume;
    while (price / STRIDE * spheres >= volume) { /* all that is paid is no more than the volume */
        price /= STRIDE;
    }
    reset_choices(r, l);
    while (price > LEAST_PRICE * volume &&
           settle(r->choice, r->choice + l->balls, r->offer, l, kind, price / STRIDE / l->weight, depth).spheres <
               spheres) {
        price /= STRIDE;
    }
    return price;
}

static void begin_curve(ms_expect_curve *curve)
{
    curve->pair[0] = (ms_expect_pair){0, 1, 1};
    curve->count = 1;
}

static const level LEVELS[] = {{.step = 8, .every = 2, .most = 1024, .last = 12},
                               {.step = 2, .every = 4, .most = 768, .last = 85},
                               {.step = 1, .every = 8, .most = 384, .last = 170, .wall = 1024}};
enum { N_LEVELS = sizeof LEVELS / sizeof *LEVELS };

static int level_of(double spheres)
{
    int i = 0;
    while (i + 1 < N_LEVELS && LEVELS[i].last < spheres) {
        i++;
    }
    return i;
}

int ms_expect_price_step(double spheres)
{
    const int i = level_of(spheres);
    return LEVELS[i + 1 < N_LEVELS ? i + 1 : i].step;
}

ms_status ms_expect_price_curves(ms_expect *expect, const ms_expect_points *points, double volume, ms_error *err)
{
    double from[KINDS];
    ms_status status = MS_OK;
    for (int kind = 0; kind < KINDS; kind++) {
        from[kind] = volume;
        begin_curve(&expect->curve[kind]);
    }
    for (int i = 0; i < N_LEVELS && status == MS_OK; i++) {
        level l = LEVELS[i];
        store r;
        status = open_level(&r, &l, points, err);
        for (int kind = 0; kind < KINDS && status == MS_OK; kind++) {
            add_pairs(&expect->curve[kind], &from[kind], &r, &l, kind, volume, HUGE_VAL);
            from[kind] *= 4;
        }
        if (status == MS_OK) {
            free_store(&r);
        }
    }
    return status;
}

/* The pairs about a number, at one level. */
static ms_status add_near(ms_expect_curve *curve, level l, const ms_expect_points *points, double volume,
                          double spheres, ms_error *err)
{
    static const double SHARES = 2; /* of the points that a sphere serves in the mean: no ball serves many more */
    store r;
    const int beyond = l.wall > 0 && spheres > l.last / STEP; /* the slope of the last quarter is wanted, too */
    l.most = beyond ? l.most : (int)fmin(l.most, SHARES * MS_EXPECT_POINTS / (l.step * spheres));
    const ms_status status = open_level(&r, &l, points, err);
    begin_curve(curve);
    if (status == MS_OK) {
        double from = find_price(&r, &l, FREE, volume, beyond ? l.last / 5 : spheres);
        add_pairs(curve, &from, &r, &l, FREE, volume, beyond ? HUGE_VAL : spheres);
        free_store(&r);
    }
    return status;
}

ms_status ms_expect_price_near(ms_expect_curve *curve, const ms_expect_points *points, double volume, double spheres,
                               ms_error *err)
{
    int i = level_of(spheres);
    ms_status status = add_near(curve, LEVELS[i], points, volume, spheres, err);
    /* no pair of the level reaches the number, as where walls begin to be worth while: the next one's do */
    while (status == MS_OK && i + 1 < N_LEVELS && curve->pair[curve->count - 1].spheres < spheres) {
        status = add_near(curve, LEVELS[++i], points, volume, spheres, err);
    }
    return status;
}
