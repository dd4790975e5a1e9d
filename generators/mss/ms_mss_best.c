#include <math.h>
#include <stdlib.h>

#include "ms_mss_open.h"
#include "ms_mss_run.h"

static double envd(const char *n, double d) { const char *s = getenv(n); return s ? atof(s) : d; }
static double UP, DOWN, STEP, SHARE, SPACING, WMAX, W0, REL, WSTEP, FIRSTREL;
static long n_counts, n_steps;

typedef struct best {
    ms_mss_run *m;
    ms_mss_open open;
} best;

/* No sphere gains more than it has voxels. */
static double bound_gain(const ms_mss_run *m, const ms_mss_candidate *c)
{
    (void)m;
    const double r = c->e + UP + REL * c->e + 0.87;
    return 4.19 * r * r * r;
}

static long fit_radius(ms_ball *ball, double e, best *b)
{
    const double up = UP + REL * e;
    long gain = ms_mss_open_fit(&ball->radius, &b->open, ball->centre, fmax(e - DOWN, 0.5), e + up, fmax(STEP, (up + DOWN) / 8));
    if (!ms_mss_run_confine(ball, b->m)) {
        return 0;
    }
    return gain;
}

static void count_candidates(best *b, double from)
{
    ms_mss_run *m = b->m;
    const double apart = m->spacing * m->spacing * (1 - 1e-9);
#pragma omp parallel for schedule(dynamic, 4)
    for (size_t c = 0; c < m->n_candidates; c++) {
        ms_mss_candidate *k = &m->candidates[c];
        if (!k->counted && k->apart >= apart && k->rank >= from) {
            k->rank = (double)fit_radius(&k->ball, k->e, b);
            k->counted = 1;
#pragma omp atomic
            n_counts++;
        }
    }
}

static double count_gains(best *b)
{
    ms_mss_run *m = b->m;
    const double apart = m->spacing * m->spacing * (1 - 1e-9);
    for (;;) {
        double most = 0, stale = 0;
        for (size_t c = 0; c < m->n_candidates; c++) {
            const ms_mss_candidate *k = &m->candidates[c];
            if (k->apart < apart) {
                continue;
            }
            if (k->counted) {
                most = fmax(most, k->rank);
            } else {
                stale = fmax(stale, k->rank);
            }
        }
        if (stale <= SHARE * most || stale <= 0) {
            return most;
        }
        count_candidates(b, fmax(SHARE * most, 0.8 * stale));
    }
}

static void mark_stale(ms_mss_run *m, size_t first)
{
    for (size_t c = 0; c < m->n_candidates; c++) {
        ms_mss_candidate *k = &m->candidates[c];
        for (size_t s = first; s < m->field.raster.n_balls && k->counted; s++) {
            const ms_ball *o = &m->field.raster.ball[s];
            const double reach = o->radius + k->e * (1 + REL) + UP + 1;
            double d = 0;
            for (int a = 0; a < 3; a++) {
                d += (o->centre[a] - k->ball.centre[a]) * (o->centre[a] - k->ball.centre[a]);
            }
            if (d < reach * reach) {
                k->counted = 0;
            }
        }
    }
}

static int fit_mean(ms_ball *ball, void *context)
{
    best *b = context;
    const double e = ms_mss_run_e_at(b->m, ball->centre);
    return e > 0 && fit_radius(ball, e, b) > 0;
}

static void report(size_t chosen, void *context)
{
    ms_mss_run_report(chosen, ((best *)context)->m);
}

static size_t choose_spheres(ms_ball *chosen, size_t limit, best *b)
{
    ms_mss_run *m = b->m;
    const double most = count_gains(b);
    if (most <= 0) {
        return 0;
    }
    ms_mss_select_rule rule = {.spacing = m->spacing,
                               .least_rank = fmax(SHARE * most, 1),
                               .disjoint = 1,
                               .fit = fit_mean,
                               .report = report,
                               .context = b};
    ms_grid_at(rule.centroid, &m->run->target->grid, m->run->target->body.centroid);
    return ms_mss_select(chosen, limit, m->candidates, m->n_candidates, m->field.raster.ball, m->field.raster.n_balls,
                         &rule);
}

static ms_status add_spheres(ms_clump *clump, ms_stop_reason *reason, best *b, const ms_ball *chosen, size_t count,
                             ms_error *err)
{
    ms_mss_run *m = b->m;
    const size_t before = m->field.raster.n_balls;
    ms_status status = ms_mss_field_add(&m->field, chosen, count, err);
    n_steps++;
    if (status == MS_OK) {
        status = ms_mss_run_accept(clump, reason, m, before, err);
    }
    for (size_t c = 0; c < m->field.n_changed; c++) {
        ms_mss_open_cover(&b->open, &m->field.raster, m->field.changed[c].lo, m->field.changed[c].hi);
    }
    if (status == MS_OK && *reason == MS_STOP_NOT) {
        status = ms_mss_run_update(m, before, err);
        mark_stale(m, before);
    }
    return status;
}

static ms_status look_closer(ms_stop_reason *reason, best *b, ms_error *err)
{
    ms_mss_run *m = b->m;
    if ((double)m->field.weight < WMAX) {
        m->field.weight += (float)WSTEP;
        ms_status status = ms_mss_field_touch_all(&m->field, err);
        return status == MS_OK ? ms_mss_run_update(m, m->field.raster.n_balls, err) : status;
    }
    if (m->spacing > 1) {
        m->spacing = fmax(1, m->spacing / 2);
        return MS_OK;
    }
    *reason = m->too_small ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    return MS_OK;
}

static ms_status step(ms_clump *clump, ms_stop_reason *reason, best *b, ms_error *err)
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
    const size_t taken = choose_spheres(chosen, limit, b);
    ms_status status = taken > 0 ? add_spheres(clump, reason, b, chosen, taken, err) : look_closer(reason, b, err);
    free(chosen);
    return status;
}

ms_status ms_mss_best_generate(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    best b = {.m = m};
    UP = envd("UP", 1); DOWN = envd("DOWN", .5); STEP = envd("STEP", .25); SHARE = envd("SHARE", .5);
    SPACING = envd("SPACING", 5); WMAX = envd("WMAX", 5); W0 = envd("W0", 1); REL = envd("REL", 0); WSTEP = envd("WSTEP", 1);
    m->rank = bound_gain;
    m->spacing = SPACING;
    m->field.weight = (float)W0;
    ms_status status = ms_mss_open_init(&b.open, &m->run->target->grid, err);
    if (status == MS_OK) {
        status = ms_mss_run_update(m, 0, err);
    }
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        status = step(clump, reason, &b, err);
        ms_mss_run_report(0, m);
    }
    if (getenv("VERB")) fprintf(stderr, "counts %ld steps %ld w %g spacing %g\n", n_counts, n_steps, m->field.weight, m->spacing);
    ms_mss_open_free(&b.open);
    return status;
}
