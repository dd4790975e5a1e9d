#include "ms_cut_cover.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

#include "shared/ms_overlap.h"
#include "voxel/ms_cut_left.h"

#define NEVER UINT64_MAX

enum { MOST_AT_ONCE = 64 };

/* A candidate and what it would cover. */
typedef struct cut_bound {
    int64_t weight;   /* exact when it was counted, an upper bound before and since */
    uint64_t counted; /* how many cells had been covered by then; NEVER */
    int waits;        /* it overlaps no ball taken so far (connected) */
} cut_bound;

struct ms_cut_cover {
    const ms_ball *candidate;
    size_t count;
    int connected;
    uint32_t n_taken;
    ms_cut_left *left;
    ms_cut_taken *taken; /* what was covered last */
    cut_bound *bound;    /* of each candidate */
    uint32_t *winner; /* a tournament: winner[m] of winner[2 m] and winner[2 m + 1]; the last `leaves` are candidates */
    size_t leaves;
};

static int64_t bound_of(const ms_cut_cover *cover, uint32_t c)
{
    return c < cover->count && !cover->bound[c].waits ? cover->bound[c].weight : 0;
}

static uint32_t find_better(const ms_cut_cover *cover, uint32_t a, uint32_t b)
{
    const int64_t one = bound_of(cover, a), other = bound_of(cover, b);
    if (one != other) {
        return one > other ? a : b;
    }
    if (one > 0 && cover->candidate[a].radius != cover->candidate[b].radius) {
        return cover->candidate[a].radius > cover->candidate[b].radius ? a : b;
    }
    return a < b ? a : b;
}

static void play(ms_cut_cover *cover, size_t match)
{
    cover->winner[match] = find_better(cover, cover->winner[2 * match], cover->winner[2 * match + 1]);
}

/* The bound of a candidate has changed. */
static void replay(ms_cut_cover *cover, uint32_t c)
{
    for (size_t match = (cover->leaves + c) / 2; match > 0; match /= 2) {
        play(cover, match);
    }
}

/* After the first ball all others wait for one that they overlap. */
static void admit_cut_neighbours(ms_cut_cover *cover, const ms_ball *ball)
{
    for (size_t c = 0; c < cover->count; c++) {
        cut_bound *one = &cover->bound[c];
        one->waits = (one->waits || cover->n_taken == 1) && !ms_overlap(&cover->candidate[c], ball);
    }
    for (size_t match = cover->leaves - 1; match > 0; match--) {
        play(cover, match);
    }
}

/* Counts a candidate anew, or takes from its count what has been covered since. */
static cut_bound count_candidate(const ms_cut_cover *cover, uint32_t c, cut_bound bound)
{
    const ms_cut_taken *taken = cover->taken;
    if (bound.counted != NEVER && taken->count - bound.counted <= MS_CUT_TAKEN) {
        bound.weight -= ms_cut_left_fallen(taken, bound.counted, &cover->candidate[c]);
    } else {
        bound.weight = ms_cut_left_count(cover->left, &cover->candidate[c]);
    }
    bound.counted = taken->count;
    return bound;
}

static int is_stale_bound(const ms_cut_cover *cover, uint32_t c)
{
    return bound_of(cover, c) > 0 && cover->bound[c].counted != cover->taken->count;
}

/* Counts the best bounds again, up to so many at once as long as they are no exact counts. More than are needed may be
 * counted, which changes no choice. */
static void count_best_bounds(ms_cut_cover *cover, int at_once)
{
    uint32_t which[MOST_AT_ONCE];
    cut_bound bound[MOST_AT_ONCE];
    int n = 0;
    for (uint32_t best; n < at_once && is_stale_bound(cover, best = cover->winner[1]); n++) {
        which[n] = best;
        bound[n] = cover->bound[best];
        cover->bound[best].weight = 0; /* out of the way */
        replay(cover, best);
    }
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
    for (int e = 0; e < n; e++) {
        bound[e] = count_candidate(cover, which[e], bound[e]);
    }
    for (int e = 0; e < n; e++) {
        cover->bound[which[e]] = bound[e];
        replay(cover, which[e]);
    }
}

int64_t ms_cut_cover_next(size_t *which, ms_cut_cover *cover)
{
    const int many = omp_get_max_threads() > 1;
    for (int at_once = 1; is_stale_bound(cover, cover->winner[1]);) {
        count_best_bounds(cover, at_once);
        at_once = many && at_once < MOST_AT_ONCE ? 2 * at_once : at_once;
    }
    const uint32_t best = cover->winner[1];
    const int64_t weight = bound_of(cover, best);
    if (weight > 0) {
        ms_cut_left_cover(cover->left, &cover->candidate[best], cover->taken);
        cover->bound[best].weight = 0;
        cover->n_taken++;
        replay(cover, best);
        if (cover->connected) {
            admit_cut_neighbours(cover, &cover->candidate[best]);
        }
        *which = best;
    }
    return weight;
}

/* As much as a ball can hold: its cells lie in a ball larger by a voxel's diagonal. */
static int64_t find_most(const ms_ball *ball)
{
    return ball->radius > 0 ? (int64_t)fmin(4.2 * pow(ball->radius + 1.74, 3) * MS_CUT_WHOLE, 9e18) : 0;
}

ms_status ms_cut_cover_build(ms_cut_cover **out, const ms_cut_cells *cells, const ms_ball *candidate, size_t count,
                             int connected, ms_error *err)
{
    size_t leaves = 2;
    *out = NULL;
    if (count >= UINT32_MAX / 2) {
        return ms_fail(err, MS_ERR_LIMIT, "%zu candidates for spheres are too many to compare; use fewer cells", count);
    }
    while (leaves < count) {
        leaves *= 2;
    }
    ms_cut_cover *cover = calloc(1, sizeof *cover);
    if (cover) {
        *cover = (ms_cut_cover){.candidate = candidate,
                                .count = count,
                                .connected = connected,
                                .left = ms_cut_left_build(cells),
                                .taken = malloc(sizeof *cover->taken),
                                .bound = calloc(count + 1, sizeof *cover->bound),
                                .winner = malloc(2 * leaves * sizeof *cover->winner),
                                .leaves = leaves};
    }
    if (!cover || !cover->left || !cover->taken || !cover->bound || !cover->winner) {
        ms_cut_cover_free(cover);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres; use fewer cells", count);
    }
    for (size_t c = 0; c < leaves; c++) {
        cover->winner[leaves + c] = (uint32_t)c;
        if (c < count) {
            cover->bound[c] = (cut_bound){.weight = find_most(&candidate[c]), .counted = NEVER};
        }
    }
    cover->taken->count = 0;
    for (size_t match = leaves - 1; match > 0; match--) {
        play(cover, match);
    }
    *out = cover;
    return MS_OK;
}

void ms_cut_cover_free(ms_cut_cover *cover)
{
    if (cover) {
        ms_cut_left_free(cover->left);
        free(cover->taken);
        free(cover->bound);
        free(cover->winner);
        free(cover);
    }
}
