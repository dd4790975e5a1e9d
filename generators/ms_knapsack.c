#include "ms_knapsack.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Beyond these the search is given up. */
enum { MOST_STATES = 2000000, MOST_TRIES = 50000000 };

/* Sums over the kinds so far. */
typedef struct knapsack_state {
    double value, weight;
    uint32_t from; /* the state before, by its place among all */
    uint32_t chosen;
} knapsack_state;

/* What some kinds add at the least. */
typedef struct bound {
    double value, weight, both; /* both: value + price * weight */
} bound;

typedef struct knapsack_search {
    const ms_kind *kind;
    size_t count;
    double limit, price, aim; /* aim: to be better than this */
    bound *rest;              /* of the kinds from i on */
    knapsack_state *all;      /* layer behind layer */
    size_t n_states, capacity, tries;
    size_t *begin; /* where the layer of i kinds begins */
} knapsack_search;

static ms_status begin_knapsack(knapsack_search *s, ms_error *err)
{
    s->rest = calloc(s->count + 1, sizeof *s->rest);
    s->begin = calloc(s->count + 2, sizeof *s->begin);
    if (!s->rest || !s->begin) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu kinds", s->count);
    }
    for (size_t i = s->count; i-- > 0;) {
        const ms_kind *kind = &s->kind[i];
        bound least = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
        for (size_t c = 0; c < kind->count; c++) {
            least.value = fmin(least.value, kind->value[c]);
            least.weight = fmin(least.weight, kind->weight[c]);
            least.both = fmin(least.both, kind->value[c] + s->price * kind->weight[c]);
        }
        const bound *next = &s->rest[i + 1];
        s->rest[i] = (bound){next->value + least.value, next->weight + least.weight, next->both + least.both};
    }
    return MS_OK;
}

static void free_search(knapsack_search *s)
{
    free(s->rest);
    free(s->begin);
    free(s->all);
}

static ms_status add_state(knapsack_search *s, const knapsack_state *next, ms_error *err)
{
    if (s->n_states == s->capacity) {
        const size_t capacity = 2 * s->capacity + 1024;
        knapsack_state *grown = realloc(s->all, capacity * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu choices", capacity);
        }
        s->all = grown;
        s->capacity = capacity;
    }
    s->all[s->n_states++] = *next;
    return MS_OK;
}

/* Can a choice that begins like this fit, and be better than what there is? */
static int is_promising(const knapsack_search *s, const knapsack_state *next, size_t kinds)
{
    const bound *rest = &s->rest[kinds];
    return next->weight + rest->weight <= s->limit && next->value + rest->value <= s->aim &&
           next->value + s->price * (next->weight - s->limit) + rest->both <= s->aim;
}

/* All choices of one kind more. */
static ms_status extend_states(knapsack_search *s, size_t i, ms_error *err)
{
    const ms_kind *kind = &s->kind[i];
    const size_t end = s->n_states;
    ms_status status = MS_OK;
    s->begin[i + 1] = end;
    for (size_t at = s->begin[i]; at < end && status == MS_OK; at++) {
        for (size_t c = 0; c < kind->count && status == MS_OK; c++) {
            const knapsack_state next = {s->all[at].value + kind->value[c], s->all[at].weight + kind->weight[c],
                                         (uint32_t)at, (uint32_t)c};
            if (is_promising(s, &next, i + 1)) {
                status = add_state(s, &next, err);
            }
        }
        s->tries += kind->count;
        if (s->n_states > MOST_STATES || s->tries > MOST_TRIES) {
            break;
        }
    }
    return status;
}

/* By weight, then by value; equals by their origin, so that the order is the same everywhere. */
static int compare(const void *left, const void *right)
{
    const knapsack_state *a = left, *b = right;
    if (a->weight != b->weight) {
        return a->weight < b->weight ? -1 : 1;
    }
    if (a->value != b->value) {
        return a->value < b->value ? -1 : 1;
    }
    return a->from != b->from ? (a->from < b->from ? -1 : 1) : (a->chosen > b->chosen) - (a->chosen < b->chosen);
}

/* Of the last layer, drops what another state beats in both. */
static void drop_beaten(knapsack_search *s, size_t begin)
{
    double least = HUGE_VAL;
    size_t kept = begin;
    qsort(s->all + begin, s->n_states - begin, sizeof *s->all, compare);
    for (size_t at = begin; at < s->n_states; at++) {
        if (s->all[at].value < least) {
            least = s->all[at].value;
            s->all[kept++] = s->all[at];
        }
    }
    s->n_states = kept;
}

/* The way back from the last state, which has the least value of the last layer. */
static void trace_choice(size_t *choice, const knapsack_search *s)
{
    size_t at = s->n_states - 1;
    for (size_t i = s->count; i-- > 0;) {
        choice[i] = s->all[at].chosen;
        at = s->all[at].from;
    }
}

ms_status ms_knapsack_improve(size_t *choice, int *proven, const ms_kind *kind, size_t count, double limit,
                              double price, double step, ms_error *err)
{
    knapsack_search s = {.kind = kind, .count = count, .limit = limit, .price = price, .aim = -step};
    const knapsack_state none = {0};
    for (size_t i = 0; i < count; i++) {
        s.aim += kind[i].value[choice[i]];
    }
    *proven = 0;
    ms_status status = begin_knapsack(&s, err);
    if (status == MS_OK) {
        status = add_state(&s, &none, err);
    }
    for (size_t i = 0; i < count && status == MS_OK; i++) {
        status = extend_states(&s, i, err);
        if (s.n_states > MOST_STATES || s.tries > MOST_TRIES) {
            break;
        }
        drop_beaten(&s, s.begin[i + 1]);
        *proven = i + 1 == count;
    }
    if (status == MS_OK && *proven && s.n_states > s.begin[count]) {
        trace_choice(choice, &s);
    }
    free_search(&s);
    return status;
}
