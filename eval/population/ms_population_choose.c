#include "ms_population_choose.h"

#include <glpk.h>
#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "clump/ms_linear_program.h"
#include "ms_population_weights.h"

/* Of an exchange: so many grains are tried for each of so many; so many are drawn anew where none helps. */
enum { COMING = 5, GOING = 3, DRAWN = 2 };

/* Programmes solved in a full search: at most MOST, and fewer where they are large. */
static const double MOST = 8000, MOST_WORK = 8000 * 20.0 * 20.0, LEAST = 50;

/* Exchanges that bring less are rounding. */
static const double ROUNDING = 1e-7;

/* A set of grains on the way. */
typedef struct choosing {
    const ms_population *p;
    size_t k;
    size_t *chosen, *best; /* k */
    char *is_in;           /* n */
    ms_population_weights now, trial, best_weights;
    double *gain; /* n */
    gsl_rng *random;
    double *value, best_mismatch; /* k x n_descriptors: room to judge a set */
    double solved, most;          /* programmes */
} choosing;

static int solve(choosing *s, ms_population_weights *w)
{
    s->solved++;
    return ms_population_weights_solve(w, s->p, s->chosen);
}

static void swap_weights(ms_population_weights *a, ms_population_weights *b)
{
    const ms_population_weights c = *a;
    *a = *b;
    *b = c;
}

static void replace(choosing *s, size_t place, size_t grain)
{
    s->is_in[s->chosen[place]] = 0;
    s->chosen[place] = grain;
    s->is_in[grain] = 1;
}

/* The grains outside that bring most, the best first. @return how many */
static size_t find_coming(size_t coming[COMING], choosing *s)
{
    size_t count = 0;
    for (size_t g = 0; g < s->p->n; g++) {
        if (s->is_in[g]) {
            continue;
        }
        s->gain[g] = ms_population_weights_gain(&s->now, s->p, s->chosen, g);
        size_t at = count;
        while (at > 0 && s->gain[coming[at - 1]] < s->gain[g]) {
            at--;
        }
        if (at < COMING && s->gain[g] > 0) {
            count += count < COMING;
            memmove(coming + at + 1, coming + at, (count - at - 1) * sizeof *coming);
            coming[at] = g;
        }
    }
    return count;
}

/* Places of those of least weight, the least first. @return how many */
static size_t find_going(size_t going[GOING], const choosing *s)
{
    size_t count = 0;
    for (size_t j = 0; j < s->k; j++) {
        size_t at = count;
        while (at > 0 && s->now.weight[going[at - 1]] > s->now.weight[j]) {
            at--;
        }
        if (at < GOING) {
            count += count < GOING;
            memmove(going + at + 1, going + at, (count - at - 1) * sizeof *going);
            going[at] = j;
        }
    }
    return count;
}

/* Takes the first exchange that helps. @return 0 if there is none */
static int exchange(choosing *s)
{
    size_t coming[COMING], going[GOING];
    const size_t n_coming = find_coming(coming, s), n_going = find_going(going, s);
    for (size_t t = 0; t < n_coming * n_going && s->solved < s->most; t++) {
        const size_t place = going[t / n_coming], before = s->chosen[place];
        replace(s, place, coming[t % n_coming]);
        if (solve(s, &s->trial) && s->trial.mismatch < s->now.mismatch - ROUNDING) {
            swap_weights(&s->now, &s->trial);
            return 1;
        }
        replace(s, place, before);
    }
    return 0;
}

/* Goes on from the best so far, with a few grains drawn anew. */
static void draw_anew(choosing *s)
{
    for (size_t j = 0; j < s->k; j++) {
        s->is_in[s->chosen[j]] = 0;
    }
    memcpy(s->chosen, s->best, s->k * sizeof *s->chosen);
    for (size_t j = 0; j < s->k; j++) {
        s->is_in[s->chosen[j]] = 1;
    }
    for (int drawn = 0; drawn < DRAWN; drawn++) {
        const size_t place = gsl_rng_uniform_int(s->random, s->k);
        size_t grain;
        do {
            grain = gsl_rng_uniform_int(s->random, s->p->n);
        } while (s->is_in[grain]);
        replace(s, place, grain);
    }
}

/* The first k of a random order. */
static void draw_first(choosing *s)
{
    for (size_t j = 0; j < s->k;) {
        const size_t grain = s->k == s->p->n ? j : gsl_rng_uniform_int(s->random, s->p->n);
        if (!s->is_in[grain]) {
            s->is_in[grain] = 1;
            s->chosen[j++] = grain;
        }
    }
}

double ms_population_choice_mismatch(const ms_population_distance *distance)
{
    return fmax(distance->largest, distance->correlation / 2);
}

/* Keeps a set that is better than the best. */
static ms_status judge(choosing *s, ms_error *err)
{
    const size_t m = s->p->n_descriptors;
    ms_population_distance distance;
    for (size_t j = 0; j < s->k; j++) {
        memcpy(s->value + j * m, s->p->value + s->chosen[j] * m, m * sizeof *s->value);
    }
    const ms_status status = ms_population_distance_of(&distance, s->p, s->value, s->now.weight, s->k, err);
    if (status == MS_OK && ms_population_choice_mismatch(&distance) < s->best_mismatch) {
        s->best_mismatch = ms_population_choice_mismatch(&distance);
        swap_weights(&s->best_weights, &s->now);
        memcpy(s->best, s->chosen, s->k * sizeof *s->best);
    }
    return status;
}

/* The mismatch of the best falls from round to round. */
static ms_status search_on(choosing *s, ms_error *err)
{
    ms_status status = MS_OK;
    draw_first(s);
    int found = solve(s, &s->now);
    s->best_mismatch = (double)INFINITY;
    for (;;) {
        while (exchange(s)) {
        }
        if (found || s->now.mismatch < 1) {
            status = judge(s, err);
        }
        if (status != MS_OK || s->solved >= s->most || s->k == s->p->n || s->best_mismatch < ROUNDING) {
            return status;
        }
        draw_anew(s);
        found = solve(s, &s->now);
    }
}

/* GLPK calls this where it has no memory, and would end the program if it returned. */
static void leave_search(void *back)
{
    longjmp(*(jmp_buf *)back, 1);
}

/* In a thread of its own, which GLPK keeps its memory for. */
static ms_status run_search(void *context, ms_error *err)
{
    choosing *s = context;
    jmp_buf back;
    if (setjmp(back)) {
        glp_error_hook(NULL, NULL);
        glp_free_env();
        return ms_fail(err, MS_ERR_NOMEM, "GLPK could not go on with %zu grains; most likely it has no memory", s->k);
    }
    glp_error_hook(leave_search, &back);
    const ms_status status = search_on(s, err);
    glp_error_hook(NULL, NULL);
    return status != MS_OK || s->best_mismatch <= 1
               ? status
               : ms_fail(err, MS_ERR_LIMIT, "the simplex method finds no weights for %zu grains", s->k);
}

static void end_search(choosing *s)
{
    free(s->chosen);
    free(s->best);
    free(s->is_in);
    free(s->gain);
    free(s->value);
    ms_population_weights_free(&s->now);
    ms_population_weights_free(&s->trial);
    ms_population_weights_free(&s->best_weights);
    ms_random_free(s->random);
}

static ms_status start_search(choosing *s, const ms_population *p, size_t k, double share, uint64_t seed, ms_error *err)
{
    const double work = fmin(MOST, MOST_WORK / ((double)k * (double)k));
    *s = (choosing){.p = p, .k = k, .most = fmax(LEAST, share * work)};
    s->chosen = malloc(k * sizeof *s->chosen);
    s->best = malloc(k * sizeof *s->best);
    s->is_in = calloc(p->n, 1);
    s->gain = malloc(p->n * sizeof *s->gain);
    s->value = malloc(k * p->n_descriptors * sizeof *s->value);
    s->random = ms_random_new((unsigned long)seed);
    ms_population_weights *const weights[] = {&s->now, &s->trial, &s->best_weights};
    ms_status status = s->chosen && s->best && s->is_in && s->gain && s->value && s->random
                           ? MS_OK
                           : ms_fail(err, MS_ERR_NOMEM, "no memory to choose %zu grains", k);
    for (int w = 0; w < 3 && status == MS_OK; w++) {
        status = ms_population_weights_init(weights[w], p, k, err);
    }
    return status;
}

static int compare_places(const void *a, const void *b)
{
    const size_t x = **(const size_t *const *)a, y = **(const size_t *const *)b;
    return (x > y) - (x < y);
}

/* By ascending number of the grain. */
static ms_status take_best(ms_population_choice *c, const choosing *s, ms_error *err)
{
    const size_t k = s->k;
    const size_t **place = malloc(k * sizeof *place);
    *c = (ms_population_choice){.k = k, .mismatch = s->best_mismatch};
    c->grain = malloc(k * sizeof *c->grain);
    c->weight = malloc(k * sizeof *c->weight);
    if (!place || !c->grain || !c->weight) {
        free(place);
        ms_population_choice_free(c);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu grains", k);
    }
    double sum = 0;
    for (size_t j = 0; j < k; j++) {
        place[j] = &s->best[j];
        sum += s->best_weights.weight[j];
    }
    qsort(place, k, sizeof *place, compare_places);
    for (size_t j = 0; j < k; j++) {
        c->grain[j] = *place[j];
        c->weight[j] = s->best_weights.weight[place[j] - s->best] / sum;
    }
    free(place);
    return MS_OK;
}

ms_status ms_population_choose(ms_population_choice *c, const ms_population *p, size_t k, double share, uint64_t seed,
                               ms_error *err)
{
    choosing s;
    *c = (ms_population_choice){0};
    if (k < 1 || k > p->n || k > MS_POPULATION_MAX_CHOSEN) {
        return ms_fail(err, MS_ERR_ARG, "of %zu grains 1 to %zu can be chosen, not %zu", p->n,
                       p->n < MS_POPULATION_MAX_CHOSEN ? p->n : MS_POPULATION_MAX_CHOSEN, k);
    }
    ms_status status = start_search(&s, p, k, share, seed, err);
    if (status == MS_OK) {
        status = ms_linear_program_apart(run_search, &s, err);
    }
    if (status == MS_OK) {
        status = take_best(c, &s, err);
    }
    end_search(&s);
    return status;
}

void ms_population_choice_free(ms_population_choice *c)
{
    free(c->grain);
    free(c->weight);
    *c = (ms_population_choice){0};
}
