#include "ms_mss_open.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 64 };

/* Voxels on a ball's surface but for rounding belong to it, so that mirror images agree. */
static const double ON_SURFACE = 1e-9;

ms_status ms_mss_open_init(ms_mss_open *open, const ms_grid *grid, ms_error *err)
{
    memset(open, 0, sizeof *open);
    memcpy(open->n, grid->n, sizeof open->n);
    open->words = ((size_t)grid->n[0] + WORD - 1) / WORD;
    const size_t rows = (size_t)grid->n[1] * (size_t)grid->n[2];
    open->inside = calloc(rows * open->words, sizeof *open->inside);
    open->outside = calloc(rows * open->words, sizeof *open->outside);
    if (!open->inside || !open->outside) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for bits of %zu voxels; use fewer cells", ms_grid_voxels(grid));
    }
#pragma omp parallel for if (ms_grid_voxels(grid) >= MS_GRID_THREADS_FROM)
    for (size_t row = 0; row < rows; row++) {
        const uint8_t *inside = grid->inside + row * (size_t)grid->n[0];
        for (int i = 0; i < grid->n[0]; i++) {
            uint64_t *bits = (inside[i] ? open->inside : open->outside) + row * open->words;
            bits[i / WORD] |= (uint64_t)1 << i % WORD;
        }
    }
    return MS_OK;
}

void ms_mss_open_free(ms_mss_open *open)
{
    free(open->inside);
    free(open->outside);
}

/* Takes the covered voxels of a row out of its bits. */
static void clear_row(uint64_t *inside, uint64_t *outside, const uint16_t *first, int from, int to)
{
    for (int i = from; i < to; i++) {
        if (!(inside[i / WORD] | outside[i / WORD])) {
            i |= WORD - 1; /* nothing is open in this word */
            continue;
        }
        const uint64_t keep = ~((uint64_t)(first[i] != MS_RASTER_NONE) << i % WORD);
        inside[i / WORD] &= keep;
        outside[i / WORD] &= keep;
    }
}

void ms_mss_open_cover(ms_mss_open *open, const ms_raster *raster, size_t first_new)
{
    for (size_t b = first_new; b < raster->n_balls; b++) {
        const ms_ball *ball = &raster->ball[b];
        int lo[3], hi[3];
        for (int a = 0; a < 3; a++) { /* half a voxel of it is enough to cover one */
            lo[a] = ms_mss_open_clamp(floor(ball->centre[a] - ball->radius), 0, open->n[a]);
            hi[a] = ms_mss_open_clamp(ceil(ball->centre[a] + ball->radius) + 1, 0, open->n[a]);
        }
        for (int k = lo[2]; k < hi[2]; k++) {
            for (int j = lo[1]; j < hi[1]; j++) {
                const size_t row = ((size_t)j + (size_t)open->n[1] * (size_t)k) * open->words;
                clear_row(open->inside + row, open->outside + row, raster->first + ms_grid_index(raster->grid, 0, j, k),
                          lo[0], hi[0]);
            }
        }
    }
}

/* Without a machine instruction that all machines have, __builtin_popcountll is a call. */
static int count_bits(uint64_t x)
{
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (int)(x * 0x0101010101010101u >> 56);
}

/* Open voxels inside less those outside, from <= i < to of a row. */
static long count_row(const uint64_t *inside, const uint64_t *outside, int from, int to)
{
    long sum = 0;
    for (int w = from / WORD; w * WORD < to; w++) {
        uint64_t mask = ~(uint64_t)0;
        if (w * WORD < from) {
            mask &= ~(uint64_t)0 << from % WORD;
        }
        if ((w + 1) * WORD > to) {
            mask &= ~(uint64_t)0 >> (WORD - to % WORD);
        }
        const uint64_t in = inside[w] & mask, out = outside[w] & mask;
        sum += (in ? count_bits(in) : 0) - (out ? count_bits(out) : 0);
    }
    return sum;
}

/* ceil where it is not below 0, else 0; ceil itself is a call. */
static int round_place(double x)
{
    const int whole = x > 0 ? (int)x : 0;
    return whole + (x > whole);
}

long ms_mss_open_gain(const ms_mss_open *open, const ms_ball *ball)
{
    const double *c = ball->centre, square = ball->radius * ball->radius + ON_SURFACE, r = sqrt(square);
    const int lo_z = ms_mss_open_clamp(ceil(c[2] - r), 0, open->n[2]),
              hi_z = ms_mss_open_clamp(floor(c[2] + r) + 1, 0, open->n[2]);
    long sum = 0;
    for (int k = lo_z; k < hi_z; k++) {
        const double z = k - c[2], rest = square - z * z, wide = rest > 0 ? sqrt(rest) : 0;
        const int lo_y = ms_mss_open_clamp(ceil(c[1] - wide), 0, open->n[1]);
        const int hi_y = ms_mss_open_clamp(floor(c[1] + wide) + 1, 0, open->n[1]);
        for (int j = lo_y; j < hi_y; j++) {
            const double y = j - c[1], left = rest - y * y;
            if (left >= 0) {
                const double half = sqrt(left);
                const double last = c[0] + half;
                const int from = round_place(c[0] - half), end = last >= 0 ? (int)last + 1 : 0;
                const int to = end < open->n[0] ? end : open->n[0];
                const size_t row = ((size_t)j + (size_t)open->n[1] * (size_t)k) * open->words;
                sum += from < to ? count_row(open->inside + row, open->outside + row, from, to) : 0;
            }
        }
    }
    return sum;
}

long ms_mss_open_fit(ms_ball *ball, const ms_mss_open *open, double lo, double hi, double step)
{
    long most = ms_mss_open_gain(open, ball);
    const double start = ball->radius;
    for (int up = 1; up >= -1 && ball->radius == start; up -= 2) { /* where it rises upwards it does not downwards */
        ms_ball next = *ball;
        for (next.radius += up * step; next.radius >= lo && next.radius <= hi; next.radius += up * step) {
            const long gain = ms_mss_open_gain(open, &next);
            if (gain <= most) {
                break;
            }
            most = gain;
            ball->radius = next.radius;
        }
    }
    return most;
}
