#include "ms_carriers_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_linear_program.h"

enum { AFRESH = 6, STARTS = 24, ROUNDS = 6, REPAIRS = 4, MOST_PICKED = 3 * MS_MASS_EQUATIONS_COUNT };

/* Errors of the equations below this are rounding of the simplex method; shares below that are none. */
static const double ROUNDING = 1e-10, NOTHING = 1e-9;
static const double SOFT = 1e-3; /* of the weights: a share so small weighs half of what one of 0 does */

typedef struct carrier_search {
    const ms_mass_equations *e;
    size_t n; /* spheres; candidates are those behind them */
    const ms_density_options *options;
    double least, most;           /* of a share, where many candidates are */
    double *row, *share, *weight; /* e->n each */
    double *given;                /* likewise: what each has beforehand */
    int do_all, none_do;          /* do all candidates, beyond what is given? Do they not even where none has any? */
    size_t *all;                  /* all candidates */
    size_t *pick, picked;         /* those tried, in ascending order */
    size_t *best, n_best;         /* the fewest */
    double margin;                /* of these: the greatest least share / the bound of it */
} carrier_search;

/* A programme for the shares of the spheres and of some candidates beyond those given, NULL for none; the errors of the
 * equations are its one goal. */
static ms_linear_program *make_choice(carrier_search *s, const size_t *some, size_t count, const double *given,
                                      double most, ms_error *err)
{
    ms_linear_program *p = ms_linear_program_new(s->n + count, 1, 0, most, err);
    ms_status status = p ? MS_OK : MS_ERR_NOMEM;
    for (int k = 0; k < MS_MASS_EQUATIONS_COUNT && status == MS_OK; k++) {
        const ms_mass_equation q = ms_mass_equations_get(s->row, s->e, k);
        double right = q.right;
        for (size_t i = 0; given && i < s->e->n; i++) {
            right -= given[i] * s->row[i];
        }
        for (size_t c = 0; c < count; c++) { /* indices ascend */
            s->row[s->n + c] = s->row[some[c]];
        }
        status = ms_linear_program_equation(p, s->row, right, q.kind == MS_MASS_EQUATION_MASS ? -1 : 0, q.scale, err);
    }
    if (status != MS_OK) {
        ms_linear_program_free(p);
        return NULL;
    }
    return p;
}

/* What stands for "not to be solved" where there is no cause to give up the whole search. */
static ms_status none_for_limit(ms_status status, int *solved)
{
    *solved = status == MS_OK;
    return status == MS_ERR_LIMIT ? MS_OK : status;
}

/* Can the spheres and these candidates do? The margin is above 1 if so. */
static ms_status check(carrier_search *s, double *margin, const size_t *some, size_t count, ms_error *err)
{
    const double most = s->options->most > 0 ? s->options->most : 1;
    double error;
    int solved = 0;
    *margin = 0;
    ms_linear_program *p = make_choice(s, some, count, NULL, most, err);
    ms_status status = p ? none_for_limit(ms_linear_program_minimise(p, 0, 0, &error, err), &solved) : MS_ERR_NOMEM;
    if (solved && error < ROUNDING) {
        status = none_for_limit(ms_linear_program_spread(p, err), &solved);
        if (solved) {
            double least = HUGE_VAL;
            ms_linear_program_shares(p, s->share);
            for (size_t i = 0; i < s->n + count; i++) {
                least = fmin(least, s->share[i]);
            }
            *margin = least / ms_density_least(s->options, s->n + count);
        }
    }
    ms_linear_program_free(p);
    return status;
}

/* Where the weights begin: all alike at first, then strewn about 1 without repeating. What is given costs nothing. */
static void start_weights(carrier_search *s, int start)
{
    static const double GOLDEN = 0.6180339887498949;
    for (size_t c = 0; c < s->e->n; c++) {
        s->weight[c] = s->given[c] > 0 ? 0 : 1 + (start ? fmod(GOLDEN * (double)c * start, 1) - 0.5 : 0);
    }
}

static void take_those_with_share(carrier_search *s)
{
    s->picked = 0;
    for (size_t c = s->n; c < s->e->n; c++) {
        if (s->share[c] + s->given[c] > NOTHING) {
            s->pick[s->picked++] = c;
        }
    }
}

/* Few candidates by programmes whose weights follow from the shares of the one before; none where not even all do with
 * what is given. */
static ms_status choose_few(carrier_search *s, int start, ms_error *err)
{
    double error;
    int solved = 0;
    ms_linear_program *p = make_choice(s, s->all, s->e->n - s->n, s->given, s->most, err);
    ms_status status = p ? none_for_limit(ms_linear_program_minimise(p, 0, 0, &error, err), &solved) : MS_ERR_NOMEM;
    s->do_all = solved = solved && error < ROUNDING;
    s->picked = 0;
    start_weights(s, start);
    for (int round = 0; round < ROUNDS && solved && status == MS_OK; round++) {
        status = none_for_limit(ms_linear_program_weigh(p, s->weight, err), &solved);
        if (!solved) {
            break;
        }
        ms_linear_program_shares(p, s->share);
        take_those_with_share(s);
        for (size_t c = s->n; c < s->e->n; c++) {
            s->weight[c] = s->given[c] > 0 ? 0 : SOFT / (SOFT + s->share[c]);
        }
    }
    ms_linear_program_free(p);
    return status;
}

/* Nothing at first; later on the best so far but for two, another pair each time. */
static void start_given(carrier_search *s, int start)
{
    for (size_t c = 0; c < s->e->n; c++) {
        s->given[c] = c < s->n ? s->least : 0;
    }
    if (start < AFRESH || s->n_best == 0) {
        return;
    }
    const size_t turn = (size_t)(start - AFRESH), first = turn % s->n_best;
    const size_t second = (first + 1 + turn / s->n_best) % s->n_best;
    for (size_t c = 0; c < s->n_best; c++) {
        if (c != first && c != second) {
            s->given[s->best[c]] = s->least;
        }
    }
}

/* Chooses until all that are chosen can have the least share: they are given it, and others make up for that. */
static ms_status choose_above_bound(carrier_search *s, double *margin, int start, ms_error *err)
{
    ms_status status = MS_OK;
    *margin = 0;
    start_given(s, start);
    for (int repair = 0; repair <= REPAIRS && *margin < 1 && status == MS_OK; repair++) {
        status = choose_few(s, start, err);
        s->none_do |= start == 0 && repair == 0 && !s->do_all;
        if (status != MS_OK || s->picked == 0 || s->picked > MOST_PICKED) {
            return status;
        }
        status = check(s, margin, s->pick, s->picked, err);
        for (size_t c = 0; c < s->picked; c++) {
            s->given[s->pick[c]] = s->least;
        }
    }
    return status;
}

/* Leaves out one after the other, as long as the rest can do; notes what is left if it is the best so far. */
static ms_status thin_out(carrier_search *s, double margin, ms_error *err)
{
    ms_status status = MS_OK;
    size_t rest[MOST_PICKED];
    for (size_t out = 0; status == MS_OK && margin >= 1 && out < s->picked && s->picked > 1;) {
        double without;
        memcpy(rest, s->pick, out * sizeof *rest);
        memcpy(rest + out, s->pick + out + 1, (s->picked - out - 1) * sizeof *rest);
        status = check(s, &without, rest, s->picked - 1, err);
        if (status == MS_OK && without >= 1) {
            memcpy(s->pick, rest, --s->picked * sizeof *rest);
            margin = without;
            out = 0;
        } else {
            out++;
        }
    }
    const int better = s->n_best == 0 || s->picked < s->n_best || (s->picked == s->n_best && margin > s->margin);
    if (status == MS_OK && margin >= 1 && better) {
        memcpy(s->best, s->pick, s->picked * sizeof *s->best);
        s->n_best = s->picked;
        s->margin = margin;
    }
    return status;
}

static ms_status run_starts(void *context, ms_error *err)
{
    carrier_search *s = context;
    ms_status status = MS_OK;
    for (int start = 0; start < STARTS && status == MS_OK; start++) {
        double margin;
        status = choose_above_bound(s, &margin, start, err);
        if (s->none_do || s->n_best == 1) { /* one is enough */
            break;
        }
        if (status == MS_OK && margin >= 1) {
            status = thin_out(s, margin, err);
        }
    }
    return status;
}

static ms_status allocate(carrier_search *s, ms_error *err)
{
    const size_t n = s->e->n;
    s->row = malloc(n * sizeof *s->row);
    s->share = malloc(n * sizeof *s->share);
    s->weight = malloc(n * sizeof *s->weight);
    s->given = malloc(n * sizeof *s->given);
    s->all = malloc(n * sizeof *s->all);
    s->pick = malloc(n * sizeof *s->pick);
    s->best = malloc(n * sizeof *s->best);
    if (!s->row || !s->share || !s->weight || !s->given || !s->all || !s->pick || !s->best) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to look for carriers in %zu spheres", s->n);
    }
    for (size_t c = s->n; c < n; c++) {
        s->all[c - s->n] = c;
    }
    return MS_OK;
}

ms_status ms_carriers_search(size_t **pick, size_t *picked, int *all_do, const ms_mass_equations *e, size_t n_spheres,
                             const ms_density_options *options, ms_error *err)
{
    carrier_search s = {.e = e, .n = n_spheres, .options = options};
    s.least = ms_density_least(options, n_spheres + MS_MASS_EQUATIONS_COUNT);
    s.most = options->most > 0 ? fmax(options->most - s.least, 0) : 1;
    ms_status status = allocate(&s, err);
    if (status == MS_OK) {
        status = ms_linear_program_apart(run_starts, &s, err);
    }
    *all_do = status == MS_OK && !s.none_do;
    *picked = status == MS_OK ? s.n_best : 0;
    *pick = *picked > 0 ? s.best : NULL;
    if (!*pick) {
        free(s.best);
    }
    free(s.row);
    free(s.share);
    free(s.weight);
    free(s.given);
    free(s.all);
    free(s.pick);
    return status;
}
