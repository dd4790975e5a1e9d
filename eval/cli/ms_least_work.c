#include "ms_least_work.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measure/ms_metrics.h"
#include "ms_json_object.h"
#include "ms_progress.h"
#include "ms_recipe.h"
#include "ms_report.h"

static ms_status take_dice(double *dice, const char *text, ms_error *err)
{
    char name[64];
    const char *value = NULL;
    ms_status status = ms_recipe_assignment(name, &value, "least-work", text, err);
    if (status == MS_OK && strcmp(name, ms_measures[MS_MEASURE_DICE].name) != 0) {
        return ms_fail(err, MS_ERR_ARG, "--least-work takes dice=VALUE alone, not %s", name);
    }
    return status == MS_OK ? ms_flags_number(dice, "least-work", value ? value : "", 1e-9, 1, err) : status;
}

ms_status ms_least_work_flag(int *taken, ms_least_work *work, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "least-work") == 0) {
        return take_dice(&work->dice, value, err);
    }
    if (strcmp(name, "work-power") == 0) {
        work->has_power = 1;
        return ms_flags_number(&work->power, name, value, 0, 3, err);
    }
    *taken = 0;
    return MS_OK;
}

ms_status ms_least_work_resolve(const ms_least_work *work, const ms_stop *stop, ms_error *err)
{
    if (work->has_power && !(work->dice > 0)) {
        return ms_fail(err, MS_ERR_ARG, "--work-power takes --least-work dice=VALUE beside it");
    }
    if (work->dice > 0 && ms_stop_has_measure(stop)) {
        return ms_fail(err, MS_ERR_ARG,
                       "--least-work ends its runs itself; beside it go -n and --min-radius, no --until MEASURE");
    }
    return MS_OK;
}

/* Runs of a generator. */
typedef struct work_runs {
    const ms_generator *generator;
    ms_run run;
    size_t max_voxels;
    ms_clump clump[MS_LEAST_WORK_MOST_RUNS];
    ms_error cause; /* of the last run that gave no clump */
} work_runs;

/* @param cause of a run that gave no clump */
static void say_try(const ms_least_work_try *row, const char *name, const ms_error *cause)
{
    fprintf(stderr, "%s: n %zu", name, row->asked);
    if (row->radius > 0) {
        fprintf(stderr, ", no radius below %.4g", row->radius);
    }
    if (row->spheres == 0) {
        fprintf(stderr, ": no clump: %s\n", cause->text);
    } else {
        fprintf(stderr, ": D %.5f, %zu spheres from %.4g on\n", row->dice, row->spheres, row->least);
    }
}

static ms_status run_once(void *context, ms_least_work_try *row, int at, ms_error *err)
{
    work_runs *w = context;
    const ms_progress_line line = {.name = w->generator->name, .part = (size_t)at, .parts = MS_LEAST_WORK_MOST_RUNS};
    ms_target plain = *w->run.target;
    ms_score score;
    plain.count_cut = 0; /* of the runs D alone is asked for */
    w->run.stop = (ms_stop){.spheres = row->asked, .radius = row->radius};
    ms_progress_open(&line);
    ms_status status = ms_generator_run(&w->clump[at], &row->reason, w->generator, &w->run, &w->cause);
    ms_progress_close();
    if (status == MS_OK) {
        status = ms_metrics_score_clump(&score, NULL, &plain, &w->clump[at], w->max_voxels, &w->cause);
    }
    if (status == MS_OK) {
        row->spheres = w->clump[at].n_spheres;
        row->dice = score.dice;
        row->least = ms_clump_smallest_radius(&w->clump[at]);
    }
    if (status != MS_OK && status != MS_ERR_SHAPE) {
        *err = w->cause;
        return status;
    }
    say_try(row, w->generator->name, &w->cause);
    return MS_OK;
}

/* The least D of all. */
static ms_status say_unreached(const ms_least_work_tries *tries, const ms_least_work *work, const ms_error *cause,
                               ms_error *err)
{
    const ms_least_work_try *best = NULL;
    for (int k = 0; k < tries->count; k++) {
        const ms_least_work_try *row = &tries->row[k];
        best = row->spheres > 0 && (!best || row->dice < best->dice) ? row : best;
    }
    return best ? ms_fail(err, MS_ERR_LIMIT,
                          "none of %d runs has D %g, the best has %.4g with %zu spheres; use more cells, allow more "
                          "spheres or smaller ones, or ease it",
                          tries->count, work->dice, best->dice, best->spheres)
                : ms_fail(err, MS_ERR_LIMIT, "none of %d runs gave a clump; the last: %s", tries->count, cause->text);
}

ms_status ms_least_work_generate(ms_clump *clump, ms_least_work_tries *tries, const ms_least_work *work,
                                 const ms_generator *generator, const ms_run *run, size_t expected, size_t max_voxels,
                                 ms_error *err)
{
    work_runs w = {.generator = generator, .run = *run, .max_voxels = max_voxels};
    const size_t most = run->stop.spheres ? run->stop.spheres : MS_CLUMP_MAX_SPHERES;
    const ms_least_work_bounds bounds = {.dice = work->dice,
                                         .power = work->power,
                                         .first = expected < 1      ? 1
                                                  : expected < most ? expected
                                                                    : most,
                                         .most = most,
                                         .radius = run->stop.radius,
                                         .equivalent = ms_target_equivalent_radius(run->target)};
    *clump = (ms_clump){0};
    ms_status status = ms_least_work_search(tries, &bounds, run_once, &w, err);
    if (status == MS_OK && tries->kept < 0) {
        status = say_unreached(tries, work, &w.cause, err);
    }
    for (int k = 0; k < MS_LEAST_WORK_MOST_RUNS; k++) {
        if (status == MS_OK && k == tries->kept) {
            *clump = w.clump[k];
        } else {
            ms_clump_free(&w.clump[k]);
        }
    }
    return status;
}

ms_stop ms_least_work_stop(const ms_least_work_tries *tries)
{
    const ms_least_work_try *kept = &tries->row[tries->kept];
    return (ms_stop){.spheres = kept->asked, .radius = kept->radius};
}

json_t *ms_least_work_json(const ms_least_work_tries *tries, const ms_least_work *work)
{
    json_t *rows = json_array();
    for (int k = 0; k < tries->count; k++) {
        const ms_least_work_try *r = &tries->row[k];
        const double known = r->spheres > 0 ? 0 : (double)NAN;
        ms_json_object_append(&rows,
                              json_pack("{s:I,s:o,s:I,s:o,s:o,s:o}", "n_asked", (json_int_t)r->asked, "least_radius",
                                        r->radius > 0 ? json_real(r->radius) : json_null(), "n", (json_int_t)r->spheres,
                                        "dice", ms_report_number(r->dice + known), "smallest_radius",
                                        ms_report_number(r->least + known), "work", ms_report_number(r->work)));
    }
    return json_pack("{s:f,s:f,s:i,s:o}", "dice", work->dice, "power", work->power, "kept", tries->kept, "tried", rows);
}
