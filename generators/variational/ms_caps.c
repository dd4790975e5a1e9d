#include "ms_caps.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "base/ms_versions.h"

/* Spheres larger than the mean radius times this are few. It decides of the time alone. */
static const double LARGE = 1.5;

/* Of rounding to float, in radii. */
static const float SLACK = 1e-5f;

/* Of the sizes of caps. Of the time alone. */
enum { CLASSES = 32 };

/* Spheres that are looked at at once. */
enum { LANES = MS_CAPS_BLOCK };

void ms_caps_window_free(ms_caps_window *s)
{
    free(s->ball);
    free(s->end);
    free(s->at[0]);
    *s = (ms_caps_window){0};
}

int ms_caps_window_alloc(ms_caps_window *out, size_t count)
{
    const size_t room = count + LANES;
    *out = (ms_caps_window){.ball = malloc(room * sizeof *out->ball),
                            .end = malloc(room * sizeof *out->end),
                            .at = {calloc(4 * room, sizeof *out->at[0])}};
    if (!out->ball || !out->end || !out->at[0]) {
        ms_caps_window_free(out);
        return 0;
    }
    for (int c = 1; c < 4; c++) {
        out->at[c] = out->at[0] + (size_t)c * room;
    }
    return 1;
}

void ms_caps_list_free(ms_caps_list *list)
{
    free(list->near);
    free(list->block);
    free(list->which);
    free(list->order);
    free(list->size);
    *list = (ms_caps_list){0};
}

int ms_caps_list_alloc(ms_caps_list *out, size_t count)
{
    const size_t blocks = count / MS_CAPS_BLOCK + 1, room = blocks * MS_CAPS_BLOCK;
    *out = (ms_caps_list){.near = malloc(blocks * sizeof *out->near),
                          .block = malloc(blocks * sizeof *out->block),
                          .which = malloc(room * sizeof *out->which),
                          .order = malloc(room * sizeof *out->order),
                          .size = malloc(room * sizeof *out->size)};
    if (!out->near || !out->block || !out->which || !out->order || !out->size) {
        ms_caps_list_free(out);
    }
    return out->near != NULL;
}

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
    for (size_t e = 0; e < s->count; e++) {
        const ms_ball *ball = &s->ball[s->end[e].ball];
        for (int c = 0; c < 3; c++) {
            s->at[c][e] = ball->centre[c];
        }
        s->at[3][e] = ball->radius;
    }
}

/* Which of so many spheres, from one on, overlap one and do not lie within it. */
MS_VERSIONS static void find_overlaps(uint8_t overlaps[LANES], const ms_caps_window *s, size_t from, const ms_ball *of)
{
    const double *x = s->at[0] + from, *y = s->at[1] + from, *z = s->at[2] + from, *r = s->at[3] + from;
    const double at[3] = {of->centre[0], of->centre[1], of->centre[2]}, own = of->radius;
    for (int i = 0; i < LANES; i++) {
        const double dx = x[i] - at[0], dy = y[i] - at[1], dz = z[i] - at[2];
        const double square = dx * dx + dy * dy + dz * dz, reach = own + r[i], deep = own - r[i];
        overlaps[i] = (square < reach * reach) & ((deep <= 0) | (square >= deep * deep));
    }
}

/* Appends those of from..to-1. */
static size_t list_range(uint32_t *which, size_t found, const ms_caps_window *s, size_t from, size_t to, uint32_t self)
{
    for (size_t e = from; e < to; e += LANES) {
        uint8_t overlaps[LANES];
        find_overlaps(overlaps, s, e, &s->ball[self]);
        for (size_t i = 0; i < LANES && e + i < to; i++) {
            which[found] = (uint32_t)(e + i);
            found += overlaps[i] && s->end[e + i].ball != self;
        }
    }
    return found;
}

/* The first of the small ones whose end is not left of a place. */
static size_t find_left(const ms_caps_window *s, double place)
{
    size_t low = 0, high = s->n_small;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        *(s->end[middle].left < place ? &low : &high) = middle + (s->end[middle].left < place);
    }
    return low;
}

/* The caps of a block of neighbours, and their classes by the cosine of their angles: the largest first. */
MS_VERSIONS static void set_block(ms_caps *to, uint8_t size[MS_CAPS_BLOCK], const ms_caps_window *s,
                                  const uint32_t which[MS_CAPS_BLOCK], const ms_ball *ball)
{
    const double own = ball->radius, part = 1 / own, half = 0.5 * part * part;
    double x[MS_CAPS_BLOCK], y[MS_CAPS_BLOCK], z[MS_CAPS_BLOCK], r[MS_CAPS_BLOCK];
    float cosine[MS_CAPS_BLOCK];
    for (int i = 0; i < MS_CAPS_BLOCK; i++) {
        x[i] = s->at[0][which[i]] - ball->centre[0];
        y[i] = s->at[1][which[i]] - ball->centre[1];
        z[i] = s->at[2][which[i]] - ball->centre[2];
        r[i] = s->at[3][which[i]];
    }
    for (int i = 0; i < MS_CAPS_BLOCK; i++) {
        const double square = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        const double least = (square + (own - r[i]) * (own + r[i])) * half;
        const double rest = square * part * part - least * least;
        to->axis[0][i] = (float)(x[i] * part);
        to->axis[1][i] = (float)(y[i] * part);
        to->axis[2][i] = (float)(z[i] * part);
        to->least[i] = (float)least;
        to->length[i] = (float)(sqrt(square) * part);
        to->root[i] = (float)sqrt(rest > 0 ? rest : 0);
    }
    for (int i = 0; i < MS_CAPS_BLOCK; i++) {
        const float length = to->length[i] > 1e-30f ? to->length[i] : 1e-30f;
        cosine[i] = (to->least[i] / length + 1) / 2 * CLASSES;
    }
    for (int i = 0; i < MS_CAPS_BLOCK; i++) {
        size[i] = (uint8_t)(cosine[i] > 0 ? cosine[i] < CLASSES - 1 ? cosine[i] : CLASSES - 1 : 0);
    }
}

static void copy_cap(ms_caps *to, size_t at, const ms_caps *from, size_t i)
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

/* All that overlap the sphere, and in which order to take them; returns how many. */
static size_t list_near(ms_caps_list *out, const ms_caps_window *s, uint32_t self)
{
    const ms_ball *ball = &s->ball[self];
    const double left = ball->centre[0] - ball->radius, right = ball->centre[0] + ball->radius;
    size_t size[CLASSES] = {0}, place[CLASSES] = {0};
    size_t found = list_range(out->which, 0, s, find_left(s, left - s->widest), find_left(s, right), self);
    found = list_range(out->which, found, s, s->n_small, s->count, self);
    for (size_t i = found; i % MS_CAPS_BLOCK; i++) {
        out->which[i] = 0;
    }
    for (size_t i = 0; i < found; i += MS_CAPS_BLOCK) {
        set_block(&out->near[i / MS_CAPS_BLOCK], out->size + i, s, out->which + i, ball);
    }
    out->nears = fill_up(out->near, found);
    for (size_t i = 0; i < found; i++) {
        size[out->size[i]]++;
    }
    for (int c = 1; c < CLASSES; c++) {
        place[c] = place[c - 1] + size[c - 1];
    }
    for (size_t i = 0; i < found; i++) {
        out->order[place[out->size[i]]++] = (uint32_t)i;
    }
    return found;
}

/* Does one of these caps hold all of another? By the addition theorem: the cosine of the angle between the axes is
 * more than that of the difference of the caps' angles, times the lengths of both axes. */
static int lies_in_cap(const ms_caps *cap, size_t at, const ms_caps *block, size_t blocks)
{
    const float axis[3] = {cap->axis[0][at], cap->axis[1][at], cap->axis[2][at]};
    const float least = cap->least[at], length = cap->length[at], root = cap->root[at];
    for (size_t b = 0; b < blocks; b++) {
        const ms_caps *c = &block[b];
        int held = 0;
#pragma omp simd reduction(| : held)
        for (int i = 0; i < MS_CAPS_BLOCK; i++) {
            const float along = c->axis[0][i] * axis[0] + c->axis[1][i] * axis[1] + c->axis[2][i] * axis[2];
            held |= (along > c->least[i] * least + c->root[i] * root + SLACK) &
                    (c->least[i] * length < least * c->length[i]);
        }
        if (held) {
            return 1;
        }
    }
    return 0;
}

static void turn_cap(ms_caps *block, size_t at, const double turn[3][3])
{
    const double axis[3] = {(double)block->axis[0][at], (double)block->axis[1][at], (double)block->axis[2][at]};
    for (int c = 0; c < 3; c++) {
        block->axis[c][at] = (float)(turn[0][c] * axis[0] + turn[1][c] * axis[1] + turn[2][c] * axis[2]);
    }
}

void ms_caps_find(ms_caps_list *out, const ms_caps_window *s, uint32_t self, const double turn[3][3])
{
    const size_t near = list_near(out, s, self);
    size_t found = 0;
    out->blocks = 0;
    for (size_t i = 0; i < near; i++) {
        const ms_caps *cap = &out->near[out->order[i] / MS_CAPS_BLOCK];
        const size_t at = out->order[i] % MS_CAPS_BLOCK;
        if (!lies_in_cap(cap, at, out->block, out->blocks)) {
            copy_cap(&out->block[found / MS_CAPS_BLOCK], found % MS_CAPS_BLOCK, cap, at);
            found++;
            out->blocks = fill_up(out->block, found);
        }
    }
    for (size_t i = 0; i < found; i++) {
        turn_cap(&out->block[i / MS_CAPS_BLOCK], i % MS_CAPS_BLOCK, turn);
    }
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
                copy_cap(&out[found / MS_CAPS_BLOCK], found % MS_CAPS_BLOCK, c, (size_t)i);
                found++;
            }
        }
    }
    return (int)fill_up(out, found);
}
