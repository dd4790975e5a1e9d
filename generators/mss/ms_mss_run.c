#include "ms_mss_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/ms_closest.h"
#include "ms_mss_maxima.h"
#include "shared/ms_nested.h"

/* E between voxels is rounded to that part of one, so that mirror images agree. */
static const double EQUAL_E = 1 << 20;

int ms_mss_run_confine(ms_ball *ball, ms_mss_run *m)
{
    const ms_target *target = m->run->target;
    const ms_sphere sphere = ms_grid_sphere(&target->grid, ball);
    double radius = sphere.radius, allowed = HUGE_VAL;
    if (ms_mss_run_option(m, MS_MSS_CONFINE) != 0) {
        allowed = -ms_closest_signed_distance(target->closest, sphere.centre);
    }
    allowed = fmin(allowed, ms_planes_distance(m->run->settings, sphere.centre));
    if (allowed < radius) {
        radius = allowed;
        ball->radius = allowed / target->grid.h;
    }
    if (!(radius > 0) || radius < m->run->stop.radius) {
        if (radius > 0) {
#pragma omp atomic write
            m->too_small = 1;
        }
        return 0;
    }
    return 1;
}

double ms_mss_run_e_at(const ms_mss_run *m, const double place[3])
{
    const ms_grid *grid = &m->run->target->grid;
    ms_peak at = {.value = 0};
    for (int a = 0; a < 3; a++) {
        at.voxel[a] = (int)rint(place[a]);
        at.shift[a] = place[a] - at.voxel[a];
    }
    if (!(m->field.e[ms_grid_index(grid, at.voxel[0], at.voxel[1], at.voxel[2])] > 0)) {
        return 0;
    }
    return ms_peaks_value(&at, m->field.e, grid->n);
}

double ms_mss_run_e_between(const ms_mss_run *m, const double place[3])
{
    if (m->coarse) {
        ms_ball ball = {.radius = 0};
        memcpy(ball.centre, place, sizeof ball.centre);
        ball = ms_mss_coarse_target_ball(m->coarse, &ball);
        return ms_mss_run_e_between(m->own, ball.centre) / MS_MSS_COARSE;
    }
    const ms_grid *grid = &m->run->target->grid;
    int voxel[3];
    double share[3], e = 0;
    for (int a = 0; a < 3; a++) {
        if (!(place[a] >= 0 && place[a] < grid->n[a] - 1)) {
            return 0;
        }
        voxel[a] = (int)place[a];
        share[a] = place[a] - voxel[a];
    }
    for (int corner = 0; corner < 8; corner++) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        const double weight =
            (x ? share[0] : 1 - share[0]) * (y ? share[1] : 1 - share[1]) * (z ? share[2] : 1 - share[2]);
        e += weight * (double)m->field.e[ms_grid_index(grid, voxel[0] + x, voxel[1] + y, voxel[2] + z)];
    }
    return rint(e * EQUAL_E) / EQUAL_E;
}

/* The sphere at a maximum of E*: centre from E*, radius from E (3.4 iv). 0 if there is no room for one. */
static int place_candidate(ms_mss_candidate *c, ms_mss_run *m, const ms_mss_maximum *maximum)
{
    const ms_peak *peak = &maximum->peak;
    for (int a = 0; a < 3; a++) {
        c->ball.centre[a] = peak->voxel[a] + peak->shift[a];
    }
    c->e =
        m->coarse ? ms_mss_run_e_between(m, c->ball.centre) : ms_peaks_value(peak, m->field.e, m->run->target->grid.n);
    c->ball.radius = c->e + ms_mss_run_option(m, MS_MSS_OFFSET);
    c->voxel = maximum->voxel;
    c->counted = 0;
    return ms_mss_run_confine(&c->ball, m);
}

static int compare_voxels(const void *first, const void *second)
{
    const ms_mss_candidate *a = first, *b = second;
    return a->voxel < b->voxel ? -1 : a->voxel > b->voxel;
}

/* Moves the candidates where the maxima are found anew behind the others, in the order of their voxels; how many. */
static size_t set_stale_apart(ms_mss_run *m)
{
    size_t kept = 0;
    if (m->n_candidates == 0) {
        return 0;
    }
    for (size_t c = 0; c < m->n_candidates; c++) {
        if (!ms_mss_maxima_is_stale(&m->field, m->candidates[c].voxel)) {
            const ms_mss_candidate swap = m->candidates[c];
            m->candidates[c] = m->candidates[kept];
            m->candidates[kept++] = swap;
        }
    }
    qsort(m->candidates + kept, m->n_candidates - kept, sizeof *m->candidates, compare_voxels);
    return m->n_candidates - kept;
}

/* Puts the new maxima in the place of the last `stale` candidates. */
static ms_status replace_candidates(ms_mss_run *m, size_t stale, const ms_mss_maximum *maximum, size_t count,
                                    ms_error *err)
{
    const size_t kept = m->n_candidates - stale;
    size_t used = kept;
    ms_mss_candidate *all = malloc((kept + count + 1) * sizeof *all);
    if (!all) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu maxima; use fewer cells", kept + count);
    }
    if (kept > 0) {
        memcpy(all, m->candidates, kept * sizeof *all);
    }
    for (size_t p = 0; p < count; p++) {
        const ms_mss_candidate key = {.voxel = maximum[p].voxel};
        const ms_mss_candidate *before =
            stale ? bsearch(&key, m->candidates + kept, stale, sizeof key, compare_voxels) : NULL;
        if (place_candidate(&all[used], m, &maximum[p])) {
            all[used].rank = m->rank(m, &all[used], before);
            all[used++].apart = HUGE_VAL;
        }
    }
    for (size_t s = 0; s < m->field.raster.n_balls; s++) {
        ms_mss_select_keep_apart(all + kept, used - kept, &m->field.raster.ball[s]);
    }
    free(m->candidates);
    m->candidates = all;
    m->n_candidates = used;
    return MS_OK;
}

ms_status ms_mss_run_update(ms_mss_run *m, size_t first_new, ms_error *err)
{
    ms_mss_maximum *maximum;
    size_t count;
    const size_t stale = set_stale_apart(m);
    for (size_t s = first_new; s < m->field.raster.n_balls; s++) {
        ms_mss_select_keep_apart(m->candidates, m->n_candidates - stale, &m->field.raster.ball[s]);
    }
    ms_status status = ms_mss_maxima_find(&maximum, &count, &m->field, err);
    if (status == MS_OK) {
        status = replace_candidates(m, stale, maximum, count, err);
        free(maximum);
    }
    return status;
}

ms_status ms_mss_run_accept(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, size_t first_new, ms_error *err)
{
    const ms_raster *raster = &m->field.raster;
    ms_status status = MS_OK;
    for (size_t s = first_new; s < raster->n_balls && *reason == MS_STOP_NOT && status == MS_OK; s++) {
        status = ms_nested_accept(clump, reason, &m->sum, m->run, &raster->ball[s], &raster->tally[s], err);
    }
    return status;
}

void ms_mss_run_report(size_t chosen, void *context)
{
    const ms_mss_run *m = context;
    if (m->run->progress) {
        m->run->progress(m->run->progress_context, m->field.raster.n_balls + chosen,
                         ms_metrics_score(&m->sum, m->run->target->voxels).dice);
    }
}

size_t ms_mss_run_left(const ms_mss_run *m)
{
    const size_t most = m->run->stop.spheres ? m->run->stop.spheres : MS_CLUMP_MAX_SPHERES;
    return most - m->field.raster.n_balls;
}
