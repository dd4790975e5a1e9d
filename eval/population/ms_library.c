#include "ms_library.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 200, SPLITS = 10 };

/* Of the full search, for a choice from each half. */
static const double SPLIT_SHARE = 0.05;

static size_t descriptors_of(const ms_library *l)
{
    return (size_t)(MS_LIBRARY_DESCRIPTORS - l->first);
}

static double volume_of(const ms_library_grain *grain)
{
    return pow(grain->shape[MS_LIBRARY_SIZE], 3);
}

/* The population of all grains, by the descriptors of the library. */
static ms_status make_population(ms_population *p, const ms_library *l, ms_error *err)
{
    const size_t n = l->table->count, m = descriptors_of(l);
    double *value = malloc(n * (m + 1) * sizeof *value), *share = value ? value + n * m : NULL;
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the descriptors of %zu grains", n);
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t d = 0; d < m; d++) {
            value[i * m + d] = l->table->grain[i].shape[(size_t)l->first + d];
        }
        share[i] = l->goal.by_mass ? volume_of(&l->table->grain[i]) : 1;
    }
    const ms_status status = ms_population_make(p, value, share, n, m, err);
    free(value);
    return status;
}

static int compare_volumes(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Cuts the grains, by ascending size, into classes of equal mass; one that the cut goes through counts in part. */
static void fill_classes(ms_library_class *size, size_t classes, const double *volume, size_t n)
{
    double all = 0, left = volume[0], number = 0;
    size_t i = 0;
    for (size_t k = 0; k < n; k++) {
        all += volume[k];
    }
    for (size_t c = 0; c < classes; c++) {
        double room = all / (double)classes;
        number = 0;
        while (i < n && (left <= room || c + 1 == classes)) {
            number += left / volume[i];
            room -= left;
            left = ++i < n ? volume[i] : 0;
        }
        if (i < n) {
            number += room / volume[i];
            left -= room;
        }
        size[c] = (ms_library_class){.diameter = cbrt(all / (double)classes / number), .number = number / (double)n};
    }
}

static ms_status make_classes(ms_library *l, ms_error *err)
{
    const size_t n = l->table->count, classes = l->goal.classes;
    if (classes > n) {
        return ms_fail(err, MS_ERR_ARG, "%zu grains make no %zu classes of size; ask for --classes %zu or fewer", n,
                       classes, n);
    }
    double *volume = malloc(n * sizeof *volume);
    l->size = calloc(classes, sizeof *l->size);
    if (!volume || !l->size) {
        free(volume);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu classes of size", classes);
    }
    for (size_t i = 0; i < n; i++) {
        volume[i] = volume_of(&l->table->grain[i]);
    }
    qsort(volume, n, sizeof *volume, compare_volumes);
    fill_classes(l->size, classes, volume, n);
    free(volume);
    return MS_OK;
}

double ms_library_number(const ms_library *l, size_t chosen)
{
    double sum = 0, own = 0;
    for (size_t j = 0; j < l->choice.k; j++) {
        /* Of one size all have one mass; with sizes of their own a share by mass is one by number over the mass. */
        const int heavy = l->goal.with_size && l->goal.by_mass;
        const double number = l->choice.weight[j] / (heavy ? volume_of(&l->table->grain[l->choice.grain[j]]) : 1);
        sum += number;
        own = j == chosen ? number : own;
    }
    return own / sum;
}

double ms_library_mass(const ms_library *l, size_t chosen)
{
    return ms_library_number(l, chosen) *
           (l->goal.with_size ? volume_of(&l->table->grain[l->choice.grain[chosen]]) : 1);
}

/* Descriptors of the chosen, of their shapes or their clumps, to those of all. */
static ms_status measure_chosen(ms_population_distance *out, double *energy, const ms_library *l,
                                const ms_population *p, int of_clumps, ms_error *err)
{
    const size_t m = descriptors_of(l), k = l->choice.k;
    double *value = malloc(k * m * sizeof *value);
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the descriptors of %zu grains", k);
    }
    for (size_t j = 0; j < k; j++) {
        const ms_library_grain *grain = &l->table->grain[l->choice.grain[j]];
        for (size_t d = 0; d < m; d++) {
            value[j * m + d] = (of_clumps ? grain->clump : grain->shape)[(size_t)l->first + d];
        }
    }
    ms_status status = ms_population_distance_of(out, p, value, l->choice.weight, k, err);
    if (status == MS_OK && energy) {
        status = ms_population_energy(energy, p, value, l->choice.weight, k, err);
    }
    free(value);
    return status;
}

/* Diameters and shares, by number or by mass, of what the library makes. The caller frees diameter, share behind it. */
static double *sizes_of_library(size_t *count, const ms_library *l, int by_mass)
{
    *count = l->size ? l->goal.classes : l->choice.k;
    double *diameter = malloc(2 * *count * sizeof *diameter);
    for (size_t c = 0; c < *count && diameter; c++) {
        diameter[c] = l->size ? l->size[c].diameter : l->table->grain[l->choice.grain[c]].shape[MS_LIBRARY_SIZE];
        diameter[*count + c] =
            (l->size ? l->size[c].number : ms_library_number(l, c)) * (by_mass ? pow(diameter[c], 3) : 1);
    }
    return diameter;
}

/* The diameter that the given share of the mass stays below. */
static double quantile_of(const ms_population *p, double share)
{
    double at = (double)INFINITY;
    for (size_t i = 0; i < p->n; i++) {
        at = p->up_to[i] >= share - 1e-12 ? fmin(at, p->value[i]) : at;
    }
    return at;
}

static ms_status make_sizes(ms_population *p, const ms_library *l, int by_mass, ms_error *err)
{
    const size_t n = l->table->count;
    double *value = malloc(2 * n * sizeof *value);
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the sizes of %zu grains", n);
    }
    for (size_t i = 0; i < n; i++) {
        value[i] = l->table->grain[i].shape[MS_LIBRARY_SIZE];
        value[n + i] = by_mass ? volume_of(&l->table->grain[i]) : 1;
    }
    const ms_status status = ms_population_make(p, value, value + n, n, 1, err);
    free(value);
    return status;
}

static ms_status measure_sizes(ms_library *l, int by_mass, ms_error *err)
{
    static const double QUANTILES[] = {0.05, 0.5, 0.95};
    ms_population all = {0}, own = {0};
    ms_population_distance distance = {.largest = 0};
    size_t count;
    double *diameter = sizes_of_library(&count, l, by_mass);
    ms_status status = diameter ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the sizes of a library");
    if (status == MS_OK) {
        status = make_sizes(&all, l, by_mass, err);
    }
    if (status == MS_OK) {
        status = ms_population_distance_of(&distance, &all, diameter, diameter + count, count, err);
    }
    if (status == MS_OK) {
        status = ms_population_make(&own, diameter, diameter + count, count, 1, err);
    }
    for (int q = 0; q < 3 && by_mass && status == MS_OK; q++) {
        l->far.of_all[q] = quantile_of(&all, QUANTILES[q]);
        l->far.of_library[q] = quantile_of(&own, QUANTILES[q]);
    }
    *(by_mass ? &l->far.sieve : &l->far.size) = distance.largest;
    ms_population_free(&all);
    ms_population_free(&own);
    free(diameter);
    return status;
}

/* A half must have k grains; where it does not, the split is not known. */
static ms_status measure_split(ms_library *l, const ms_population *p, ms_error *err)
{
    l->far.split = (ms_population_split){.choice = (double)NAN, .halves = (double)NAN};
    return p->n / 2 < l->goal.k
               ? MS_OK
               : ms_population_split_of(&l->far.split, p, l->goal.k, SPLITS, SPLIT_SHARE, l->goal.seed, err);
}

static ms_status measure_library(ms_library *l, const ms_population *p, ms_error *err)
{
    const int has_energy = p->n <= MS_LIBRARY_MOST_FOR_ENERGY;
    l->far.energy = (double)NAN;
    ms_status status = measure_chosen(&l->far.grains, has_energy ? &l->far.energy : NULL, l, p, 0, err);
    if (status == MS_OK) {
        status = measure_chosen(&l->far.clumps, NULL, l, p, 1, err);
    }
    if (status == MS_OK) {
        status = ms_population_noise(&l->far.noise, p, SAMPLES, (unsigned long)l->goal.seed, err);
    }
    if (status == MS_OK) {
        status = measure_split(l, p, err);
    }
    for (int by_mass = 0; by_mass < 2 && status == MS_OK; by_mass++) {
        status = measure_sizes(l, by_mass, err);
    }
    return status;
}

ms_status ms_library_make(ms_library *l, const ms_library_table *table, const ms_library_goal *goal, ms_error *err)
{
    ms_population p;
    *l = (ms_library){.table = table, .goal = *goal, .first = goal->with_size ? MS_LIBRARY_SIZE : MS_LIBRARY_SIZE + 1};
    ms_status status = goal->with_size ? MS_OK : make_classes(l, err);
    if (status == MS_OK) {
        status = make_population(&p, l, err);
    }
    if (status == MS_OK) {
        status = ms_population_choose(&l->choice, &p, goal->k, 1, goal->seed, err);
        if (status == MS_OK) {
            status = measure_library(l, &p, err);
        }
        ms_population_free(&p);
    }
    if (status != MS_OK) {
        ms_library_free(l);
    }
    return status;
}

void ms_library_free(ms_library *l)
{
    ms_population_choice_free(&l->choice);
    free(l->size);
    *l = (ms_library){0};
}

int ms_library_is_overfitted(const ms_library *l)
{
    return l->far.split.choice > MS_LIBRARY_OVERFITTED * l->far.split.halves;
}
