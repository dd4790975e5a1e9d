#include "ms_stability.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_text.h"
#include "chart/ms_csv.h"
#include "ms_perturb.h"

#define CHANGE_NAME(code, name, level) name,
static const char *const CHANGES[] = {MS_CHANGE_LIST(CHANGE_NAME)};
#define OUTCOME_NAME(code, name) name,
static const char *const OUTCOMES[] = {MS_OUTCOME_LIST(OUTCOME_NAME)};

/* What --until-dice allows, over the number of spheres asked for. */
enum { UNTIL_FACTOR = 10, MOST_REFINED = 2 };

const char *ms_stability_change_name(ms_change change)
{
    return CHANGES[change];
}

ms_status ms_stability_change_find(ms_change *change, const char *name, ms_error *err)
{
    char names[256] = "";
    for (int c = MS_CHANGE_NONE + 1; c < MS_CHANGES; c++) {
        if (strcmp(CHANGES[c], name) == 0) {
            *change = (ms_change)c;
            return MS_OK;
        }
        strcat(strcat(names, c == MS_CHANGE_NONE + 1 ? "" : ", "), CHANGES[c]);
    }
    return ms_fail(err, MS_ERR_ARG, "there is no perturbation '%.40s'; choose from %s", name, names);
}

int ms_stability_change_runs(ms_change change, int runs)
{
    const int most = change == MS_CHANGE_NONE     ? 1
                     : change == MS_CHANGE_AXES   ? MS_MOTION_AXIS_TURNS - 1
                     : change == MS_CHANGE_REFINE ? MOST_REFINED
                                                  : runs;
    return runs < most ? runs : most;
}

/* Step `number` of `runs` from lo to hi, in equal ratios; of a single one the middle. */
static double ladder(double lo, double hi, int number, int runs)
{
    return runs < 2 ? sqrt(lo * hi) : lo * pow(hi / lo, (double)(number - 1) / (runs - 1));
}

static double level_of(const ms_stability *s, ms_change change, int number)
{
    switch (change) {
    case MS_CHANGE_NONE:
        return 0;
    case MS_CHANGE_AXES:
        return 1 + (number - 1) * (MS_MOTION_AXIS_TURNS - 1) / ms_stability_change_runs(change, s->runs);
    case MS_CHANGE_RESOLUTION:
        return ladder(0.5, 2, number, s->runs);
    case MS_CHANGE_NOISE:
        return ladder(0.001, 0.03, number, s->runs);
    case MS_CHANGE_DECIMATE:
        return ladder(0.02, 0.2, number, s->runs);
    case MS_CHANGE_SHIFT:
    case MS_CHANGE_REFINE:
    case MS_CHANGE_THREADS:
        return number;
    default: /* seeds */
        return (double)s->seed + number;
    }
}

/* A shape as it was changed. */
typedef struct changed {
    ms_mesh mesh;
    ms_motion motion;
    ms_target target;
} changed;

/* Places that fill the cube evenly: multiples of the powers of 1 / 1.2207, the root of x^4 = x + 1. */
static void choose_shift(double shift[3], double voxel, double level)
{
    static const double step[3] = {0.81917251339616444, 0.67104360670378921, 0.54970047790197029};
    for (int a = 0; a < 3; a++) {
        shift[a] = voxel * fmod(level * step[a], 1);
    }
}

static ms_status refine(ms_mesh *mesh, int times, ms_error *err)
{
    ms_status status = MS_OK;
    for (int k = 0; k < times && status == MS_OK; k++) {
        ms_mesh finer;
        status = ms_perturb_refine(&finer, mesh, err);
        if (status == MS_OK) {
            ms_mesh_free(mesh);
            *mesh = finer;
        }
    }
    return status;
}

static ms_status decimate(ms_mesh *mesh, double cell, int closed, ms_error *err)
{
    ms_mesh coarser;
    ms_mesh_report report;
    ms_status status = ms_perturb_decimate(&coarser, &report, mesh, cell, err);
    if (status == MS_OK && closed && !report.closed) {
        ms_mesh_free(&coarser);
        return ms_fail(err, MS_ERR_SHAPE, "with its vertices joined in cells of %g the mesh is open: %zu odd edges",
                       cell, report.odd_edges);
    }
    if (status == MS_OK) {
        ms_mesh_free(mesh);
        *mesh = coarser;
    }
    return status;
}

static ms_status change_mesh(changed *c, const ms_stability_run *run, const ms_input *input, ms_error *err)
{
    const double diameter = 2 * ms_target_equivalent_radius(&input->target);
    const uint64_t seed = (uint64_t)run->level;
    c->motion = ms_perturb_motion_none();
    ms_status status = ms_perturb_copy(&c->mesh, &input->mesh, err);
    if (status != MS_OK) {
        return status;
    }
    switch (run->change) {
    case MS_CHANGE_AXES:
        c->motion = ms_perturb_motion_axis_turn((int)run->level);
        break;
    case MS_CHANGE_ROTATION:
        status = ms_perturb_motion_random_turn(&c->motion, seed, err);
        break;
    case MS_CHANGE_SHIFT:
        choose_shift(c->motion.shift, run->voxel_size, run->level);
        break;
    case MS_CHANGE_NOISE:
        status = ms_perturb_noise(&c->mesh, run->level * diameter, run->seed + (uint64_t)run->number, err);
        break;
    case MS_CHANGE_REFINE:
        status = refine(&c->mesh, (int)run->level, err);
        break;
    case MS_CHANGE_DECIMATE:
        status = decimate(&c->mesh, run->level * diameter, input->report.closed, err);
        break;
    case MS_CHANGE_ORDER:
        status = ms_perturb_order(&c->mesh, seed, err);
        break;
    default: /* the mesh stays */
        break;
    }
    ms_perturb_motion_apply(&c->mesh, &c->motion);
    return status;
}

static ms_status make_changed(changed *c, const ms_stability_run *run, const ms_stability *s, ms_error *err)
{
    double n[3];
    ms_status status = change_mesh(c, run, s->input, err);
    if (status == MS_OK) {
        ms_voxelize_extents(n, &c->mesh, run->voxel_size);
        if (ms_target_bytes(n) > s->flags->max_memory) {
            status = ms_fail(err, MS_ERR_LIMIT, "a grid of %.6gx%.6gx%.6g voxels takes more than the memory allowed",
                             n[0], n[1], n[2]);
        }
    }
    return status == MS_OK ? ms_target_from_mesh(&c->target, &c->mesh, s->input->report.closed, run->voxel_size,
                                                 s->flags->rule, err)
                           : status;
}

static void free_changed(changed *c)
{
    ms_target_free(&c->target);
    ms_mesh_free(&c->mesh);
}

static uint64_t sum_spheres(const ms_clump *clump)
{
    const ms_bytes bytes = {(uint8_t *)clump->sphere, clump->n_spheres * sizeof *clump->sphere};
    return ms_file_checksum(&bytes);
}

/* The number of spheres at fixed D, by the method's own stop rule on the shape as it was changed. */
static ms_status seek_number(ms_stability_run *run, ms_run job, const ms_stability *s, ms_error *err)
{
    ms_clump clump;
    ms_stop_reason reason;
    job.stop = ms_stop_none();
    job.stop.spheres =
        s->spheres < MS_CLUMP_MAX_SPHERES / UNTIL_FACTOR ? s->spheres * UNTIL_FACTOR : MS_CLUMP_MAX_SPHERES;
    job.stop.dice = s->until_dice;
    ms_status status = ms_generator_run(&clump, &reason, s->method->generator, &job, err);
    run->spheres_until = status == MS_OK && reason == MS_STOP_DICE ? clump.n_spheres : 0;
    ms_clump_free(&clump);
    return status;
}

static ms_status run_method(ms_stability_run *run, const changed *c, const ms_stability *s, ms_error *err)
{
    ms_clump clump;
    ms_run job = {.target = &c->target, .stop = ms_stop_none(), .settings = &s->method->settings, .seed = run->seed};
    job.stop.spheres = s->spheres;
    const double start = omp_get_wtime();
    ms_status status = ms_generator_run(&clump, &run->reason, s->method->generator, &job, err);
    run->seconds = omp_get_wtime() - start;
    if (status == MS_OK) {
        ms_perturb_motion_undo(&clump, &c->motion);
        run->checksum = sum_spheres(&clump);
        status = ms_metrics_compute(&run->metrics, NULL, &s->input->target, &clump, ms_input_max_voxels(s->flags), err);
    }
    if (status == MS_OK && s->until_dice >= 0) {
        status = seek_number(run, job, s, err);
    }
    ms_clump_free(&clump);
    return status;
}

void ms_stability_try(ms_stability_run *run, const ms_stability *s, ms_change change, int number)
{
    changed c = {0};
    memset(run, 0, sizeof *run);
    run->shape = s->input->path;
    run->method = s->method;
    run->shape_checksum = s->input->checksum;
    run->change = change;
    run->number = number;
    run->level = level_of(s, change, number);
    run->seed = change == MS_CHANGE_SEED ? (uint64_t)run->level : s->seed;
    run->voxel_size = s->input->target.grid.h / (change == MS_CHANGE_RESOLUTION ? run->level : 1);
    run->threads = change == MS_CHANGE_THREADS ? (int)run->level : s->threads;
    run->asked = s->spheres;
    run->until_dice = s->until_dice;
    omp_set_num_threads(run->threads);
    if (make_changed(&c, run, s, &run->cause) != MS_OK) {
        run->outcome = MS_OUTCOME_UNUSABLE;
    } else if (run_method(run, &c, s, &run->cause) != MS_OK) {
        run->outcome = MS_OUTCOME_FAILED;
    } else {
        run->outcome = run->metrics.spheres < s->spheres ? MS_OUTCOME_SHORT : MS_OUTCOME_OK;
        run->cause.text[0] = 0;
    }
    omp_set_num_threads(s->threads);
    free_changed(&c);
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
    while (run > runs && run->change != MS_CHANGE_NONE) {
        run--;
    }
    return ms_stability_gave(run) ? run : NULL;
}

void ms_stability_header(FILE *stream)
{
    fputs("shape,checksum,generator,options,perturbation,level,seed,voxel_size,threads,n_asked,status,n,stopped_by,"
          "eta,dice,coverage,overshoot,off_volume,inertia_error,smallest_radius_ratio,pieces,n_until,seconds,spheres_"
          "fnv1a,"
          "cause\n",
          stream);
}

/* Empty where there is none. */
static void put_number(FILE *stream, double value)
{
    fprintf(stream, ",%s", isfinite(value) ? ms_text_of_number(value).text : "");
}

static void put_results(FILE *stream, const ms_stability_run *run)
{
    const ms_metrics *m = &run->metrics;
    const double values[] = {m->score.eta,        m->score.dice,       m->score.coverage,        m->score.overshoot,
                             m->score.off_volume, m->inertia.weighted, m->smallest_radius_ratio, (double)m->pieces};
    fprintf(stream, ",%zu,%s", m->spheres, ms_stop_name(run->reason));
    for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
        put_number(stream, values[v]);
    }
    put_number(stream, run->spheres_until ? (double)run->spheres_until : (double)NAN);
    put_number(stream, run->seconds);
    fprintf(stream, ",%016" PRIx64, run->checksum);
}

void ms_stability_row(FILE *stream, const ms_stability_run *run)
{
    ms_csv_put(stream, run->shape);
    fprintf(stream, ",%016" PRIx64 ",", run->shape_checksum);
    ms_csv_put(stream, run->method->name);
    fputc(',', stream);
    ms_csv_put(stream, run->method->options);
    fprintf(stream, ",%s", CHANGES[run->change]);
    put_number(stream, run->level);
    fprintf(stream, ",%" PRIu64, run->seed);
    put_number(stream, run->voxel_size);
    fprintf(stream, ",%d,%zu,%s", run->threads, run->asked, OUTCOMES[run->outcome]);
    if (ms_stability_gave(run)) {
        put_results(stream, run);
    } else {
        fputs(",,,,,,,,,,,,,", stream);
    }
    fputc(',', stream);
    ms_csv_put(stream, run->cause.text);
    fputc('\n', stream);
}
