#include "ms_population_weights.h"

#include <glpk.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

ms_status ms_population_weights_init(ms_population_weights *w, const ms_population *p, size_t k, ms_error *err)
{
    const size_t m = p->n_descriptors;
    *w = (ms_population_weights){.k = k, .n_descriptors = m, .n_pairs = p->n_pairs, .mismatch = 1};
    w->weight = calloc(k, sizeof *w->weight);
    w->order = calloc(m * k, sizeof *w->order);
    w->short_of = calloc(m * k, sizeof *w->short_of);
    w->beyond = calloc(m * k, sizeof *w->beyond);
    w->pair = calloc(p->n_pairs + 1, sizeof *w->pair);
    const size_t entries = (2 * (m * k + p->n_pairs) + 1) * (k + 1) + 1;
    w->row = malloc(entries * sizeof *w->row);
    w->column = malloc(entries * sizeof *w->column);
    w->entry = malloc(entries * sizeof *w->entry);
    if (!w->weight || !w->order || !w->short_of || !w->beyond || !w->pair || !w->row || !w->column || !w->entry) {
        ms_population_weights_free(w);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the weights of %zu grains", k);
    }
    return MS_OK;
}

void ms_population_weights_free(ms_population_weights *w)
{
    free(w->weight);
    free(w->order);
    free(w->short_of);
    free(w->beyond);
    free(w->pair);
    free(w->row);
    free(w->column);
    free(w->entry);
    *w = (ms_population_weights){0};
}

static double below_of(const ms_population *p, size_t grain, size_t d)
{
    return p->below[grain * p->n_descriptors + d];
}

static double up_to_of(const ms_population *p, size_t grain, size_t d)
{
    return p->up_to[grain * p->n_descriptors + d];
}

/* By insertion: they are few. */
static void sort_chosen(size_t *order, const ms_population *p, const size_t *chosen, size_t k, size_t d)
{
    for (size_t j = 0; j < k; j++) {
        size_t i = j;
        for (; i > 0 && below_of(p, chosen[order[i - 1]], d) > below_of(p, chosen[j], d); i--) {
            order[i] = order[i - 1];
        }
        order[i] = j;
    }
}

/* The dual while it is put together. */
typedef struct dual {
    glp_prob *problem;
    ms_population_weights *w;
    int columns, entries;
} dual;

static void add_entry(dual *to, size_t row, double value)
{
    to->entries++;
    to->w->row[to->entries] = (int)row + 1;
    to->w->column[to->entries] = to->columns;
    to->w->entry[to->entries] = value;
}

/* A bound of the programme is a column of its dual; `scale` times the mismatch may lack. */
static void start_bound(dual *to, double right, double scale)
{
    to->columns = glp_add_cols(to->problem, 1);
    glp_set_obj_coef(to->problem, to->columns, right);
    glp_set_col_bnds(to->problem, to->columns, scale > 0 ? GLP_LO : GLP_FR, 0, 0);
    if (scale > 0) {
        add_entry(to, to->w->k, scale);
    }
}

/*
 * Between two of the chosen, by ascending value, the distribution of the weights stands still while that of the
 * population rises from up_to of the former to below of the latter: it may be no less than the one without mismatch,
 * and no more than the other with it.
 */
static void add_steps(dual *to, const ms_population *p, const size_t *chosen, size_t d)
{
    const size_t k = to->w->k, *order = to->w->order + d * k;
    for (size_t s = 0; s < k; s++) {
        start_bound(to, below_of(p, chosen[order[s]], d), 1);
        for (size_t j = 0; j < s; j++) {
            add_entry(to, order[j], 1);
        }
        start_bound(to, -up_to_of(p, chosen[order[s]], d), 1);
        for (size_t j = 0; j <= s; j++) {
            add_entry(to, order[j], -1);
        }
    }
}

static void add_pairs(dual *to, const ms_population *p, const size_t *chosen)
{
    for (size_t pair = 0; pair < p->n_pairs; pair++) {
        for (int sign = 1; sign >= -1; sign -= 2) {
            start_bound(to, sign * p->correlation[pair], MS_POPULATION_CORRELATION_SCALE);
            for (size_t j = 0; j < to->w->k; j++) {
                add_entry(to, j, sign * p->product[chosen[j] * p->n_pairs + pair]);
            }
        }
    }
}

static void build_dual(dual *to, const ms_population *p, const size_t *chosen)
{
    const size_t k = to->w->k;
    glp_set_obj_dir(to->problem, GLP_MAX);
    glp_add_rows(to->problem, (int)k + 1);
    for (size_t j = 0; j < k; j++) {
        glp_set_row_bnds(to->problem, (int)j + 1, GLP_UP, 0, 0); /* a weight is not below 0 */
    }
    glp_set_row_bnds(to->problem, (int)k + 1, GLP_FX, 1, 1);
    for (size_t d = 0; d < p->n_descriptors; d++) {
        sort_chosen(to->w->order + d * k, p, chosen, k, d);
        add_steps(to, p, chosen, d);
    }
    add_pairs(to, p, chosen);
    start_bound(to, 1, 0); /* the weights sum to 1 */
    for (size_t j = 0; j < k; j++) {
        add_entry(to, j, 1);
    }
    glp_load_matrix(to->problem, to->entries, to->w->row, to->w->column, to->w->entry);
}

static void read_solution(ms_population_weights *w, glp_prob *problem)
{
    int column = 0;
    w->mismatch = glp_get_obj_val(problem);
    for (size_t j = 0; j < w->k; j++) {
        w->weight[j] = fmax(0, glp_get_row_dual(problem, (int)j + 1));
    }
    for (size_t s = 0; s < w->n_descriptors * w->k; s++) {
        w->short_of[s] = glp_get_col_prim(problem, ++column);
        w->beyond[s] = glp_get_col_prim(problem, ++column);
    }
    for (size_t pair = 0; pair < w->n_pairs; pair++) {
        w->pair[pair] = glp_get_col_prim(problem, ++column);
        w->pair[pair] -= glp_get_col_prim(problem, ++column);
    }
    w->level = glp_get_col_prim(problem, ++column);
}

int ms_population_weights_solve(ms_population_weights *w, const ms_population *p, const size_t *chosen)
{
    dual to = {.problem = glp_create_prob(), .w = w};
    glp_smcp how;
    glp_init_smcp(&how);
    how.msg_lev = GLP_MSG_OFF;
    build_dual(&to, p, chosen);
    const int found = glp_simplex(to.problem, &how) == 0 && glp_get_status(to.problem) == GLP_OPT;
    w->mismatch = 1;
    if (found) {
        read_solution(w, to.problem);
    }
    glp_delete_prob(to.problem);
    return found;
}

double ms_population_weights_gain(const ms_population_weights *w, const ms_population *p, const size_t *chosen,
                                  size_t grain)
{
    double gain = w->level;
    for (size_t d = 0; d < w->n_descriptors; d++) {
        const size_t at = d * w->k;
        const double below = below_of(p, grain, d);
        for (size_t s = 0; s < w->k; s++) {
            const double of_step = below_of(p, chosen[w->order[at + s]], d);
            gain += (of_step > below ? w->short_of[at + s] : 0) - (of_step >= below ? w->beyond[at + s] : 0);
        }
    }
    for (size_t pair = 0; pair < w->n_pairs; pair++) {
        gain += w->pair[pair] * p->product[grain * w->n_pairs + pair];
    }
    return gain;
}
