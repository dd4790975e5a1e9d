#include "ms_compare_walk.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_expectation.h"
#include "cli/ms_files.h"
#include "cli/ms_machine.h"
#include "ms_compare.h"
#include "ms_compare_charts.h"
#include "ms_compare_plan.h"
#include "ms_compare_population_write.h"
#include "ms_compare_report.h"
#include "ms_compare_sheet.h"
#include "ms_compare_verdict.h"
#include "ms_trial.h"

/* A row, with the texts that it borrows. */
typedef struct compare_result {
    ms_compare_row row;
    char checksum[20];
    ms_error cause;
    int is_remarked; /* nonzero: the method has a remark on the clump */
} compare_result;

/* Where the comparison stands. */
typedef struct compare_walk {
    const ms_comparison *a;
    const ms_compare_plan *plan;
    compare_result **result; /* of each run that is done and not taken; NULL without memory */
    ms_csv *csv;
    ms_machine machine;
    size_t made, failed; /* rows; of those made how many failed */
    size_t remarked;     /* of the others: the method has a remark on the clump */
    ms_error first_cause;
    ms_status drawn;  /* of the first chart that failed; the comparison goes on */
    ms_error why_not; /* it failed */
} compare_walk;

static void put_input(ms_compare_row *row, const ms_input *input)
{
    row->number[MS_COLUMN_VOXEL] = input->target.grid.h;
    row->number[MS_COLUMN_READ] = input->read_seconds;
    row->number[MS_COLUMN_VOXELIZE] = input->voxelize_seconds;
    row->number[MS_COLUMN_DISTANCE] = input->distance_seconds;
    row->number[MS_COLUMN_DESCRIBE] = input->describe_seconds;
}

static void say_row(FILE *words, const ms_compare_row *row)
{
    fprintf(words, "%s %s%s%s", row->text[MS_COLUMN_SHAPE], row->text[MS_COLUMN_GENERATOR],
            row->text[MS_COLUMN_OPTIONS][0] ? ":" : "", row->text[MS_COLUMN_OPTIONS]);
    if (isfinite(row->number[MS_COLUMN_CELLS])) {
        fprintf(words, ", %g cells", row->number[MS_COLUMN_CELLS]);
    }
    const ms_column n = isfinite(row->number[MS_COLUMN_SPHERES]) ? MS_COLUMN_SPHERES : MS_COLUMN_ASKED;
    if (isfinite(row->number[n])) {
        fprintf(words, ", n %g", row->number[n]);
    }
    if (isfinite(row->number[MS_COLUMN_DICE])) {
        fprintf(words, ": D %.4f", row->number[MS_COLUMN_DICE]);
    } else if (row->text[MS_COLUMN_CAUSE]) {
        fprintf(words, ": %s", row->text[MS_COLUMN_CAUSE]);
    }
    if (isfinite(row->number[MS_COLUMN_GENERATE])) {
        fprintf(words, ", %.3g s", row->number[MS_COLUMN_GENERATE]);
    }
    fprintf(words, "\n");
    fflush(words);
}

/* Remembers the first failure of a chart. */
static void note_drawn(compare_walk *w, ms_status status, const ms_error *err)
{
    if (status != MS_OK && w->drawn == MS_OK) {
        w->drawn = status;
        w->why_not = *err;
    }
}

/* The sheet of a shape of that name. */
static ms_compare_sheet plan_sheet(const ms_comparison *a, const char *name, size_t at)
{
    return (ms_compare_sheet){.folder = a->charts,
                              .shape = name,
                              .at = at,
                              .methods = &a->methods,
                              .asked = a->asked.value,
                              .n_asked = a->asked.count,
                              .max_voxels = ms_input_max_voxels(&a->input)};
}

/* For the contact sheet: charts are drawn of runs in turn, so that no other run is at it.
 * @param clump of n spheres; NULL, before a run: none, and none of a run before either */
static void keep_clump(compare_walk *w, const ms_compare_run *run, double asked, const ms_clump *clump, size_t n)
{
    char name[256];
    ms_error err;
    const double finest = w->a->cells.value[w->a->cells.count - 1];
    if (w->a->charts && run->method->generator && !(run->stage->cells < finest)) {
        ms_compare_name(name, sizeof name, run->stage->shape, w->a->label);
        const ms_compare_sheet sheet = plan_sheet(w->a, name, run->stage->at);
        const ms_clump prefix = {.n_spheres = n, .capacity = n, .sphere = clump ? clump->sphere : NULL};
        note_drawn(w,
                   clump ? ms_compare_sheet_keep(&sheet, run->method, asked, &prefix, &err)
                         : ms_compare_sheet_drop(&sheet, run->method, asked, &err),
                   &err);
    }
}

static void draw_sheet(compare_walk *w, const ms_compare_stage *stage)
{
    char name[256];
    ms_error err;
    if (stage->shared.status == MS_OK) {
        ms_compare_name(name, sizeof name, stage->shape, w->a->label);
        const ms_compare_sheet sheet = plan_sheet(w->a, name, stage->at);
        note_drawn(w, ms_compare_sheet_draw(&sheet, &stage->shared.input.target, w->a->words, &err), &err);
    }
}

/* One row, of the first spheres of what a trial or another tool gave. */
static ms_status judge_clump(compare_walk *w, compare_result *result, const ms_compare_run *run, size_t k,
                             const ms_trial *trial)
{
    const double asked = run->asked[k];
    const ms_method *method = run->method;
    const ms_clump *clump = method->generator ? &trial->clump : &method->clump[run->stage->at].clump;
    const size_t n = asked < (double)clump->n_spheres ? (size_t)asked : clump->n_spheres;
    ms_compare_row *row = &result->row;
    if (method->generator) {
        row->text[MS_COLUMN_STOPPED] =
            ms_stop_name(asked <= (double)clump->n_spheres ? MS_STOP_SPHERES : trial->reason);
        row->number[MS_COLUMN_GENERATE] = trial->seconds[k];
        row->number[MS_COLUMN_FASTEST] = trial->fastest[k];
        row->number[MS_COLUMN_SLOWEST] = trial->slowest[k];
        row->number[MS_COLUMN_MEMORY] = trial->memory;
    }
    keep_clump(w, run, asked, clump, n);
    row->number[MS_COLUMN_EXPECTED] = ms_expectation_dice(&run->stage->expect, n);
    return ms_trial_judge(row, clump, n, &run->stage->shared.input.target, ms_input_max_voxels(&w->a->input),
                          &result->cause);
}

/* What is expected of a shape, found by the first run that needs it; others wait. */
static ms_status need_expected(ms_compare_stage *stage, ms_error *err)
{
    ms_status status = MS_OK;
    pthread_mutex_lock(&stage->shared.lock);
    if (!stage->is_expected) {
        status = ms_expectation_try(&stage->expect, &stage->shared.input, err);
        stage->is_expected = status == MS_OK;
    }
    pthread_mutex_unlock(&stage->shared.lock);
    return status;
}

static ms_status make_trial(compare_walk *w, ms_trial *trial, const ms_compare_run *run, int beside, ms_error *err)
{
    size_t n[MS_NUMBERS_MAX];
    char title[256];
    const ms_trial_run how = {.generator = run->method->generator,
                              .settings = &run->method->settings,
                              .seed = (uint64_t)w->a->seed,
                              .repeats = (int)w->a->repeats,
                              .beside = beside,
                              .asked = n,
                              .n_asked = run->count,
                              .min_radius = w->a->min_radius,
                              .title = title};
    for (size_t k = 0; k < run->count; k++) {
        n[k] = (size_t)run->asked[k];
    }
    snprintf(title, sizeof title, "%.150s %.80s", run->stage->shape, run->method->name);
    return ms_trial_make(trial, &how, &run->stage->shared.input.target, err);
}

/* What a row that failed, in all or in its masses, has as its cause, and what the method remarks on its clump. */
static void put_cause(compare_result *r, const ms_trial *trial, int failed)
{
    char *text = r->cause.text;
    const size_t length = failed ? strlen(text) : 0;
    if (!failed || trial->remarks.text[0]) {
        snprintf(text + length, sizeof r->cause.text - length, "%s%s", failed ? "; " : "", trial->remarks.text);
    }
    r->row.text[MS_COLUMN_CAUSE] = text[0] ? text : NULL;
    r->is_remarked = trial->remarks.text[0] != '\0';
}

/* The rows of a run, from `there` on; those before were there. */
static void make_rows(compare_walk *w, compare_result *result, const ms_compare_run *run, int beside)
{
    const ms_shared_input *shared = &run->stage->shared;
    ms_trial trial = {0};
    ms_error cause = shared->cause;
    ms_status made = shared->status;
    for (size_t k = run->there; k < run->count; k++) {
        keep_clump(w, run, run->asked[k], NULL, 0);
    }
    if (made == MS_OK) {
        made = need_expected(run->stage, &cause);
    }
    if (made == MS_OK && run->method->generator) {
        made = make_trial(w, &trial, run, beside, &cause);
    }
    for (size_t k = run->there; k < run->count; k++) {
        compare_result *r = &result[k];
        ms_compare_plan_checksum(r->checksum, shared->input.checksum);
        r->row = ms_compare_plan_row(w->a, run->stage, run->method, run->asked[k], r->checksum);
        r->row.text[MS_COLUMN_MACHINE] = w->machine.text;
        r->row.number[MS_COLUMN_THREADS] = omp_get_max_threads();
        r->row.number[MS_COLUMN_BESIDE] = beside;
        r->cause = cause;
        if (shared->status == MS_OK) {
            put_input(&r->row, &shared->input);
        }
        const int failed = made != MS_OK || judge_clump(w, r, run, k, &trial) != MS_OK;
        put_cause(r, &trial, failed);
    }
    ms_trial_free(&trial);
}

static void work_run(void *context, size_t at, ms_queue_place *place)
{
    compare_walk *w = context;
    const ms_compare_run *run = &w->plan->run[at];
    ms_shared_input_need(&run->stage->shared, place);
    if (!run->method) {
        draw_sheet(w, run->stage);
    } else if ((w->result[at] = calloc(run->count, sizeof **w->result))) {
        make_rows(w, w->result[at], run, ms_queue_beside(place));
    }
    ms_shared_input_release(&run->stage->shared);
}

/* Counts it, and remembers why the first one failed. Nonzero if it did. */
static int note_row(compare_walk *w, const compare_result *result)
{
    const ms_compare_row *row = &result->row;
    const int failed = !isfinite(row->number[MS_COLUMN_DICE]);
    if (failed && !w->first_cause.text[0]) {
        ms_fail(&w->first_cause, MS_ERR_SHAPE, "%s", row->text[MS_COLUMN_CAUSE]);
    }
    w->made++;
    w->remarked += !failed && result->is_remarked;
    return failed;
}

static ms_status add_row(compare_walk *w, const compare_result *result, size_t *failed, ms_error *err)
{
    char *line = ms_compare_line(&result->row);
    const ms_status status = line ? ms_csv_add(w->csv, line, err) : ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    free(line);
    if (status == MS_OK) {
        *failed += note_row(w, result);
        say_row(w->a->words, &result->row);
    }
    return status;
}

static ms_status take_rows(void *context, size_t at, size_t *failed, ms_error *err)
{
    compare_walk *w = context;
    const ms_compare_run *run = &w->plan->run[at];
    ms_status status = MS_OK;
    if (run->method && !w->result[at]) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu rows", run->count);
    }
    for (size_t k = run->there; k < run->count && status == MS_OK; k++) {
        status = add_row(w, &w->result[at][k], failed, err);
    }
    free(w->result[at]);
    w->result[at] = NULL;
    w->failed += *failed;
    return status;
}

static ms_status list_charts(ms_files *files, const ms_comparison *a, size_t s, ms_error *err)
{
    char name[256], other[256];
    ms_compare_name(name, sizeof name, a->shape[s], a->label);
    for (size_t before = 0; before < s; before++) {
        ms_compare_name(other, sizeof other, a->shape[before], a->label);
        if (strcmp(name, other) == 0) {
            return ms_fail(err, MS_ERR_ARG, "two shapes are called %s, and so would be their charts; rename one", name);
        }
    }
    const ms_compare_sheet sheet = plan_sheet(a, name, s);
    const ms_status status = ms_compare_sheet_list(files, &sheet, err);
    return status == MS_OK ? ms_compare_charts_list(files, a->charts, name, err) : status;
}

ms_status ms_compare_list_files(ms_files *files, const ms_comparison *comparison, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; s < comparison->n_shapes && status == MS_OK; s++) {
        status = ms_files_add_shape(files, comparison->shape[s], err);
        if (status == MS_OK && comparison->charts) {
            status = list_charts(files, comparison, s, err);
        }
    }
    if (status == MS_OK && comparison->population) {
        status = ms_compare_population_list(files, comparison->population, err);
    }
    return status == MS_OK ? ms_methods_list_files(files, &comparison->methods, err) : status;
}

/* Times are the result where they are charted or the median of several. */
static int are_times_asked(const ms_comparison *a)
{
    return a->charts || a->repeats > 1;
}

static ms_status walk_plan(compare_walk *w, ms_error *err)
{
    const ms_compare_plan *plan = w->plan;
    const ms_queue queue = {.count = plan->n_runs,
                            .threads = w->a->input.threads ? w->a->input.threads : omp_get_max_threads(),
                            .in_turn = are_times_asked(w->a),
                            .context = w,
                            .work = work_run,
                            .take = take_rows};
    w->result = calloc(plan->n_runs + 1, sizeof(compare_result *)); /* of none, too */
    if (!w->result) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu runs", plan->n_runs);
    }
    const ms_status status = ms_queue_run(&queue, err);
    for (size_t r = 0; r < plan->n_runs; r++) {
        free(w->result[r]); /* of a queue that has failed */
    }
    free(w->result);
    return status;
}

/* What is made of all rows together: charts, the population, the page, the verdict. */
static void conclude(compare_walk *w)
{
    const ms_comparison *a = w->a;
    ms_compare_records all;
    ms_error why;
    const ms_status cut = ms_compare_records_cut(&all, w->csv, &why);
    note_drawn(w, cut, &why);
    if (cut == MS_OK && a->charts) {
        note_drawn(w, ms_compare_charts(&all, a->charts, a->words, &why), &why);
    }
    if (cut == MS_OK && a->population) {
        note_drawn(w, ms_compare_population_write(&all, a->population, a->words, &why), &why);
    }
    if (cut == MS_OK && a->report) { /* without its charts, too, where gnuplot is not there */
        note_drawn(w, ms_compare_report_write(w->csv, a, &why), &why);
    }
    if (cut == MS_OK) {
        note_drawn(w, ms_compare_verdict_say(stderr, &all, &why), &why);
    }
    ms_compare_records_free(&all);
}

ms_status ms_compare_walk(ms_csv *csv, const ms_comparison *comparison, ms_error *err)
{
    ms_compare_plan plan;
    ms_status status = ms_compare_plan_make(&plan, comparison, csv, err);
    compare_walk w = {.a = comparison, .plan = &plan, .csv = csv, .machine = ms_machine_read()};
    if (status != MS_OK) {
        return status;
    }
    if (comparison->charts) {
        status = ms_files_make_folder(comparison->charts, err);
    }
    if (status == MS_OK && comparison->population) {
        status = ms_files_make_folder(comparison->population, err);
    }
    status = status == MS_OK ? walk_plan(&w, err) : status;
    ms_compare_plan_free(&plan);
    if (status != MS_OK) {
        return status;
    }
    fprintf(comparison->words, "wrote %s, %zu rows", csv->path, csv->n_rows);
    if (w.failed) {
        fprintf(comparison->words, "; %zu of the new ones failed, see the column cause", w.failed);
    }
    if (w.remarked) {
        fprintf(comparison->words, "; on %zu of them the method has a remark, see the column cause", w.remarked);
    }
    putc('\n', comparison->words);
    conclude(&w);
    *err = w.why_not;
    if (w.drawn == MS_OK && w.made > 0 && w.failed == w.made) {
        return ms_fail(err, MS_ERR_SHAPE, "not one of %zu rows succeeded; the first failed because of this: %.700s",
                       w.made, w.first_cause.text);
    }
    return w.drawn;
}
