#include "ms_population_split.h"

#include <gsl/gsl_randist.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "ms_population_choose.h"
#include "ms_population_distance.h"

/* Grains of p as a population of their own. */
static ms_status take_grains(ms_population *part, const ms_population *p, const size_t *grain, size_t count,
                             ms_error *err)
{
    const size_t m = p->n_descriptors;
    double *value = malloc(count * (m + 1) * sizeof *value), *share = value ? value + count * m : NULL;
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for half of %zu grains", p->n);
    }
    for (size_t i = 0; i < count; i++) {
        memcpy(value + i * m, p->value + grain[i] * m, m * sizeof *value);
        share[i] = p->share[grain[i]];
    }
    const ms_status status = ms_population_make(part, value, share, count, m, err);
    free(value);
    return status;
}

static ms_status measure_choice(double *largest, const ms_population *other, const ms_population *own,
                                const ms_population_choice *choice, ms_error *err)
{
    const size_t m = own->n_descriptors;
    ms_population_distance distance = {.largest = 0};
    double *value = malloc(choice->k * m * sizeof *value);
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu grains", choice->k);
    }
    for (size_t j = 0; j < choice->k; j++) {
        memcpy(value + j * m, own->value + choice->grain[j] * m, m * sizeof *value);
    }
    const ms_status status = ms_population_distance_of(&distance, other, value, choice->weight, choice->k, err);
    *largest = distance.largest;
    free(value);
    return status;
}

/* From the first half of `grain` to the second. */
static ms_status judge_halves(ms_population_split *out, const ms_population *p, const size_t *grain, size_t k,
                              double share, uint64_t seed, ms_error *err)
{
    const size_t first = p->n / 2;
    ms_population own = {0}, other = {0};
    ms_population_choice choice = {0};
    ms_population_distance halves = {.largest = 0};
    ms_status status = take_grains(&own, p, grain, first, err);
    if (status == MS_OK) {
        status = take_grains(&other, p, grain + first, p->n - first, err);
    }
    if (status == MS_OK) {
        status = ms_population_distance_of(&halves, &other, own.value, own.share, own.n, err);
    }
    if (status == MS_OK) {
        status = ms_population_choose(&choice, &own, k, share, seed, err);
    }
    if (status == MS_OK) {
        status = measure_choice(&out->choice, &other, &own, &choice, err);
    }
    out->halves = halves.largest;
    ms_population_choice_free(&choice);
    ms_population_free(&own);
    ms_population_free(&other);
    return status;
}

ms_status ms_population_split_of(ms_population_split *out, const ms_population *p, size_t k, size_t splits,
                                 double share, uint64_t seed, ms_error *err)
{
    gsl_rng *random = ms_random_new((unsigned long)seed);
    size_t *grain = malloc(p->n * sizeof *grain);
    ms_status status = random && grain ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to split %zu grains", p->n);
    *out = (ms_population_split){0};
    for (size_t i = 0; i < p->n && grain; i++) {
        grain[i] = i;
    }
    for (size_t s = 0; s < splits && status == MS_OK; s++) {
        ms_population_split one;
        gsl_ran_shuffle(random, grain, p->n, sizeof *grain);
        status = judge_halves(&one, p, grain, k, share, seed + s, err);
        if (status == MS_OK) {
            out->choice += one.choice / (double)splits;
            out->halves += one.halves / (double)splits;
        }
    }
    free(grain);
    ms_random_free(random);
    return status;
}
