#include "ms_mirror.h"

#include <math.h>
#include <string.h>

int mirrors_holds(const mirrors *m, const ms_ball *ball, int axis)
{
    return m->across[axis] && !(fabs(ball->centre[axis] - m->at[axis]) > 0);
}

size_t mirrors_images(const mirrors *m, const ms_ball *ball)
{
    size_t images = 1;
    for (int a = 0; a < 3; a++) {
        images <<= m->across[a] && !mirrors_holds(m, ball, a);
    }
    return images;
}

size_t mirrors_expand(ms_ball *all, const ms_ball *ball, size_t count, const mirrors *m)
{
    memcpy(all, ball, count * sizeof *all);
    for (int a = 0; a < 3; a++) {
        const size_t before = count;
        for (size_t b = 0; m->across[a] && b < before; b++) {
            if (!mirrors_holds(m, &all[b], a)) {
                all[count] = all[b];
                all[count++].centre[a] = 2 * m->at[a] - all[b].centre[a];
            }
        }
    }
    return count;
}

void mirrors_fold(ms_ball *ball, const mirrors *m, double part)
{
    for (int a = 0; a < 3; a++) {
        const double away = fabs(ball->centre[a] - m->at[a]);
        if (m->across[a]) {
            ball->centre[a] = away < part * ball->radius ? m->at[a] : m->at[a] + away;
        }
    }
}

int mirrors_nearest(double *part, const mirrors *m, const ms_ball *ball)
{
    int axis = -1;
    *part = HUGE_VAL;
    for (int a = 0; a < 3; a++) {
        const double away = fabs(ball->centre[a] - m->at[a]) / ball->radius;
        if (m->across[a] && away > 0 && away < *part) {
            *part = away;
            axis = a;
        }
    }
    return axis;
}
