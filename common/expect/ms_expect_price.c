#include "ms_expect_price.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = MS_EXPECT_KINDS, FREE = MS_EXPECT_FREE };

/* A point of which another ball is cheaper by this part is served by that one: less is the noise of counting points. */
static const double CHEAPER = 0.15;

/* A level: each `step`-th point, and a ball at each `every`-th of them; for numbers of spheres up to its last, which
 * have from 50 to 200 of these points each. */
typedef struct level {
    int step, every, points, balls, most; /* most: points that are kept of a ball's neighbours */
    double weight;                        /* area of a point */
    double last;                          /* number of spheres */
} level;

/* A point as a ball sees it. */
typedef struct view {
    double power; /* squared distance to the centre less the squared radius */
    double slope; /* what the surface is off for each unit of that: 1 / twice the radius about the ball's own point */
    int point;    /* of the level */
} view;

/* What a ball costs that serves its first k + 1 points, by error summed over points. */
typedef struct offer {
    int count, neighbours;
    double radius;
    double *error[KINDS]; /* most */
    double *middle;       /* most: power of the best sphere about the centre */
    view *neighbour;      /* those of the points that have balls, nearest first; point: the ball */
} offer;

static int compare_views(const void *a, const void *b)
{
    const view *v = a, *w = b;
    return v->power != w->power ? (v->power > w->power) - (v->power < w->power) : v->point - w->point;
}

/* Moves the `keep` nearest to the front. Source: Hoare, Algorithm 65 (1961). */
static void select_nearest(view *v, int count, int keep)
{
    int lo = 0, hi = count - 1;
    while (lo < hi) {
        const double pivot = v[lo + (hi - lo) / 2].power;
        int i = lo, j = hi;
        while (i <= j) {
            while (v[i].power < pivot) {
                i++;
            }
            while (v[j].power > pivot) {
                j--;
            }
            if (i <= j) {
                const view swap = v[i];
                v[i++] = v[j];
                v[j--] = swap;
            }
        }
        if (keep - 1 <= j) {
            hi = j;
        } else if (keep - 1 >= i) {
            lo = i;
        } else {
            return;
        }
    }
}

/*
 * The points that a ball faces, nearest first. Along the normal of a point at height b above the centre and x beside
 * it, a sphere of radius R is off by b - sqrt(R^2 - x^2) = (b^2 + x^2 - R^2) / (b + sqrt(R^2 - x^2)), of which 2 b is
 * the denominator to first order.
 */
static int see_points(view *v, const ms_expect_points *points, const level *l, int ball)
{
    const int own = ball * l->every * l->step;
    const double radius = points->radius[own / MS_EXPECT_BALL_STEP];
    double centre[3];
    int count = 0;
    for (int a = 0; a < 3; a++) {
        centre[a] = points->at[a][own] - radius * points->normal[a][own];
    }
    for (int p = 0; p < l->points; p++) {
        const int at = p * l->step;
        const double x = points->at[0][at] - centre[0], y = points->at[1][at] - centre[1],
                     z = points->at[2][at] - centre[2];
        const double square = x * x + y * y + z * z, power = square - radius * radius;
        const double height = x * points->normal[0][at] + y * points->normal[1][at] + z * points->normal[2][at];
        if (height <= 0 || height * height < 0.01 * square || power > 4 * radius * height) {
            continue;
        }
        const double slope = 1 / (2 * height);
        if (power * slope < 2 * radius) {
            v[count++] = (view){power, slope, p};
        }
    }
    if (count > l->most) {
        select_nearest(v, count, l->most);
        count = l->most;
    }
    qsort(v, (size_t)count, sizeof *v, compare_views);
    return count;
}

/* Sums of errors over the first points, for the sphere that is best for just these (the weighted median of their
 * powers), and for the inscribed ball. */
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
        o->error[!FREE][k] = all;
    }
}

static void make_offer(offer *o, view *v, const ms_expect_points *points, const level *l, int ball)
{
    o->radius = points->radius[ball * l->every * l->step / MS_EXPECT_BALL_STEP];
    o->count = see_points(v, points, l, ball);
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
        if (fmax(error, own->value) < c->value) {
            *c = (choice){fmax(error, own->value), 0, error > own->value ? 0 : own->served};
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
        view *v = malloc((size_t)l->points * sizeof *v);
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
    return failed ? ms_fail(err, MS_ERR_NOMEM, "no memory for the views of %d points", l->points) : MS_OK;
}

/* Prices from high to low until there are too many spheres for the level. from: a price in error, and the last one */
static void add_pairs(ms_expect_curve *curve, double *from, store *r, const level *l, int kind, double volume)
{
    static const double STEP = 1.4;
    double sum = 0;
    for (int b = 0; b < l->balls; b++) {
        sum += r->offer[b].radius;
        r->choice[b].served = l->most;
    }
    const double area = l->weight * l->points;
    const double depth = fmin(1, volume / area * l->balls / sum), least = 1e-12 * volume;
    for (double price = *from; curve->count < MS_EXPECT_MOST_PAIRS && price > least; price /= STEP) {
        const ms_expect_pair pair =
            settle(r->choice, r->choice + l->balls, r->offer, l, kind, price / l->weight, depth);
        if (pair.spheres > l->last && (pair.lost < 0.02 || pair.spheres > l->points / 8.0)) {
            return;
        }
        *from = price;
        if (pair.spheres > curve->pair[curve->count - 1].spheres) {
            curve->pair[curve->count++] = pair;
        }
    }
}

ms_status ms_expect_price_curves(ms_expect *expect, const ms_expect_points *points, double volume, ms_error *err)
{
    static const int STEPS[] = {8, 2, 1}, EVERY[] = {2, 4, 8}, MOST[] = {1024, 768, 384};
    static const double LAST[] = {10, 40, 170};
    double from[KINDS];
    ms_status status = MS_OK;
    for (int kind = 0; kind < KINDS; kind++) {
        from[kind] = volume;
        expect->curve[kind].pair[0] = (ms_expect_pair){0, 1, 1};
        expect->curve[kind].count = 1;
    }
    for (int i = 0; i < 3 && status == MS_OK; i++) {
        level l = {.step = STEPS[i], .every = EVERY[i], .points = MS_EXPECT_POINTS / STEPS[i]};
        store r;
        l.weight = points->weight * l.step;
        l.balls = l.points / l.every;
        l.last = LAST[i];
        l.most = MOST[i];
        status = alloc_store(&r, &l, err);
        if (status == MS_OK) {
            status = make_offers(r.offer, points, &l, err);
            for (int kind = 0; kind < KINDS && status == MS_OK; kind++) {
                add_pairs(&expect->curve[kind], &from[kind], &r, &l, kind, volume);
                from[kind] *= 4;
            }
            free_store(&r);
        }
    }
    return status;
}
