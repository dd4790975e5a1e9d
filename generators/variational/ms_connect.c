#include "ms_connect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* By how much two spheres of one piece overlap along the line of their centres, voxels. */
static const double OVERLAP = 0.5;

/* What spheres lack to overlap enough; 0 or less where they do. */
static double find_lack(const ms_ball *a, const ms_ball *b)
{
    return sqrt(ms_squared_distance(a->centre, b->centre)) - a->radius - b->radius + OVERLAP;
}

/* The shortest tree from the first sphere of any size: each sphere's link to one before, SIZE_MAX for the first one and
 * those of no size. */
static ms_status find_tree(size_t *link, const ms_ball *ball, size_t count, ms_error *err)
{
    double *lack = malloc((count + 1) * sizeof *lack);
    if (!lack) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to connect %zu spheres", count);
    }
    size_t at = SIZE_MAX;
    for (size_t b = 0; b < count; b++) {
        lack[b] = ball[b].radius > 0 ? HUGE_VAL : -HUGE_VAL; /* -HUGE_VAL: in the tree, or not to be */
        link[b] = SIZE_MAX;
        at = at == SIZE_MAX && ball[b].radius > 0 ? b : at;
    }
    while (at != SIZE_MAX) {
        size_t next = SIZE_MAX;
        lack[at] = -HUGE_VAL;
        for (size_t b = 0; b < count; b++) {
            if (!(lack[b] > -HUGE_VAL)) {
                continue;
            }
            const double here = find_lack(&ball[at], &ball[b]);
            if (here < lack[b]) {
                lack[b] = here;
                link[b] = at;
            }
            next = next == SIZE_MAX || lack[b] < lack[next] ? b : next;
        }
        at = next;
    }
    free(lack);
    return MS_OK;
}

static ms_tie make_tie(const ms_ball *ball, size_t from, size_t to, double lack)
{
    ms_tie tie = {.ball = from, .away = 0.5 * lack};
    const double way = sqrt(ms_squared_distance(ball[from].centre, ball[to].centre));
    for (int c = 0; c < 3; c++) {
        tie.normal[c] = way > 0 ? (ball[to].centre[c] - ball[from].centre[c]) / way : 0; /* of one centre: grow */
    }
    return tie;
}

/* The sphere that is the nearest to a plane, if none reaches beyond it far enough. */
static int tie_to_plane(ms_tie *tie, const ms_ball *ball, size_t count, const ms_mirror *mirror, int axis)
{
    double least = HUGE_VAL;
    for (size_t b = 0; b < count && mirror->across[axis]; b++) {
        const double lack = fabs(ball[b].centre[axis] - mirror->at[axis]) - ball[b].radius + 0.5 * OVERLAP;
        if (ball[b].radius > 0 && lack < least) {
            least = lack;
            *tie = (ms_tie){.ball = b, .away = lack};
            tie->normal[axis] = ball[b].centre[axis] > mirror->at[axis] ? -1 : 1;
        }
    }
    return least > 0 && least < HUGE_VAL;
}

ms_status ms_connect_find(ms_tie **tie, size_t *ties, const ms_ball *ball, size_t count, const ms_mirror *mirror,
                          ms_error *err)
{
    size_t *link = malloc((count + 1) * sizeof *link);
    *tie = malloc((2 * count + 3) * sizeof **tie);
    *ties = 0;
    ms_status status = link && *tie ? find_tree(link, ball, count, err)
                                    : ms_fail(err, MS_ERR_NOMEM, "no memory to connect %zu spheres", count);
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        const double lack = link[b] == SIZE_MAX ? 0 : find_lack(&ball[b], &ball[link[b]]);
        if (lack > 0) {
            (*tie)[(*ties)++] = make_tie(ball, b, link[b], lack);
            (*tie)[(*ties)++] = make_tie(ball, link[b], b, lack);
        }
    }
    for (int a = 0; a < 3 && status == MS_OK; a++) {
        *ties += (size_t)tie_to_plane(*tie + *ties, ball, count, mirror, a);
    }
    free(link);
    return status;
}

/* The piece of a sphere by the links of the tree that hold. */
static size_t find_top(const size_t *link, const ms_ball *ball, size_t b)
{
    while (link[b] != SIZE_MAX && !(find_lack(&ball[b], &ball[link[b]]) > 0)) {
        b = link[b];
    }
    return b;
}

ms_status ms_connect_keep_largest(ms_ball *ball, size_t *count, ms_error *err)
{
    size_t *link = malloc((*count + 1) * sizeof *link), *piece = malloc((*count + 1) * sizeof *piece);
    double *volume = calloc(*count + 1, sizeof *volume);
    size_t largest = 0, kept = 0;
    ms_status status = link && piece && volume ? find_tree(link, ball, *count, err)
                                               : ms_fail(err, MS_ERR_NOMEM, "no memory to connect %zu spheres", *count);
    for (size_t b = 0; b < *count && status == MS_OK; b++) {
        piece[b] = find_top(link, ball, b);
        volume[piece[b]] += ball[b].radius * ball[b].radius * ball[b].radius;
    }
    for (size_t b = 0; b < *count && status == MS_OK; b++) {
        largest = volume[b] > volume[largest] ? b : largest;
    }
    for (size_t b = 0; b < *count && status == MS_OK; b++) {
        if (piece[b] == largest) {
            ball[kept++] = ball[b];
        }
    }
    *count = status == MS_OK ? kept : *count;
    free(link);
    free(piece);
    free(volume);
    return status;
}
