#include "ms_mirror.h"

#include <math.h>
#include <string.h>

int ms_mirror_holds(const ms_mirror *m, const ms_ball *ball, int axis)
{
    return m->across[axis] && !(fabs(ball->centre[axis] - m->at[axis]) > 0);
}

size_t ms_mirror_images(const ms_mirror *m, const ms_ball *ball)
{
    size_t images = 1;
    for (int a = 0; a < 3; a++) {
        images <<= m->across[a] && !ms_mirror_holds(m, ball, a);
    }
    return images;
}

size_t ms_mirror_expand(ms_ball *all, const ms_ball *ball, size_t count, const ms_mirror *m)
{
    memcpy(all, ball, count * sizeof *all);
    for (int a = 0; a < 3; a++) {
        const size_t before = count;
        for (size_t b = 0; m->across[a] && b < before; b++) {
            if (!ms_mirror_holds(m, &all[b], a)) {
                all[count] = all[b];
                all[count++].centre[a] = 2 * m->at[a] - all[b].centre[a];
            }
        }
    }
    return count;
}

void ms_mirror_fold(ms_ball *ball, const ms_mirror *m, double part)
{
    for (int a = 0; a < 3; a++) {
        const double away = fabs(ball->centre[a] - m->at[a]);
        if (m->across[a]) {
            ball->centre[a] = away < part * ball->radius ? m->at[a] : m->at[a] + away;
        }
    }
}

int ms_mirror_nearest(double *part, const ms_mirror *m, const ms_ball *ball)
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
