#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "ms_mss_open.h"
#include "ms_mss_polish.h"
#include "ms_mss_run.h"

/* Radii that are tried, in voxels from E: E is to the centre of the nearest background voxel, half a voxel beyond the
 * surface, and spheres that stand out a little lower the mismatch. Farther out is better for few
 * spheres and worse for many, where what the first spheres cover too much cannot be made good. */
static const double LEAST_OVER_E = -0.5, FIRST_OVER_E = 0.25, MOST_OVER_E = 1, RADIUS_STEP = 0.25;

/* A step takes all maxima that gain at least this share of what the best one does. */
static const double SHARE = 0.35;

/* w, and delta_min in voxels, to begin with, where they are left to us. With w = 1 smooth bodies run out of maxima that
 * are worth their sphere. */
static const double FIRST_BOOST = 5, LAST_BOOST = 40, FIRST_SPACING = 3;

/* Half the diagonal of a voxel. */
static const double HALF_DIAGONAL = 0.86602540378443871;

typedef struct best {
    ms_mss_run *m;
    ms_mss_open open;
} best;

/* Voxel centres in a ball, no fewer (or no more, with -HALF_DIAGONAL). */
static double count_in_ball(double radius, double margin)
{
    const double r = fmax(radius + margin, 0);
    return 4.18879020478639098 * r * r * r;
}

/*
 * What a new candidate gains at most: no more than a ball of its largest radius has voxels, less those that E~ says are
 * covered, as near as that to its voxel; and than the one that was at its voxel before, the gain of which has not risen
 * since, and what its centre has moved by sweeps.
 */
static double bound_gain(const ms_mss_run *m, const ms_mss_candidate *c, const ms_mss_candidate *before)
{
    const ms_grid *grid = &m->run->target->grid;
    const size_t nx = (size_t)grid->n[0], ny = (size_t)grid->n[1];
    const double voxel[3] = {(double)(c->voxel % nx), (double)(c->voxel / nx % ny), (double)(c->voxel / nx / ny)};
    const double covered = (double)m->field.within[c->voxel] - sqrt(ms_squared_distance(voxel, c->ball.centre));
    const double most = c->e + MOST_OVER_E, r = most + HALF_DIAGONAL;
    const double ring = count_in_ball(most, HALF_DIAGONAL) - count_in_ball(covered, -HALF_DIAGONAL);
    if (!before) {
        return ring;
    }
    return fmin(ring, before->rank + 3.15 * r * r * sqrt(ms_squared_distance(before->ball.centre, c->ball.centre)));
}

/* Gives a ball the radius that lowers |S xor S~| most. @return by how many voxels; 0 if there is no room for one */
static double fit_best_ball(ms_ball *ball, double e, best *b)
{
    ball->radius = e + FIRST_OVER_E;
    const double least = fmax(e + LEAST_OVER_E, 0.5);
    long gain = ms_mss_open_fit(ball, &b->open, least, e + MOST_OVER_E, RADIUS_STEP);
    if (gain <= 0) { /* specks of a voxel: the climb ends on a step too wide */
        ball->radius = least;
        gain = ms_mss_open_gain(&b->open, ball);
    }
    const double fitted = ball->radius;
    if (!ms_mss_run_confine(ball, b->m)) {
        return 0;
    }
    return (double)(ball->radius < fitted ? ms_mss_open_gain(&b->open, ball) : gain);
}

/* Counts what candidates gain of which at least `from` is to be expected. */
static void count_candidates(best *b, double from)
{
    ms_mss_run *m = b->m;
#pragma omp parallel for schedule(dynamic, 4) if (ms_grid_voxels(&m->run->target->grid) >= MS_GRID_THREADS_FROM)
    for (size_t c = 0; c < m->n_candidates; c++) {
        ms_mss_candidate *k = &m->candidates[c];
        if (!k->counted && k->rank >= from && ms_mss_select_is_apart(k, m->spacing)) {
            k->rank = fit_best_ball(&k->ball, k->e, b);
            k->counted = 1;
        }
    }
}

/* The largest gain of a candidate. Gains are kept from step to step, as bounds (lazy evaluation; Minoux 1978): only
 * those are counted again that may be worth a sphere of this step. */
static double count_gains(best *b)
{
    const ms_mss_run *m = b->m;
    for (;;) {
        double most = 0, bound = 0;
        for (size_t c = 0; c < m->n_candidates; c++) {
            const ms_mss_candidate *k = &m->candidates[c];
            if (ms_mss_select_is_apart(k, m->spacing)) {
                most = k->counted ? fmax(most, k->rank) : most;
                bound = k->counted ? bound : fmax(bound, k->rank);
            }
        }
        if (bound <= SHARE * most) {
            return most;
        }
        count_candidates(b, fmax(SHARE * most, 0.8 * bound));
    }
}

/* The gains of candidates that overlap new spheres are bounds from now on. */
static void mark_overlapping(ms_mss_run *m, size_t first_new)
{
    for (size_t c = 0; c < m->n_candidates; c++) {
        ms_mss_candidate *k = &m->candidates[c];
        for (size_t s = first_new; s < m->field.raster.n_balls && k->counted; s++) {
            const ms_ball *sphere = &m->field.raster.ball[s];
            const double reach = sphere->radius + k->e + MOST_OVER_E + 2 * HALF_DIAGONAL;
            k->counted = ms_squared_distance(sphere->centre, k->ball.centre) > reach * reach;
        }
    }
}

/* The radius at the mean of several maxima (ms_mss_select_rule). */
static int fit_best_mean(ms_ball *ball, void *context)
{
    best *b = context;
    const double e = ms_mss_run_e_at(b->m, ball->centre);
    return e > 0 && fit_best_ball(ball, e, b) > 0;
}

static void report(size_t chosen, void *context)
{
    const best *b = context;
    ms_mss_run_report(chosen, b->m);
}

/* The spheres of a step: of those that are worth it the ones that do not overlap, so that what they gain adds up. */
static size_t choose_best_spheres(ms_ball *chosen, size_t limit, best *b)
{
    const ms_mss_run *m = b->m;
    const double most = count_gains(b);
    ms_mss_select_rule rule = {.spacing = m->spacing,
                               .least_rank = fmax(SHARE * most, 1),
                               .disjoint = 1,
                               .may_wait = m->spacing > 1,
                               .fit = fit_best_mean,
                               .report = report,
                               .context = b};
    ms_grid_at(rule.centroid, &m->run->target->grid, m->run->target->body.centroid);
    return ms_mss_select(chosen, limit, m->candidates, m->n_candidates, m->field.raster.ball, m->field.raster.n_balls,
                         &rule);
}

/* Adds the spheres of a step to S~ and to the clump, and finds the new maxima. */
static ms_status add_best_spheres(ms_clump *clump, ms_stop_reason *reason, best *b, const ms_ball *chosen, size_t count,
                                  ms_error *err)
{
    ms_mss_run *m = b->m;
    const size_t before = m->field.raster.n_balls;
    ms_status status = ms_mss_field_add(&m->field, chosen, count, err);
    if (status == MS_OK) {
        status = ms_mss_run_accept(clump, reason, m, before, err);
    }
    if (status == MS_OK && *reason == MS_STOP_NOT) {
        ms_mss_open_cover(&b->open, &m->field.raster, before);
        status = ms_mss_run_update(m, before, err);
        mark_overlapping(m, before);
    }
    return status;
}

/* No maximum that is far enough from the spheres gains anything: delta_min is halved, then w doubled, if they are left
 * to us. */
static ms_status look_closer_for_best(ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    if (ms_mss_run_option(m, MS_MSS_SPACING) == 0 && m->spacing > 1) {
        m->spacing = fmax(1, m->spacing / 2);
        return MS_OK;
    }
    if (ms_mss_run_option(m, MS_MSS_BOOST) == 0 && (double)m->field.weight < LAST_BOOST) {
        m->field.weight *= 2;
        const ms_status status = ms_mss_field_touch_all(&m->field, err);
        return status == MS_OK ? ms_mss_run_update(m, m->field.raster.n_balls, err) : status;
    }
    *reason = m->too_small ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    return MS_OK;
}

/* One step: place what is worth placing, or look closer. */
static ms_status take_best_step(ms_clump *clump, ms_stop_reason *reason, best *b, ms_error *err)
{
    const size_t left = ms_mss_run_left(b->m);
    if (left == 0) { /* as many as a clump can have */
        *reason = MS_STOP_SPHERES;
        return MS_OK;
    }
    const size_t limit = b->m->n_candidates < left ? b->m->n_candidates : left;
    ms_ball *chosen = malloc((limit + 1) * sizeof *chosen);
    if (!chosen) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", limit);
    }
    const size_t taken = choose_best_spheres(chosen, limit, b);
    ms_status status =
        taken > 0 ? add_best_spheres(clump, reason, b, chosen, taken, err) : look_closer_for_best(reason, b->m, err);
    free(chosen);
    return status;
}

ms_status ms_mss_best_generate(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    best b = {.m = m};
    const double spacing = ms_mss_run_option(m, MS_MSS_SPACING), boost = ms_mss_run_option(m, MS_MSS_BOOST);
    m->rank = bound_gain;
    m->spacing = spacing > 0 ? spacing : FIRST_SPACING;
    m->field.weight = (float)(boost > 0 ? boost : FIRST_BOOST);
    ms_status status = ms_mss_open_init(&b.open, &m->run->target->grid, err);
    if (status == MS_OK) {
        status = ms_mss_run_update(m, 0, err);
    }
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        status = take_best_step(clump, reason, &b, err);
        ms_mss_run_report(0, m);
    }
    ms_mss_open_free(&b.open);
    if (status == MS_OK && ms_mss_run_option(m, MS_MSS_POLISH) != 0) {
        status = ms_mss_polish(clump, m, err);
    }
    return status;
}
