#include "ms_mss_select.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "shared/ms_overlap.h"

/* Ranks and distances of mirror images agree but for rounding. */
static const double EQUAL = 1e-6;

static int by_rank(const void *first, const void *second)
{
    const ms_mss_candidate *a = first, *b = second;
    if (a->rank != b->rank) {
        return a->rank > b->rank ? -1 : 1;
    }
    return a->voxel < b->voxel ? -1 : a->voxel > b->voxel;
}

static int by_voxel(const void *first, const void *second)
{
    const ms_mss_candidate *a = first, *b = second;
    return a->voxel < b->voxel ? -1 : a->voxel > b->voxel;
}

/* Squared distances from here on keep the spacing: on a lattice many are equal to it but for rounding. */
static double least_square(double spacing)
{
    return spacing * spacing * (1 - 1e-9);
}

int ms_mss_select_is_apart(const ms_mss_candidate *candidate, double spacing)
{
    return candidate->apart >= least_square(spacing);
}

/* The mean of a cluster, with the least radius of its members. */
static ms_ball mean_ball(const ms_mss_candidate *cluster, size_t count)
{
    ms_ball mean = {{0, 0, 0}, cluster[0].ball.radius};
    for (size_t m = 0; m < count; m++) {
        for (int a = 0; a < 3; a++) {
            mean.centre[a] += cluster[m].ball.centre[a] / (double)count;
        }
        mean.radius = fmin(mean.radius, cluster[m].ball.radius);
    }
    return mean;
}

/* Refined maxima of a plateau of two voxels stand in one place. */
static int in_one_place(const ms_mss_candidate *cluster, size_t count)
{
    for (size_t m = 1; m < count; m++) {
        if (ms_squared_distance(cluster[m].ball.centre, cluster[0].ball.centre) > EQUAL) {
            return 0;
        }
    }
    return 1;
}

/* Moves all that hang together with the first candidate by steps below `spacing` to the
 * front; how many they are. */
static size_t gather_cluster(ms_mss_candidate *c, size_t count, double spacing)
{
    size_t size = 1;
    for (size_t done = 0; done < size; done++) {
        for (size_t m = size; m < count; m++) {
            if (ms_squared_distance(c[done].ball.centre, c[m].ball.centre) < least_square(spacing)) {
                const ms_mss_candidate swap = c[m];
                c[m] = c[size];
                c[size++] = swap;
            }
        }
    }
    return size;
}

void ms_mss_select_keep_apart(ms_mss_candidate *candidates, size_t count, const ms_ball *sphere)
{
    for (size_t m = 0; m < count; m++) {
        candidates[m].apart = fmin(candidates[m].apart, ms_squared_distance(candidates[m].ball.centre, sphere->centre));
    }
}

static void keep_apart_now(ms_mss_candidate *c, size_t count, const ms_ball *sphere)
{
    for (size_t m = 0; m < count; m++) {
        c[m].now = fmin(c[m].now, ms_squared_distance(c[m].ball.centre, sphere->centre));
    }
}

/* Those that overlap a sphere of this step wait: they are not apart from it at all. */
static void put_off_overlapping(ms_mss_candidate *c, size_t count, const ms_ball *sphere)
{
    for (size_t m = 0; m < count; m++) {
        if (ms_overlap(&c[m].ball, sphere)) {
            c[m].now = 0;
        }
    }
}

/* Moves to the front those that are farthest from all spheres; how many they are. */
static size_t gather_farthest(ms_mss_candidate *c, size_t count)
{
    double most = -HUGE_VAL;
    size_t size = 0;
    for (size_t m = 0; m < count; m++) {
        most = fmax(most, c[m].now);
    }
    for (size_t m = 0; m < count; m++) {
        if (!(c[m].now < most - EQUAL * (1 + fabs(most)))) {
            const ms_mss_candidate swap = c[m];
            c[m] = c[size];
            c[size++] = swap;
        }
    }
    return size;
}

/* Moves to the front those that keep their distance and are large enough; how many they are. */
static size_t gather_eligible(ms_mss_candidate *c, size_t count, double spacing, double least_radius)
{
    size_t size = 0;
    for (size_t m = 0; m < count; m++) {
        if (c[m].now >= least_square(spacing) && c[m].ball.radius >= least_radius) {
            const ms_mss_candidate swap = c[m];
            c[m] = c[size];
            c[size++] = swap;
        }
    }
    return size;
}

/* Spheres that new ones keep away from: those of earlier steps and those of this one. */
typedef struct placed {
    const ms_ball *earlier, *step;
    size_t n_earlier, n_step;
} placed;

static int too_close(const ms_ball *ball, const placed *p, double spacing)
{
    for (size_t s = 0; s < p->n_earlier + p->n_step; s++) {
        const ms_ball *other = s < p->n_earlier ? &p->earlier[s] : &p->step[s - p->n_earlier];
        if (ms_squared_distance(ball->centre, other->centre) < least_square(spacing)) {
            return 1;
        }
    }
    return 0;
}

/* Of equals, the first sphere of all is the one nearest to the centroid. */
static size_t gather_central(ms_mss_candidate *c, size_t count, const double centroid[3])
{
    for (size_t m = 0; m < count; m++) {
        c[m].now = -ms_squared_distance(c[m].ball.centre, centroid);
    }
    const size_t size = gather_farthest(c, count);
    for (size_t m = 0; m < count; m++) {
        c[m].now = HUGE_VAL;
    }
    return size;
}

/* Places balls behind p->step that keep their distance. */
static void place_ball(ms_ball *chosen, size_t *taken, size_t limit, const ms_ball *ball, const placed *p,
                       const ms_mss_select_rule *rule)
{
    const placed now = {p->earlier, p->step, p->n_earlier, p->n_step + *taken};
    if (*taken < limit && !too_close(ball, &now, rule->spacing)) {
        chosen[(*taken)++] = *ball;
    }
}

/* Places the first `count` candidates, equals in rank and distance: clusters as their mean. */
static size_t place_equals(ms_ball *chosen, size_t limit, ms_mss_candidate *c, size_t count, const placed *p,
                           const ms_mss_select_rule *rule)
{
    size_t taken = 0;
    qsort(c, count, sizeof *c, by_voxel);
    for (size_t at = 0, size; at < count && taken < limit; at += size) {
        size = gather_cluster(c + at, count - at, rule->spacing);
        ms_ball mean = mean_ball(c + at, size);
        if (in_one_place(c + at, size) || rule->fit(&mean, rule->context)) {
            place_ball(chosen, &taken, limit, &mean, p, rule);
        } else if (!rule->may_wait) {
            for (size_t m = 0; m < size; m++) {
                place_ball(chosen, &taken, limit, &c[at + m].ball, p, rule);
            }
        }
    }
    return taken;
}

/* Chooses among candidates of one rank; `chosen` is the end of p.step. */
static size_t select_equals(ms_ball *chosen, size_t limit, ms_mss_candidate *c, size_t count, placed p,
                            const ms_mss_select_rule *rule)
{
    size_t taken = 0;
    for (size_t s = 0; s < p.n_step; s++) {
        keep_apart_now(c, count, &p.step[s]);
        if (rule->disjoint) {
            put_off_overlapping(c, count, &p.step[s]);
        }
    }
    while ((count = gather_eligible(c, count, rule->spacing, 0)) > 0 && taken < limit && !(rule->one_set && taken)) {
        const size_t set =
            p.n_earlier + p.n_step ? gather_farthest(c, count) : gather_central(c, count, rule->centroid);
        const size_t placed_now = place_equals(chosen + taken, limit - taken, c, set, &p, rule);
        c += set; /* placed, merged into one that is, or waiting */
        count -= set;
        for (size_t s = 0; s < placed_now; s++) {
            keep_apart_now(c, count, &chosen[taken + s]);
            if (rule->disjoint) {
                put_off_overlapping(c, count, &chosen[taken + s]);
            }
        }
        taken += placed_now;
        p.n_step += placed_now;
        rule->report(p.n_step, rule->context);
    }
    return taken;
}

size_t ms_mss_select(ms_ball *chosen, size_t limit, ms_mss_candidate *candidates, size_t count, const ms_ball *spheres,
                     size_t n_spheres, const ms_mss_select_rule *rule)
{
    size_t taken = 0;
    for (size_t m = 0; m < count; m++) {
        candidates[m].now = candidates[m].apart;
    }
    count = gather_eligible(candidates, count, rule->spacing, rule->least_radius);
    qsort(candidates, count, sizeof *candidates, by_rank);
    for (size_t from = 0; from < count && taken < limit && !(rule->one_set && taken);) {
        if (candidates[from].rank < rule->least_rank) {
            break;
        }
        const double least = candidates[from].rank - EQUAL * (1 + fabs(candidates[from].rank));
        size_t to = from + 1;
        while (to < count && candidates[to].rank >= least) {
            to++;
        }
        const placed p = {spheres, chosen, n_spheres, taken};
        taken += select_equals(chosen + taken, limit - taken, candidates + from, to - from, p, rule);
        from = to;
    }
    return taken;
}
