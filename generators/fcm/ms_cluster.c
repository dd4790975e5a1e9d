/*
 * Bezdek, Pattern Recognition with Fuzzy Objective Function Algorithms (1981). With the squared distances
 * d_i of a point from the centres, the least of them d, and p = 1 / (m - 1), let w_i = (d / d_i)^p and W their
 * sum. Then u_i = w_i / W, u_i^m = w_i (d / d_i) / W^m, and the point adds d W^(1-m) to the objective: one power for
 * each pair, and no number too large whatever m.
 */
#include "ms_cluster.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "base/ms_versions.h"
#include "ms_power.h"

/* Points side by side; partial sums over them; parts into which all points are cut, so that sums are
 * added up in the same order whatever the number of threads. */
enum { LANES = 64, SUMS = 4, PARTS = 64 };

/* Coordinates, and what is summed for each centre: its weight and its weighted points. */
enum { AXES = 4, TERMS = 5 };

/* Centres nearer than this part of the points' extent coincide. */
static const double COINCIDENT = 1e-3;

typedef struct block {
    double x[AXES][LANES];
} block;

struct ms_cluster {
    size_t count, n_blocks;
    block *blocks; /* the last one is filled up with its last point */
    double extent; /* diagonal of the points' box */
    double least;  /* squared distances below this count as this */
};

/* What a block's points weigh. */
typedef struct weights {
    double (*of)[LANES];   /* for each centre */
    double nearest[LANES]; /* squared distance to the nearest centre */
    double total[LANES];
} weights;

/* What one part of the points adds up to. */
typedef struct share {
    double (*sum)[TERMS]; /* of each centre */
    double objective;
    double farthest; /* squared distance of the point farthest from all centres */
    size_t point;    /* which one */
} share;

/* One run. */
typedef struct work {
    const ms_cluster *cluster;
    const ms_cluster_rule *rule;
    size_t count;            /* of centres */
    double (*sum)[TERMS];    /* PARTS times as many */
    double (*weight)[LANES]; /* `count` for each thread */
    share parts[PARTS];
} work;

void ms_cluster_free(ms_cluster *cluster)
{
    if (cluster) {
        free(cluster->blocks);
        free(cluster);
    }
}

static void get_point(double out[AXES], const ms_cluster *c, size_t point)
{
    for (int a = 0; a < AXES; a++) {
        out[a] = c->blocks[point / LANES].x[a][point % LANES];
    }
}

static double squared_distance(const double a[AXES], const double b[AXES])
{
    double sum = 0;
    for (int k = 0; k < AXES; k++) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return sum;
}

static void copy_points(ms_cluster *c, const double (*point)[4])
{
    double square = 0;
    for (int a = 0; a < AXES; a++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (size_t p = 0; p < c->n_blocks * LANES; p++) {
            const double x = point[p < c->count ? p : c->count - 1][a];
            c->blocks[p / LANES].x[a][p % LANES] = x;
            lo = fmin(lo, x);
            hi = fmax(hi, x);
        }
        square += (hi - lo) * (hi - lo);
    }
    c->extent = sqrt(square);
    c->least = square > 0 ? 1e-24 * square : 1;
}

ms_status ms_cluster_build(ms_cluster **out, const double (*point)[4], size_t count, ms_error *err)
{
    *out = NULL;
    if (count == 0) {
        return ms_fail(err, MS_ERR_ARG, "there are no points to cluster");
    }
    for (size_t p = 0; p < count; p++) {
        for (int a = 0; a < AXES; a++) {
            if (!(fabs(point[p][a]) <= 1e100)) {
                return ms_fail(err, MS_ERR_ARG, "coordinate %d of point %zu is %g; it must be within 1e100", a + 1,
                               p + 1, point[p][a]);
            }
        }
    }
    ms_cluster *c = calloc(1, sizeof *c);
    const size_t n_blocks = (count + LANES - 1) / LANES;
    block *blocks = malloc(n_blocks * sizeof *blocks);
    if (!c || !blocks) {
        free(c);
        free(blocks);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to cluster %zu points", count);
    }
    *c = (ms_cluster){.count = count, .n_blocks = n_blocks, .blocks = blocks};
    copy_points(c, point);
    *out = c;
    return MS_OK;
}

/* Squared distances of a block's points from the centres, and the least for each point. */
MS_VERSIONS static void measure_distances(double (*square)[LANES], double nearest[LANES], const block *b,
                                          const double (*centre)[AXES], size_t count, double least)
{
    for (int l = 0; l < LANES; l++) {
        nearest[l] = HUGE_VAL;
    }
    for (size_t i = 0; i < count; i++) {
        const double *c = centre[i];
        double *out = square[i];
        for (int l = 0; l < LANES; l++) {
            const double x = b->x[0][l] - c[0], y = b->x[1][l] - c[1], z = b->x[2][l] - c[2], r = b->x[3][l] - c[3];
            const double sum = x * x + y * y + z * z + r * r;
            out[l] = sum > least ? sum : least;
            nearest[l] = out[l] < nearest[l] ? out[l] : nearest[l];
        }
    }
}

/* Squared distances become w_i (d / d_i). @param[out] total W */
MS_VERSIONS static void weigh_fuzzily(double (*weight)[LANES], double total[LANES], const double nearest[LANES],
                                      size_t count, double power)
{
    for (int l = 0; l < LANES; l++) {
        total[l] = 0;
    }
    for (size_t i = 0; i < count; i++) {
        double *w = weight[i];
        for (int l = 0; l < LANES; l++) {
            const double ratio = nearest[l] / w[l], one = ms_power(ratio, power);
            w[l] = one * ratio;
            total[l] += one;
        }
    }
}

/* Squared distances become 1 for the first centre that is nearest, else 0. @param[out] total ones */
static void assign_nearest(double (*weight)[LANES], double total[LANES], const double nearest[LANES], size_t count)
{
    double left[LANES];
    for (int l = 0; l < LANES; l++) {
        left[l] = total[l] = 1;
    }
    for (size_t i = 0; i < count; i++) {
        double *w = weight[i];
        for (int l = 0; l < LANES; l++) {
            w[l] = w[l] > nearest[l] ? 0 : left[l];
            left[l] -= w[l];
        }
    }
}

/* Weights of a block's points for all centres, but for a factor of each point. */
static void weigh_block(weights *w, const ms_cluster *c, size_t which, const double (*centre)[AXES], size_t count,
                        double fuzzifier)
{
    measure_distances(w->of, w->nearest, &c->blocks[which], centre, count, c->least);
    if (fuzzifier > 1) {
        weigh_fuzzily(w->of, w->total, w->nearest, count, 1 / (fuzzifier - 1));
    } else {
        assign_nearest(w->of, w->total, w->nearest, count);
    }
}

/* Adds a block's weighted points to the sums of the centres. */
MS_VERSIONS static void add_weighted(double (*sum)[TERMS], double (*weight)[LANES], const double factor[LANES],
                                     const block *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double *w = weight[i];
        double term[TERMS][SUMS] = {{0}};
        for (int l = 0; l < LANES; l += SUMS) {
            for (int k = 0; k < SUMS; k++) {
                const double u = w[l + k] * factor[l + k];
                term[0][k] += u;
                term[1][k] += u * b->x[0][l + k];
                term[2][k] += u * b->x[1][l + k];
                term[3][k] += u * b->x[2][l + k];
                term[4][k] += u * b->x[3][l + k];
            }
        }
        for (int t = 0; t < TERMS; t++) {
            sum[i][t] += (term[t][0] + term[t][1]) + (term[t][2] + term[t][3]);
        }
    }
}

/* One block: its part of the sums, of the objective, and its farthest point. */
static void add_block(share *part, const work *w, double (*weight)[LANES], size_t which, const double (*centre)[AXES])
{
    const ms_cluster *c = w->cluster;
    const double m = w->rule->fuzzifier;
    const size_t left = c->count - which * LANES, points = left < LANES ? left : LANES;
    double factor[LANES];
    weights of = {.of = weight};
    weigh_block(&of, c, which, centre, w->count, m);
    for (size_t l = 0; l < LANES; l++) {
        factor[l] = ms_power(1 / of.total[l], m); /* W^-m */
    }
    for (size_t l = points; l < LANES; l++) {
        factor[l] = 0;
    }
    for (size_t l = 0; l < points; l++) {
        part->objective += of.nearest[l] * of.total[l] * factor[l];
        if (of.nearest[l] > part->farthest) {
            part->farthest = of.nearest[l];
            part->point = which * LANES + l;
        }
    }
    add_weighted(part->sum, weight, factor, &c->blocks[which], w->count);
}

/* All points; what the parts came to is put together in the first. */
static void pass_points(work *w, const double (*centre)[AXES])
{
    const size_t blocks = w->cluster->n_blocks;
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t p = 0; p < PARTS; p++) {
        share *part = &w->parts[p];
        part->sum = w->sum + p * w->count;
        part->objective = part->farthest = 0;
        memset(part->sum, 0, w->count * sizeof *part->sum);
        for (size_t b = p * blocks / PARTS; b < (p + 1) * blocks / PARTS; b++) {
            add_block(part, w, w->weight + (size_t)omp_get_thread_num() * w->count, b, centre);
        }
    }
    share *all = &w->parts[0];
    for (size_t p = 1; p < PARTS; p++) {
        const share *part = &w->parts[p];
        all->objective += part->objective;
        if (part->farthest > all->farthest) {
            all->farthest = part->farthest;
            all->point = part->point;
        }
        for (size_t i = 0; i < w->count; i++) {
            for (int t = 0; t < TERMS; t++) {
                all->sum[i][t] += part->sum[i][t];
            }
        }
    }
}

/* Moves the centres to the mean of what belongs to them; of those without anything one to the farthest
 * point. @return nonzero if one was moved so */
static int update_centres(double (*centre)[AXES], const work *w)
{
    const share *all = &w->parts[0];
    int moved = all->farthest <= w->cluster->least; /* no point is away from all centres */
    for (size_t i = 0; i < w->count; i++) {
        if (all->sum[i][0] > 1e-290) {
            for (int a = 0; a < AXES; a++) {
                centre[i][a] = all->sum[i][1 + a] / all->sum[i][0];
            }
        } else if (!moved) {
            get_point(centre[i], w->cluster, all->point);
            moved = 1;
        }
    }
    return moved && all->farthest > w->cluster->least;
}

/* To the minimum that the centres lead to. */
static ms_cluster_result descend_objective(double (*centre)[AXES], work *w)
{
    ms_cluster_result result = {.objective = HUGE_VAL};
    int going = 1;
    while (going && result.iterations < w->rule->iterations) {
        pass_points(w, (const double(*)[AXES])centre);
        const double before = result.objective;
        result.objective = w->parts[0].objective;
        result.iterations++;
        going = update_centres(centre, w) || before - result.objective > w->rule->tolerance * result.objective;
    }
    return result;
}

/* A centre that coincides with an earlier one; `count` if there is none. */
static size_t find_coincident(const double (*centre)[AXES], size_t count, double extent)
{
    const double near = COINCIDENT * COINCIDENT * extent * extent;
    for (size_t i = 1; i < count; i++) {
        for (size_t j = 0; j < i; j++) {
            if (squared_distance(centre[i], centre[j]) <= near) {
                return i;
            }
        }
    }
    return count;
}

/* Moves centres that coincide with others for as long as that lowers the objective. */
static void separate_coincident(ms_cluster_result *result, double (*centre)[AXES], double (*trial)[AXES], work *w)
{
    for (size_t t = 0; t < w->count; t++) {
        const size_t which = find_coincident((const double(*)[AXES])centre, w->count, w->cluster->extent);
        if (which == w->count || w->parts[0].farthest <= w->cluster->least) {
            return;
        }
        memcpy(trial, centre, w->count * sizeof *trial);
        get_point(trial[which], w->cluster, w->parts[0].point);
        const ms_cluster_result tried = descend_objective(trial, w);
        result->iterations += tried.iterations;
        if (!(tried.objective < result->objective)) {
            return;
        }
        result->objective = tried.objective;
        memcpy(centre, trial, w->count * sizeof *trial);
    }
}

ms_status ms_cluster_run(ms_cluster_result *result, double (*centre)[4], size_t count, const ms_cluster *cluster,
                         const ms_cluster_rule *rule, ms_error *err)
{
    if (count == 0 || !(rule->fuzzifier >= 1)) {
        return ms_fail(err, MS_ERR_ARG,
                       "%zu clusters with the fuzzifier %g; there must be one at least, and it "
                       "must be 1 or more",
                       count, rule->fuzzifier);
    }
    work w = {.cluster = cluster, .rule = rule, .count = count};
    w.sum = malloc(PARTS * count * sizeof *w.sum);
    w.weight = malloc((size_t)omp_get_max_threads() * count * sizeof *w.weight);
    double(*trial)[AXES] = malloc(count * sizeof *trial);
    ms_status status = MS_OK;
    if (w.sum && w.weight && trial) {
        ms_cluster_result reached = descend_objective(centre, &w);
        separate_coincident(&reached, centre, trial, &w);
        if (result) {
            *result = reached;
        }
    } else {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu clusters", count);
    }
    free(w.sum);
    free(w.weight);
    free(trial);
    return status;
}

/* The first point at which the sum of the chances exceeds a random part of it; the last with any. */
static size_t choose_by_chance(const double *chance, size_t count, double part)
{
    double total = 0, sum = 0;
    size_t chosen = 0;
    for (size_t p = 0; p < count; p++) {
        total += chance[p];
    }
    for (size_t p = 0; p < count && (sum <= part * total || chance[chosen] <= 0); p++) {
        sum += chance[p];
        chosen = chance[p] > 0 ? p : chosen;
    }
    return total > 0 ? chosen : (size_t)(part * (double)count);
}

ms_status ms_cluster_start(double (*centre)[4], size_t given, size_t wanted, const ms_cluster *cluster,
                           ms_cluster_spread spread, uint64_t seed, ms_error *err)
{
    double *square = malloc(cluster->count * sizeof *square), *chance = malloc(cluster->count * sizeof *chance);
    gsl_rng *random = ms_random_new((unsigned long)seed);
    ms_status status = MS_OK;
    if (!square || !chance || !random) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to start %zu clusters", wanted);
    } else {
        for (size_t p = 0; p < cluster->count; p++) {
            square[p] = HUGE_VAL;
        }
        for (size_t i = 0; i < wanted; i++) {
            for (size_t p = 0; i >= given && p < cluster->count; p++) {
                chance[p] = spread == MS_CLUSTER_FAR && i > 0 ? square[p] : square[p] > 0;
            }
            if (i >= given) {
                get_point(centre[i], cluster, choose_by_chance(chance, cluster->count, gsl_rng_uniform(random)));
            }
            for (size_t p = 0; p < cluster->count; p++) {
                double point[AXES];
                get_point(point, cluster, p);
                square[p] = fmin(square[p], squared_distance(point, centre[i]));
            }
        }
    }
    free(square);
    free(chance);
    ms_random_free(random);
    return status;
}

ms_status ms_cluster_memberships(double *u, const double (*centre)[4], size_t count, const ms_cluster *cluster,
                                 double fuzzifier, ms_error *err)
{
    weights w = {.of = malloc((count + 1) * sizeof *w.of)};
    if (!w.of) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu clusters", count);
    }
    for (size_t p = 0; p < cluster->count; p++) {
        if (p % LANES == 0) {
            weigh_block(&w, cluster, p / LANES, centre, count, fuzzifier);
        }
        for (size_t i = 0; i < count; i++) { /* w_i (d / d_i) is w_i^m */
            u[p * count + i] = pow(w.of[i][p % LANES], 1 / fuzzifier) / w.total[p % LANES];
        }
    }
    free(w.of);
    return MS_OK;
}
