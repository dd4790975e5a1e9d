#include "ms_population_distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"

/* A value, and what it adds to the distribution of the sample less that of the population. */
typedef struct step {
    double value, share;
} step;

static int compare_steps(const void *a, const void *b)
{
    const double x = ((const step *)a)->value, y = ((const step *)b)->value;
    return (x > y) - (x < y);
}

static double largest_difference(step *steps, size_t count)
{
    double difference = 0, largest = 0;
    qsort(steps, count, sizeof *steps, compare_steps);
    for (size_t i = 0; i < count; i++) {
        difference += steps[i].share;
        if (i + 1 == count || steps[i + 1].value > steps[i].value) {
            largest = fmax(largest, fabs(difference));
        }
    }
    return largest;
}

/* A population of the sample: its ranks and correlations. What has no weight is no part of it. */
static ms_status make_sample(ms_population *sample, const ms_population *p, const double *value, const double *weight,
                             size_t k, ms_error *err)
{
    const size_t m = p->n_descriptors;
    double *kept = malloc((k * (m + 1) + 1) * sizeof *kept), *share = kept ? kept + k * m : NULL;
    size_t count = 0;
    if (!kept) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a sample of %zu grains", k);
    }
    for (size_t i = 0; i < k; i++) {
        if (weight[i] > 0) {
            memcpy(kept + count * m, value + i * m, m * sizeof *value);
            share[count++] = weight[i];
        }
    }
    const ms_status status = ms_population_make(sample, kept, share, count, m, err);
    free(kept);
    return status;
}

static ms_status measure(ms_population_distance *out, const ms_population *p, const ms_population *sample,
                         ms_error *err)
{
    const size_t m = p->n_descriptors, count = p->n + sample->n;
    step *steps = malloc(count * sizeof *steps);
    if (!steps) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for two distributions of %zu grains", count);
    }
    *out = (ms_population_distance){.largest = 0};
    for (size_t d = 0; d < m; d++) {
        for (size_t i = 0; i < p->n; i++) {
            steps[i] = (step){p->value[i * m + d], -p->share[i]};
        }
        for (size_t i = 0; i < sample->n; i++) {
            steps[p->n + i] = (step){sample->value[i * m + d], sample->share[i]};
        }
        out->ks[d] = largest_difference(steps, count);
        out->largest = fmax(out->largest, out->ks[d]);
    }
    for (size_t pair = 0; pair < p->n_pairs; pair++) {
        out->correlation = fmax(out->correlation, fabs(sample->correlation[pair] - p->correlation[pair]));
    }
    free(steps);
    return MS_OK;
}

ms_status ms_population_distance_of(ms_population_distance *out, const ms_population *p, const double *value,
                                    const double *weight, size_t k, ms_error *err)
{
    ms_population sample;
    ms_status status = make_sample(&sample, p, value, weight, k, err);
    if (status == MS_OK) {
        status = measure(out, p, &sample, err);
        ms_population_free(&sample);
    }
    return status;
}

/* 1 over the standard deviation of each descriptor; 0 for one of equal values. */
static void find_scales(double *scale, const ms_population *p)
{
    const size_t m = p->n_descriptors;
    for (size_t d = 0; d < m; d++) {
        double mean = 0, square = 0;
        for (size_t i = 0; i < p->n; i++) {
            mean += p->share[i] * p->value[i * m + d];
        }
        for (size_t i = 0; i < p->n; i++) {
            square += p->share[i] * pow(p->value[i * m + d] - mean, 2);
        }
        scale[d] = square > 0 ? 1 / sqrt(square) : 0;
    }
}

static double away(const double *a, const double *b, const double *scale, size_t m)
{
    double square = 0;
    for (size_t d = 0; d < m; d++) {
        const double x = (a[d] - b[d]) * scale[d];
        square += x * x;
    }
    return sqrt(square);
}

/* E|A - B|. @param row room for a->n values: sums are added in the order of the grains, whatever the threads */
static double mean_distance(const ms_population *a, const ms_population *b, const double *scale, double *row)
{
    const size_t m = a->n_descriptors;
    double sum = 0;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < a->n; i++) {
        double of_row = 0;
        for (size_t j = 0; j < b->n; j++) {
            of_row += b->share[j] * away(a->value + i * m, b->value + j * m, scale, m);
        }
        row[i] = a->share[i] * of_row;
    }
    for (size_t i = 0; i < a->n; i++) {
        sum += row[i];
    }
    return sum;
}

ms_status ms_population_energy(double *out, const ms_population *p, const double *value, const double *weight, size_t k,
                               ms_error *err)
{
    double scale[MS_POPULATION_DESCRIPTORS];
    ms_population sample;
    const ms_status status = make_sample(&sample, p, value, weight, k, err);
    if (status != MS_OK) {
        return status;
    }
    double *row = malloc((p->n + sample.n) * sizeof *row);
    if (row) {
        find_scales(scale, p);
        *out = fmax(0, 2 * mean_distance(p, &sample, scale, row) - mean_distance(p, p, scale, row) -
                           mean_distance(&sample, &sample, scale, row));
    }
    ms_population_free(&sample);
    free(row);
    return row ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the distances of %zu grains", p->n);
}

/* Draws as many grains as there are, each as likely as its share; how often each came is its weight. */
static void draw_weights(double *weight, const ms_population *p, const double *cumulative, gsl_rng *random)
{
    memset(weight, 0, p->n * sizeof *weight);
    for (size_t i = 0; i < p->n; i++) {
        const double at = gsl_rng_uniform(random) * cumulative[p->n - 1];
        size_t low = 0, high = p->n - 1;
        while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if (cumulative[middle] > at) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        weight[low] += 1;
    }
}

ms_status ms_population_noise(ms_population_distance *out, const ms_population *p, size_t samples, unsigned long seed,
                              ms_error *err)
{
    gsl_rng *random = ms_random_new(seed);
    double *weight = malloc(2 * p->n * sizeof *weight), *cumulative = weight ? weight + p->n : NULL;
    ms_status status = random && weight ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to draw %zu grains", p->n);
    *out = (ms_population_distance){.largest = 0};
    for (size_t i = 0; i < p->n && status == MS_OK; i++) {
        cumulative[i] = p->share[i] + (i ? cumulative[i - 1] : 0);
    }
    for (size_t s = 0; s < samples && status == MS_OK; s++) {
        ms_population_distance one;
        draw_weights(weight, p, cumulative, random);
        status = ms_population_distance_of(&one, p, p->value, weight, p->n, err);
        for (size_t d = 0; d < p->n_descriptors && status == MS_OK; d++) {
            out->ks[d] += one.ks[d] / (double)samples;
        }
        if (status == MS_OK) {
            out->largest += one.largest / (double)samples;
            out->correlation += one.correlation / (double)samples;
        }
    }
    free(weight);
    ms_random_free(random);
    return status;
}
