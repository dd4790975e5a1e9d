#include "ms_templates.h"

#include <math.h>
#include <stdlib.h>

#include "clump/ms_equal_volume.h"
#include "measure/ms_descriptors.h"
#include "ms_curve.h"

ms_status ms_templates_alloc(ms_templates *t, size_t most, ms_error *err)
{
    *t = (ms_templates){0};
    if (most == 0) {
        return ms_fail(err, MS_ERR_ARG, "templates have one sphere at least");
    }
    *t = (ms_templates){.most = most,
                        .clump = calloc(most, sizeof *t->clump),
                        .score = calloc(most, sizeof *t->score),
                        .dice = calloc(most, sizeof *t->dice),
                        .remarks = calloc(most, sizeof *t->remarks)};
    if (!t->clump || !t->score || !t->dice || !t->remarks) {
        ms_templates_free(t);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu templates", most);
    }
    for (size_t n = 0; n < most; n++) {
        t->dice[n] = (double)NAN; /* not run */
    }
    return MS_OK;
}

/* The listener of a run that is one of several. It is told of spheres and not of stages, whose shares are those of this
 * run alone; but a method may ask at either whether it is to end. */
typedef struct part_listener {
    const ms_run *all;
    int is_over;
} part_listener;

static int tell_spheres(void *context, size_t spheres, double dice)
{
    part_listener *listener = context;
    const ms_run *all = listener->all;
    listener->is_over |= all->progress && all->progress(all->progress_context, spheres, dice) != 0;
    return listener->is_over;
}

static int ask_listener(void *context, const char *stage, double share)
{
    const part_listener *listener = context;
    (void)stage;
    (void)share;
    return listener->is_over;
}

/* The clump of so many spheres. A run that its listener ends gives none. */
static ms_status run_once(ms_clump *clump, ms_error *remarks, const ms_templates_how *how, size_t spheres,
                          ms_error *err)
{
    ms_run one = *how->run;
    part_listener listener = {how->run, 0};
    one.stop.spheres = spheres;
    one.progress = tell_spheres;
    one.stage = ask_listener;
    one.progress_context = one.stage_context = &listener;
    ms_generator_keep_remarks(&one, remarks);
    return ms_generator_run_whole(clump, how->generator, &one, err);
}

/* Scaled, where that is asked for, and judged. */
static ms_status judge_template(ms_templates *t, size_t n, const ms_templates_how *how, ms_error *err)
{
    ms_equal_volume scaled = {0};
    ms_metrics metrics;
    ms_status status = how->equal ? ms_equal_volume_scale(&t->clump[n - 1], &scaled, how->equal, err) : MS_OK;
    ms_equal_volume_remark(&t->remarks[n - 1], &scaled);
    if (status == MS_OK) {
        status = ms_metrics_compute_kinds(&metrics, NULL, 0, how->run->target, &t->clump[n - 1], how->max_voxels, err);
    }
    if (status == MS_OK) {
        t->score[n - 1] = metrics.score;
    }
    return status;
}

/* Where a method gave fewer spheres than asked for, the better of both clumps stands at their number. */
static void choose_numbers(ms_templates *t)
{
    for (size_t n = t->most; n >= 1; n--) {
        const size_t have = t->clump[n - 1].n_spheres;
        if (have < n && t->score[n - 1].dice < t->score[have - 1].dice) {
            const ms_clump clump = t->clump[n - 1];
            const ms_score score = t->score[n - 1];
            const ms_error remarks = t->remarks[n - 1];
            t->clump[n - 1] = t->clump[have - 1];
            t->score[n - 1] = t->score[have - 1];
            t->remarks[n - 1] = t->remarks[have - 1];
            t->clump[have - 1] = clump;
            t->score[have - 1] = score;
            t->remarks[have - 1] = remarks;
        }
    }
    for (size_t n = 0; n < t->most; n++) {
        t->dice[n] = t->score[n].dice;
    }
}

/* @param remarks on the clump: prefixes of one share them, and other templates have their own */
static ms_status fill_templates(ms_templates *t, const ms_clump *clump, const ms_error *remarks,
                                const ms_templates_how *how, ms_error *err)
{
    const ms_run *run = how->run;
    ms_status status = ms_templates_alloc(t, clump->n_spheres, err);
    const size_t most = t->most;
    for (size_t n = ms_generator_is_nested(how->generator, run->settings) ? 1 : most; n > 0 && n <= most; n++) {
        t->remarks[n - 1] = *remarks;
    }
    if (status == MS_OK) {
        status = ms_curve_clumps(t->score, t->clump, t->remarks, clump, how->generator, run, how->max_voxels, err);
    }
    for (size_t n = 1; n <= most && status == MS_OK && how->equal; n++) {
        status = judge_template(t, n, how, err);
    }
    if (status == MS_OK) {
        choose_numbers(t);
    }
    return status;
}

ms_status ms_templates_make(ms_templates *templates, const ms_templates_how *how, ms_error *err)
{
    ms_clump clump;
    ms_error remarks = {""};
    *templates = (ms_templates){0};
    ms_status status = run_once(&clump, &remarks, how, how->run->stop.spheres, err);
    if (status == MS_OK) {
        status = fill_templates(templates, &clump, &remarks, how, err);
        ms_clump_free(&clump);
    }
    if (status != MS_OK) {
        ms_templates_free(templates);
    }
    return status;
}

/* A search for the least number of spheres that reaches a measure, by runs of their own. */
typedef struct template_search {
    ms_templates *t;
    const ms_templates_how *how;
    const ms_measure *measure;
    double value; /* to be reached */
} template_search;

/* The template of n spheres. */
static ms_status run_number(template_search *s, size_t n, ms_error *err)
{
    ms_status status = run_once(&s->t->clump[n - 1], &s->t->remarks[n - 1], s->how, n, err);
    if (status == MS_OK) {
        status = judge_template(s->t, n, s->how, err);
    }
    if (status == MS_OK) {
        s->t->dice[n - 1] = s->t->score[n - 1].dice;
    }
    return status;
}

/* A search before may have run it. @param[out] reached does it reach the value? */
static ms_status try_number(int *reached, template_search *s, size_t n, ms_error *err)
{
    const ms_status status = s->t->clump[n - 1].n_spheres > 0 ? MS_OK : run_number(s, n, err);
    if (status == MS_OK) {
        *reached = ms_measure_is_reached(s->measure, s->measure->of_score(&s->t->score[n - 1]), s->value);
    }
    return status;
}

/* Numbers of which the lower one does not reach the value (0: none is known) and the higher one does, in steps of a
 * fifth from the one that is expected. */
static ms_status bracket_number(size_t *lo, size_t *hi, template_search *s, size_t first, ms_error *err)
{
    size_t n = first;
    int reached = 0;
    *lo = *hi = 0;
    ms_status status = try_number(&reached, s, n, err);
    const int begins_above = reached;
    while (status == MS_OK && reached == begins_above) {
        *(reached ? hi : lo) = n;
        if (reached ? n == 1 : n == s->t->most) {
            break;
        }
        const size_t step = 1 + n / 5;
        n = !reached ? n + step : n > step ? n - step : 1;
        n = n < s->t->most ? n : s->t->most;
        status = try_number(&reached, s, n, err);
    }
    *(reached ? hi : lo) = n;
    *lo = reached && n == 1 ? 0 : *lo;
    return status;
}

ms_status ms_templates_search(ms_templates *templates, size_t *reached, const ms_templates_how *how,
                              const ms_measure *measure, double value, size_t first, ms_error *err)
{
    const size_t most = templates->most;
    size_t lo = 0, hi = 0;
    template_search s = {.t = templates, .how = how, .measure = measure, .value = value};
    ms_status status = bracket_number(&lo, &hi, &s, first < 1 ? 1 : first < most ? first : most, err);
    while (status == MS_OK && hi > 0 && hi - lo > 1) {
        int is_reached;
        const size_t middle = lo + (hi - lo) / 2;
        status = try_number(&is_reached, &s, middle, err);
        *(status == MS_OK && is_reached ? &hi : &lo) = middle;
    }
    *reached = hi;
    return status;
}

size_t ms_templates_least(double *best, const ms_templates *templates, const ms_measure *measure, double value)
{
    *best = (double)NAN;
    for (size_t n = 1; n <= templates->most; n++) {
        if (templates->clump[n - 1].n_spheres == 0) { /* not run */
            continue;
        }
        const double have = measure->of_score(&templates->score[n - 1]);
        if (ms_measure_is_reached(measure, have, value)) {
            return n;
        }
        *best = measure->better == MS_BETTER_MORE ? fmax(*best, have) : fmin(*best, have);
    }
    return 0;
}

ms_status ms_templates_surface(double *surface, const ms_target *target, ms_error *err)
{
    ms_descriptors of_shape;
    const ms_status status = ms_descriptors_of_target(&of_shape, target, err);
    if (status != MS_OK) {
        return status;
    }
    *surface = of_shape.area / of_shape.volume;
    return isnan(*surface) ? ms_fail(err, MS_ERR_SHAPE,
                                     "the area of its surface is not known, so that no length can be tolerated; use "
                                     "more cells, or tolerate a D")
                           : MS_OK;
}

double ms_templates_dice(double length, double surface, double factor)
{
    return length * surface / (2 * factor);
}

double ms_templates_length(double dice, double surface, double factor)
{
    return 2 * dice * factor / surface;
}

void ms_templates_free(ms_templates *templates)
{
    if (templates) {
        for (size_t n = 0; templates->clump && n < templates->most; n++) {
            ms_clump_free(&templates->clump[n]);
        }
        free(templates->clump);
        free(templates->score);
        free(templates->dice);
        free(templates->remarks);
        *templates = (ms_templates){0};
    }
}
