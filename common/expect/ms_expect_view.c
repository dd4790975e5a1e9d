#include "ms_expect_view.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

enum { RUN = MS_EXPECT_RUN };

/* Parts the views at a pivot: those from 0 to *low are no farther, those from *high on no nearer. Source: Hoare,
 * Algorithm 63 (1961). */
static void split_views(int *low, int *high, ms_expect_view *v, int count)
{
    const double pivot = v[count / 2].power;
    int i = 0, j = count - 1;
    while (i <= j) {
        while (v[i].power < pivot) {
            i++;
        }
        while (v[j].power > pivot) {
            j--;
        }
        if (i <= j) {
            const ms_expect_view swap = v[i];
            v[i++] = v[j];
            v[j--] = swap;
        }
    }
    *low = j;
    *high = i;
}

/* Moves the `keep` nearest to the front. Source: Hoare, Algorithm 65 (1961). */
static void select_nearest(ms_expect_view *v, int count, int keep)
{
    while (count > 1) {
        int low, high;
        split_views(&low, &high, v, count);
        if (keep - 1 <= low) {
            count = low + 1;
        } else if (keep - 1 >= high) {
            v += high;
            count -= high;
            keep -= high;
        } else {
            return;
        }
    }
}

static void sort_views(ms_expect_view *v, int count)
{
    enum { FEW = 12 };
    if (count > FEW) {
        int low, high;
        split_views(&low, &high, v, count);
        sort_views(v, low + 1);
        sort_views(v + high, count - high);
        return;
    }
    for (int i = 1; i < count; i++) {
        const ms_expect_view moved = v[i];
        int j = i;
        for (; j > 0 && v[j - 1].power > moved.power; j--) {
            v[j] = v[j - 1];
        }
        v[j] = moved;
    }
}

static void fill_run(ms_expect_run *run, const ms_expect_points *points, int first, int step)
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        run->centre[a] = 0;
        for (int k = 0; k < RUN; k++) {
            run->at[a][k] = points->at[a][first + k * step];
            run->normal[a][k] = points->normal[a][first + k * step];
            run->centre[a] += run->at[a][k] / RUN;
        }
    }
    for (int k = 0; k < RUN; k++) {
        const double p[3] = {run->at[0][k], run->at[1][k], run->at[2][k]};
        square = fmax(square, ms_squared_distance(p, run->centre));
    }
    run->radius = sqrt(square);
}

ms_status ms_expect_view_open(ms_expect_level *l, const ms_expect_points *points, ms_error *err)
{
    l->points = MS_EXPECT_POINTS / l->step;
    l->balls = l->points / l->every;
    l->weight = points->weight * l->step;
    l->run = malloc((size_t)(l->points / RUN) * sizeof *l->run);
    if (!l->run) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %d points of the surface", l->points);
    }
    for (int r = 0; r < l->points / RUN; r++) {
        fill_run(&l->run[r], points, r * RUN * l->step, l->step);
    }
    return MS_OK;
}

void ms_expect_view_close(ms_expect_level *l)
{
    free(l->run);
    l->run = NULL;
}

/* The least that the power of a point of a run can be. */
static double least_power(const ms_expect_run *run, const double centre[3], double radius)
{
    const double gap = fmax(0, sqrt(ms_squared_distance(run->centre, centre)) - run->radius);
    return gap * gap - radius * radius;
}

/*
 * The points of a run that a ball faces, from its `first` on; their slopes are heights yet. Along the normal of a point
 * at height b above the centre and x beside it, a sphere of radius R is off by b - sqrt(R^2 - x^2) = (b^2 + x^2 - R^2)
 * / (b + sqrt(R^2 - x^2)), of which 2 b is the denominator to first order; about a tube, where the columns along the
 * normals converge, it is so exactly.
 */
static int see_run(ms_expect_view *v, const ms_expect_run *run, int first, const double centre[3], double radius,
                   double most)
{
    double power[RUN], height[RUN];
    int count = 0;
    for (int k = 0; k < RUN; k++) {
        const double x = run->at[0][k] - centre[0], y = run->at[1][k] - centre[1], z = run->at[2][k] - centre[2];
        power[k] = x * x + y * y + z * z - radius * radius;
        height[k] = x * run->normal[0][k] + y * run->normal[1][k] + z * run->normal[2][k];
    }
    for (int k = 0; k < RUN; k++) {
        const int faced = (power[k] <= most) & (10 * height[k] >= radius) & (power[k] < 4 * radius * height[k]);
        v[count] = (ms_expect_view){power[k], height[k], first + k};
        count += faced;
    }
    return count;
}

/* Keeps the nearest; the largest of their powers. */
static double keep_nearest(ms_expect_view *v, int count, int keep)
{
    double most = v[0].power;
    select_nearest(v, count, keep);
    for (int i = 0; i < keep; i++) {
        most = v[i].power > most ? v[i].power : most;
    }
    return most;
}

/* Runs are looked at from the ball's own on in both directions, so that the farther ones soon have nothing to add. */
int ms_expect_view_see(ms_expect_view *v, const ms_expect_points *points, const ms_expect_level *l, int ball)
{
    const int own = ball * l->every * l->step, runs = l->points / RUN, home = ball * l->every / RUN;
    const double radius = points->radius[own / MS_EXPECT_BALL_STEP];
    double centre[3], most = 17 * radius * radius; /* none farther has power < 4 radius height */
    int count = 0;
    for (int a = 0; a < 3; a++) {
        centre[a] = points->at[a][own] - radius * points->normal[a][own];
    }
    for (int k = 0; k < runs; k++) {
        const int at = (home + (k % 2 ? runs - (k + 1) / 2 : k / 2)) % runs;
        if (least_power(&l->run[at], centre, radius) <= most) {
            count += see_run(v + count, &l->run[at], at * RUN, centre, radius, most);
        }
        if (count > 2 * l->most - RUN || (k + 1 == runs && count > l->most)) {
            most = keep_nearest(v, count, l->most);
            count = l->most;
        }
    }
    sort_views(v, count);
    for (int k = 0; k < count; k++) {
        v[k].slope = 1 / (2 * v[k].slope);
    }
    return count;
}
