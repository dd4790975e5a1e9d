#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "ms_mss_fit.h"
#include "ms_mss_polish.h"
#include "ms_mss_run.h"

/* A step takes all maxima that gain at least this share of what the best one does. */
static const double SHARE = 0.35;

/* w, and delta_min in voxels, to begin with, where they are left to us. With w = 1 smooth bodies run out of maxima that
 * are worth their sphere. */
static const double FIRST_BOOST = 5, LAST_BOOST = 40, FIRST_SPACING = 3;

/* Half the diagonal of a voxel. */
static const double HALF_DIAGONAL = 0.86602540378443871;

/* Of spheres smaller than so many coarse voxels the target's own lattice has better maxima. */
static const double LEAST_COARSE = 3;

/* A lattice on which maxima are sought. */
typedef struct lattice {
    ms_mss_run *m;
    ms_mss_open open;
} lattice;

typedef struct best {
    lattice own;   /* the target's; spheres are fitted and counted there */
    lattice *seek; /* a coarse one, then the target's */
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
    int at[3];
    ms_grid_voxel(at, grid->n, c->voxel);
    const double voxel[3] = {at[0], at[1], at[2]};
    const double covered = (double)m->field.within[c->voxel] - sqrt(ms_squared_distance(voxel, c->ball.centre));
    const double most = c->e + MS_MSS_FIT_MOST * ms_mss_fit_unit(m), r = most + HALF_DIAGONAL;
    const double ring = count_in_ball(most, HALF_DIAGONAL) - count_in_ball(covered, -HALF_DIAGONAL);
    if (!before) {
        return ring;
    }
    return fmin(ring, before->rank + 3.15 * r * r * sqrt(ms_squared_distance(before->ball.centre, c->ball.centre)));
}

/* Counts what candidates gain of which at least `from` is to be expected. */
static void count_candidates(const lattice *l, double from)
{
    ms_mss_run *m = l->m;
#pragma omp parallel for schedule(dynamic, 4) if (ms_grid_voxels(&m->run->target->grid) >= MS_GRID_THREADS_FROM)
    for (size_t c = 0; c < m->n_candidates; c++) {
        ms_mss_candidate *k = &m->candidates[c];
        if (!k->counted && k->rank >= from && ms_mss_select_is_apart(k, m->spacing)) {
            k->rank = (double)ms_mss_fit_radius(&k->ball, k->e, &l->open, m);
            k->counted = 1;
        }
    }
}

/* The largest gain of a candidate. Gains are kept from step to step, as bounds (lazy evaluation; Minoux 1978): only
 * those are counted again that may be worth a sphere of this step. */
static double count_gains(const lattice *l)
{
    const ms_mss_run *m = l->m;
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
        count_candidates(l, fmax(SHARE * most, 0.8 * bound));
    }
}

/* The gains of candidates that overlap new spheres are bounds from now on. */
static void mark_overlapping(ms_mss_run *m, size_t first_new)
{
    for (size_t c = 0; c < m->n_candidates; c++) {
        ms_mss_candidate *k = &m->candidates[c];
        for (size_t s = first_new; s < m->field.raster.n_balls && k->counted; s++) {
            const ms_ball *sphere = &m->field.raster.ball[s];
            const double reach = sphere->radius + k->e + MS_MSS_FIT_MOST + 2 * HALF_DIAGONAL;
            k->counted = ms_squared_distance(sphere->centre, k->ball.centre) > reach * reach;
        }
    }
}

/* The radius at the mean of several maxima (ms_mss_select_rule). */
static int fit_best_mean(ms_ball *ball, void *context)
{
    const best *b = context;
    ms_mss_run *m = b->seek->m;
    const double e = ms_mss_run_e_between(m, ball->centre);
    return e > 0 && ms_mss_fit_radius(ball, e, &b->seek->open, m) > 0;
}

/* A step may choose more than are left to be placed. */
static void report(size_t chosen, void *context)
{
    const best *b = context;
    const size_t left = ms_mss_run_left(b->own.m);
    ms_mss_run_report(chosen < left ? chosen : left, b->own.m);
}

/* The spheres of a step: of those that are worth it the ones that do not overlap, so that what they gain adds up. */
static size_t choose_best_spheres(ms_ball *chosen, best *b)
{
    const ms_mss_run *m = b->seek->m;
    const double most = count_gains(b->seek);
    ms_mss_select_rule rule = {.spacing = m->spacing,
                               .least_rank = fmax(SHARE * most, 1),
                               .disjoint = 1,
                               .may_wait = m->spacing > 1,
                               .fit = fit_best_mean,
                               .report = report,
                               .context = b};
    ms_grid_at(rule.centroid, &m->run->target->grid, m->run->target->body.centroid);
    return ms_mss_select(chosen, m->n_candidates, m->candidates, m->n_candidates, m->field.raster.ball,
                         m->field.raster.n_balls, &rule);
}

/* Fits the spheres of a step on the target's own lattice, unless their distances were asked for. @return how many gain
 * something there, up to so many */
static size_t fit_best_spheres(ms_ball *chosen, size_t count, size_t most, const best *b)
{
    ms_mss_run *own = b->own.m;
    const ms_mss_coarse *coarse = b->seek->m->coarse;
    size_t fitted = 0;
    if (ms_mss_run_option(own, MS_MSS_SPACING) > 0) {
        return count < most ? count : most;
    }
    for (size_t c = 0; c < count && fitted < most; c++) {
        ms_ball ball = coarse ? ms_mss_coarse_target_ball(coarse, &chosen[c]) : chosen[c];
        if (ms_mss_fit_place(&ball, &b->own.open, own) > 0) {
            chosen[fitted++] = ball;
        }
    }
    return fitted;
}

/* Adds spheres to S~ as it is seen coarsely. `balls` are in voxels of the target, and in coarse ones afterwards. */
static ms_status add_coarse_spheres(best *b, ms_ball *balls, size_t count, ms_error *err)
{
    for (size_t c = 0; c < count; c++) {
        balls[c] = ms_mss_coarse_ball(b->seek->m->coarse, &balls[c]);
    }
    return ms_mss_field_add(&b->seek->m->field, balls, count, err);
}

/* Adds the spheres of a step to S~ and to the clump, and finds the new maxima. */
static ms_status add_best_spheres(ms_clump *clump, ms_stop_reason *reason, best *b, ms_ball *balls, size_t count,
                                  ms_error *err)
{
    ms_mss_run *own = b->own.m, *m = b->seek->m;
    const size_t before = own->field.raster.n_balls;
    ms_status status = m->coarse ? ms_raster_add(&own->field.raster, balls, count, err)
                                 : ms_mss_field_add(&own->field, balls, count, err);
    if (status == MS_OK) {
        status = ms_mss_run_accept(clump, reason, own, before, err);
    }
    if (status != MS_OK || *reason != MS_STOP_NOT) {
        return status;
    }
    ms_mss_open_cover(&b->own.open, &own->field.raster, before);
    if (m->coarse) {
        status = add_coarse_spheres(b, balls, count, err);
        ms_mss_open_cover(&b->seek->open, &m->field.raster, before);
    }
    if (status == MS_OK) {
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

static double largest_radius(const ms_ball *ball, size_t count)
{
    double largest = 0;
    for (size_t b = 0; b < count; b++) {
        largest = fmax(largest, ball[b].radius);
    }
    return largest;
}

/* One step: place what is worth placing, or look closer. What a step has to offer does not depend on how many spheres
 * are left to be placed, so that a clump is the beginning of any larger one.
 * @param[out] done the coarse lattice has no more to offer */
static ms_status take_best_step(int *done, ms_clump *clump, ms_stop_reason *reason, best *b, ms_error *err)
{
    ms_mss_run *m = b->seek->m;
    const size_t left = ms_mss_run_left(b->own.m);
    if (left == 0) { /* as many as a clump can have */
        *reason = MS_STOP_SPHERES;
        return MS_OK;
    }
    ms_ball *chosen = malloc((m->n_candidates + 1) * sizeof *chosen);
    if (!chosen) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", m->n_candidates);
    }
    size_t taken = choose_best_spheres(chosen, b);
    if (m->coarse && largest_radius(chosen, taken) < LEAST_COARSE) {
        taken = 0;
    }
    taken = fit_best_spheres(chosen, taken, left, b);
    ms_status status = MS_OK;
    if (taken > 0) {
        status = add_best_spheres(clump, reason, b, chosen, taken, err);
    } else if (m->coarse) {
        *done = 1;
    } else {
        status = look_closer_for_best(reason, m, err);
    }
    free(chosen);
    return status;
}

/* Places what the maxima of a lattice are worth. */
static ms_status seek_on(lattice *l, ms_clump *clump, ms_stop_reason *reason, best *b, ms_error *err)
{
    const double spacing = ms_mss_run_option(l->m, MS_MSS_SPACING), boost = ms_mss_run_option(l->m, MS_MSS_BOOST);
    int done = 0;
    b->seek = l;
    l->m->rank = bound_gain;
    l->m->spacing = spacing > 0 ? spacing : FIRST_SPACING;
    l->m->field.weight = (float)(boost > 0 ? boost : FIRST_BOOST);
    ms_status status = ms_mss_field_start(&l->m->field, err);
    if (status == MS_OK) {
        status = ms_mss_run_update(l->m, l->m->field.raster.n_balls, err);
    }
    while (status == MS_OK && *reason == MS_STOP_NOT && !done) {
        status = take_best_step(&done, clump, reason, b, err);
        ms_mss_run_report(0, b->own.m);
    }
    return status;
}

/* The larger spheres, by the maxima of the target seen coarsely: an eighth of the voxels. */
static ms_status seek_coarsely(ms_clump *clump, ms_stop_reason *reason, best *b, ms_error *err)
{
    ms_mss_coarse coarse;
    ms_run run = *b->own.m->run;
    ms_mss_run m = {.run = &run, .coarse = &coarse, .own = b->own.m};
    lattice l = {.m = &m};
    ms_status status = ms_mss_coarse_make(&coarse, run.target, err);
    run.target = &coarse.target;
    if (status == MS_OK) {
        status = ms_mss_field_init(&m.field, &coarse.target, run.settings, err);
    }
    if (status == MS_OK) {
        status = ms_mss_open_init(&l.open, &coarse.target.grid, err);
    }
    if (status == MS_OK) {
        status = seek_on(&l, clump, reason, b, err);
    }
    ms_mss_open_free(&l.open);
    ms_mss_field_free(&m.field);
    free(m.candidates);
    ms_mss_coarse_free(&coarse);
    return status;
}

ms_status ms_mss_best_generate(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    best b = {.own = {.m = m}};
    ms_status status = ms_mss_open_init(&b.own.open, &m->run->target->grid, err);
    if (status == MS_OK && ms_mss_run_option(m, MS_MSS_SPACING) == 0) {
        status = seek_coarsely(clump, reason, &b, err);
    }
    if (status == MS_OK && *reason == MS_STOP_NOT) {
        status = seek_on(&b.own, clump, reason, &b, err);
    }
    ms_mss_open_free(&b.own.open);
    if (status == MS_OK && ms_mss_run_option(m, MS_MSS_POLISH) != 0) {
        status = ms_mss_polish(clump, m, err);
    }
    return status;
}
