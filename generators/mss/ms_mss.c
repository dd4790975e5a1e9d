/*
 * MSS. F. Buchele, T. Poeschel, P. Mueller, Multi-sphere shape generator for DEM simulations
 * of complex-shaped particles, arXiv:2603.05877 (2026), Powder Technology. Equation and
 * section numbers are of that paper; docs/methods/mss.md says what it leaves open and how it
 * was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/ms_closest.h"
#include "ms_mss_field.h"
#include "ms_mss_select.h"
#include "ms_peaks.h"
#include "shared/ms_nested.h"

enum { SPACING, BOOST, OFFSET, ORDER, CONFINE, PLANES };
enum { ORDER_RADIUS, ORDER_GAIN };

static const ms_option OPTIONS[] = {
    [SPACING] = {"spacing", MS_OPTION_REAL, 0, 0, 1000, NULL, "voxels",
                 "least distance between the centres of any two spheres (delta_min, section 3.4); 0: as large as "
                 "leaves maxima, halved from the largest radius down to 1 voxel (gain: from 2), spheres smaller "
                 "across waiting"},
    [BOOST] = {"boost", MS_OPTION_INTEGER, 1, 1, 5, NULL, NULL,
               "where no maximum is left, E* = E + w (E - E~) is tried with w up to this; the paper has w = 1 "
               "(eq. 25)"},
    [OFFSET] = {"radius-offset", MS_OPTION_REAL, 0, -2, 2, NULL, "voxels",
                "added to every radius; the paper adds nothing, 0.5 to 0.75 lowers the mismatch"},
    [ORDER] = {"order", MS_OPTION_CHOICE, ORDER_RADIUS, 0, 0, "radius|gain", NULL,
               "radius: all maxima of a step, the largest spheres first (the paper); gain: one set of mirror "
               "images a step, that of the largest (E - E~) E"},
    [CONFINE] = {"confine", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
                 "no sphere leaves the mesh: radii are at most the distance to the nearest face (section 3.5)"},
    [PLANES] = {"plane", MS_OPTION_PLANE, 0, 0, 0, NULL, NULL,
                "a,b,c,d: no sphere crosses the plane a x + b y + c z = d (section 3.5); may be repeated"},
    {0},
};

typedef struct mss {
    const ms_run *run;
    ms_mss_field field;
    ms_mss_candidate *candidates; /* maxima of E* where a sphere may be placed */
    size_t n_candidates, room;
    double spacing; /* delta_min, in voxels */
    int too_small;  /* a maximum was passed over because its sphere would be too small */
    ms_tally sum;   /* of the spheres so far */
} mss;

static double mss_option(const mss *m, int which)
{
    return m->run->settings->value[which];
}

/* Shrinks a ball to what faces and planes allow (section 3.5); 0 if it becomes too small. */
static int confine_ball(ms_ball *ball, mss *m)
{
    const ms_target *target = m->run->target;
    const ms_sphere sphere = ms_grid_sphere(&target->grid, ball);
    double radius = sphere.radius, allowed = HUGE_VAL;
    if (mss_option(m, CONFINE) != 0) {
        allowed = -ms_closest_signed_distance(target->closest, sphere.centre);
    }
    allowed = fmin(allowed, ms_planes_distance(m->run->settings, sphere.centre));
    if (allowed < radius) {
        radius = allowed;
        ball->radius = allowed / target->grid.h;
    }
    if (!(radius > 0) || radius < m->run->stop.radius) {
        m->too_small |= radius > 0;
        return 0;
    }
    return 1;
}

/* The sphere at a maximum of E*: centre from E*, radius from E (3.4 iv). 0 if there is no room for one. */
static int place_candidate(ms_mss_candidate *c, mss *m, size_t voxel)
{
    const ms_target *target = m->run->target;
    ms_peak peak;
    ms_peaks_refine(&peak, m->field.star, target->grid.n, voxel);
    for (int a = 0; a < 3; a++) {
        c->ball.centre[a] = peak.voxel[a] + peak.shift[a];
    }
    c->ball.radius = ms_peaks_value(&peak, m->field.e, target->grid.n) + mss_option(m, OFFSET);
    c->voxel = voxel;
    if (!confine_ball(&c->ball, m)) {
        return 0;
    }
    c->rank = c->ball.radius;
    if (mss_option(m, ORDER) == ORDER_GAIN) {
        const double e = (double)m->field.e[voxel]; /* E* - E = w (E - E~) */
        c->rank = ((double)m->field.star[voxel] - e) / (double)m->field.weight * e;
    }
    return 1;
}

static int in_box(const int lo[3], const int hi[3], const int n[3], size_t voxel)
{
    const int at[3] = {(int)(voxel % (size_t)n[0]), (int)(voxel / (size_t)n[0] % (size_t)n[1]),
                       (int)(voxel / (size_t)n[0] / (size_t)n[1])};
    for (int a = 0; a < 3; a++) {
        if (at[a] < lo[a] || at[a] >= hi[a]) {
            return 0;
        }
    }
    return 1;
}

/* Forgets the candidates in a box. */
static void forget_candidates(mss *m, const int lo[3], const int hi[3])
{
    size_t kept = 0;
    for (size_t c = 0; c < m->n_candidates; c++) {
        if (!in_box(lo, hi, m->run->target->grid.n, m->candidates[c].voxel)) {
            m->candidates[kept++] = m->candidates[c];
        }
    }
    m->n_candidates = kept;
}

static ms_status add_candidates(mss *m, const size_t *voxel, size_t count, ms_error *err)
{
    const size_t first = m->n_candidates;
    if (m->n_candidates + count > m->room) {
        const size_t room = m->n_candidates + m->n_candidates / 2 + count;
        ms_mss_candidate *grown = realloc(m->candidates, room * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu maxima; use fewer cells", room);
        }
        m->candidates = grown;
        m->room = room;
    }
    for (size_t p = 0; p < count; p++) {
        ms_mss_candidate *next = &m->candidates[m->n_candidates];
        if (place_candidate(next, m, voxel[p])) {
            next->apart = HUGE_VAL;
            m->n_candidates++;
        }
    }
    ms_mss_candidate *added = m->candidates + first;
    for (size_t s = 0; s < m->field.raster.n_balls; s++) {
        ms_mss_select_keep_apart(added, m->n_candidates - first, &m->field.raster.ball[s]);
    }
    return MS_OK;
}

/* Finds the maxima anew where E* has changed; a maximum and its place depend on the voxels up
 * to two away. */
static ms_status update_candidates(mss *m, size_t first_new, ms_error *err)
{
    int lo[3], hi[3];
    size_t *voxel, count;
    const int changed = m->field.hi[0] > m->field.lo[0];
    for (int a = 0; a < 3; a++) {
        lo[a] = changed ? m->field.lo[a] - 2 : 0;
        hi[a] = changed ? m->field.hi[a] + 2 : 0;
    }
    forget_candidates(m, lo, hi);
    for (size_t s = first_new; s < m->field.raster.n_balls; s++) {
        ms_mss_select_keep_apart(m->candidates, m->n_candidates, &m->field.raster.ball[s]);
    }
    if (!changed) {
        return MS_OK;
    }
    ms_status status = ms_peaks_find(&voxel, &count, m->field.star, m->run->target->grid.n, lo, hi, err);
    if (status == MS_OK) {
        status = add_candidates(m, voxel, count, err);
        free(voxel);
    }
    return status;
}

/* Copies the new spheres to the clump until the stop rule holds. */
static ms_status accept_spheres(ms_clump *clump, ms_stop_reason *reason, mss *m, size_t first_new, ms_error *err)
{
    const ms_raster *raster = &m->field.raster;
    ms_status status = MS_OK;
    for (size_t s = first_new; s < raster->n_balls && *reason == MS_STOP_NOT && status == MS_OK; s++) {
        status = ms_nested_accept(clump, reason, &m->sum, m->run, &raster->ball[s], &raster->tally[s], err);
    }
    return status;
}

/* The radius at the mean of several maxima: that of E there, if that is less (ms_mss_select_rule). */
static int fit_mean(ms_ball *ball, void *context)
{
    mss *m = context;
    const ms_grid *grid = &m->run->target->grid;
    ms_peak at = {.value = 0};
    for (int a = 0; a < 3; a++) {
        at.voxel[a] = (int)rint(ball->centre[a]);
        at.shift[a] = ball->centre[a] - at.voxel[a];
    }
    if (!(m->field.e[ms_grid_index(grid, at.voxel[0], at.voxel[1], at.voxel[2])] > 0)) {
        return 0;
    }
    ball->radius = fmin(ball->radius, ms_peaks_value(&at, m->field.e, grid->n) + mss_option(m, OFFSET));
    return confine_ball(ball, m);
}

static void report(size_t chosen, void *context)
{
    const mss *m = context;
    if (m->run->progress) {
        m->run->progress(m->run->progress_context, m->field.raster.n_balls + chosen,
                         ms_metrics_score(&m->sum, m->run->target->voxels).dice);
    }
}

/* The spheres of a step. Where delta_min is ours to choose, spheres smaller across than it is
 * wait until it has shrunk: else every speck of noise in a corner, being far from all spheres,
 * would come early. */
static size_t choose_spheres(ms_ball *chosen, size_t limit, mss *m)
{
    const int automatic = mss_option(m, SPACING) == 0;
    ms_mss_select_rule rule = {.spacing = m->spacing,
                               .least_radius = automatic ? m->spacing / 2 : 0,
                               .one_set = mss_option(m, ORDER) == ORDER_GAIN,
                               .may_wait = automatic && m->spacing > 1,
                               .fit = fit_mean,
                               .report = report,
                               .context = m};
    ms_grid_at(rule.centroid, &m->run->target->grid, m->run->target->body.centroid);
    return ms_mss_select(chosen, limit, m->candidates, m->n_candidates, m->field.raster.ball, m->field.raster.n_balls,
                         &rule);
}

/* Adds the spheres of a step to S~ and to the clump, and finds the new maxima. */
static ms_status add_spheres(ms_clump *clump, ms_stop_reason *reason, mss *m, const ms_ball *chosen, size_t count,
                             ms_error *err)
{
    const size_t before = m->field.raster.n_balls;
    ms_status status = ms_mss_field_add(&m->field, chosen, count, err);
    if (status == MS_OK) {
        status = accept_spheres(clump, reason, m, before, err);
    }
    if (status == MS_OK && *reason == MS_STOP_NOT) {
        status = update_candidates(m, before, err);
    }
    return status;
}

/* delta_min to begin with. */
static double first_spacing(const mss *m)
{
    if (mss_option(m, SPACING) > 0) {
        return mss_option(m, SPACING);
    }
    return mss_option(m, ORDER) == ORDER_GAIN ? 2 : (double)m->field.deepest;
}

/* No maximum is far enough from the spheres: delta_min is halved, if it is left to us; then
 * E - E~ gets more weight, if that is asked for; then there is nothing more to find. */
static ms_status look_closer(ms_stop_reason *reason, mss *m, ms_error *err)
{
    if (mss_option(m, SPACING) == 0 && m->spacing > 1) {
        m->spacing = fmax(1, m->spacing / 2);
        return MS_OK;
    }
    if ((double)m->field.weight < mss_option(m, BOOST)) {
        m->spacing = first_spacing(m);
        ms_status status = ms_mss_field_set_weight(&m->field, m->field.weight + 1, err);
        return status == MS_OK ? update_candidates(m, m->field.raster.n_balls, err) : status;
    }
    *reason = m->too_small ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    return MS_OK;
}

/* One step: place what can be placed, or look closer. */
static ms_status step(ms_clump *clump, ms_stop_reason *reason, mss *m, ms_error *err)
{
    const size_t most = m->run->stop.spheres ? m->run->stop.spheres : MS_CLUMP_MAX_SPHERES;
    const size_t left = most - m->field.raster.n_balls;
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

static ms_status generate_by_mss(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    mss m = {.run = run};
    if (run->settings->value[CONFINE] != 0 && (!run->target->closest || !run->target->closed)) {
        return ms_fail(err, MS_ERR_ARG, "confine needs a closed mesh; this shape is a volume or an open mesh");
    }
    ms_status status = ms_mss_field_init(&m.field, run->target, run->settings, err);
    if (status == MS_OK) {
        m.spacing = first_spacing(&m);
        status = update_candidates(&m, 0, err);
    }
    while (status == MS_OK && *reason == MS_STOP_NOT) {
        status = step(clump, reason, &m, err);
        report(0, &m);
    }
    ms_mss_field_free(&m.field);
    free(m.candidates);
    return status;
}

const ms_generator ms_generator_mss = {
    .name = "mss",
    .summary = "spheres at the maxima of the distance field, then of twice it less that of the spheres",
    .source = "F. Buchele, T. Poeschel, P. Mueller, Powder Technology (2026), arXiv:2603.05877",
    .nested = 1,
    .options = OPTIONS,
    .generate = generate_by_mss,
};
