#include "ms_allocate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_knapsack.h"

/* What rounding may do to a sum. */
static const double ROUNDING = 1e-12;

/* From a template to a larger one. */
typedef struct hull_step {
    size_t to;
    double slope; /* error taken away by each further sphere; 0: no template up to the last is better */
} hull_step;

/* The steepest descent from template n to one of at most `last` spheres: along the lower hull of what lies ahead. */
static hull_step steepest(const ms_share *share, size_t n, size_t last)
{
    hull_step best = {n, 0};
    for (size_t to = n + 1; to <= last; to++) {
        const double slope = (share->error[n - 1] - share->error[to - 1]) / (double)(to - n);
        if (slope > best.slope) {
            best = (hull_step){to, slope};
        }
    }
    return best;
}

static uint64_t cost(const ms_share *share, size_t from, size_t to)
{
    return share->particles * (to - from);
}

ms_allocation ms_allocate_sum(const ms_share *share, const size_t *n, size_t count)
{
    ms_allocation sum = {0};
    for (size_t s = 0; s < count; s++) {
        sum.particles += share[s].particles;
        sum.spheres += cost(&share[s], 0, n[s]);
        sum.error += (double)share[s].particles * share[s].error[n[s] - 1];
    }
    sum.error /= (double)sum.particles;
    return sum;
}

double ms_allocate_gain(const ms_share *share, const size_t *n, size_t count)
{
    double least = HUGE_VAL;
    for (size_t s = 0; s < count; s++) {
        const double *error = share[s].error;
        for (size_t to = 1; to < n[s]; to++) {
            least = fmin(least, (error[to - 1] - error[n[s] - 1]) / (double)(n[s] - to));
        }
    }
    return isfinite(least) ? least : 0;
}

/* The sums of errors and the spheres of all templates, as kinds of a knapsack. */
typedef struct error_table {
    ms_kind *kind;
    double *error, *spheres; /* shape behind shape */
} error_table;

static void free_table(error_table *t)
{
    free(t->kind);
    free(t->error);
    free(t->spheres);
}

static ms_status make_error_table(error_table *t, const ms_share *share, size_t count, int by_error, ms_error *err)
{
    size_t size = 0, at = 0;
    for (size_t s = 0; s < count; s++) {
        size += share[s].most;
    }
    *t = (error_table){malloc(count * sizeof *t->kind), malloc(size * sizeof *t->error),
                       malloc(size * sizeof *t->spheres)};
    if (!t->kind || !t->error || !t->spheres) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu templates", size);
    }
    for (size_t s = 0; s < count; s++) {
        double *error = t->error + at, *spheres = t->spheres + at;
        t->kind[s] = (ms_kind){share[s].most, by_error ? error : spheres, by_error ? spheres : error};
        for (size_t n = 0; n < share[s].most; n++) {
            error[n] = (double)share[s].particles * share[s].error[n];
            spheres[n] = (double)cost(&share[s], 0, n + 1);
        }
        at += share[s].most;
    }
    return MS_OK;
}

/* What the search looks for: the least of one sum within a limit of the other. */
typedef struct aim {
    int by_error; /* nonzero: the least sum of errors within a limit of spheres; zero: the other way round */
    double limit, price, step; /* as ms_knapsack_improve takes them */
} aim;

/* From a good allocation to the best. */
static ms_status improve(size_t *n, ms_allocation *sum, const ms_share *share, size_t count, const aim *wanted,
                         ms_error *err)
{
    error_table t;
    int proven = 0;
    const double slack = sum->slack;
    ms_status status = make_error_table(&t, share, count, wanted->by_error, err);
    for (size_t s = 0; s < count; s++) {
        n[s]--; /* places in the table */
    }
    if (status == MS_OK) {
        status = ms_knapsack_improve(n, &proven, t.kind, count, wanted->limit, wanted->price, wanted->step, err);
    }
    for (size_t s = 0; s < count; s++) {
        n[s]++;
    }
    *sum = ms_allocate_sum(share, n, count);
    sum->slack = proven ? 0 : slack;
    free_table(&t);
    return status;
}

/* One sphere each, and the steepest step of each shape from there; NULL without memory. */
static hull_step *begin_steps(size_t *n, const ms_share *share, size_t count, ms_error *err)
{
    hull_step *ahead = malloc((count + 1) * sizeof *ahead);
    if (!ahead) {
        ms_fail(err, MS_ERR_NOMEM, "no memory for the steps of %zu shapes", count);
        return NULL;
    }
    for (size_t s = 0; s < count; s++) {
        n[s] = 1;
        ahead[s] = steepest(&share[s], 1, share[s].most);
    }
    return ahead;
}

/* The shape with the steepest step; the first of equals. */
static size_t first_of(const hull_step *ahead, size_t count)
{
    size_t best = 0;
    for (size_t s = 1; s < count; s++) {
        best = ahead[s].slope > ahead[best].slope ? s : best;
    }
    return best;
}

/* The same among the steps that the rest pays: where it does not pay the steepest of a shape, one to a smaller template
 * may do. */
static size_t first_payable(hull_step *best, const hull_step *ahead, const size_t *n, const ms_share *share,
                            size_t count, uint64_t rest)
{
    size_t shape = 0;
    *best = (hull_step){n[0], 0};
    for (size_t s = 0; s < count; s++) {
        const hull_step payable = cost(&share[s], n[s], ahead[s].to) <= rest
                                      ? ahead[s]
                                      : steepest(&share[s], n[s], n[s] + (size_t)(rest / share[s].particles));
        if (payable.slope > best->slope) {
            *best = payable;
            shape = s;
        }
    }
    return shape;
}

static void take(size_t *n, hull_step *ahead, const ms_share *share, size_t shape, size_t to)
{
    n[shape] = to;
    ahead[shape] = steepest(&share[shape], to, share[shape].most);
}

/* The steps of ms_allocate_budget, from one sphere each; in `price` the slope of the first that cannot be paid. */
static ms_allocation spend(size_t *n, double *price, hull_step *ahead, const ms_share *share, size_t count,
                           uint64_t budget)
{
    ms_allocation sum = ms_allocate_sum(share, n, count);
    double bound = HUGE_VAL; /* on the mean error, from the first step that cannot be paid */
    *price = 0;
    for (;;) {
        hull_step next;
        const uint64_t rest = budget - sum.spheres;
        const double wanted = ahead[first_of(ahead, count)].slope;
        const size_t shape = first_payable(&next, ahead, n, share, count, rest);
        if (next.slope < wanted && bound == HUGE_VAL) {
            bound = sum.error - wanted * (double)rest / (double)sum.particles;
            *price = wanted;
        }
        if (!(next.slope > 0)) {
            break;
        }
        take(n, ahead, share, shape, next.to);
        sum = ms_allocate_sum(share, n, count);
    }
    sum.slack = fmax(0, sum.error - bound);
    return sum;
}

ms_status ms_allocate_budget(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count, uint64_t budget,
                             ms_error *err)
{
    double price = 0;
    hull_step *ahead = begin_steps(n, share, count, err);
    if (!ahead) {
        return MS_ERR_NOMEM;
    }
    *allocated = ms_allocate_sum(share, n, count);
    ms_status status = MS_OK;
    if (budget < allocated->particles) {
        status = ms_fail(err, MS_ERR_LIMIT,
                         "a budget of %llu spheres is less than one for each of the %llu particles; raise it",
                         (unsigned long long)budget, (unsigned long long)allocated->particles);
    } else {
        *allocated = spend(n, &price, ahead, share, count, budget);
    }
    free(ahead);
    if (status == MS_OK && allocated->slack > 0) {
        const double least = ROUNDING * allocated->error * (double)allocated->particles;
        status = improve(n, allocated, share, count, &(aim){1, (double)budget, price, least}, err);
    }
    return status;
}

/* By halving, a budget as small as can be for which the steps of ms_allocate_budget reach the error. On entry n and sum
 * are an allocation that reaches it. */
static ms_status shrink_budget(size_t *n, ms_allocation *sum, double fewest, const ms_share *share, size_t count,
                               double error, ms_error *err)
{
    double unused;
    uint64_t few = (uint64_t)fewest;
    ms_status status = MS_OK;
    size_t *fewer = malloc(count * sizeof *fewer);
    if (!fewer) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu shapes", count);
    }
    while (few + 1 < sum->spheres && status == MS_OK) {
        const uint64_t budget = few + (sum->spheres - few) / 2;
        hull_step *ahead = begin_steps(fewer, share, count, err);
        status = ahead ? MS_OK : MS_ERR_NOMEM;
        const ms_allocation less = ahead ? spend(fewer, &unused, ahead, share, count, budget) : *sum;
        if (ahead && less.error <= error) {
            memcpy(n, fewer, count * sizeof *n);
            *sum = less;
        } else {
            few = budget;
        }
        free(ahead);
    }
    free(fewer);
    return status;
}

/* Steps from one sphere each until the error is reached; in `price` the spheres for a unit of error at the last, in
 * `fewest` how many any allocation needs, by the hulls. */
static ms_status reach(size_t *n, ms_allocation *sum, double *price, double *fewest, hull_step *ahead,
                       const ms_share *share, size_t count, double error, ms_error *err)
{
    *price = *fewest = 0;
    *sum = ms_allocate_sum(share, n, count);
    while (sum->error > error) {
        const size_t shape = first_of(ahead, count);
        if (!(ahead[shape].slope > 0)) {
            return ms_fail(err, MS_ERR_LIMIT, "the best templates reach a mean of %.6g, not %.6g; allow more spheres",
                           sum->error, error);
        }
        *price = 1 / ahead[shape].slope;
        *fewest = (double)sum->spheres + (sum->error - error) * (double)sum->particles * *price;
        take(n, ahead, share, shape, ahead[shape].to);
        *sum = ms_allocate_sum(share, n, count);
    }
    return MS_OK;
}

ms_status ms_allocate_error(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count, double error,
                            ms_error *err)
{
    double price, fewest;
    hull_step *ahead = begin_steps(n, share, count, err);
    if (!ahead) {
        return MS_ERR_NOMEM;
    }
    ms_status status = reach(n, allocated, &price, &fewest, ahead, share, count, error, err);
    free(ahead);
    if (status == MS_OK && fewest > 0) {
        fewest *= 1 - ROUNDING;
        status = shrink_budget(n, allocated, fewest, share, count, error, err);
        allocated->slack = fmax(0, floor((double)allocated->spheres - fewest));
    }
    if (status == MS_OK && allocated->slack > 0) {
        const double limit = (1 + ROUNDING) * error * (double)allocated->particles;
        status = improve(n, allocated, share, count, &(aim){0, limit, price, 0.5}, err);
    }
    return status;
}

size_t ms_allocate_knee(const ms_share *share, double part)
{
    for (size_t n = 1; n < share->most; n++) {
        const double slope = steepest(share, n, share->most).slope;
        if (!(slope > 0) || slope < part * share->error[n - 1]) {
            return n;
        }
    }
    return 0;
}
