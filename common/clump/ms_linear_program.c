#include "ms_linear_program.h"

#include <glpk.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdlib.h>

/*
 * Columns: n excesses, then the smallest share u, then the goals. The share of s is u plus its excess, so that the
 * bound m_s >= u, which would be a row for each sphere, is the bound 0 of a column.
 */
struct ms_linear_program {
    glp_prob *problem;
    size_t n;
    int n_goals;
    double most;
    double tolerance; /* to which the simplex method meets bounds */
    int *index;       /* room for a row; GLPK counts from 1 */
    double *value;
};

/* Of the simplex method: the one to begin with, and the last one that is tried where it finds no end. */
static const double FINEST = 1e-11, COARSEST = 1e-6;

/* GLPK aborts when it has no memory; this returns to where it was called instead. */
static void leave_solver(void *back)
{
    longjmp(*(jmp_buf *)back, 1);
}

static void end_guard(void)
{
    glp_error_hook(NULL, NULL);
}

/* After an error GLPK has nothing left in this thread that may be used. */
static ms_status give_up(ms_linear_program *p, ms_error *err)
{
    end_guard();
    glp_free_env();
    p->problem = NULL;
    return ms_fail(err, MS_ERR_NOMEM,
                   "GLPK could not go on with a programme of %zu spheres; most likely it has no memory", p->n);
}

/* What the thread is given, and gives back. */
typedef struct errand {
    ms_linear_program_work work;
    void *context;
    ms_error *err;
    ms_status status;
} errand;

/* Takes what GLPK would print: before an error it switches its terminal on. */
static int swallow(void *info, const char *text)
{
    (void)info;
    (void)text;
    return 1;
}

static void *run_errand(void *argument)
{
    errand *e = argument;
    if (glp_init_env() != 0) {
        e->status = ms_fail(e->err, MS_ERR_NOMEM, "no memory for GLPK");
        return NULL;
    }
    glp_term_hook(swallow, NULL);
    e->status = e->work(e->context, e->err);
    glp_free_env();
    return NULL;
}

ms_status ms_linear_program_apart(ms_linear_program_work work, void *context, ms_error *err)
{
    errand e = {.work = work, .context = context, .err = err};
    pthread_t thread;
    if (!glp_config("TLS")) {
        return ms_fail(err, MS_ERR_LIMIT, "this GLPK keeps nothing apart for threads; build it reentrant");
    }
    if (pthread_create(&thread, NULL, run_errand, &e) != 0) {
        return ms_fail(err, MS_ERR_NOMEM, "no thread could be started to solve for the masses");
    }
    pthread_join(thread, NULL);
    return e.status;
}

static void make_columns(ms_linear_program *p, double least)
{
    const int n = (int)p->n;
    p->problem = glp_create_prob();
    glp_set_obj_dir(p->problem, GLP_MIN);
    glp_add_cols(p->problem, n + 1 + p->n_goals);
    for (int c = 1; c <= n + 1 + p->n_goals; c++) {
        glp_set_col_bnds(p->problem, c, GLP_LO, c == n + 1 ? least : 0, 0);
    }
}

/* Rows m_s <= most, where that does not follow from the sum. */
static void make_upper_bounds(ms_linear_program *p)
{
    const int n = (int)p->n, first = glp_add_rows(p->problem, n);
    const double ones[3] = {0, 1, 1};
    for (int s = 0; s < n; s++) {
        const int columns[3] = {0, s + 1, n + 1};
        glp_set_row_bnds(p->problem, first + s, GLP_UP, 0, p->most);
        glp_set_mat_row(p->problem, first + s, 2, columns, ones);
    }
}

static ms_status make_problem(ms_linear_program *p, double least, ms_error *err)
{
    jmp_buf back;
    glp_error_hook(leave_solver, &back);
    if (setjmp(back)) {
        return give_up(p, err);
    }
    make_columns(p, least);
    if (p->most < 1) {
        make_upper_bounds(p);
    }
    end_guard();
    return MS_OK;
}

ms_linear_program *ms_linear_program_new(size_t n, int n_goals, double least, double most, ms_error *err)
{
    ms_linear_program *p = calloc(1, sizeof *p);
    if (p) {
        *p = (ms_linear_program){.n = n, .n_goals = n_goals, .most = most, .tolerance = FINEST};
        p->index = malloc((n + 4) * sizeof *p->index);
        p->value = malloc((n + 4) * sizeof *p->value);
    }
    if (!p || !p->index || !p->value) {
        ms_fail(err, MS_ERR_NOMEM, "no memory for a programme of %zu spheres", n);
        ms_linear_program_free(p);
        return NULL;
    }
    if (make_problem(p, least, err) != MS_OK) {
        ms_linear_program_free(p);
        return NULL;
    }
    return p;
}

/* The row's coefficients in GLPK's arrays; returns how many. */
static int fill_row(ms_linear_program *p, const double *row, int goal, double weight)
{
    const int n = (int)p->n;
    double sum = 0;
    int used = 0;
    for (int s = 0; s < n; s++) {
        sum += row[s];
        if (row[s] != 0) {
            p->index[++used] = s + 1;
            p->value[used] = row[s];
        }
    }
    p->index[++used] = n + 1;
    p->value[used] = sum;
    if (goal >= 0) {
        p->index[++used] = n + 2 + goal;
        p->value[used] = weight;
    }
    return used;
}

ms_status ms_linear_program_equation(ms_linear_program *p, const double *row, double right, int goal, double weight,
                                     ms_error *err)
{
    jmp_buf back;
    glp_error_hook(leave_solver, &back);
    if (setjmp(back)) {
        return give_up(p, err);
    }
    for (int side = 0; side < (goal < 0 ? 1 : 2); side++) {
        const int at = glp_add_rows(p->problem, 1);
        const int used = fill_row(p, row, goal, side == 0 ? -weight : weight);
        glp_set_mat_row(p->problem, at, used, p->index, p->value);
        glp_set_row_bnds(p->problem, at, goal < 0 ? GLP_FX : side == 0 ? GLP_UP : GLP_LO, right, right);
    }
    end_guard();
    return MS_OK;
}

/* One run of the simplex method, from the basis that stands or, afresh, from one that GLPK makes. */
static ms_status run_simplex(ms_linear_program *p, int afresh, ms_error *err)
{
    glp_smcp how;
    jmp_buf back;
    glp_error_hook(leave_solver, &back);
    if (setjmp(back)) {
        return give_up(p, err);
    }
    glp_init_smcp(&how);
    how.msg_lev = GLP_MSG_OFF;
    how.tol_bnd = how.tol_dj = p->tolerance;
    how.it_lim = 20000 + 20 * (int)p->n;
    if (afresh) {
        glp_adv_basis(p->problem, 0);
    }
    const int failed = glp_simplex(p->problem, &how), status = glp_get_status(p->problem);
    end_guard();
    if (failed || status != GLP_OPT) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "the simplex method found no masses for %zu spheres (code %d, status %d); leave out spheres "
                       "that all but coincide",
                       p->n, failed, status);
    }
    return MS_OK;
}

/* Minimises the objective that is set. Where rounding hides the end, bounds are met less closely. */
static ms_status minimise_objective(ms_linear_program *p, ms_error *err)
{
    ms_status status = run_simplex(p, 0, err);
    if (status == MS_ERR_LIMIT) {
        status = run_simplex(p, 1, err);
    }
    while (status == MS_ERR_LIMIT && p->tolerance < COARSEST) {
        p->tolerance = fmin(100 * p->tolerance, COARSEST);
        status = run_simplex(p, 1, err);
    }
    return status;
}

ms_status ms_linear_program_minimise(ms_linear_program *p, int goal, double allowed, double *value, ms_error *err)
{
    const int column = (int)p->n + 2 + goal;
    glp_set_obj_coef(p->problem, column, 1);
    ms_status status = minimise_objective(p, err);
    if (status != MS_OK) {
        return status;
    }
    *value = fmax(glp_get_col_prim(p->problem, column), 0);
    glp_set_obj_coef(p->problem, column, 0);
    /* Above the least value by more than the simplex method's own tolerance: a bound that it meets only by rounding may
     * leave no masses at all. */
    const double bound = fmax(*value, allowed);
    glp_set_col_bnds(p->problem, column, GLP_DB, 0, bound + 2 * p->tolerance * (1 + bound));
    return MS_OK;
}

ms_status ms_linear_program_weigh(ms_linear_program *p, const double *weight, ms_error *err)
{
    const int n = (int)p->n;
    for (int s = 0; s < n; s++) {
        glp_set_obj_coef(p->problem, s + 1, weight[s]);
    }
    /* Shares that could be 0 are not to have what all have alike. */
    glp_set_col_bnds(p->problem, n + 1, GLP_FX, glp_get_col_lb(p->problem, n + 1), 0);
    return minimise_objective(p, err);
}

ms_status ms_linear_program_spread(ms_linear_program *p, ms_error *err)
{
    const int u = (int)p->n + 1;
    glp_set_obj_coef(p->problem, u, -1);
    return minimise_objective(p, err);
}

void ms_linear_program_shares(const ms_linear_program *p, double *share)
{
    for (size_t s = 0; s < p->n; s++) {
        share[s] = glp_get_col_prim(p->problem, (int)p->n + 1) + glp_get_col_prim(p->problem, (int)s + 1);
    }
}

void ms_linear_program_free(ms_linear_program *p)
{
    if (p) {
        if (p->problem) {
            glp_delete_prob(p->problem);
        }
        free(p->index);
        free(p->value);
        free(p);
    }
}
