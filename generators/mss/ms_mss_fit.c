#include "ms_mss_fit.h"

#include <math.h>

/* Where the radius begins, and by which steps it climbs, in voxels of the target. */
static const double FIRST_OVER_E = 0.25, RADIUS_STEP = 0.25;

/* By which steps a centre moves, and how often around at most by each, in voxels. */
static const double FIRST_STEP = 1, LAST_STEP = 0.5;
enum { ROUNDS = 4 };

long ms_mss_fit_radius(ms_ball *ball, double e, const ms_mss_open *open, ms_mss_run *m)
{
    const double unit = ms_mss_fit_unit(m);
    const double least = fmax(e + MS_MSS_FIT_LEAST * unit, 0.5 * unit), most = e + MS_MSS_FIT_MOST * unit;
    ball->radius = e + FIRST_OVER_E * unit;
    long gain = ms_mss_open_fit(ball, open, least, most, RADIUS_STEP * unit);
    if (gain <= 0) { /* specks of a voxel: the climb ends on a step too wide */
        ball->radius = least;
        gain = ms_mss_open_gain(open, ball);
    }
    const double fitted = ball->radius;
    if (!ms_mss_run_confine(ball, m)) {
        return 0;
    }
    return ball->radius < fitted ? ms_mss_open_gain(open, ball) : gain;
}

/* A ball with a margin over E, and what it gains. */
typedef struct fitted {
    ms_ball ball;
    double over_e;
    long gain;
} fitted;

/* Takes the best radius where the ball is, if that is better than the one it has. */
static void refit(fitted *f, const ms_mss_open *open, ms_mss_run *m)
{
    const double e = ms_mss_run_e_between(m, f->ball.centre);
    ms_ball ball = f->ball;
    const long gain = e > 0 ? ms_mss_fit_radius(&ball, e, open, m) : 0;
    if (gain > f->gain) {
        f->ball = ball;
        f->gain = gain;
    }
    f->over_e = f->ball.radius - e;
}

/* The same ball a step away, with the same margin over E there; it gains 0 where it has no room. */
static fitted move_along(const fitted *f, int axis, double step, const ms_mss_open *open, ms_mss_run *m)
{
    fitted moved = *f;
    moved.ball.centre[axis] += step;
    const double e = ms_mss_run_e_between(m, moved.ball.centre);
    moved.ball.radius = e + f->over_e;
    moved.gain = e > 0 && ms_mss_run_confine(&moved.ball, m) ? ms_mss_open_gain(open, &moved.ball) : 0;
    return moved;
}

/* One step along an axis, if that gains more than the ball as it is and than the step the other way. */
static int step_along(fitted *f, int axis, double step, const ms_mss_open *open, ms_mss_run *m)
{
    const fitted up = move_along(f, axis, step, open, m), down = move_along(f, axis, -step, open, m);
    const fitted *better = up.gain > down.gain ? &up : &down;
    if (up.gain == down.gain || better->gain <= f->gain) {
        return 0;
    }
    *f = *better;
    refit(f, open, m);
    return 1;
}

long ms_mss_fit_place(ms_ball *ball, const ms_mss_open *open, ms_mss_run *m)
{
    fitted f = {.ball = *ball, .gain = ms_mss_open_gain(open, ball)};
    refit(&f, open, m);
    for (double step = FIRST_STEP; step >= LAST_STEP; step /= 2) {
        int moved = 1;
        for (int round = 0; round < ROUNDS && moved; round++) {
            moved = 0;
            for (int a = 0; a < 3; a++) {
                moved |= step_along(&f, a, step, open, m);
            }
        }
    }
    *ball = f.ball;
    return f.gain;
}
