#include "ms_population.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A grain and its value of one descriptor. */
typedef struct entry {
    double value;
    size_t grain;
} entry;

static int compare_entries(const void *a, const void *b)
{
    const double x = ((const entry *)a)->value, y = ((const entry *)b)->value;
    return (x > y) - (x < y);
}

/* Fills up_to and below of descriptor d; equal values have equal ones. */
static void rank_grains(ms_population *p, size_t d, entry *order)
{
    const size_t m = p->n_descriptors;
    double before = 0;
    for (size_t i = 0; i < p->n; i++) {
        order[i] = (entry){p->value[i * m + d], i};
    }
    qsort(order, p->n, sizeof *order, compare_entries);
    for (size_t first = 0, end; first < p->n; first = end) {
        double of_these = 0;
        for (end = first; end < p->n && order[end].value == order[first].value; end++) {
            of_these += p->share[order[end].grain];
        }
        const double after = end == p->n ? 1 : before + of_these;
        for (size_t i = first; i < end; i++) {
            p->below[order[i].grain * m + d] = before;
            p->up_to[order[i].grain * m + d] = after;
        }
        before = after;
    }
}

/* The rank of a grain among all, from 0 to 1, less its mean. */
static double centred_rank(const ms_population *p, size_t grain, size_t d)
{
    const size_t at = grain * p->n_descriptors + d;
    return (p->below[at] + p->up_to[at] - 1) / 2;
}

/* Spearman's correlation is Pearson's of the ranks. */
static void correlate(ms_population *p)
{
    double deviation[MS_POPULATION_DESCRIPTORS];
    for (size_t d = 0; d < p->n_descriptors; d++) {
        double square = 0;
        for (size_t i = 0; i < p->n; i++) {
            square += p->share[i] * pow(centred_rank(p, i, d), 2);
        }
        deviation[d] = sqrt(square);
    }
    size_t pair = 0;
    for (size_t d = 0; d < p->n_descriptors; d++) {
        for (size_t e = 0; e < d; e++, pair++) {
            const double scale = deviation[d] * deviation[e];
            p->correlation[pair] = 0;
            for (size_t i = 0; i < p->n; i++) {
                const double product = scale > 0 ? centred_rank(p, i, d) * centred_rank(p, i, e) / scale : 0;
                p->product[i * p->n_pairs + pair] = product;
                p->correlation[pair] += p->share[i] * product;
            }
        }
    }
}

static void fill_shares(ms_population *p, const double *share)
{
    double sum = 0;
    for (size_t i = 0; i < p->n; i++) {
        sum += share ? share[i] : 1;
    }
    for (size_t i = 0; i < p->n; i++) {
        p->share[i] = (share ? share[i] : 1) / sum;
    }
}

ms_status ms_population_make(ms_population *p, const double *value, const double *share, size_t n, size_t n_descriptors,
                             ms_error *err)
{
    const size_t m = n_descriptors, pairs = m * (m - 1) / 2;
    *p = (ms_population){.n = n, .n_descriptors = m, .n_pairs = pairs};
    p->share = malloc(n * sizeof *p->share);
    p->value = malloc(n * m * sizeof *p->value);
    p->up_to = malloc(n * m * sizeof *p->up_to);
    p->below = malloc(n * m * sizeof *p->below);
    p->product = malloc((n * pairs + 1) * sizeof *p->product);
    p->correlation = malloc((pairs + 1) * sizeof *p->correlation);
    entry *order = malloc(n * sizeof *order);
    if (!p->share || !p->value || !p->up_to || !p->below || !p->product || !p->correlation || !order) {
        ms_population_free(p);
        free(order);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the descriptors of %zu grains", n);
    }
    fill_shares(p, share);
    memcpy(p->value, value, n * m * sizeof *value);
    for (size_t d = 0; d < m; d++) {
        rank_grains(p, d, order);
    }
    correlate(p);
    free(order);
    return MS_OK;
}

void ms_population_free(ms_population *p)
{
    free(p->share);
    free(p->value);
    free(p->up_to);
    free(p->below);
    free(p->product);
    free(p->correlation);
    *p = (ms_population){0};
}
