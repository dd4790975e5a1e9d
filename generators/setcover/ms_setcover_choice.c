#include "ms_setcover_choice.h"

#include <math.h>

#include "ms_setcover_roll.h"

/* Side of the cells by the radius of a ball of as many voxels as the best one adds. */
static const double CELL_OF_GAIN = 0.5;

/* Moves begin with this part of the cells' side, but at most of the radius, and are halved. */
static const double FIRST_MOVE = 0.25, LARGEST_MOVE = 0.25;

/* Spheres that add less are left where they are. */
static const double LEAST_GAIN = 32;

enum { HALVINGS = 3, MOVES = 6 };

/* The side of cells among which the best may add so much. */
static double scale_of_gain(const ms_setcover_choice *choice, double gain)
{
    return CELL_OF_GAIN * cbrt(gain / 4.18879) * choice->pool->target->grid.h;
}

/* Fits the candidates that stand for the largest cells but those whose candidates are fitted. */
static void fit_finer(ms_setcover_choice *choice)
{
    const double scale = choice->next, above = choice->scale;
    const ms_setcover_pool *pool = choice->pool;
    ms_setcover_pool_fit(pool, scale, above);
    choice->scale = scale;
    choice->next = 0;
    for (size_t c = 0; c < pool->count; c++) {
        ms_ball *ball = &pool->ball[c];
        const double side = pool->start[c].scale;
        if (side < scale) {
            choice->next = fmax(choice->next, side);
        } else if (side < above) {
            if (ball->radius < choice->least) {
                choice->dropped |= ball->radius > 0;
                ball->radius = 0;
            }
            ms_cover_admit(choice->cover, c);
        }
    }
}

/* The best of the moves by so much, if it adds more. @return what the ball adds */
static size_t move_ball(ms_ball *ball, size_t gain, const ms_setcover_choice *choice, double by)
{
    ms_ball moved[MOVES];
    size_t adds[MOVES];
#pragma omp parallel for schedule(dynamic, 1)
    for (int m = 0; m < MOVES; m++) {
        moved[m] = ms_setcover_pool_move(choice->pool, ball, m / 2, m % 2 ? by : -by);
        adds[m] = moved[m].radius >= choice->least ? ms_cover_count(choice->cover, &moved[m]) : 0;
    }
    for (int m = 0; m < MOVES; m++) {
        if (adds[m] > gain) {
            gain = adds[m];
            *ball = moved[m];
        }
    }
    return gain;
}

/* Puts a ball more exactly on the medial surface than it was fitted. @return what it adds then */
static size_t place_exactly(ms_ball *ball, size_t gain, const ms_setcover_choice *choice)
{
    const ms_ball exact = ms_setcover_pool_move(choice->pool, ball, 0, 0);
    const size_t adds = exact.radius >= choice->least ? ms_cover_count(choice->cover, &exact) : 0;
    if (adds < gain) {
        return gain;
    }
    *ball = exact;
    return adds;
}

/* The best of those fitted, and whether it is as good as the finer ones may be. */
static int find_best(size_t *which, size_t *gain, const ms_setcover_choice *choice)
{
    *gain = ms_cover_best(which, choice->cover);
    if (choice->next == 0) {
        return 1; /* there are no finer ones */
    }
    return *gain > 0 && (choice->next == choice->finest || choice->scale <= scale_of_gain(choice, (double)*gain));
}

ms_setcover_choice ms_setcover_choice_start(const ms_setcover_pool *pool, ms_cover *cover, double least)
{
    ms_setcover_choice choice = {.pool = pool, .cover = cover, .scale = (double)HUGE_VAL, .least = least};
    choice.finest = (double)HUGE_VAL;
    for (size_t c = 0; c < pool->count; c++) {
        choice.next = fmax(choice.next, pool->start[c].scale);
        choice.finest = fmin(choice.finest, pool->start[c].scale);
    }
    return choice;
}

size_t ms_setcover_choose(ms_ball *ball, ms_setcover_choice *choice)
{
    size_t which, gain;
    while (!find_best(&which, &gain, choice)) {
        fit_finer(choice);
    }
    if (gain == 0) {
        return 0;
    }
    *ball = choice->pool->ball[which];
    double by = fmin(FIRST_MOVE * choice->scale / choice->pool->target->grid.h, LARGEST_MOVE * ball->radius);
    if ((double)gain >= LEAST_GAIN) {
        gain = place_exactly(ball, gain, choice);
    }
    for (int half = 0; half < HALVINGS && (double)gain >= LEAST_GAIN; half++, by /= 2) {
        gain = move_ball(ball, gain, choice, by);
    }
    ms_cover_take(choice->cover, ball);
    return gain;
}
