/*
 * F. Westbrink, A. Schwung, Improved approximation of arbitrary shapes in DEM simulations with
 * multi-spheres, COMPLAS XIV (2017). Section, equation and algorithm numbers are of that paper;
 * docs/methods/fcm.md says what it leaves open and how it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/ms_metrics.h"
#include "mesh/ms_hull.h"
#include "ms_cluster.h"
#include "ms_long_edges.h"
#include "ms_random_spheres.h"
#include "shared/ms_bisect_count.h"
#include "shared/ms_judge.h"
#include "shared/ms_order.h"

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
    OFF_VOLUME,
    VOLUME,
    NODES,
    COVERS,
    SEARCH
};
enum { CLUSTERING_FUZZY, CLUSTERING_KMEANS };
enum { RADIUS_NODE, RADIUS_MEAN };
enum { VOLUME_SHAPE, VOLUME_HULL };
enum { NODES_THINNED, NODES_ALL };
enum { SEARCH_HALVES, SEARCH_UP };

static const ms_option OPTIONS[] = {
    [NODES_COVERED] = {"nodes-covered", MS_OPTION_REAL, 0.9, 0, 1, NULL, NULL,
                       "share of the nodes that the filling has to touch (section 3)"},
    [FILLING] = {"filling", MS_OPTION_INTEGER, 10000, 0, 1e7, NULL, NULL,
                 "spheres that are clustered: the first so many that were drawn; 0: those it took to cover the nodes "
                 "(the paper)"},
    [TRIES] = {"tries", MS_OPTION_INTEGER, 1e7, 1, 1e8, NULL, NULL, "centres drawn at most to cover the nodes"},
    [NORM] = {"norm", MS_OPTION_CHOICE, MS_NORM_EUCLIDEAN, 0, 0, "euclidean|sum", NULL,
              "distance from a centre to the nodes; sum: eq. 1 as it is printed, |x| + |y| + |z|, up to 1.7 times as "
              "large"},
    [OFFSET] = {"radius-offset", MS_OPTION_REAL, 0, -100, 100, NULL, "voxels", "added to every radius (section 3)"},
    [CLUSTERING] = {"clustering", MS_OPTION_CHOICE, CLUSTERING_FUZZY, 0, 0, "fuzzy|kmeans", NULL,
                    "fuzzy c-means (eq. 4) or k-means (eq. 3)"},
    [FUZZIFIER] = {"fuzzifier", MS_OPTION_REAL, 0, 0, 100, NULL, NULL,
                   "m of eq. 4, from 1.01; 0: the best from 1.5 to 3, in steps of 0.25 (algorithm 1)"},
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
    [VOLUME] = {"volume", MS_OPTION_CHOICE, VOLUME_SHAPE, 0, 0, "shape|hull", NULL,
                "of the shape in eq. 2: its own, or that of its convex hull (section 4)"},
    [NODES] = {"nodes", MS_OPTION_CHOICE, NODES_THINNED, 0, 0, "thinned|all", NULL,
               "that nodes-covered counts; thinned: where there are more than `filling`, one in each cube of the size "
               "of a filling sphere's share, d_eq / filling^(1/3)"},
    [COVERS] = {"covers", MS_OPTION_CHOICE, 0, 0, 0, "touched|within", NULL,
                "nodes that a filling sphere covers: the one that it touches, or all within it (section 3, figure 1)"},
    [SEARCH] =
        {"search", MS_OPTION_CHOICE, SEARCH_HALVES, 0, 0, "halves|up", NULL,
         "for the number of clusters that reaches a measure: doubled, then by halves; or one more each time, from "
         "one up (section 4)"},
    {0},
};

/* Values of m between which the best is sought (section 5.1). */
static const double SWEEP[] = {1.5, 1.75, 2, 2.25, 2.5, 2.75, 3};

/* Nearer to 1 nothing changes but the time. */
static const double LEAST_FUZZIFIER = 1.01;

/* The clustering ends when the objective falls by less than this part of itself, or after as many steps. */
static const double TOLERANCE = 1e-3;
enum { ITERATIONS = 500 };

/* The volume criterion where nothing else is asked for (section 7). */
static const double DEFAULT_OFF_VOLUME = 0.9;

/* Spheres whose centres and radii differ by less, in voxels, are one. */
static const double SAME = 0.01;

typedef struct fcm {
    const ms_run *run;
    ms_random_spheres_rule rule;
    ms_nodes nodes;
    ms_cluster *cluster;
    size_t filled;     /* spheres to cluster */
    int dropped;       /* some were smaller than the least radius */
    double off_volume; /* to be reached, relative to the shape's own volume; 0: not asked for */
    double (*few)[4];  /* centres of the last number of clusters that was not enough, at the first m */
    size_t n_few;
} fcm;

/* Spheres, and what they are worth. */
typedef struct attempt {
    ms_ball *ball;
    size_t count;
    double dice;
    ms_stop_reason reason;
} attempt;

static double fcm_option(const fcm *f, int which)
{
    return f->run->settings->value[which];
}

/* Keeps the first spheres that are large enough. */
static void drop_small_balls(ms_ball *ball, size_t *count, fcm *f)
{
    const double least = f->run->stop.radius / f->run->target->grid.h;
    const size_t wanted = fcm_option(f, FILLING) > 0 ? (size_t)fcm_option(f, FILLING) : *count;
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
    double(*point)[4] = malloc((count + 1) * sizeof *point);
    ms_status status = MS_OK;
    if (!point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to cluster %zu spheres; lower filling", count);
    }
    for (size_t b = 0; b < count; b++) {
        memcpy(point[b], ball[b].centre, sizeof ball[b].centre);
        point[b][3] = fcm_option(f, SCALE_RADIUS) * ball[b].radius;
    }
    f->filled = count;
    if (count > 0) {
        status = ms_cluster_build(&f->cluster, (const double(*)[4])point, count, err);
    }
    free(point);
    return status;
}

/* Nodes nearer to each other than the spheres of the filling need not be told apart. 0: all count. */
static double thinning_edge(const fcm *f)
{
    const double filling = fcm_option(f, FILLING);
    const ms_target *target = f->run->target;
    const int is_thinned = fcm_option(f, NODES) == NODES_THINNED && filling > 0 && (double)f->nodes.count > filling;
    return is_thinned ? 2 * ms_target_equivalent_radius(target) / target->grid.h / cbrt(filling) : 0;
}

static void remark_thinning(const fcm *f, size_t counted)
{
    if (counted < f->nodes.count) {
        ms_generator_remark(f->run,
                            "%zu nodes are thinned to %zu, one in each cube of edge %.2g, the size of a filling "
                            "sphere's share: nodes-covered counts these; nodes=all counts each, and takes longer",
                            f->nodes.count, counted, f->rule.thinned * f->run->target->grid.h);
    }
}

static ms_status fill_shape(fcm *f, ms_error *err)
{
    ms_status status = ms_nodes_of_target(&f->nodes, f->run->target, err);
    f->rule = (ms_random_spheres_rule){.nodes_covered = fcm_option(f, NODES_COVERED),
                                       .thinned = thinning_edge(f),
                                       .within = fcm_option(f, COVERS) != 0,
                                       .least = (size_t)fcm_option(f, FILLING),
                                       .norm = (ms_norm)fcm_option(f, NORM),
                                       .offset = fcm_option(f, OFFSET),
                                       .tries = (size_t)fcm_option(f, TRIES),
                                       .seed = f->run->seed,
                                       .progress = f->run->progress,
                                       .progress_context = f->run->progress_context};
    ms_ball *ball = NULL;
    size_t count = 0, counted;
    if (status == MS_OK) {
        status = ms_random_spheres(&ball, &count, &counted, f->run->target, &f->nodes, &f->rule, err);
    }
    if (status == MS_OK) {
        remark_thinning(f, counted);
        drop_small_balls(ball, &count, f);
        status = make_points(f, ball, count, err);
    }
    free(ball);
    return status;
}

/* The best start for n clusters: the first one goes on from fewer. */
static ms_status start_centres(double (*centre)[4], size_t n, const ms_cluster_rule *rule, const fcm *f, ms_error *err)
{
    double(*trial)[4] = malloc(n * sizeof *trial), least = HUGE_VAL;
    ms_status status = trial ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu clusters", n);
    for (size_t r = 0; status == MS_OK && r < (size_t)fcm_option(f, RESTARTS); r++) {
        ms_cluster_result result;
        const size_t given = r == 0 && f->n_few < n ? f->n_few : 0;
        if (given > 0) {
            memcpy(trial, f->few, given * sizeof *trial);
        }
        status = ms_cluster_start(trial, given, n, f->cluster, (ms_cluster_spread)fcm_option(f, START),
                                  f->run->seed + r, err);
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

/* The radius of a filling sphere about a centre; 0 outside. */
static double free_radius(const fcm *f, const double centre[3])
{
    const ms_grid *grid = &f->run->target->grid;
    const size_t voxel = ms_grid_index(grid, (int)rint(centre[0]), (int)rint(centre[1]), (int)rint(centre[2]));
    return grid->inside[voxel] ? ms_random_spheres_radius(NULL, centre, f->run->target, &f->nodes, &f->rule) : 0;
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
        ms_ball ball = {.radius = fmax(centre[i][3] / fcm_option(f, SCALE_RADIUS), least)};
        memcpy(ball.centre, centre[i], sizeof ball.centre);
        if (fcm_option(f, RADIUS) == RADIUS_NODE) {
            ball.radius = fmax(ball.radius, free_radius(f, ball.centre));
        }
        if (is_new(&ball, a)) {
            a->ball[a->count++] = ball;
        }
    }
}

/* Scores the spheres, and says why they are enough; MS_STOP_NOT if they are not. */
static ms_status judge_attempt(attempt *a, const fcm *f, ms_error *err)
{
    ms_score score;
    const ms_status status = ms_judge_union(&score, &a->reason, f->run, a->ball, a->count, err);
    if (status == MS_OK) {
        a->dice = score.dice;
        if (a->reason == MS_STOP_NOT && f->off_volume > 0 && score.off_volume >= f->off_volume) {
            a->reason = MS_STOP_OFF_VOLUME;
        }
    }
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

/* What a number of clusters is worked out in. */
typedef struct trials {
    size_t n;
    double (*first)[4];  /* centres at the first m */
    double (*centre)[4]; /* at this m */
    attempt best, next;
} trials;

static void close_trials(trials *t)
{
    free(t->first);
    free(t->centre);
    free(t->best.ball);
    free(t->next.ball);
}

static ms_status open_trials(trials *t, size_t n, ms_error *err)
{
    *t = (trials){.n = n};
    t->first = calloc(n + 1, sizeof *t->first);
    t->centre = calloc(n + 1, sizeof *t->centre);
    t->best.ball = calloc(n + 1, sizeof *t->best.ball);
    t->next.ball = calloc(n + 1, sizeof *t->next.ball);
    if (!t->first || !t->centre || !t->best.ball || !t->next.ball) {
        close_trials(t);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu clusters", n);
    }
    return MS_OK;
}

/* The clusters at one value of m: from a start, or from the centres at the last one. */
static ms_status cluster_points(trials *t, double m, int is_first, const fcm *f, ms_error *err)
{
    const ms_cluster_rule rule = {.fuzzifier = m, .tolerance = TOLERANCE, .iterations = ITERATIONS};
    if (!is_first) {
        return ms_cluster_run(NULL, t->centre, t->n, f->cluster, &rule, err);
    }
    const ms_status status = start_centres(t->first, t->n, &rule, f, err);
    memcpy(t->centre, t->first, t->n * sizeof *t->centre);
    return status;
}

/* One value of m after the other; the best spheres are kept. */
static ms_status sweep_fuzzifier(trials *t, const fcm *f, ms_error *err)
{
    const double given = fcm_option(f, CLUSTERING) == CLUSTERING_KMEANS ? 1 : fcm_option(f, FUZZIFIER);
    const size_t values = given > 0 ? 1 : sizeof SWEEP / sizeof *SWEEP;
    ms_status status = MS_OK;
    for (size_t s = 0; status == MS_OK && s < values; s++) {
        status = ms_generator_stage(f->run, "clusters", (double)NAN, err);
        if (status == MS_OK) {
            status = cluster_points(t, given > 0 ? given : SWEEP[s], s == 0, f, err);
        }
        if (status == MS_OK) {
            make_spheres(&t->next, (const double(*)[4])t->centre, t->n, f);
            status = judge_attempt(&t->next, f, err);
        }
        if (status == MS_OK && (s == 0 || is_better(&t->next, &t->best))) {
            const attempt swap = t->best;
            t->best = t->next;
            t->next = swap;
        }
    }
    return status;
}

/* Where more clusters start from. */
static void remember_centres(fcm *f, trials *t)
{
    double(*swap)[4] = f->few;
    f->few = t->first;
    f->n_few = t->n;
    t->first = swap;
}

/* The clump of n spheres; ms_bisect_count_solve. */
static ms_status make_clump_of(void *context, ms_clump *clump, ms_stop_reason *reason, size_t n, ms_error *err)
{
    fcm *f = context;
    trials t;
    ms_status status = open_trials(&t, n < f->filled ? n : f->filled, err);
    if (status != MS_OK) {
        return status;
    }
    if (t.n > 0) {
        status = sweep_fuzzifier(&t, f, err);
    }
    if (status == MS_OK) {
        status = ms_order_by_gain(clump, t.best.ball, t.best.count, f->run, err);
    }
    *reason = t.best.reason;
    if (*reason == MS_STOP_NOT) {
        remember_centres(f, &t);
        if (t.n < n) {
            *reason = f->dropped ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
        }
    }
    close_trials(&t);
    return status;
}

/* One cluster more each time, until they are enough or more would not help. */
static ms_status search_upward(ms_clump *clump, ms_stop_reason *reason, size_t most, fcm *f, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t n = 1; n <= most && *reason == MS_STOP_NOT && status == MS_OK; n++) {
        ms_clump_free(clump);
        status = make_clump_of(f, clump, reason, n, err);
    }
    if (*reason == MS_STOP_NOT) {
        *reason = MS_STOP_SPHERES;
    }
    return status;
}

/* The volume of the nodes' convex hull in voxels. Those of a volume are voxels, and have eight corners. */
static ms_status find_hull_volume(double *volume, const fcm *f, ms_error *err)
{
    const size_t corners = f->run->target->mesh ? 1 : 8, count = corners * f->nodes.count;
    double(*point)[3] = malloc((count + 1) * sizeof *point);
    ms_mesh hull = {0};
    ms_body body = {0};
    ms_status status = point ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the hull of %zu points", count);
    for (size_t p = 0; p < count && status == MS_OK; p++) {
        for (int a = 0; a < 3; a++) {
            const double half = corners == 1 ? 0 : (p >> a & 1) != 0 ? 0.5 : -0.5;
            point[p][a] = f->nodes.at[p / corners][a] + half;
        }
    }
    if (status == MS_OK) {
        status = ms_hull_build(&hull, (const double(*)[3])point, count, err);
    }
    if (status == MS_OK) {
        status = ms_inertia_mesh(&body, &hull, err);
    }
    *volume = body.volume;
    ms_mesh_free(&hull);
    free(point);
    return status;
}

/* The volume that is asked for of the hull, as one of the shape. */
static ms_status ask_of_hull(fcm *f, ms_error *err)
{
    double volume;
    const ms_status status = find_hull_volume(&volume, f, err);
    if (status == MS_OK) {
        f->off_volume *= volume / (double)f->run->target->voxels;
    }
    return status;
}

/* A number is solved for; for a measure it is sought. */
static ms_status make_clump(ms_clump *clump, ms_stop_reason *reason, fcm *f, ms_error *err)
{
    const ms_stop *stop = &f->run->stop;
    if (f->off_volume == 0 && stop->spheres == 0 && !ms_stop_has_measure(stop)) {
        f->off_volume = DEFAULT_OFF_VOLUME;
    }
    if (f->off_volume > 0 && fcm_option(f, VOLUME) == VOLUME_HULL) {
        const ms_status asked = ask_of_hull(f, err);
        if (asked != MS_OK) {
            return asked;
        }
    }
    if (ms_stop_has_measure(stop) || f->off_volume > 0) {
        const size_t most = stop->spheres > 0 ? stop->spheres : MS_CLUMP_MAX_SPHERES;
        return fcm_option(f, SEARCH) == SEARCH_UP ? search_upward(clump, reason, most, f, err)
                                                  : ms_bisect_count(clump, reason, most, make_clump_of, f, err);
    }
    const ms_status status = make_clump_of(f, clump, reason, stop->spheres, err);
    if (*reason == MS_STOP_NOT) {
        *reason = MS_STOP_EXHAUSTED; /* some clusters coincide */
    }
    return status;
}

static ms_status generate_by_fcm(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    fcm f = {.run = run, .off_volume = run->settings->value[OFF_VOLUME]};
    const double m = fcm_option(&f, FUZZIFIER);
    if (m != 0 && m < LEAST_FUZZIFIER) {
        return ms_fail(err, MS_ERR_ARG, "fuzzifier=%g is too small; give %g or more, or clustering=kmeans", m,
                       LEAST_FUZZIFIER);
    }
    ms_status status = fill_shape(&f, err);
    if (status == MS_OK) {
        status = make_clump(clump, reason, &f, err);
    }
    if (status == MS_OK) {
        ms_long_edges_remark(run, clump->n_spheres);
    }
    free(f.few);
    ms_cluster_free(f.cluster);
    ms_nodes_free(&f.nodes);
    return status;
}

const ms_generator ms_generator_fcm = {
    .name = "fcm",
    .summary = "random spheres that touch the surface, put together by fuzzy c-means",
    .source = "F. Westbrink, A. Schwung, COMPLAS XIV (2017)",
    .nested = 0,
    .bytes_per_voxel = 5,
    .options = OPTIONS,
    .generate = generate_by_fcm,
};
