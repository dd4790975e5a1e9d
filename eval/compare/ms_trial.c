#include "ms_trial.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "cli/ms_progress.h"
#include "clump/ms_density.h"
#include "measure/ms_metrics.h"

/* Gives back what earlier runs have freed and lets Linux count the largest memory anew; elsewhere it is that of the
 * program so far. */
static void forget_peak(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    FILE *stream = fopen("/proc/self/clear_refs", "w");
    if (stream) {
        fputc('5', stream);
        fclose(stream);
    }
}

static double peak_memory(void)
{
    char line[256];
    double peak = (double)NAN;
    struct rusage usage;
    FILE *stream = fopen("/proc/self/status", "r");
    while (stream && isnan(peak) && fgets(line, sizeof line, stream)) {
        if (strncmp(line, "VmHWM:", 6) == 0) {
            peak = strtod(line + 6, NULL);
        }
    }
    if (stream) {
        fclose(stream);
    }
    getrusage(RUSAGE_SELF, &usage);
    return isnan(peak) ? (double)usage.ru_maxrss : peak;
}

/* Notes when each number of spheres was there, and passes on how far the run is. */
typedef struct trial_watch {
    const ms_trial_run *run;
    double start;
    size_t next;
    double *seconds;
    ms_progress pass; /* NULL: the queue has the line */
    void *context;
} trial_watch;

static int note_progress(void *context, size_t spheres, double dice)
{
    trial_watch *w = context;
    const double now = omp_get_wtime();
    while (w->next < w->run->n_asked && spheres >= w->run->asked[w->next]) {
        w->seconds[w->next++] = now - w->start;
    }
    return w->pass ? w->pass(w->context, spheres, dice) : 0;
}

/* One run; a clump from before is replaced. */
static ms_status run_once(ms_trial *trial, double *seconds, const ms_trial_run *run, const ms_target *target,
                          ms_error *err)
{
    trial_watch w = {.run = run, .seconds = seconds};
    ms_run one = {.target = target, .settings = run->settings, .seed = run->seed};
    one.stop = (ms_stop){.spheres = run->asked[run->n_asked - 1], .radius = run->min_radius};
    ms_clump_free(&trial->clump);
    trial->remarks.text[0] = '\0';
    ms_generator_keep_remarks(&one, &trial->remarks);
    if (!run->beside) {
        const ms_progress_line line = {.name = run->title, .goal = run->generator->nested ? one.stop.spheres : 0};
        ms_progress_show(&one);
        ms_progress_open(&line);
    }
    w.pass = one.progress;
    w.context = one.progress_context;
    one.progress = note_progress;
    one.progress_context = &w;
    w.start = omp_get_wtime();
    const ms_status status = ms_generator_run(&trial->clump, &trial->reason, run->generator, &one, err);
    const double whole = omp_get_wtime() - w.start;
    if (!run->beside) {
        ms_progress_close();
    }
    for (size_t k = 0; k < run->n_asked; k++) {
        if (k >= w.next || run->asked[k] >= trial->clump.n_spheres) {
            seconds[k] = whole;
        }
    }
    return status;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Median of n values, which are sorted. */
static double median(double *value, size_t n)
{
    qsort(value, n, sizeof *value, ascending);
    return (value[(n - 1) / 2] + value[n / 2]) / 2;
}

ms_status ms_trial_make(ms_trial *trial, const ms_trial_run *run, const ms_target *target, ms_error *err)
{
    const size_t n = run->n_asked, repeats = (size_t)run->repeats;
    memset(trial, 0, sizeof *trial);
    double *seconds = malloc(repeats * n * sizeof *seconds), *one = malloc(repeats * sizeof *one);
    trial->seconds = malloc(3 * n * sizeof *trial->seconds);
    ms_status status = seconds && one && trial->seconds
                           ? MS_OK
                           : ms_fail(err, MS_ERR_NOMEM, "no memory for the times of %zu runs", repeats);
    if (status == MS_OK) {
        trial->fastest = trial->seconds + n;
        trial->slowest = trial->fastest + n;
    }
    if (!run->beside) {
        forget_peak();
    }
    for (size_t r = 0; r < repeats && status == MS_OK; r++) {
        status = run_once(trial, seconds + r * n, run, target, err);
    }
    trial->memory = run->beside ? (double)NAN : peak_memory();
    for (size_t k = 0; k < n && status == MS_OK; k++) {
        for (size_t r = 0; r < repeats; r++) {
            one[r] = seconds[r * n + k];
        }
        trial->seconds[k] = median(one, repeats); /* which sorts them */
        trial->fastest[k] = one[0];
        trial->slowest[k] = one[repeats - 1];
    }
    free(seconds);
    free(one);
    if (status != MS_OK) {
        ms_trial_free(trial);
    }
    return status;
}

void ms_trial_free(ms_trial *trial)
{
    ms_clump_free(&trial->clump);
    free(trial->seconds);
    trial->seconds = trial->fastest = trial->slowest = NULL;
}

static void put_metrics(ms_compare_row *row, const ms_metrics *metrics)
{
    row->number[MS_COLUMN_SPHERES] = (double)metrics->spheres;
    for (int m = 0; m < MS_MEASURES; m++) {
        row->number[MS_COLUMN_MEASURES + m] = ms_measures[m].of_metrics(metrics);
    }
}

/* The masses do not depend on density and unit, so 1 will do. */
static ms_status put_masses(ms_compare_row *row, ms_clump *clump, const ms_target *target, ms_error *err)
{
    static const ms_density_options DEFAULTS;
    ms_particle particle;
    ms_principal principal;
    ms_density_report report;
    double difference = 0, sum = 0;
    ms_status status = ms_particle_from_body(&particle, &target->body, 1, 1, err);
    if (status == MS_OK) {
        status = ms_inertia_principal(&principal, &target->body, err);
    }
    if (status == MS_OK) {
        status = ms_density_solve(clump, &report, &particle, &DEFAULTS, err);
    }
    if (status != MS_OK) {
        return status;
    }
    for (int k = 0; k < 3; k++) {
        difference += fabs(report.error_moment[k]) * principal.moment[k];
        sum += principal.moment[k];
    }
    row->number[MS_COLUMN_CORRECTED] = difference / sum;
    row->number[MS_COLUMN_EPSILON] = report.epsilon;
    row->number[MS_COLUMN_PRODUCTS] = report.products;
    row->number[MS_COLUMN_CENTRE] = report.centre;
    return MS_OK;
}

ms_status ms_trial_judge(ms_compare_row *row, const ms_clump *clump, size_t n, const ms_target *target,
                         size_t max_voxels, ms_error *err)
{
    ms_clump prefix = {.n_spheres = n, .capacity = n, .sphere = clump->sphere}; /* its masses are its own */
    ms_metrics metrics;
    const double start = omp_get_wtime();
    ms_status status = ms_metrics_compute(&metrics, NULL, target, &prefix, max_voxels, err);
    const double scored = omp_get_wtime();
    if (status != MS_OK) {
        return status;
    }
    put_metrics(row, &metrics);
    row->number[MS_COLUMN_SCORE] = scored - start;
    status = put_masses(row, &prefix, target, err);
    row->number[MS_COLUMN_CORRECT] = omp_get_wtime() - scored;
    free(prefix.mass);
    return status;
}
