#include "ms_statistics.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_json_object.h"
#include "cli/ms_report.h"

/* Leaves out what is not finite; sorts `values`. */
static ms_statistics summarise_values(double *values, size_t count)
{
    size_t n = 0;
    for (size_t v = 0; v < count; v++) {
        if (isfinite(values[v])) {
            values[n++] = values[v];
        }
    }
    if (n == 0) {
        return (ms_statistics){0, (double)NAN, (double)NAN, (double)NAN, (double)NAN};
    }
    gsl_sort(values, 1, n);
    return (ms_statistics){n, values[0], gsl_stats_median_from_sorted_data(values, 1, n), values[n - 1],
                           n > 1 ? gsl_stats_sd(values, 1, n) : 0};
}

static int is_of_group(const ms_statistics_group *group, const ms_stability_run *run)
{
    return run->change == group->change && run->method == group->method &&
           (!group->shape || strcmp(run->shape, group->shape) == 0);
}

static void count_outcome(ms_statistics_group *g, const ms_stability_run *run)
{
    const int was_failed = g->failed > 0;
    g->unusable += run->outcome == MS_OUTCOME_UNUSABLE;
    g->failed += run->outcome == MS_OUTCOME_FAILED;
    g->shorter += run->outcome == MS_OUTCOME_SHORT;
    g->runs += run->outcome != MS_OUTCOME_UNUSABLE;
    if (run->cause.text[0] && ms_stability_gave(run)) {
        g->remarked++;
        g->remark = g->remark ? g->remark : &run->cause;
    } else if (run->cause.text[0] && (!g->cause || (!was_failed && g->failed))) {
        g->cause = &run->cause;
    }
}

/* D of a run in a group: that of all shapes sets it over D of the unchanged shape. */
static double weigh_dice(ms_statistics_group *g, double *largest, const ms_stability_run *run,
                         const ms_stability_run *unchanged)
{
    const double dice = run->metrics.score.dice;
    if (g->shape) {
        return dice;
    }
    const double ratio = unchanged ? dice / unchanged->metrics.score.dice : (double)NAN;
    if (ratio > *largest) {
        *largest = ratio;
        g->worst = run->shape;
    }
    return ratio;
}

/* `room` has three numbers for each run. */
static void measure_group(ms_statistics_group *g, const ms_stability_run *runs, size_t n_runs, double *room)
{
    double *dice = room, *inertia = room + n_runs, *until = room + 2 * n_runs, largest = 1;
    size_t n = 0;
    for (size_t r = 0; r < n_runs; r++) {
        const ms_stability_run *run = &runs[r];
        if (!is_of_group(g, run)) {
            continue;
        }
        count_outcome(g, run);
        if (ms_stability_gave(run)) {
            const ms_stability_run *unchanged = ms_stability_unchanged(runs, run);
            g->identical += unchanged && run->checksum == unchanged->checksum;
            g->not_reached += run->until_dice > 0 && !run->spheres_until;
            dice[n] = weigh_dice(g, &largest, run, unchanged);
            inertia[n] = run->metrics.inertia.weighted;
            until[n++] = run->spheres_until ? (double)run->spheres_until : (double)NAN;
        }
    }
    g->dice = summarise_values(dice, n);
    g->inertia = summarise_values(inertia, n);
    g->until = summarise_values(until, n);
}

/* The groups that the runs fall into, not yet measured. @return how many */
static size_t list_groups(ms_statistics_group *groups, const ms_stability_run *runs, size_t n_runs, int all_shapes)
{
    size_t count = 0;
    for (size_t r = 0; r < n_runs; r++) {
        const ms_statistics_group next = {
            .shape = all_shapes ? NULL : runs[r].shape, .method = runs[r].method, .change = runs[r].change};
        int known = 0;
        for (size_t g = count; g-- > 0 && !known;) {
            known = is_of_group(&groups[g], &runs[r]);
        }
        if (!known) {
            groups[count++] = next;
        }
    }
    return count;
}

ms_status ms_statistics_group_runs(ms_statistics_group **groups, size_t *count, const ms_stability_run *runs,
                                   size_t n_runs, ms_error *err)
{
    double *room = malloc((3 * n_runs + 1) * sizeof *room);
    *groups = malloc((2 * n_runs + 1) * sizeof **groups);
    *count = 0;
    if (!room || !*groups) {
        free(room);
        free(*groups);
        *groups = NULL;
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the summary of %zu runs", n_runs);
    }
    *count = list_groups(*groups, runs, n_runs, 0);
    if (n_runs && strcmp(runs[0].shape, runs[n_runs - 1].shape) != 0) {
        *count += list_groups(*groups + *count, runs, n_runs, 1);
    }
    for (size_t g = 0; g < *count; g++) {
        measure_group(&(*groups)[g], runs, n_runs, room);
    }
    free(room);
    return MS_OK;
}

static void print_number(FILE *stream, int width, int digits, double value)
{
    if (isfinite(value)) {
        fprintf(stream, " %*.*f", width, digits, value);
    } else {
        fprintf(stream, " %*s", width, "-");
    }
}

static void print_head(FILE *stream, const ms_statistics_group *g, int until)
{
    fprintf(stream, "%s\n  %-22s %-10s %4s %5s %6s %5s %8s %31s %17s%s\n", g->shape ? g->shape : "all shapes", "method",
            "changed", "runs", "same", "failed", "short", "unusable",
            g->shape ? "D least  median    most st.dev." : "D/D none least .. most   st.dev.", "inertia error %",
            until ? "    n at fixed D" : "");
}

static void print_group(FILE *stream, const ms_statistics_group *g, int until)
{
    const ms_statistics *d = &g->dice;
    fprintf(stream, "  %-22s %-10s %4zu %5zu %6zu %5zu %8zu", ms_stability_label(g->method).text, g->change->name,
            g->runs, g->identical, g->failed, g->shorter, g->unusable);
    print_number(stream, 7, 4, d->least);
    print_number(stream, 7, 4, d->median);
    print_number(stream, 7, 4, d->most);
    print_number(stream, 8, 5, d->deviation);
    print_number(stream, 8, 2, 100 * g->inertia.median);
    print_number(stream, 8, 2, 100 * g->inertia.most);
    if (until) {
        print_number(stream, 6, 0, g->until.least);
        print_number(stream, 5, 0, g->until.median);
        print_number(stream, 5, 0, g->until.most);
        if (g->not_reached) {
            fprintf(stream, ", not reached %zu times", g->not_reached);
        }
    }
    fprintf(stream, "%s%s\n", g->worst ? "  worst: " : "", g->worst ? g->worst : "");
}

static int same_table(const ms_statistics_group *a, const ms_statistics_group *b)
{
    return a->shape == b->shape || (a->shape && b->shape && strcmp(a->shape, b->shape) == 0);
}

void ms_statistics_print(FILE *stream, const ms_statistics_group *groups, size_t count, int until)
{
    for (size_t g = 0; g < count; g++) {
        if (g == 0 || !same_table(&groups[g], &groups[g - 1])) {
            print_head(stream, &groups[g], until);
        }
        print_group(stream, &groups[g], until);
    }
    for (size_t g = 0; g < count; g++) {
        const ms_statistics_group *at = &groups[g];
        if (at->shape && at->cause) {
            fprintf(stream, "%s, %s, %s: %zu failed, %zu unusable: %s\n", at->shape,
                    ms_stability_label(at->method).text, at->change->name, at->failed, at->unusable, at->cause->text);
        }
        if (at->shape && at->remark) {
            fprintf(stream, "%s, %s, %s: %zu with a remark: %s\n", at->shape, ms_stability_label(at->method).text,
                    at->change->name, at->remarked, at->remark->text);
        }
    }
}

static json_t *statistics_json(const ms_statistics *s)
{
    json_t *json = json_object();
    int failed = json_object_set_new(json, "count", json_integer((json_int_t)s->count));
    failed |= json_object_set_new(json, "min", ms_report_number(s->least));
    failed |= json_object_set_new(json, "median", ms_report_number(s->median));
    failed |= json_object_set_new(json, "max", ms_report_number(s->most));
    failed |= json_object_set_new(json, "deviation", ms_report_number(s->deviation));
    return ms_report_whole(json, failed);
}

static json_t *group_json(const ms_statistics_group *g)
{
    const struct {
        const char *key;
        size_t value;
    } counts[] = {{"runs", g->runs},        {"identical", g->identical}, {"failed", g->failed},
                  {"short", g->shorter},    {"unusable", g->unusable},   {"not_reached", g->not_reached},
                  {"remarked", g->remarked}};
    json_t *json = json_object();
    int failed = json_object_set_new(json, "shape", g->shape ? ms_report_text(g->shape) : json_null());
    failed |= json_object_set_new(json, "method", ms_report_text(ms_stability_label(g->method).text));
    failed |= json_object_set_new(json, "perturbation", json_string(g->change->name));
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        failed |= json_object_set_new(json, counts[c].key, json_integer((json_int_t)counts[c].value));
    }
    failed |= json_object_set_new(json, g->shape ? "dice" : "dice_ratio", statistics_json(&g->dice));
    failed |= json_object_set_new(json, "inertia_error_spread", statistics_json(&g->inertia));
    failed |= json_object_set_new(json, "n_until", statistics_json(&g->until));
    failed |= json_object_set_new(json, "worst", g->worst ? ms_report_text(g->worst) : json_null());
    failed |= json_object_set_new(json, "cause", g->cause ? ms_report_text(g->cause->text) : json_null());
    failed |= json_object_set_new(json, "remark", g->remark ? ms_report_text(g->remark->text) : json_null());
    return ms_report_whole(json, failed);
}

json_t *ms_statistics_json(const ms_statistics_group *groups, size_t count)
{
    json_t *json = json_array();
    for (size_t g = 0; g < count; g++) {
        ms_json_object_append(&json, group_json(&groups[g]));
    }
    return json;
}
