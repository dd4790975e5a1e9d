#include "ms_compare_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_version.h"

void ms_compare_plan_checksum(char out[20], uint64_t checksum)
{
    snprintf(out, 20, "%016llx", (unsigned long long)checksum);
}

ms_compare_row ms_compare_plan_row(const ms_comparison *comparison, const ms_compare_stage *stage,
                                   const ms_method *method, double asked, const char *checksum)
{
    ms_compare_row row = ms_compare_empty();
    row.text[MS_COLUMN_SHAPE] = stage->shape;
    row.text[MS_COLUMN_CHECKSUM] = checksum;
    row.text[MS_COLUMN_LABEL] = comparison->label;
    row.text[MS_COLUMN_GENERATOR] = method->name;
    row.text[MS_COLUMN_OPTIONS] = method->generator ? method->options : ms_file_name(method->clump[stage->at].file);
    row.number[MS_COLUMN_CELLS] = stage->cells;
    if (method->generator) {
        row.number[MS_COLUMN_SEED] = comparison->seed;
        row.number[MS_COLUMN_ASKED] = asked;
        row.number[MS_COLUMN_REPEATS] = comparison->repeats;
    }
    row.text[MS_COLUMN_FLAGS] = comparison->flags.text;
    row.text[MS_COLUMN_VERSION] = MS_VERSION;
    return row;
}

/* A plan in the making. */
typedef struct compare_planner {
    ms_compare_plan *plan;
    const ms_comparison *a;
    const ms_csv *csv;
    char checksum[20]; /* of the shape, where rows are there */
} compare_planner;

/* Does the next row, if it was there before, begin as it would now? */
static ms_status check_row(const compare_planner *p, const ms_compare_run *run, double asked, ms_error *err)
{
    const ms_compare_row row = ms_compare_plan_row(p->a, run->stage, run->method, asked, p->checksum);
    char *key = ms_compare_key(&row);
    ms_status status = MS_OK;
    if (!key) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    } else if (strncmp(p->csv->row[p->plan->n_rows], key, strlen(key)) != 0) {
        status = ms_fail(err, MS_ERR_ARG,
                         "%s: line %zu is of another comparison; it should begin with '%.300s'; --resume takes "
                         "shapes, methods, numbers and flags as they were",
                         p->csv->path, p->plan->n_rows + 2, key);
    }
    free(key);
    return status;
}

/* A run, unless all its rows are there. */
static ms_status plan_run(compare_planner *p, ms_compare_run run, ms_error *err)
{
    ms_compare_plan *plan = p->plan;
    for (size_t k = 0; k < run.count; k++) {
        if (plan->n_rows < p->csv->n_rows) {
            const ms_status status = check_row(p, &run, run.asked[k], err);
            if (status != MS_OK) {
                return status;
            }
            run.there++;
        }
        plan->n_rows++;
    }
    if (run.there < run.count || !run.method) {
        run.stage->shared.users++;
        plan->run[plan->n_runs++] = run;
    }
    return MS_OK;
}

/* How many numbers of spheres a method is asked for, and how many of them one run gives. */
static size_t count_asked(size_t *batch, const ms_comparison *a, const ms_method *method)
{
    const size_t count = method->generator ? a->asked.count : 1;
    *batch = method->generator && ms_generator_is_nested(method->generator, &method->settings) ? count : 1;
    return count;
}

static ms_status plan_method(compare_planner *p, ms_compare_stage *stage, const ms_method *method, ms_error *err)
{
    static const double AS_IT_IS[] = {HUGE_VAL};
    const double *asked = method->generator ? p->a->asked.value : AS_IT_IS;
    size_t batch;
    const size_t count = count_asked(&batch, p->a, method);
    ms_status status = MS_OK;
    for (size_t k = 0; k < count && status == MS_OK; k += batch) {
        const ms_compare_run run = {.stage = stage, .method = method, .asked = asked + k, .count = batch};
        status = plan_run(p, run, err);
    }
    return status;
}

static ms_status read_as_it_is(ms_input *input, const char *name, ms_input_flags *flags, ms_error *err)
{
    return ms_input_read(input, name, flags, err);
}

/* A shape that cannot be read has no checksum; why, its rows will say. */
static void sum_shape(compare_planner *p, const char *shape)
{
    ms_bytes bytes;
    ms_error ignored;
    ms_compare_plan_checksum(p->checksum, 0);
    if (p->plan->n_rows < p->csv->n_rows && ms_file_read(&bytes, shape, &ignored) == MS_OK) {
        ms_compare_plan_checksum(p->checksum, ms_file_checksum(&bytes));
        ms_file_free(&bytes);
    }
}

static ms_status plan_shape(compare_planner *p, size_t at, ms_error *err)
{
    const char *shape = p->a->shape[at];
    const int is_volume = ms_volume_is_volume_path(shape); /* which has voxels of its own */
    ms_compare_stage *stage = NULL;
    ms_status status = MS_OK;
    sum_shape(p, shape);
    for (size_t c = 0; c < (is_volume ? 1 : p->a->cells.count) && status == MS_OK; c++) {
        ms_input_flags flags = p->a->input;
        stage = &p->plan->stage[p->plan->n_stages++];
        stage->shape = shape;
        stage->at = at;
        stage->cells = is_volume ? (double)NAN : p->a->cells.value[c];
        flags.cells = is_volume ? 0 : stage->cells;
        flags.need = ms_methods_need(&p->a->methods, flags.cut);
        ms_shared_input_begin(&stage->shared, shape, read_as_it_is, &flags, 0);
        for (size_t m = 0; m < p->a->methods.count && status == MS_OK; m++) {
            status = plan_method(p, stage, &p->a->methods.method[m], err);
        }
    }
    return status == MS_OK && p->a->charts ? plan_run(p, (ms_compare_run){.stage = stage}, err) : status;
}

/* The most runs that a stage can have, its contact sheet among them. */
static size_t count_runs(const ms_comparison *a)
{
    size_t runs = 1, batch;
    for (size_t m = 0; m < a->methods.count; m++) {
        runs += count_asked(&batch, a, &a->methods.method[m]);
    }
    return runs;
}

ms_status ms_compare_plan_make(ms_compare_plan *plan, const ms_comparison *comparison, const ms_csv *csv, ms_error *err)
{
    const size_t stages = comparison->n_shapes * comparison->cells.count;
    compare_planner p = {.plan = plan, .a = comparison, .csv = csv};
    *plan = (ms_compare_plan){.stage = calloc(stages, sizeof *plan->stage),
                              .run = calloc(stages, count_runs(comparison) * sizeof *plan->run)};
    ms_status status =
        plan->stage && plan->run ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu stages of runs", stages);
    for (size_t s = 0; s < comparison->n_shapes && status == MS_OK; s++) {
        status = plan_shape(&p, s, err);
    }
    if (status == MS_OK && plan->n_rows < csv->n_rows) {
        status = ms_fail(err, MS_ERR_ARG, "%s: holds %zu rows of another comparison behind these; name another file",
                         csv->path, csv->n_rows - plan->n_rows);
    }
    if (status != MS_OK) {
        ms_compare_plan_free(plan);
    }
    return status;
}

void ms_compare_plan_free(ms_compare_plan *plan)
{
    for (size_t s = 0; s < plan->n_stages; s++) {
        ms_shared_input_end(&plan->stage[s].shared);
    }
    free(plan->stage);
    free(plan->run);
    *plan = (ms_compare_plan){0};
}
