#include "ms_stability_walk.h"

#include <errno.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ms_hard_shapes.h"
#include "queue/ms_shared_input.h"

/* A run that is to do. */
typedef struct stability_job {
    ms_shared_input *shared;
    size_t run; /* of all */
} stability_job;

typedef struct stability_walk {
    const ms_stability_plan *plan;
    ms_stability_rows *rows;
    ms_stability_run *run;
    size_t n_runs;
    ms_shared_input *shared; /* of each shape */
    stability_job *job;
    size_t n_jobs;
} stability_walk;

size_t ms_stability_count(const ms_stability_plan *plan)
{
    size_t each = 0;
    for (int c = 0; ms_changes[c].name; c++) {
        each += plan->wanted[c] ? (size_t)ms_change_runs(&ms_changes[c], plan->runs) : 0;
    }
    return each * plan->n_shapes * plan->methods->count;
}

ms_status ms_stability_read_shape(ms_input *input, const char *name, ms_input_flags *flags, ms_error *err)
{
    ms_choice choice = {.typed = name};
    const ms_hard_shape *built_in = ms_hard_shapes_find(&choice);
    if (built_in) {
        return ms_hard_shapes_read(input, built_in, flags, err);
    }
    if (choice.nearest[0] && access(name, F_OK) != 0) {
        return ms_choice_fail(&choice, err, "there is no file and no built-in shape '%s'", name);
    }
    const ms_status status = ms_input_read(input, name, flags, err);
    if (status == MS_OK && input->is_volume) {
        ms_input_free(input);
        return ms_fail(err, MS_ERR_ARG, "%s is a volume; perturbations are of meshes", name);
    }
    return status;
}

static ms_status sum_shape(uint64_t *checksum, const char *name, const ms_input_flags *flags, ms_error *err)
{
    ms_input input;
    ms_input_flags own = *flags;
    const ms_status status = ms_stability_read_shape(&input, name, &own, err);
    if (status == MS_OK) {
        *checksum = input.checksum;
        ms_input_free(&input);
    }
    return status;
}

ms_status ms_stability_try_shapes(const ms_stability_plan *plan, ms_error *err)
{
    uint64_t checksum;
    ms_status status = MS_OK;
    for (size_t s = 0; s < plan->n_shapes && status == MS_OK; s++) {
        ms_choice choice = {.typed = plan->shape[s]};
        status = ms_hard_shapes_find(&choice) ? MS_OK : sum_shape(&checksum, plan->shape[s], plan->flags, err);
    }
    return status;
}

/* A run as far as it is known before; takes what it gave from the row, where there is one. */
static ms_status plan_run(stability_walk *w, ms_stability_run run, ms_shared_input *shared, ms_error *err)
{
    const size_t at = w->n_runs++;
    ms_status status = MS_OK;
    if (at < w->rows->csv.n_rows) {
        status = ms_stability_read_row(&run, w->rows->csv.row[at], err);
        if (status != MS_OK) {
            const ms_error cause = *err;
            return ms_fail(err, status, "%s: line %zu %s", w->rows->csv.path, at + 2, cause.text);
        }
    } else {
        shared->users++;
        w->job[w->n_jobs++] = (stability_job){shared, at};
    }
    w->run[at] = run;
    return status;
}

static ms_status plan_method(stability_walk *w, ms_stability_run run, ms_shared_input *shared, ms_error *err)
{
    const ms_stability_plan *plan = w->plan;
    ms_status status = MS_OK;
    for (const ms_change *change = ms_changes; change->name && status == MS_OK; change++) {
        const int runs = plan->wanted[change - ms_changes] ? ms_change_runs(change, plan->runs) : 0;
        run.change = change;
        for (run.number = 1; run.number <= runs && status == MS_OK; run.number++) {
            run.level = ms_change_level(change, plan->seed, run.number, plan->runs);
            status = plan_run(w, run, shared, err);
        }
    }
    return status;
}

static ms_status plan_shape(stability_walk *w, size_t s, ms_error *err)
{
    const ms_stability_plan *plan = w->plan;
    ms_stability_run run = {.shape = plan->shape[s],
                            .flags = plan->said.text,
                            .seed = plan->seed,
                            .asked = plan->spheres,
                            .min_radius = plan->min_radius,
                            .until_dice = plan->until_dice};
    ms_status status = MS_OK;
    ms_shared_input_begin(&w->shared[s], plan->shape[s], ms_stability_read_shape, plan->flags, 0);
    if (w->n_runs < w->rows->csv.n_rows) {
        status = sum_shape(&run.shape_checksum, plan->shape[s], plan->flags, err);
    }
    for (size_t m = 0; m < plan->methods->count && status == MS_OK; m++) {
        run.method = &plan->methods->method[m];
        status = plan_method(w, run, &w->shared[s], err);
    }
    return status;
}

static ms_status plan_shapes(stability_walk *w, ms_error *err)
{
    ms_status status = MS_OK;
    size_t begun = 0;
    for (; begun < w->plan->n_shapes && status == MS_OK; begun++) {
        status = plan_shape(w, begun, err);
    }
    for (size_t s = begun; s < w->plan->n_shapes; s++) { /* so that all can be ended */
        ms_shared_input_begin(&w->shared[s], w->plan->shape[s], ms_stability_read_shape, w->plan->flags, 0);
    }
    if (status == MS_OK && w->n_runs < w->rows->csv.n_rows) {
        status = ms_fail(err, MS_ERR_ARG, "%s: holds %zu rows of other runs behind these; name another file",
                         w->rows->csv.path, w->rows->csv.n_rows - w->n_runs);
    }
    return status;
}

static void work_run(void *context, size_t at, ms_queue_place *place)
{
    stability_walk *w = context;
    ms_shared_input *shared = w->job[at].shared;
    ms_stability_run *run = &w->run[w->job[at].run];
    if (ms_shared_input_need(shared, place) == MS_OK) {
        const ms_stability s = {.input = &shared->input,
                                .seed = w->plan->seed,
                                .flags = w->plan->flags,
                                .place = place,
                                .keep = w->plan->keeps_clumps};
        ms_stability_try(run, &s);
        run->beside = ms_queue_beside(place);
    } else {
        run->cause = shared->cause;
        run->outcome = MS_OUTCOMES;
    }
    ms_shared_input_release(shared);
}

/* Once for each resolution of a shape: that of its own grid was said when the grid was made. */
static void say_misfit(const stability_walk *w, const ms_stability_run *run)
{
    int said = run->change == ms_changes;
    for (const ms_stability_run *before = w->run; before < run && !said; before++) {
        said = before->shape_checksum == run->shape_checksum && before->voxel_size == run->voxel_size &&
               fabs(before->misfit) >= MS_INPUT_MISFIT;
    }
    if (!said) {
        ms_input_say_misfit(run->shape, run->misfit, run->voxel_size, run->shortest_side);
    }
}

/* The row into the table, at once. */
static ms_status add_row(ms_stability_rows *rows, const ms_stability_run *run, ms_error *err)
{
    char *line = ms_stability_line(run);
    ms_status status = MS_OK;
    if (!line) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    }
    if (!rows->stream) {
        status = ms_csv_add(&rows->csv, line, err);
    } else if (fprintf(rows->stream, "%s\n", line) < 0 || fflush(rows->stream) != 0) {
        status = ms_fail(err, MS_ERR_IO, "a row could not be written: %s; is the disk full?", strerror(errno));
    }
    free(line);
    return status;
}

static ms_status take_run(void *context, size_t at, size_t *failed, ms_error *err)
{
    stability_walk *w = context;
    const ms_stability_run *run = &w->run[w->job[at].run];
    if (run->outcome == MS_OUTCOMES) { /* without the shape there is nothing to tell of the others */
        *err = run->cause;
        return w->job[at].shared->status;
    }
    *failed += !ms_stability_gave(run);
    say_misfit(w, run);
    return add_row(w->rows, run, err);
}

static ms_status work_through(stability_walk *w, ms_error *err)
{
    const ms_queue queue = {.count = w->n_jobs,
                            .done = w->n_runs - w->n_jobs,
                            .threads = w->plan->flags->threads ? w->plan->flags->threads : omp_get_max_threads(),
                            .context = w,
                            .work = work_run,
                            .take = take_run};
    return ms_queue_run(&queue, err);
}

ms_status ms_stability_walk(ms_stability_run *run, const ms_stability_plan *plan, ms_stability_rows *rows,
                            ms_error *err)
{
    stability_walk w = {.plan = plan, .rows = rows, .run = run};
    w.shared = malloc(plan->n_shapes * sizeof *w.shared);
    w.job = malloc(ms_stability_count(plan) * sizeof *w.job);
    ms_status status = MS_ERR_NOMEM;
    if (w.shared && w.job) {
        status = plan_shapes(&w, err);
        status = status == MS_OK ? work_through(&w, err) : status;
        for (size_t s = 0; s < plan->n_shapes; s++) {
            ms_shared_input_end(&w.shared[s]);
        }
    } else {
        ms_fail(err, status, "no memory for %zu shapes", plan->n_shapes);
    }
    free(w.shared);
    free(w.job);
    return status;
}
