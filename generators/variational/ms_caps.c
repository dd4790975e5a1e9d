#include "ms_caps.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

/* Spheres larger than the mean radius times this are few. It decides of the time alone. */
static const double LARGE = 1.5;

/* Of rounding to float, in radii. */
static const float SLACK = 1e-5f;

/* Of the sizes of caps. Of the time alone. */
enum { CLASSES = 32 };

static int compare_ends(const void *a, const void *b)
{
    const ms_caps_end *p = a, *q = b;
    return p->left != q->left ? (p->left > q->left) - (p->left < q->left) : (p->ball > q->ball) - (p->ball < q->ball);
}

void ms_caps_sort(ms_caps_window *s)
{
    double sum = 0;
    size_t large = s->count;
    for (size_t b = 0; b < s->count; b++) {
        sum += s->ball[b].radius;
    }
    s->widest = LARGE * 2 * sum / (double)s->count;
    s->n_small = 0;
    for (size_t b = 0; b < s->count; b++) {
        const ms_caps_end e = {s->ball[b].centre[0] - s->ball[b].radius, (uint32_t)b};
        s->end[2 * s->ball[b].radius <= s->widest ? s->n_small++ : --large] = e;
    }
    qsort(s->end, s->n_small, sizeof *s->end, compare_ends);
}

static void set_cap(ms_caps *block, size_t at, const ms_ball *ball, const ms_ball *other, const double turn[3][3])
{
    const double r = ball->radius, square = ms_squared_distance(ball->centre, other->centre);
    const double least = (square + (r - other->radius) * (r + other->radius)) / (2 * r * r);
    double way[3];
    for (int c = 0; c < 3; c++) {
        way[c] = (other->centre[c] - ball->centre[c]) / r;
    }
    for (int c = 0; c < 3; c++) {
        block->axis[c][at] = (float)(turn[0][c] * way[0] + turn[1][c] * way[1] + turn[2][c] * way[2]);
    }
    block->least[at] = (float)least;
    block->length[at] = (float)(sqrt(square) / r);
    block->root[at] = (float)sqrt(fmax(0, square / (r * r) - least * least));
}

static void copy_cap(ms_caps *to, size_t at, const ms_caps *from, int i)
{
    for (int c = 0; c < 3; c++) {
        to->axis[c][at] = from->axis[c][i];
    }
    to->least[at] = from->least[i];
    to->length[at] = from->length[i];
    to->root[at] = from->root[i];
}

/* Fills the last block with caps that cover nothing; returns how many blocks there are. */
static size_t fill_up(ms_caps *block, size_t found)
{
    static const ms_caps NOTHING = {.least = {1}};
    for (; found % MS_CAPS_BLOCK; found++) {
        copy_cap(&block[found / MS_CAPS_BLOCK], found % MS_CAPS_BLOCK, &NOTHING, 0);
    }
    return found / MS_CAPS_BLOCK;
}

/* In which class the cap of another sphere is, by the cosine of its angle; -1: it covers nothing. */
static int classify_cap(const ms_ball *ball, const ms_ball *other)
{
    const double reach = ball->radius + other->radius, square = ms_squared_distance(ball->centre, other->centre);
    const double deep = ball->radius - other->radius; /* those inside cover nothing of it */
    if (!(square < reach * reach) || (deep > 0 && square < deep * deep)) {
        return -1;
    }
    const double least = square + deep * reach, length = 2 * ball->radius * sqrt(square);
    const double at = length > 0 ? (least / length + 1) / 2 * CLASSES : 0;
    return at > 0 ? (int)fmin(at, CLASSES - 1) : 0;
}

/* Lists neighbours and counts them by class. */
static size_t list_near(ms_caps_near *near, size_t size[CLASSES], const ms_caps_window *s, uint32_t self)
{
    const ms_ball *ball = &s->ball[self];
    const double from = ball->centre[0] - ball->radius - s->widest, to = ball->centre[0] + ball->radius;
    size_t low = 0, high = s->n_small, found = 0;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        *(s->end[middle].left < from ? &low : &high) = middle + (s->end[middle].left < from);
    }
    while (low < s->count) {
        const ms_caps_end *e = &s->end[low++];
        if (low <= s->n_small && !(e->left < to)) {
            low = s->n_small;
            continue;
        }
        const int class = e->ball == self ? -1 : classify_cap(ball, &s->ball[e->ball]);
        if (class >= 0) {
            near[found++] = (ms_caps_near){e->ball, class};
            size[class]++;
        }
    }
    return found;
}

size_t ms_caps_find(ms_caps *block, ms_caps_near *near, const ms_caps_window *s, uint32_t self, const double turn[3][3])
{
    size_t size[CLASSES] = {0}, place[CLASSES] = {0};
    const size_t found = list_near(near, size, s, self);
    for (int c = 1; c < CLASSES; c++) {
        place[c] = place[c - 1] + size[c - 1];
    }
    for (size_t i = 0; i < found; i++) {
        const size_t at = place[near[i].class]++;
        set_cap(&block[at / MS_CAPS_BLOCK], at % MS_CAPS_BLOCK, &s->ball[self], &s->ball[near[i].ball], turn);
    }
    return fill_up(block, found);
}

/* From the angles of cap and group by the addition theorem: their cosines times the length of the axis. */
int ms_caps_narrow(ms_caps *out, const ms_caps *block, size_t blocks, const float centre[3], float cosine, float sine)
{
    size_t found = 0;
    for (size_t b = 0; b < blocks; b++) {
        const ms_caps *c = &block[b];
        int covers = 0, reaches[MS_CAPS_BLOCK];
#pragma omp simd reduction(| : covers)
        for (int i = 0; i < MS_CAPS_BLOCK; i++) {
            const float along = c->axis[0][i] * centre[0] + c->axis[1][i] * centre[1] + c->axis[2][i] * centre[2];
            const float high = c->least[i] * cosine + c->root[i] * sine, low = c->least[i] * cosine - c->root[i] * sine;
            covers |= (along > high) & (c->least[i] < c->length[i] * cosine);
            reaches[i] = (along > low - SLACK) | (c->least[i] < SLACK - c->length[i] * cosine);
        }
        if (covers) {
            return -1;
        }
        for (int i = 0; i < MS_CAPS_BLOCK; i++) {
            if (reaches[i] && c->length[i] > 0) {
                copy_cap(&out[found / MS_CAPS_BLOCK], found % MS_CAPS_BLOCK, c, i);
                found++;
            }
        }
    }
    return (int)fill_up(out, found);
}
