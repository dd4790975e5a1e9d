#include "ms_allocate.h"

#include <math.h>
#include <stdlib.h>

/* Against rounding, where a bound must not be above the truth. */
static const double ROUNDED_DOWN = 1 - 1e-12;

/* From a template to a larger one. */
typedef struct step {
    size_t to;
    double slope; /* error taken away by each further sphere; 0: no template up to the last is better */
} step;

/* The steepest descent from template n to one of at most `last` spheres: along the lower hull of what lies ahead. */
static step steepest(const ms_share *share, size_t n, size_t last)
{
    step best = {n, 0};
    for (size_t to = n + 1; to <= last; to++) {
        const double slope = (share->error[n - 1] - share->error[to - 1]) / (double)(to - n);
        if (slope > best.slope) {
            best = (step){to, slope};
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

/* One sphere each, and the steepest step of each shape from there; NULL without memory. */
static step *begin(size_t *n, const ms_share *share, size_t count, ms_error *err)
{
    step *ahead = malloc((count + 1) * sizeof *ahead);
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
static size_t first_of(const step *ahead, size_t count)
{
    size_t best = 0;
    for (size_t s = 1; s < count; s++) {
        best = ahead[s].slope > ahead[best].slope ? s : best;
    }
    return best;
}

/* The same among the steps that the rest pays: where it does not pay the steepest of a shape, one to a smaller template
 * may do. */
static size_t first_payable(step *best, const step *ahead, const size_t *n, const ms_share *share, size_t count,
                            uint64_t rest)
{
    size_t shape = 0;
    *best = (step){n[0], 0};
    for (size_t s = 0; s < count; s++) {
        const step payable = cost(&share[s], n[s], ahead[s].to) <= rest
                                 ? ahead[s]
                                 : steepest(&share[s], n[s], n[s] + (size_t)(rest / share[s].particles));
        if (payable.slope > best->slope) {
            *best = payable;
            shape = s;
        }
    }
    return shape;
}

static void take(size_t *n, step *ahead, const ms_share *share, size_t shape, size_t to)
{
    n[shape] = to;
    ahead[shape] = steepest(&share[shape], to, share[shape].most);
}

/* All that is said of ms_allocate_budget, from one sphere each. */
static ms_allocation spend(size_t *n, step *ahead, const ms_share *share, size_t count, uint64_t budget)
{
    ms_allocation sum = ms_allocate_sum(share, n, count);
    double gain = 0, bound = HUGE_VAL; /* on the mean error, from the first step that cannot be paid */
    for (;;) {
        step next;
        const uint64_t rest = budget - sum.spheres;
        const double wanted = ahead[first_of(ahead, count)].slope;
        const size_t shape = first_payable(&next, ahead, n, share, count, rest);
        if (next.slope < wanted && bound == HUGE_VAL) {
            bound = sum.error - wanted * (double)rest / (double)sum.particles;
        }
        if (!(next.slope > 0)) {
            break;
        }
        gain = next.slope;
        take(n, ahead, share, shape, next.to);
        sum = ms_allocate_sum(share, n, count);
    }
    sum.gain = gain;
    sum.slack = fmax(0, sum.error - bound);
    return sum;
}

ms_status ms_allocate_budget(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count,
                             uint64_t budget, ms_error *err)
{
    step *ahead = begin(n, share, count, err);
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
        *allocated = spend(n, ahead, share, count, budget);
    }
    free(ahead);
    return status;
}

/* The least template of a shape that takes at least `excess` off the sum of errors; 0 if there is none. */
static size_t least_that_takes(const ms_share *share, size_t n, double excess)
{
    for (size_t to = n + 1; to <= share->most; to++) {
        if ((double)share->particles * (share->error[n - 1] - share->error[to - 1]) >= excess) {
            return to;
        }
    }
    return 0;
}

/* The cheapest single step that takes away the excess; there is one. Returns its gain for each sphere. */
static double finish(size_t *n, const ms_share *share, size_t count, double excess)
{
    size_t shape = 0, best = 0;
    for (size_t s = 0; s < count; s++) {
        const size_t to = least_that_takes(&share[s], n[s], excess);
        if (to && (!best || cost(&share[s], n[s], to) < cost(&share[shape], n[shape], best))) {
            shape = s;
            best = to;
        }
    }
    const double taken = share[shape].error[n[shape] - 1] - share[shape].error[best - 1];
    const double gain = taken / (double)(best - n[shape]);
    n[shape] = best;
    return gain;
}

ms_status ms_allocate_error(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count, double error,
                            ms_error *err)
{
    ms_status status = MS_OK;
    double gain = 0, fewest = 0;
    step *ahead = begin(n, share, count, err);
    if (!ahead) {
        return MS_ERR_NOMEM;
    }
    ms_allocation sum = ms_allocate_sum(share, n, count);
    while (sum.error > error) {
        const double excess = (sum.error - error) * (double)sum.particles;
        const size_t shape = first_of(ahead, count);
        if (!(ahead[shape].slope > 0)) {
            status = ms_fail(err, MS_ERR_LIMIT, "the best templates reach a mean of %.6g, not %.6g; allow more spheres",
                             sum.error, error);
            break;
        }
        fewest = (double)sum.spheres + excess / ahead[shape].slope;
        if (least_that_takes(&share[shape], n[shape], excess)) {
            gain = finish(n, share, count, excess);
            sum = ms_allocate_sum(share, n, count);
            break;
        }
        gain = ahead[shape].slope;
        take(n, ahead, share, shape, ahead[shape].to);
        sum = ms_allocate_sum(share, n, count);
    }
    free(ahead);
    *allocated = sum;
    allocated->gain = gain;
    allocated->slack = fewest > 0 ? fmax(0, floor((double)sum.spheres - ROUNDED_DOWN * fewest)) : 0;
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
