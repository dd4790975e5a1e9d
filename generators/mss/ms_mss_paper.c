#include <math.h>
#include <stdlib.h>

#include "ms_mss_run.h"

/* Of a candidate: its radius, or (E - E~) E. */
static double rank_candidate(const ms_mss_run *m, const ms_mss_candidate *c, const ms_mss_candidate *before)
{
    (void)before;
    if (ms_mss_run_option(m, MS_MSS_ORDER) != MS_MSS_BY_GAIN) {
        return c->ball.radius;
    }
    const double e = (double)m->field.e[c->voxel]; /* E* - E = w (E - E~) */
    return ((double)ms_mss_field_star(&m->field, c->voxel) - e) / (double)m->field.weight * e;
}

/* The radius at the mean of several maxima: that of E there, if that is less (ms_mss_select_rule). */
static int fit_mean(ms_ball *ball, void *context)
{
    ms_mss_run *m = context;
    const double e = ms_mss_run_e_at(m, ball->centre);
    ball->radius = fmin(ball->radius, e + ms_mss_run_option(m, MS_MSS_OFFSET));
    return e > 0 && ms_mss_run_confine(ball, m);
}

/* The spheres of a step. Where delta_min is ours to choose, spheres smaller across than it is
 * wait until it has shrunk: else every speck of noise in a corner, being far from all spheres,
 * would come early. */
static size_t choose_spheres(ms_ball *chosen, size_t limit, ms_mss_run *m)
{
    const int automatic = ms_mss_run_option(m, MS_MSS_SPACING) == 0;
    ms_mss_select_rule rule = {.spacing = m->spacing,
                               .least_radius = automatic ? m->spacing / 2 : 0,
                               .one_set = ms_mss_run_option(m, MS_MSS_ORDER) == MS_MSS_BY_GAIN,
                               .least_rank = -HUGE_VAL,
                               .may_wait = automatic && m->spacing > 1,
                               .fit = fit_mean,
                               .report = ms_mss_run_report,
                               .context = m};
    ms_grid_at(rule.centroid, &m->run->target->grid, m->run->target->body.centroid);
    return ms_mss_select(chosen, limit, m->candidates, m->n_candidates, m->field.raster.ball, m->field.raster.n_balls,
                         &rule);
}

/* Adds the spheres of a step to S~ and to the clump, and finds the new maxima. */
static ms_status add_spheres(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, const ms_ball *chosen,
                             size_t count, ms_error *err)
{
    const size_t before = m->field.raster.n_balls;
    ms_status status = ms_mss_field_add(&m->field, chosen, count, err);
    if (status == MS_OK) {
        status = ms_mss_run_accept(clump, reason, m, before, err);
    }
    if (status == MS_OK && *reason == MS_STOP_NOT) {
        status = ms_mss_run_update(m, before, err);
    }
    return status;
}

/* delta_min to begin with. */
static double first_spacing(const ms_mss_run *m)
{
    if (ms_mss_run_option(m, MS_MSS_SPACING) > 0) {
        return ms_mss_run_option(m, MS_MSS_SPACING);
    }
    return ms_mss_run_option(m, MS_MSS_ORDER) == MS_MSS_BY_GAIN ? 2 : (double)m->field.deepest;
}

/* No maximum is far enough from the spheres: delta_min is halved, if it is left to us; then
 * E - E~ gets more weight, if that is asked for; then there is nothing more to find. */
static ms_status look_closer(ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    if (ms_mss_run_option(m, MS_MSS_SPACING) == 0 && m->spacing > 1) {
        m->spacing = fmax(1, m->spacing / 2);
        return MS_OK;
    }
    if ((double)m->field.weight < ms_mss_run_option(m, MS_MSS_BOOST)) { /* 0: eq. 25 as it is */
        m->spacing = first_spacing(m);
        m->field.weight += 1;
        ms_status status = ms_mss_field_touch_all(&m->field, err);
        return status == MS_OK ? ms_mss_run_update(m, m->field.raster.n_balls, err) : status;
    }
    *reason = m->too_small ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    return MS_OK;
}

/* One step: place what can be placed, or look closer. */
static ms_status step(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    const size_t left = ms_mss_run_left(m);
    if (left == 0) { /* as many as a clump can have */
        *reason = MS_STOP_SPHERES;
        return MS_OK;
    }
    const size_t limit = m->n_candidates < left ? m->n_candidates : left;
    ms_ball *chosen = malloc((limit + 1) * sizeof *chosen);
    if (!chosen) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", limit);
    }
    const size_t taken = choose_spheres(chosen, limit, m);
    ms_status status = taken > 0 ? add_spheres(clump, reason, m, chosen, taken, err) : look_closer(reason, m, err);
    free(chosen);
    return status;
}

ms_status ms_mss_paper_generate(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err)
{
    m->rank = rank_candidate;
    m->spacing = first_spacing(m);
    ms_status status = ms_mss_field_start(&m->field, err);
    if (status == MS_OK) {
        status = ms_mss_run_update(m, 0, err);
    }
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        status = step(clump, reason, m, err);
        ms_mss_run_report(0, m);
    }
    return status;
}
