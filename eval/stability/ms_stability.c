#include "ms_stability.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "chart/ms_csv.h"

#define OUTCOME_NAME(code, name) name,
static const char *const OUTCOMES[] = {MS_OUTCOME_LIST(OUTCOME_NAME)};

/* What --until-dice allows, over the number of spheres asked for. */
enum { UNTIL_FACTOR = 10 };

enum { MOST_COLUMNS = 32 + MS_MEASURES };

/* The shape and the run as they were changed. */
static ms_status apply_change(ms_changed *c, const ms_stability_run *run, const ms_stability *s, ms_error *err)
{
    const ms_change_order order = {.level = run->level,
                                   .number = run->number,
                                   .seed = s->seed,
                                   .diameter = 2 * ms_target_equivalent_radius(&s->input->target),
                                   .closed = s->input->report.closed};
    *c = (ms_changed){.motion = ms_perturb_motion_none(),
                      .seed = s->seed,
                      .voxel_size = s->input->target.grid.h,
                      .threads = omp_get_max_threads()};
    ms_status status = ms_perturb_copy(&c->mesh, &s->input->mesh, err);
    if (status == MS_OK) {
        status = run->change->apply(c, &order, err);
        ms_perturb_motion_apply(&c->mesh, &c->motion);
    }
    return status;
}

static ms_status make_target(ms_target *target, const ms_changed *c, const ms_stability *s, ms_error *err)
{
    double n[3];
    ms_voxelize_extents(n, &c->mesh, c->voxel_size);
    for (int a = 0; a < 3; a++) {
        n[a] += c->lattice[a] > 0; /* as ms_voxelize_moved */
    }
    const double squares = ms_mesh_area(&c->mesh) / (c->voxel_size * c->voxel_size);
    const double bytes = ms_target_bytes(n, squares, s->flags->need);
    if (bytes > s->flags->max_memory) {
        return ms_fail(err, MS_ERR_LIMIT, "a grid of %.6gx%.6gx%.6g voxels takes more than the memory allowed", n[0],
                       n[1], n[2]);
    }
    ms_queue_need_memory(s->place, bytes, s->flags->max_memory);
    return ms_target_from_mesh_moved(target, &c->mesh, s->input->report.closed, c->voxel_size, s->flags->rule,
                                     c->lattice, err);
}

static uint64_t sum_spheres(const ms_clump *clump)
{
    const ms_bytes bytes = {.data = (uint8_t *)clump->sphere, .size = clump->n_spheres * sizeof *clump->sphere};
    return ms_file_checksum(&bytes);
}

/* The number of spheres at fixed D, by the method's own stop rule on the shape as it was changed. */
static ms_status seek_number(ms_stability_run *run, ms_run job, ms_error *err)
{
    ms_clump clump;
    ms_stop_reason reason;
    job.remark = NULL; /* of its clump the number alone is kept */
    job.stop = (ms_stop){.radius = run->min_radius};
    job.stop.spheres =
        run->asked < MS_CLUMP_MAX_SPHERES / UNTIL_FACTOR ? run->asked * UNTIL_FACTOR : MS_CLUMP_MAX_SPHERES;
    job.stop.dice = run->until_dice;
    ms_status status = ms_generator_run(&clump, &reason, run->method->generator, &job, err);
    run->spheres_until = status == MS_OK && reason == MS_STOP_DICE ? clump.n_spheres : 0;
    ms_clump_free(&clump);
    return status;
}

/* @param[out] remarks of the method */
static ms_status run_method(ms_stability_run *run, ms_error *remarks, const ms_target *target, const ms_motion *motion,
                            const ms_stability *s, ms_error *err)
{
    ms_clump clump;
    ms_run job = {.target = target, .settings = &run->method->settings, .seed = run->seed};
    job.stop = (ms_stop){.spheres = run->asked, .radius = run->min_radius};
    ms_generator_keep_remarks(&job, remarks);
    const double start = omp_get_wtime();
    ms_status status = ms_generator_run(&clump, &run->reason, run->method->generator, &job, err);
    run->seconds = omp_get_wtime() - start;
    if (status == MS_OK) {
        ms_perturb_motion_undo(&clump, motion);
        run->checksum = sum_spheres(&clump);
        status = ms_metrics_compute_kinds(&run->metrics, NULL, MS_METRICS_ALL & ~MS_METRICS_KIND(SURFACE),
                                          &s->input->target, &clump, ms_input_max_voxels(s->flags), err);
    }
    if (status == MS_OK && run->until_dice > 0) {
        status = seek_number(run, job, err);
    }
    if (status == MS_OK && s->keep) {
        run->clump = clump;
    } else {
        ms_clump_free(&clump);
    }
    return status;
}

void ms_stability_free(ms_stability_run *run, size_t count)
{
    for (size_t r = 0; r < count; r++) {
        ms_clump_free(&run[r].clump);
    }
}

void ms_stability_try(ms_stability_run *run, const ms_stability *s)
{
    const int threads = omp_get_max_threads();
    ms_changed c;
    ms_target target = {0};
    ms_error remarks = {""};
    run->shape_checksum = s->input->checksum;
    run->shortest_side = ms_input_shortest_side(&s->input->mesh);
    ms_status status = apply_change(&c, run, s, &run->cause);
    run->seed = c.seed;
    run->voxel_size = c.voxel_size;
    run->threads = c.threads;
    omp_set_num_threads(run->threads);
    if (status == MS_OK) {
        status = make_target(&target, &c, s, &run->cause);
        run->misfit = status == MS_OK ? ms_target_misfit(&target) : 0;
    }
    if (status != MS_OK) {
        run->outcome = MS_OUTCOME_UNUSABLE;
    } else if (run_method(run, &remarks, &target, &c.motion, s, &run->cause) != MS_OK) {
        run->outcome = MS_OUTCOME_FAILED;
    } else {
        run->outcome = run->metrics.spheres < run->asked ? MS_OUTCOME_SHORT : MS_OUTCOME_OK;
        run->cause = remarks;
    }
    omp_set_num_threads(threads);
    ms_target_free(&target);
    ms_mesh_free(&c.mesh);
}

ms_label ms_stability_label(const ms_method *method)
{
    ms_label label;
    snprintf(label.text, sizeof label.text, "%s%s%s", method->name, method->options[0] ? ":" : "", method->options);
    return label;
}

int ms_stability_gave(const ms_stability_run *run)
{
    return run->outcome == MS_OUTCOME_OK || run->outcome == MS_OUTCOME_SHORT;
}

const ms_stability_run *ms_stability_unchanged(const ms_stability_run *runs, const ms_stability_run *run)
{
    while (run > runs && run->change != &ms_changes[0]) {
        run--;
    }
    return ms_stability_gave(run) ? run : NULL;
}

/* The measures that are columns, in their order: first those of S and U, then those of the spheres; no surfaces. */
static size_t list_measures(const ms_measure *listed[MS_MEASURES])
{
    size_t count = 0;
    for (int of_spheres = 0; of_spheres < 2; of_spheres++) {
        for (const ms_measure *m = ms_measures; m->name; m++) {
            if (m->kind != MS_MEASURE_KIND_SURFACE && ms_measure_is_of_score(m) == !of_spheres) {
                listed[count++] = m;
            }
        }
    }
    return count;
}

static void print_header(FILE *stream)
{
    const ms_measure *listed[MS_MEASURES];
    const size_t count = list_measures(listed);
    fputs(
        "shape,checksum,generator,options,perturbation,level,seed,voxel_size,threads,n_asked,flags,status,n,stopped_by",
        stream);
    for (size_t m = 0; m < count; m++) {
        fprintf(stream, ",%s", ms_measure_column(listed[m], listed[m]->in_stability));
    }
    fputs(",n_until,seconds,beside,spheres_fnv1a,cause", stream);
}

/* From n to spheres_fnv1a; all empty if the run gave nothing. */
static void put_results(FILE *stream, const ms_stability_run *run)
{
    const int gave = ms_stability_gave(run);
    const double nothing = (double)NAN;
    const ms_measure *listed[MS_MEASURES];
    const size_t count = list_measures(listed);
    fputc(',', stream);
    if (gave) {
        fprintf(stream, "%zu", run->metrics.spheres);
    }
    fprintf(stream, ",%s", gave ? ms_stop_name(run->reason) : "");
    for (size_t m = 0; m < count; m++) {
        ms_csv_put_number(stream, gave ? listed[m]->of_metrics(&run->metrics) : nothing);
    }
    ms_csv_put_number(stream, gave && run->spheres_until ? (double)run->spheres_until : nothing);
    ms_csv_put_number(stream, gave ? run->seconds : nothing);
    ms_csv_put_number(stream, gave ? run->beside : nothing);
    fputc(',', stream);
    if (gave) {
        fprintf(stream, "%016" PRIx64, run->checksum);
    }
}

static void print_row(FILE *stream, const ms_stability_run *run)
{
    ms_escape_csv_path(stream, run->shape);
    fprintf(stream, ",%016" PRIx64 ",", run->shape_checksum);
    ms_escape_csv(stream, run->method->name);
    fputc(',', stream);
    ms_escape_csv(stream, run->method->options);
    fprintf(stream, ",%s", run->change->name);
    ms_csv_put_number(stream, run->level);
    fprintf(stream, ",%" PRIu64, run->seed);
    ms_csv_put_number(stream, run->voxel_size);
    fprintf(stream, ",%d,%zu,", run->threads, run->asked);
    ms_escape_csv(stream, run->flags);
    fprintf(stream, ",%s", OUTCOMES[run->outcome]);
    put_results(stream, run);
    fputc(',', stream);
    ms_escape_csv(stream, run->cause.text);
}

char *ms_stability_line(const ms_stability_run *run)
{
    char *line = NULL;
    size_t size;
    FILE *stream = open_memstream(&line, &size);
    if (!stream) {
        return NULL;
    }
    if (run) {
        print_row(stream, run);
    } else {
        print_header(stream);
    }
    return fclose(stream) == 0 ? line : NULL;
}

/* A line and its fields, which are within it. */
typedef struct stability_fields {
    char *line, *field[MOST_COLUMNS];
    size_t count;
} stability_fields;

static void cut_line(stability_fields *f, char *line)
{
    f->line = line;
    f->count = line ? ms_csv_split(f->field, MOST_COLUMNS, line) : 0;
}

/* Whether a column says what a run is, which is known before it: of seeds that of the unchanged shape. */
static int is_key(const char *column, const ms_stability_run *run)
{
    static const char *const KEYS[] = {"shape",        "checksum", "generator", "options",
                                       "perturbation", "level",    "n_asked",   "flags"};
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) {
        if (strcmp(column, KEYS[k]) == 0) {
            return 1;
        }
    }
    return run->change == &ms_changes[0] && strcmp(column, "seed") == 0;
}

/* Zero for a word that is none of them. */
static int take_outcome(ms_outcome *outcome, const char *text)
{
    for (int o = 0; o < MS_OUTCOMES; o++) {
        if (strcmp(text, OUTCOMES[o]) == 0) {
            *outcome = (ms_outcome)o;
            return 1;
        }
    }
    return 0;
}

/* Empty where the mismatch was not reached. Zero for what is no number of spheres. */
static int take_until(size_t *spheres, const char *text)
{
    const double n = ms_csv_number(text);
    const int is_number = n >= 1 && n <= MS_CLUMP_MAX_SPHERES;
    *spheres = is_number ? (size_t)n : 0;
    return is_number || !text[0];
}

/* What the statistics and the charts are made of. Zero if the field cannot be. */
static int take_field(ms_stability_run *run, const char *column, const char *text)
{
    if (strcmp(column, "status") == 0) {
        return take_outcome(&run->outcome, text);
    }
    if (strcmp(column, "n_until") == 0) {
        return take_until(&run->spheres_until, text);
    }
    if (strcmp(column, "voxel_size") == 0) {
        run->voxel_size = ms_csv_number(text);
    } else if (strcmp(column, ms_measure_column(&ms_measures[MS_MEASURE_DICE],
                                                ms_measures[MS_MEASURE_DICE].in_stability)) == 0) {
        run->metrics.score.dice = ms_csv_number(text);
    } else if (strcmp(column, ms_measure_column(&ms_measures[MS_MEASURE_INERTIA],
                                                ms_measures[MS_MEASURE_INERTIA].in_stability)) == 0) {
        run->metrics.inertia.weighted = ms_csv_number(text);
    } else if (strcmp(column, "spheres_fnv1a") == 0) {
        run->checksum = strtoull(text, NULL, 16);
    } else if (strcmp(column, "cause") == 0) {
        snprintf(run->cause.text, sizeof run->cause.text, "%s", text);
    }
    return 1;
}

ms_status ms_stability_read_row(ms_stability_run *run, const char *row, ms_error *err)
{
    stability_fields header, own, there;
    cut_line(&header, ms_stability_line(NULL));
    cut_line(&own, ms_stability_line(run));
    cut_line(&there, strdup(row));
    ms_status status = header.line && own.line && there.line ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "has no memory");
    for (size_t c = 0; c < header.count && status == MS_OK; c++) {
        if (there.count != header.count ||
            (is_key(header.field[c], run) && strcmp(own.field[c], there.field[c]) != 0)) {
            status = ms_fail(err, MS_ERR_ARG,
                             "is of another run: %s should be '%.200s'; --resume takes shapes, methods, numbers and "
                             "flags as they were",
                             header.field[c], own.field[c]);
        } else if (!take_field(run, header.field[c], there.field[c])) {
            status = ms_fail(err, MS_ERR_FORMAT,
                             "is damaged: %s cannot be '%.60s'; take the lines from there on out, and --resume makes "
                             "them anew",
                             header.field[c], there.field[c]);
        }
    }
    free(header.line);
    free(own.line);
    free(there.line);
    return status;
}
