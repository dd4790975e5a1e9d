#include "ms_distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_grid.h"

/* Strided passes take neighbouring lines together, as many as fill a cache line, so that
 * every byte fetched is used. In the work space they stay interleaved: no transposition. */
enum { BLOCK = 16 };

/* "No background along the axes so far"; larger than any squared distance in the grid. */
static const uint32_t NONE = UINT32_MAX;

/* A parabola of the lower envelope. */
typedef struct parabola {
    double height; /* f + site^2 */
    int site;      /* where it stands */
    int start;     /* first voxel where it is the lowest */
} parabola;

/* Work space of one thread, for lines of up to `length` voxels. */
typedef struct lines {
    uint32_t *block;      /* BLOCK lines, interleaved */
    parabola *envelope;   /* a stack */
    double *half_inverse; /* 1/(2 d) for d = 1..length */
} lines;

static void lines_free(lines *w)
{
    free(w->block);
    free(w->envelope);
    free(w->half_inverse);
}

static int lines_alloc(lines *w, size_t length)
{
    w->block = malloc(BLOCK * length * sizeof *w->block);
    w->envelope = malloc((length + 1) * sizeof *w->envelope);
    w->half_inverse = malloc((length + 1) * sizeof *w->half_inverse);
    if (!w->block || !w->envelope || !w->half_inverse) {
        return 0;
    }
    w->half_inverse[0] = 0;
    for (size_t d = 1; d <= length; d++) {
        w->half_inverse[d] = 0.5 / (double)d;
    }
    return 1;
}

/* Squared distance along x to the nearest background voxel of the row. */
static void row_distances(uint32_t *out, const uint8_t *inside, int n)
{
    const uint32_t far = 1u << 16; /* beyond any row */
    uint32_t away = far;
    if (!inside[0] && memcmp(inside, inside + 1, (size_t)n - 1) == 0) { /* all background */
        memset(out, 0, (size_t)n * sizeof *out);
        return;
    }
    for (int i = 0; i < n; i++) {
        away = inside[i] ? away + 1 : 0;
        out[i] = away;
    }
    away = far;
    for (int i = n - 1; i >= 0; i--) {
        away = inside[i] ? away + 1 : 0;
        const uint32_t least = away < out[i] ? away : out[i];
        out[i] = least >= far ? NONE : least * least;
    }
}

/*
 * f[u] = min over the sites s in [first, last] of f[s] + (u-s)^2, for u in [first, last], in
 * place. Where two parabolas cross exactly at a voxel both are right, so that a quotient
 * rounded to the wrong side of a whole number does no harm.
 */
static void lower_envelope(uint32_t *f, int first, int last, const lines *w)
{
    parabola *top = w->envelope - 1;
    for (int u = first; u <= last; u++) {
        const uint32_t here = f[(size_t)u * BLOCK];
        if (here == NONE) {
            continue;
        }
        const double height = here + (double)u * u;
        int start = first;
        while (top >= w->envelope) {
            const double crossing = (height - top->height) * w->half_inverse[u - top->site];
            if (crossing >= top->start) {
                start = crossing < last ? (int)crossing + 1 : last + 1;
                break;
            }
            top--;
        }
        if (start <= last) {
            *++top = (parabola){.height = height, .site = u, .start = start};
        }
    }
    int end = last;
    for (; top >= w->envelope; top--) {
        const uint32_t base = (uint32_t)(top->height - (double)top->site * top->site);
        for (int u = end; u >= top->start; u--) {
            const int away = u - top->site;
            f[(size_t)u * BLOCK] = base + (uint32_t)(away * away);
        }
        end = top->start - 1;
    }
}

/* One line: background stays 0 and cuts it into runs, each with an envelope of its own that
 * the background voxels at its ends belong to. */
static void transform_line(uint32_t *f, int n, const lines *w)
{
    int u = 0;
    while (u < n) {
        if (f[(size_t)u * BLOCK] == 0) {
            u++;
            continue;
        }
        const int first = u > 0 ? u - 1 : 0;
        while (u < n && f[(size_t)u * BLOCK] != 0) {
            u++;
        }
        lower_envelope(f, first, u < n ? u : n - 1, w);
    }
}

/* Transforms a block of up to BLOCK neighbouring lines, their voxels `stride` apart, in the
 * work space; 0 if all are background. */
static int transform_block(const uint32_t *grid, int width, int n, size_t stride, const lines *w)
{
    uint32_t any = 0;
    for (int u = 0; u < n; u++) {
        for (int c = 0; c < width; c++) {
            const uint32_t value = grid[(size_t)u * stride + (size_t)c];
            w->block[(size_t)u * BLOCK + (size_t)c] = value;
            any |= value;
        }
    }
    for (int c = 0; any && c < width; c++) {
        transform_line(w->block + c, n, w);
    }
    return any != 0;
}

static int block_width(int n, int at)
{
    return n - at < BLOCK ? n - at : BLOCK;
}

/* The pass along y of one plane of constant z, in place. */
static void transform_plane(uint32_t *plane, const int n[3], const lines *w)
{
    for (int i = 0; i < n[0]; i += BLOCK) {
        const int width = block_width(n[0], i);
        if (transform_block(plane + i, width, n[1], (size_t)n[0], w)) {
            for (int j = 0; j < n[1]; j++) {
                memcpy(plane + (size_t)j * n[0] + i, w->block + (size_t)j * BLOCK, (size_t)width * sizeof *plane);
            }
        }
    }
}

/* The integers on the way become floats, zeros too. */
static void write_background(float *roots, int width, int n, size_t stride)
{
    for (int k = 0; k < n; k++) {
        for (int c = 0; c < width; c++) {
            roots[(size_t)k * stride + (size_t)c] = 0;
        }
    }
}

/* The pass along z of all lines with one y, and the roots. `row` is voxel (0, y, 0). */
static void transform_slice(uint32_t *row, float *roots, const int n[3], const lines *w)
{
    const size_t stride = (size_t)n[0] * (size_t)n[1];
    for (int i = 0; i < n[0]; i += BLOCK) {
        const int width = block_width(n[0], i);
        if (!transform_block(row + i, width, n[2], stride, w)) {
            write_background(roots + i, width, n[2], stride);
            continue;
        }
        for (int k = 0; k < n[2]; k++) {
            for (int c = 0; c < width; c++) {
                const uint32_t squared = w->block[(size_t)k * BLOCK + (size_t)c];
                const float root = sqrtf((float)squared);
                roots[(size_t)k * stride + (size_t)(i + c)] = squared == NONE ? INFINITY : root;
            }
        }
    }
}

ms_status ms_distance(float *distance, const uint8_t *inside, const int n[3], ms_error *err)
{
    for (int a = 0; a < 3; a++) {
        if (n[a] < 1 || n[a] > 32767) {
            return ms_fail(err, MS_ERR_ARG, "grid extent %d along %c is not from 1 to 32767", n[a], "xyz"[a]);
        }
    }
    const size_t stride = (size_t)n[0] * (size_t)n[1];
    uint32_t *squared = (uint32_t *)(void *)distance;
    int out_of_memory = 0;
#pragma omp parallel reduction(| : out_of_memory) if (stride * (size_t)n[2] >= MS_GRID_THREADS_FROM)
    {
        lines w = {0};
        const int ready = lines_alloc(&w, (size_t)(n[1] > n[2] ? n[1] : n[2]));
        out_of_memory = !ready;
#pragma omp for schedule(dynamic, 1)
        for (int k = 0; k < n[2]; k++) {
            if (ready) {
                uint32_t *plane = squared + stride * k;
                for (int j = 0; j < n[1]; j++) {
                    row_distances(plane + (size_t)j * n[0], inside + stride * k + (size_t)j * n[0], n[0]);
                }
                transform_plane(plane, n, &w);
            }
        }
#pragma omp for schedule(dynamic, 1)
        for (int j = 0; j < n[1]; j++) {
            if (ready) {
                transform_slice(squared + (size_t)j * n[0], distance + (size_t)j * n[0], n, &w);
            }
        }
        lines_free(&w);
    }
    if (out_of_memory) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for lines of %d voxels", n[1] > n[2] ? n[1] : n[2]);
    }
    return MS_OK;
}
