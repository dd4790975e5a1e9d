/* A ball is a run of bits in each of its rows: counting them costs one root and one or two words a row. */
#include "ms_cover_bits.h"

#include <math.h>
#include <stdlib.h>

#include "voxel/ms_window.h"

enum { WORD = 64, TILE = 8 };

/* What is done with what a row of a ball holds of the set. */
typedef enum walk_purpose { FIND, COUNT, REMOVE } walk_purpose;

/* Not __builtin_popcountll, which gcc turns into a slower call for a plain x86-64. */
static inline size_t popcount(uint64_t x)
{
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (size_t)(x * 0x0101010101010101u >> 56);
}

/* The whole numbers between two places, as bits of a window of at most 64 that begins with `base`. */
static inline uint64_t window_mask(double from, double to, int base, int end)
{
    if (!(from < end) || !(to >= base)) {
        return 0;
    }
    const int first = from > base ? (int)from + ((int)from < from) : base, last = to < end ? (int)to : end - 1;
    return first <= last ? UINT64_MAX << (first - base) & UINT64_MAX >> (WORD - 1 - (last - base)) : 0;
}

/* The end of a window of 64 voxels, or before that of the set. */
static inline int end_window(int base, int n)
{
    return base + WORD < n ? base + WORD : n;
}

/* Takes a run out of the set. */
static void take_run(ms_cover_bits *set, ms_cover_run run)
{
    const uint64_t before = set->left[run.word], after = before & ~run.bits;
    const size_t row = run.word / set->words, k = row / (size_t)set->n[1], j = row % (size_t)set->n[1];
    set->left[run.word] = after;
    for (size_t t = 0; t < WORD / TILE; t++) {
        const size_t tile = run.word % set->words * (WORD / TILE) + t;
        if ((before >> t * TILE & 0xff) && !(after >> t * TILE & 0xff)) {
            set->tiles[(k * set->columns + tile) * set->groups + j / WORD] &= ~((uint64_t)1 << j % WORD);
        }
    }
}

static inline void keep_run(ms_cover_room *room, size_t *n_found, ms_cover_run found)
{
    room->found[*n_found < room->room ? *n_found : room->room] = found;
    *n_found += found.bits != 0;
}

/* A walk through the rows of a ball that have anything left. */
typedef struct walk {
    ms_cover_bits *set;  /* changed by REMOVE alone */
    ms_cover_room *room; /* of FIND */
    const ms_ball *ball;
    int step;      /* every so many-th row of such planes */
    int base, end; /* the window of voxels along x that it goes through */
    size_t n_found, sum;
} walk;

/* Of the 64 rows of plane k from j = 64 g on those that a disc may reach and have anything left in its tiles. */
static inline uint64_t find_rows_left(const walk *w, int k, int g, double reach)
{
    const ms_cover_bits *set = w->set;
    const double x = w->ball->centre[0], y = w->ball->centre[1];
    const int above = ms_window_end(x + reach, w->end), below = ms_window_first(x - reach, w->end);
    uint64_t rows = 0;
    for (int tile = (below > w->base ? below : w->base) / TILE; tile * TILE < above; tile++) {
        rows |= set->tiles[((size_t)k * set->columns + (size_t)tile) * set->groups + (size_t)g];
    }
    return rows & window_mask(y - reach, y + reach, g * WORD, end_window(g * WORD, set->n[1]));
}

/* A row whose window begins in `word`: of what is left `near` the ball that between its ends. `rest` is the square of
 * half its chord there. */
static inline void walk_row(walk *w, walk_purpose purpose, size_t word, uint64_t near, double rest)
{
    const int shift = w->base % WORD;
    const double x = w->ball->centre[0];
    const uint64_t *left = w->set->left + word;
    near &= left[0] >> shift | left[1] << 1 << (WORD - 1 - shift);
    if (near == 0 || !(rest >= 0)) {
        return;
    }
    const double chord = sqrt(rest);
    const uint64_t bits = near & window_mask(x - chord, x + chord, w->base, w->end);
    const ms_cover_run low = {word, bits << shift}, high = {word + 1, bits >> 1 >> (WORD - 1 - shift)};
    if (purpose == FIND) {
        keep_run(w->room, &w->n_found, low);
        keep_run(w->room, &w->n_found, high);
    } else if (purpose == REMOVE) {
        take_run(w->set, low);
        take_run(w->set, high);
    }
    w->sum += popcount(bits);
}

/* The rows of plane k within the window. */
static inline void walk_plane(walk *w, walk_purpose purpose, int k)
{
    static const uint64_t EVERY[] = {
        [1] = UINT64_MAX, [2] = 0x5555555555555555u, [4] = 0x1111111111111111u, [8] = 0x0101010101010101u};
    const ms_cover_bits *set = w->set;
    const double x = w->ball->centre[0], y = w->ball->centre[1], dz = k - w->ball->centre[2];
    const double square = w->ball->radius * w->ball->radius, disc = square - dz * dz;
    if (!(disc >= 0)) {
        return;
    }
    const double reach = sqrt(disc);
    const uint64_t near = window_mask(x - reach, x + reach, w->base, w->end);
    const int end = ms_window_end(y + reach, set->n[1]);
    for (int g = ms_window_first(y - reach, set->n[1]) / WORD; g * WORD < end; g++) {
        for (uint64_t rows = find_rows_left(w, k, g, reach) & EVERY[w->step]; rows; rows &= rows - 1) {
            const int j = g * WORD + __builtin_ctzll(rows);
            const size_t row = (size_t)j + (size_t)set->n[1] * (size_t)k;
            const double dy = j - y;
            walk_row(w, purpose, set->words * row + (size_t)(w->base / WORD), near, square - (dy * dy + dz * dz));
        }
    }
}

static inline void walk_ball(walk *w, walk_purpose purpose)
{
    const double x = w->ball->centre[0], z = w->ball->centre[2], r = w->ball->radius;
    const int end = ms_window_end(x + r, w->set->n[0]), planes = ms_window_end(z + r, w->set->n[2]);
    const int first = (ms_window_first(z - r, w->set->n[2]) + w->step - 1) / w->step * w->step;
    for (w->base = ms_window_first(x - r, w->set->n[0]); w->base < end; w->base += WORD) {
        w->end = end_window(w->base, w->set->n[0]);
        for (int k = first; k < planes; k += w->step) {
            walk_plane(w, purpose, k);
        }
    }
}

size_t ms_cover_bits_walk(const ms_cover_bits *set, ms_cover_room *room, size_t *n_found, const ms_ball *ball)
{
    ms_cover_bits same = *set;
    walk w = {.set = &same, .room = room, .ball = ball, .step = 1};
    walk_ball(&w, FIND);
    *n_found = w.n_found;
    return w.sum;
}

size_t ms_cover_bits_sample(const ms_cover_bits *set, const ms_ball *ball, int step)
{
    ms_cover_bits same = *set;
    walk w = {.set = &same, .ball = ball, .step = step};
    walk_ball(&w, COUNT);
    return w.sum;
}

void ms_cover_bits_remove(ms_cover_bits *set, const ms_ball *ball)
{
    walk w = {.set = set, .ball = ball, .step = 1};
    walk_ball(&w, REMOVE);
}

size_t ms_cover_bits_recount(const ms_cover_bits *set, ms_cover_run *run, uint32_t *n)
{
    size_t sum = 0;
    uint32_t kept = 0;
    for (uint32_t m = 0; m < *n; m++) {
        const ms_cover_run left = {run[m].word, run[m].bits & set->left[run[m].word]};
        run[kept] = left;
        kept += left.bits != 0;
        sum += popcount(left.bits);
    }
    *n = kept;
    return sum;
}

void ms_cover_bits_take(ms_cover_bits *set, const ms_cover_run *run, uint32_t n)
{
    for (uint32_t m = 0; m < n; m++) {
        take_run(set, run[m]);
    }
}

int ms_cover_bits_alloc(ms_cover_bits *set, const ms_grid *grid)
{
    const ptrdiff_t planes = grid->n[2];
    const size_t rows = (size_t)grid->n[1];
    *set = (ms_cover_bits){.n = {grid->n[0], grid->n[1], grid->n[2]},
                           .words = ((size_t)grid->n[0] + WORD - 1) / WORD,
                           .groups = (rows + WORD - 1) / WORD};
    set->columns = set->words * (WORD / TILE);
    set->left = calloc(set->words * rows * (size_t)planes + 1, sizeof *set->left);
    set->tiles = calloc(set->columns * set->groups * (size_t)planes, sizeof *set->tiles);
    if (!set->left || !set->tiles) {
        return 0;
    }
#pragma omp parallel for schedule(static)
    for (ptrdiff_t k = 0; k < planes; k++) {
        for (size_t j = 0; j < rows; j++) {
            const size_t row = j + rows * (size_t)k;
            const uint8_t *inside = grid->inside + (size_t)grid->n[0] * row;
            for (int i = 0; i < grid->n[0]; i++) {
                const uint64_t bit = inside[i] != 0;
                set->left[set->words * row + (size_t)(i / WORD)] |= bit << i % WORD;
                set->tiles[((size_t)k * set->columns + (size_t)(i / TILE)) * set->groups + j / WORD] |= bit << j % WORD;
            }
        }
    }
    return 1;
}

void ms_cover_bits_free(ms_cover_bits *set)
{
    free(set->left);
    free(set->tiles);
    *set = (ms_cover_bits){0};
}
