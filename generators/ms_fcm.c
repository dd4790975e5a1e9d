/*
 * F. Westbrink, A. Schwung, Improved approximation of arbitrary shapes in DEM simulations with
 * multi-spheres, COMPLAS XIV (2017). Section, equation and algorithm numbers are of that paper;
 * docs/methods/fcm.md says what it leaves open and how it was decided.
 */
#include "ms_fcm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_cluster.h"
#include "ms_cover.h"
#include "ms_fill.h"
#include "ms_metrics.h"
#include "ms_search.h"

enum {
    NODES_COVERED,
    FILLING,
    TRIES,
    NORM,
    OFFSET,
    CLUSTERING,
    FUZZIFIER,
    SCALE_RADIUS,
    START,
    RESTARTS,
    RADIUS,
    OFF_VOLUME
};
enum { CLUSTERING_FUZZY, CLUSTERING_KMEANS };
enum { RADIUS_NODE, RADIUS_MEAN };

static const ms_option OPTIONS[] = {
    [NODES_COVERED] = {"nodes-covered", MS_OPTION_REAL, 0.9, 0, 1, NULL, NULL,
                       "share of the nodes that the filling has to touch (section 3)"},
    [FILLING] = {"filling", MS_OPTION_INTEGER, 5000, 0, 1e7, NULL, NULL,
                 "spheres that are clustered: the first so many that were drawn; 0: those it took to cover the nodes "
                 "(the paper)"},
    [TRIES] = {"tries", MS_OPTION_INTEGER, 1e7, 1, 1e9, NULL, NULL, "centres drawn at most to cover the nodes"},
    [NORM] = {"norm", MS_OPTION_CHOICE, MS_NORM_EUCLIDEAN, 0, 0, "euclidean|sum", NULL,
              "distance from a centre to the nodes; sum: eq. 1 as it is printed, |x| + |y| + |z|, up to 1.7 times as "
              "large"},
    [OFFSET] = {"radius-offset", MS_OPTION_REAL, 0, -100, 100, NULL, "voxels", "added to every radius (section 3)"},
    [CLUSTERING] = {"clustering", MS_OPTION_CHOICE, CLUSTERING_FUZZY, 0, 0, "fuzzy|kmeans", NULL,
                    "fuzzy c-means (eq. 4) or k-means (eq. 3)"},
    [FUZZIFIER] = {"fuzzifier", MS_OPTION_REAL, 0, 0, 100, NULL, NULL,
                   "m of eq. 4, from 1.01; 0: 1.5, 2, 2.5 and 3 are tried, and the best is kept (algorithm 1)"},
    [SCALE_RADIUS] = {"scale-radius", MS_OPTION_REAL, 1, 1e-3, 1e3, NULL, NULL,
                      "weighs radii against coordinates when distances between spheres are measured"},
    [START] = {"start", MS_OPTION_CHOICE, MS_CLUSTER_FAR, 0, 0, "far|random", NULL,
               "centres to begin with: spheres far from each other (k-means++), or any (the paper)"},
    [RESTARTS] = {"restarts", MS_OPTION_INTEGER, 1, 1, 1000, NULL, NULL,
                  "starts, of which the one with the least objective is kept"},
    [RADIUS] = {"radius", MS_OPTION_CHOICE, RADIUS_NODE, 0, 0, "node|mean", NULL,
                "of a cluster: mean of its spheres' radii (the paper), or, where it is larger, the distance from its "
                "centre to the nearest node"},
    [OFF_VOLUME] = {"off-volume", MS_OPTION_REAL, 0, 0, 2, NULL, NULL,
                    "ends at this volume of the union / of the shape (eq. 2); 0: 0.9, as the paper, where no number "
                    "and no measure is asked for, else not at all"},
    {0},
};

/* Values of m between which the best is sought (section 5.1). */
static const double SWEEP[] = {1.5, 2, 2.5, 3};

/* The clustering ends when the objective falls by less than this part of itself, or after as many steps. */
static const double TOLERANCE = 1e-4;
enum { ITERATIONS = 500 };

/* The volume criterion where nothing else is asked for (section 7). */
static const double DEFAULT_OFF_VOLUME = 0.9;

/* Spheres whose centres and radii differ by less, in voxels, are one. */
static const double SAME = 0.01;

typedef struct fcm {
    const ms_run *run;
    ms_nodes nodes;
    ms_cluster *cluster;
    size_t filled;     /* spheres to cluster */
    int dropped;       /* some were smaller than the least radius */
    double off_volume; /* to be reached; 0: not asked for */
} fcm;

/* Spheres, and what they are worth. */
typedef struct attempt {
    ms_ball *ball;
    size_t count;
    double dice;
    ms_stop_reason reason;
} attempt;

static double option(const fcm *f, int which)
{
    return f->run->settings->value[which];
}

/* Keeps the first spheres that are large enough. */
static void drop_small(ms_ball *ball, size_t *count, fcm *f)
{
    const double least = f->run->stop.radius / f->run->target->grid.h;
    const size_t wanted = option(f, FILLING) > 0 ? (size_t)option(f, FILLING) : *count;
    size_t kept = 0;
    for (size_t b = 0; b < *count && kept < wanted; b++) {
        if (ball[b].radius > 0 && !(ball[b].radius < least)) {
            ball[kept++] = ball[b];
        }
    }
    f->dropped = kept < *count && kept < wanted;
    *count = kept;
}

/* The points (x, y, z, r) that are clustered. */
static ms_status make_points(fcm *f, const ms_ball *ball, size_t count, ms_error *err)
{
    double (*point)[4] = malloc((count + 1) * sizeof *point);
    ms_status status = MS_OK;
    if (!point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to cluster %zu spheres; lower filling", count);
    }
    for (size_t b = 0; b < count; b++) {
        memcpy(point[b], ball[b].centre, sizeof ball[b].centre);
        point[b][3] = option(f, SCALE_RADIUS) * ball[b].radius;
    }
    f->filled = count;
    if (count > 0) {
        status = ms_cluster_build(&f->cluster, (const double (*)[4])point, count, err);
    }
    free(point);
    return status;
}

static ms_status fill(fcm *f, ms_error *err)
{
    const ms_fill_rule rule = {.nodes_covered = option(f, NODES_COVERED),
                               .least = (size_t)option(f, FILLING),
                               .norm = (ms_norm)option(f, NORM),
                               .offset = option(f, OFFSET),
                               .tries = (size_t)option(f, TRIES),
                               .seed = f->run->seed};
    ms_ball *ball = NULL;
    size_t count = 0;
    ms_status status = ms_nodes_of_target(&f->nodes, f->run->target, err);
    if (status == MS_OK) {
        status = ms_fill(&ball, &count, f->run->target, &f->nodes, &rule, err);
    }
    if (status == MS_OK) {
        drop_small(ball, &count, f);
        status = make_points(f, ball, count, err);
    }
    free(ball);
    return status;
}

/* The best start for n clusters. */
static ms_status start(double (*centre)[4], size_t n, const ms_cluster_rule *rule, const fcm *f, ms_error *err)
{
    double (*trial)[4] = malloc(n * sizeof *trial), least = HUGE_VAL;
    ms_status status = trial ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu clusters", n);
    for (size_t r = 0; status == MS_OK && r < (size_t)option(f, RESTARTS); r++) {
        ms_cluster_result result;
        status = ms_cluster_start(trial, 0, n, f->cluster, (ms_cluster_spread)option(f, START), f->run->seed + r, err);
        if (status == MS_OK) {
            status = ms_cluster_run(&result, trial, n, f->cluster, rule, err);
        }
        if (status == MS_OK && (r == 0 || result.objective < least)) {
            least = result.objective;
            memcpy(centre, trial, n * sizeof *trial);
        }
    }
    free(trial);
    return status;
}

/* The distance from a centre to the nearest node; 0 outside. */
static double free_radius(const fcm *f, const double centre[3])
{
    const ms_grid *grid = &f->run->target->grid;
    double distance;
    const size_t voxel = ms_grid_index(grid, (int)rint(centre[0]), (int)rint(centre[1]), (int)rint(centre[2]));
    if (!grid->inside[voxel]) {
        return 0;
    }
    ms_nodes_nearest(&distance, &f->nodes, centre, (ms_norm)option(f, NORM));
    return distance + option(f, OFFSET);
}

static int is_new(const ms_ball *ball, const attempt *a)
{
    for (size_t b = 0; b < a->count; b++) {
        const ms_ball *other = &a->ball[b];
        if (fabs(other->centre[0] - ball->centre[0]) < SAME && fabs(other->centre[1] - ball->centre[1]) < SAME &&
            fabs(other->centre[2] - ball->centre[2]) < SAME && fabs(other->radius - ball->radius) < SAME) {
            return 0;
        }
    }
    return 1;
}

/* Centres of clusters as spheres, those that coincide as one. Means of radii are no smaller than the least
 * but for rounding. */
static void make_spheres(attempt *a, const double (*centre)[4], size_t n, const fcm *f)
{
    const double least = fmax(0, f->run->stop.radius / f->run->target->grid.h);
    a->count = 0;
    for (size_t i = 0; i < n; i++) {
        ms_ball ball = {.radius = fmax(centre[i][3] / option(f, SCALE_RADIUS), least)};
        memcpy(ball.centre, centre[i], sizeof ball.centre);
        if (option(f, RADIUS) == RADIUS_NODE) {
            ball.radius = fmax(ball.radius, free_radius(f, ball.centre));
        }
        if (is_new(&ball, a)) {
            a->ball[a->count++] = ball;
        }
    }
}

/* Scores the spheres, and says why they are enough; MS_STOP_NOT if they are not. */
static ms_status judge(attempt *a, const fcm *f, ms_error *err)
{
    const ms_target *target = f->run->target;
    ms_raster raster;
    ms_tally sum = {0};
    ms_status status = ms_raster_alloc(&raster, &target->grid, target->rule, err);
    if (status == MS_OK) {
        status = ms_raster_add(&raster, a->ball, a->count, err);
    }
    for (size_t b = 0; status == MS_OK && b < raster.n_balls; b++) {
        ms_tally_add(&sum, &raster.tally[b]);
    }
    if (status == MS_OK) {
        const ms_score score = ms_score_of(&sum, target->voxels);
        a->dice = score.dice;
        a->reason = ms_stop_reached(&f->run->stop, target, &sum, a->count);
        if (a->reason == MS_STOP_NOT && f->off_volume > 0 && score.off_volume >= f->off_volume) {
            a->reason = MS_STOP_OFF_VOLUME;
        }
        if (f->run->progress) {
            f->run->progress(f->run->progress_context, a->count, a->dice);
        }
    }
    ms_raster_free(&raster);
    return status;
}

/* Enough spheres are better than too few, then the lower mismatch. */
static int is_better(const attempt *a, const attempt *b)
{
    if ((a->reason == MS_STOP_NOT) != (b->reason == MS_STOP_NOT)) {
        return a->reason != MS_STOP_NOT;
    }
    return a->dice < b->dice;
}

/* One value of m after the other, each from the centres of the one before. */
static ms_status sweep(attempt *best, attempt *next, double (*centre)[4], size_t n, const fcm *f, ms_error *err)
{
    const int fuzzy = option(f, CLUSTERING) == CLUSTERING_FUZZY, all = fuzzy && option(f, FUZZIFIER) == 0;
    ms_cluster_rule rule = {.fuzzifier = fuzzy ? option(f, FUZZIFIER) : 1,
                            .tolerance = TOLERANCE,
                            .iterations = ITERATIONS};
    ms_status status = MS_OK;
    for (size_t s = 0; status == MS_OK && s < (all ? sizeof SWEEP / sizeof *SWEEP : 1); s++) {
        rule.fuzzifier = all ? SWEEP[s] : rule.fuzzifier;
        status = s == 0 ? start(centre, n, &rule, f, err) : ms_cluster_run(NULL, centre, n, f->cluster, &rule, err);
        if (status == MS_OK) {
            make_spheres(next, (const double (*)[4])centre, n, f);
            status = judge(next, f, err);
        }
        if (status == MS_OK && (s == 0 || is_better(next, best))) {
            const attempt swap = *best;
            *best = *next;
            *next = swap;
        }
    }
    return status;
}

static ms_status add_sphere(ms_clump *clump, const ms_ball *ball, const ms_run *run, ms_error *err)
{
    ms_sphere sphere;
    ms_target_from_voxels(sphere.centre, &sphere.radius, &run->target->grid, ball->centre, ball->radius);
    sphere.radius = fmax(sphere.radius, run->stop.radius);
    return ms_clump_add(clump, &sphere, err);
}

/* The spheres by the voxels of the shape that each adds, those that add none as they come. */
static ms_status order(ms_clump *clump, const attempt *a, const ms_run *run, ms_error *err)
{
    ms_cover *cover = NULL;
    uint8_t *taken = calloc(a->count + 1, sizeof *taken);
    size_t which;
    ms_status status = taken ? ms_cover_build(&cover, &run->target->grid, a->ball, a->count, 0, err)
                             : ms_fail(err, MS_ERR_NOMEM, "no memory to order %zu spheres", a->count);
    while (status == MS_OK && ms_cover_next(&which, cover) > 0) {
        taken[which] = 1;
        status = add_sphere(clump, &a->ball[which], run, err);
    }
    for (size_t b = 0; status == MS_OK && b < a->count; b++) {
        if (!taken[b]) {
            status = add_sphere(clump, &a->ball[b], run, err);
        }
    }
    ms_cover_free(cover);
    free(taken);
    return status;
}

/* The clump of n spheres. */
static ms_status solve(void *context, ms_clump *clump, ms_stop_reason *reason, size_t n, ms_error *err)
{
    const fcm *f = context;
    const size_t clusters = n < f->filled ? n : f->filled;
    attempt best = {.reason = MS_STOP_NOT}, next = {.reason = MS_STOP_NOT};
    double (*centre)[4] = malloc((clusters + 1) * sizeof *centre);
    best.ball = malloc((clusters + 1) * sizeof *best.ball);
    next.ball = malloc((clusters + 1) * sizeof *next.ball);
    ms_status status = MS_OK;
    if (!centre || !best.ball || !next.ball) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", n);
    } else if (clusters > 0) {
        status = sweep(&best, &next, centre, clusters, f, err);
    }
    if (status == MS_OK) {
        status = order(clump, &best, f->run, err);
    }
    *reason = best.reason;
    if (best.reason == MS_STOP_NOT && clump->n_spheres < n) {
        *reason = f->dropped ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    }
    free(centre);
    free(best.ball);
    free(next.ball);
    return status;
}

static int has_measure(const ms_stop *stop)
{
    return stop->eta >= 0 || stop->dice >= 0 || stop->coverage >= 0 || stop->inertia >= 0;
}

static ms_status generate(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    const ms_stop *stop = &run->stop;
    fcm f = {.run = run, .off_volume = run->settings->value[OFF_VOLUME]};
    const double m = option(&f, FUZZIFIER);
    if (m != 0 && m < 1.01) {
        return ms_fail(err, MS_ERR_ARG, "fuzzifier=%g is too small; give 1.01 or more, or clustering=kmeans", m);
    }
    if (f.off_volume == 0 && stop->spheres == 0 && !has_measure(stop)) {
        f.off_volume = DEFAULT_OFF_VOLUME;
    }
    ms_status status = fill(&f, err);
    if (status == MS_OK && (has_measure(stop) || f.off_volume > 0)) {
        const size_t most = stop->spheres > 0 ? stop->spheres : MS_CLUMP_MAX_SPHERES;
        status = ms_search(clump, reason, most, solve, &f, err);
    } else if (status == MS_OK) {
        status = solve(&f, clump, reason, stop->spheres, err);
    }
    ms_cluster_free(f.cluster);
    ms_nodes_free(&f.nodes);
    return status;
}

const ms_generator ms_generator_fcm = {
    .name = "fcm",
    .summary = "random spheres that touch the surface, put together by fuzzy c-means",
    .source = "F. Westbrink, A. Schwung, COMPLAS XIV (2017)",
    .nested = 0,
    .options = OPTIONS,
    .generate = generate,
};
