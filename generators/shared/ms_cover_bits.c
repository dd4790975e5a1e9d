/* A ball is a run of bits in each of its rows: counting them costs one root and one or two words a row. */
#include "ms_cover_bits.h"

#include <math.h>
#include <stdlib.h>

enum { WORD = 64 };

/* Not __builtin_popcountll, which gcc turns into a call for a plain x86-64: 2.7 ns by it, 1.1 to 1.6 by this;
 * clang: both 0.7 to 1.0. */
static inline size_t popcount(uint64_t x)
{
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (size_t)(x * 0x0101010101010101u >> 56);
}

/* The least whole number not below the value, from 0 to n. */
static int round_up(double value, int n)
{
    if (!(value > 0)) {
        return 0;
    }
    return value >= n ? n : (int)value + ((int)value < value);
}

/* One more than the largest whole number not above the value, from 0 to n. */
static int round_above(double value, int n)
{
    if (!(value >= 0)) {
        return 0;
    }
    return value >= n ? n : (int)value + 1;
}

/* Bits from..to-1 of a word, cut to the word. */
static uint64_t run_mask(int from, int to)
{
    const uint64_t above = from > 0 ? (from < WORD ? UINT64_MAX << from : 0) : UINT64_MAX;
    const uint64_t below = to < WORD ? (to > 0 ? UINT64_MAX >> (WORD - to) : 0) : UINT64_MAX;
    return above & below;
}

static inline void keep_run(ms_cover_room *room, size_t *n_found, ms_cover_run found)
{
    room->found[*n_found < room->room ? *n_found : room->room] = found;
    *n_found += found.bits != 0;
}

/* ms_cover_bits_walk in the slab of a ball that is 64 voxels wide from x = base on. Most rows have nothing left within
 * the ball's box, and are passed over before their chord is known. */
static inline size_t walk_slab(ms_cover_bits *set, ms_cover_room *room, size_t *n_found, const ms_ball *ball, int base)
{
    const double x = ball->centre[0], y = ball->centre[1], z = ball->centre[2], r = ball->radius;
    const int planes = round_above(z + r, set->n[2]), shift = base % WORD;
    size_t sum = 0;
    for (int k = round_up(z - r, set->n[2]); k < planes; k++) {
        const double dz = k - z, disc = r * r - dz * dz;
        if (!(disc >= 0)) {
            continue;
        }
        const double reach = sqrt(disc);
        const int rows = round_above(y + reach, set->n[1]);
        const uint64_t disc_mask =
            run_mask(round_up(x - reach, set->n[0]) - base, round_above(x + reach, set->n[0]) - base);
        int j = round_up(y - reach, set->n[1]);
        size_t word = set->words * ((size_t)j + (size_t)set->n[1] * (size_t)k) + (size_t)(base / WORD);
        for (; j < rows; j++, word += set->words) {
            uint64_t *left = set->left + word;
            const uint64_t window = disc_mask & (left[0] >> shift | left[1] << 1 << (WORD - 1 - shift));
            const double dy = j - y, rest = r * r - (dy * dy + dz * dz);
            if (window == 0 || !(rest >= 0)) {
                continue;
            }
            const double chord = sqrt(rest);
            const uint64_t bits =
                window & run_mask(round_up(x - chord, set->n[0]) - base, round_above(x + chord, set->n[0]) - base);
            const ms_cover_run low = {word, bits << shift}, high = {word + 1, bits >> 1 >> (WORD - 1 - shift)};
            if (!room) {
                left[0] &= ~low.bits;
                left[1] &= ~high.bits;
            } else {
                keep_run(room, n_found, low);
                keep_run(room, n_found, high);
            }
            sum += popcount(bits);
        }
    }
    return sum;
}

size_t ms_cover_bits_walk(ms_cover_bits *set, ms_cover_room *room, size_t *n_found, const ms_ball *ball)
{
    const double x = ball->centre[0], r = ball->radius;
    const int end = round_above(x + r, set->n[0]);
    size_t sum = 0;
    for (int base = round_up(x - r, set->n[0]); base < end; base += WORD) {
        sum += walk_slab(set, room, n_found, ball, base);
    }
    return sum;
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
        set->left[run[m].word] &= ~run[m].bits;
    }
}

int ms_cover_bits_alloc(ms_cover_bits *set, const ms_grid *grid)
{
    const ptrdiff_t rows = (ptrdiff_t)grid->n[1] * grid->n[2];
    *set = (ms_cover_bits){.n = {grid->n[0], grid->n[1], grid->n[2]}, .words = ((size_t)grid->n[0] + WORD - 1) / WORD};
    set->left = calloc(set->words * (size_t)rows + 1, sizeof *set->left);
    if (!set->left) {
        return 0;
    }
#pragma omp parallel for schedule(static)
    for (ptrdiff_t row = 0; row < rows; row++) {
        const uint8_t *inside = grid->inside + (size_t)grid->n[0] * (size_t)row;
        uint64_t *word = set->left + set->words * (size_t)row;
        for (int i = 0; i < grid->n[0]; i++) {
            word[i / WORD] |= (uint64_t)(inside[i] != 0) << i % WORD;
        }
    }
    return 1;
}

void ms_cover_bits_free(ms_cover_bits *set)
{
    free(set->left);
    *set = (ms_cover_bits){0};
}
