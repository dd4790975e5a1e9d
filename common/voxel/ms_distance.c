#include "ms_distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_grid.h"

/* Strided passes take neighbouring lines together, as many as fill a cache line, so that
 * every byte fetched is used. In the work space they stay interleaved: no transposition. */
enum { BLOCK = MS_DISTANCE_BLOCK };

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

/* The part of a line of n voxels that is asked for: from <= u < to. */
typedef struct line_part {
    int n, from, to;
} line_part;

/* One line: background stays 0 and cuts it into runs, each with an envelope of its own that
 * the background voxels at its ends belong to. Runs with nothing that is asked for are left as they are. */
static void transform_line(uint32_t *f, const line_part *s, const lines *w)
{
    int u = 0;
    while (u < s->to) {
        if (f[(size_t)u * BLOCK] == 0) {
            u++;
            continue;
        }
        const int first = u > 0 ? u - 1 : 0;
        while (u < s->n && f[(size_t)u * BLOCK] != 0) {
            u++;
        }
        if (u > s->from) {
            lower_envelope(f, first, u < s->n ? u : s->n - 1, w);
        }
    }
}

/* Transforms a block of up to BLOCK neighbouring lines, their voxels `stride` apart, in the
 * work space; 0 if all are background. */
static int transform_block(const uint32_t *grid, int width, const line_part *s, size_t stride, const lines *w)
{
    uint32_t any = 0;
    for (int u = 0; u < s->n; u++) {
        for (int c = 0; c < width; c++) {
            const uint32_t value = grid[(size_t)u * stride + (size_t)c];
            w->block[(size_t)u * BLOCK + (size_t)c] = value;
            any |= value;
        }
    }
    for (int c = 0; any && c < width; c++) {
        transform_line(w->block + c, s, w);
    }
    return any != 0;
}

static int block_width(int n, int at)
{
    return n - at < BLOCK ? n - at : BLOCK;
}

/* The pass along y of one plane of constant z, rows of `width_x` voxels; what is asked for goes to `out`, which may be
 * the plane itself. */
static void transform_plane(uint32_t *out, const uint32_t *plane, int width_x, const line_part *y, const lines *w)
{
    for (int i = 0; i < width_x; i += BLOCK) {
        const int width = block_width(width_x, i);
        const int any = transform_block(plane + i, width, y, (size_t)width_x, w);
        if (!any && out == plane) {
            continue; /* zeros already */
        }
        for (int j = y->from; j < y->to; j++) {
            uint32_t *to = out + (size_t)(j - y->from) * (size_t)width_x + i;
            memcpy(to, w->block + (size_t)j * BLOCK, (size_t)width * sizeof *to);
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

/* The pass along z of all lines with one y, and the roots of what is asked for. `row` is the first voxel of that y,
 * of planes `stride` apart; the roots' planes are `apart`. */
static void transform_slice(float *roots, size_t apart, const uint32_t *row, size_t stride, int width_x,
                            const line_part *z, const lines *w)
{
    for (int i = 0; i < width_x; i += BLOCK) {
        const int width = block_width(width_x, i);
        if (!transform_block(row + i, width, z, stride, w)) {
            write_background(roots + i, width, z->to - z->from, apart);
            continue;
        }
        for (int k = z->from; k < z->to; k++) {
            for (int c = 0; c < width; c++) {
                const uint32_t squared = w->block[(size_t)k * BLOCK + (size_t)c];
                const float root = sqrtf((float)squared);
                roots[(size_t)(k - z->from) * apart + (size_t)(i + c)] = squared == NONE ? INFINITY : root;
            }
        }
    }
}

static ms_status check_extents(const int n[3], ms_error *err)
{
    for (int a = 0; a < 3; a++) {
        if (n[a] < 1 || n[a] > MS_GRID_MAX_EXTENT) {
            return ms_fail(err, MS_ERR_ARG, "grid extent %d along %c is not from 1 to %d", n[a], "xyz"[a],
                           MS_GRID_MAX_EXTENT);
        }
    }
    return MS_OK;
}

ms_status ms_distance(float *distance, const uint8_t *inside, const int n[3], ms_error *err)
{
    const ms_status status = check_extents(n, err);
    if (status != MS_OK) {
        return status;
    }
    const size_t stride = (size_t)n[0] * (size_t)n[1];
    const line_part y = {n[1], 0, n[1]}, z = {n[2], 0, n[2]};
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
                transform_plane(plane, plane, n[0], &y, &w);
            }
        }
#pragma omp for schedule(dynamic, 1)
        for (int j = 0; j < n[1]; j++) {
            if (ready) {
                transform_slice(distance + (size_t)j * n[0], stride, squared + (size_t)j * n[0], stride, n[0], &z, &w);
            }
        }
        lines_free(&w);
    }
    if (out_of_memory) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for lines of %d voxels", n[1] > n[2] ? n[1] : n[2]);
    }
    return MS_OK;
}

/* The wanted planes of a row (along z), and how far the background that decides of them may be. */
typedef struct wanted_row {
    int from, to, reach;
} wanted_row;

/* A block of columns of which some voxels are wanted. */
typedef struct block_job {
    float *distance;
    const uint8_t *inside, *wanted; /* wanted[0]: of the block in row 0 */
    const int *n;
    int x, width, blocks;         /* first column, columns, blocks of a row */
    int lo, hi;                   /* rows with wanted voxels */
    int first_plane, after_plane; /* planes that may decide */
    wanted_row *row;              /* n[1] */
    uint32_t *between;            /* after x and y: rows lo to hi of those planes */
} block_job;

/* How many voxels there are without background before `at`, or from it on (forward). */
static int count_inside(const uint8_t *inside, int n, int at, int forward)
{
    if (forward) {
        const uint8_t *end = at < n ? memchr(inside + at, 0, (size_t)(n - at)) : NULL;
        return end ? (int)(end - inside) - at : (int)MS_GRID_MAX_EXTENT + 1;
    }
    const uint64_t ones = 0x0101010101010101u, highest = 0x8080808080808080u;
    int i = at;
    for (; i >= 8; i -= 8) {
        uint64_t eight;
        memcpy(&eight, inside + i - 8, sizeof eight);
        if ((eight - ones) & ~eight & highest) { /* a byte is 0: Warren, Hacker's Delight, 6-1 */
            break;
        }
    }
    while (i > 0 && inside[i - 1]) {
        i--;
    }
    return i > 0 ? at - i : (int)MS_GRID_MAX_EXTENT + 1;
}

/* row_distances of `width` voxels from x on; 0 if all are background. */
static int part_distances(uint32_t *out, const uint8_t *inside, int n, int x, int width)
{
    const uint32_t far = MS_GRID_MAX_EXTENT + 1;
    if (!inside[x] && memcmp(inside + x, inside + x + 1, (size_t)width - 1) == 0) {
        memset(out, 0, (size_t)width * sizeof *out);
        return 0;
    }
    uint32_t away = (uint32_t)count_inside(inside, n, x, 0);
    for (int i = 0; i < width; i++) {
        away = inside[x + i] ? away + 1 : 0;
        out[i] = away;
    }
    away = (uint32_t)count_inside(inside, n, x + width, 1);
    for (int i = width - 1; i >= 0; i--) {
        away = inside[x + i] ? away + 1 : 0;
        const uint32_t least = away < out[i] ? away : out[i];
        out[i] = least >= far ? NONE : least * least;
    }
    return 1;
}

static size_t find_row(const block_job *b, int j, int k)
{
    return (size_t)j + (size_t)b->n[1] * (size_t)k;
}

static int is_wanted(const block_job *b, int j, int k)
{
    return b->wanted[find_row(b, j, k) * (size_t)b->blocks];
}

/* Where voxels of row j are wanted. No background that decides is farther than that of a voxel's own line along x. */
static wanted_row find_wanted(const block_job *b, int j)
{
    wanted_row w = {b->n[2], 0, 0};
    uint32_t most = 0;
    for (int k = 0; k < b->n[2]; k++) {
        uint32_t line[BLOCK];
        if (is_wanted(b, j, k)) {
            w.from = k < w.from ? k : w.from;
            w.to = k + 1;
            if (part_distances(line, b->inside + find_row(b, j, k) * (size_t)b->n[0], b->n[0], b->x, b->width)) {
                for (int c = 0; c < b->width; c++) {
                    most = line[c] > most ? line[c] : most;
                }
            }
        }
    }
    w.reach = most == NONE ? MS_GRID_MAX_EXTENT : (int)ceil(sqrt(most));
    return w;
}

/* The first of the planes that may decide of a row, and the one after the last. */
static int first_deciding(const block_job *b, int j)
{
    return b->row[j].from > b->row[j].reach ? b->row[j].from - b->row[j].reach : 0;
}

static int after_deciding(const block_job *b, int j)
{
    return b->n[2] - b->row[j].to > b->row[j].reach ? b->row[j].to + b->row[j].reach : b->n[2];
}

/* 0 if nothing is wanted in the block. */
static int find_rows(block_job *b)
{
    b->lo = b->n[1];
    b->hi = b->after_plane = 0;
    b->first_plane = b->n[2];
#pragma omp parallel for schedule(dynamic, 4) if ((size_t)b->n[1] * (size_t)b->n[2] >= MS_GRID_THREADS_FROM)
    for (int j = 0; j < b->n[1]; j++) {
        b->row[j] = find_wanted(b, j);
    }
    for (int j = 0; j < b->n[1]; j++) {
        if (b->row[j].to > 0) {
            b->lo = j < b->lo ? j : b->lo;
            b->hi = j + 1;
            b->first_plane = first_deciding(b, j) < b->first_plane ? first_deciding(b, j) : b->first_plane;
            b->after_plane = after_deciding(b, j) > b->after_plane ? after_deciding(b, j) : b->after_plane;
        }
    }
    return b->hi > 0;
}

/* The passes along x and y of plane k, as far as it may decide of wanted voxels. */
static void block_plane(const block_job *b, int k, const lines *w)
{
    int lo = b->hi, hi = b->lo, from = b->n[1], to = 0, any = 0;
    for (int j = b->lo; j < b->hi; j++) {
        if (b->row[j].to > 0 && k >= first_deciding(b, j) && k < after_deciding(b, j)) {
            const int reach = b->row[j].reach;
            lo = j < lo ? j : lo;
            hi = j + 1;
            from = j - reach < from ? j - reach : from;
            to = j + reach >= to ? j + reach + 1 : to;
        }
    }
    from = from > 0 ? from : 0;
    to = to < b->n[1] ? to : b->n[1];
    for (int j = from; j < to; j++) {
        any |= part_distances(w->block + (size_t)(j - from) * BLOCK, b->inside + find_row(b, j, k) * (size_t)b->n[0],
                              b->n[0], b->x, b->width);
    }
    const line_part y = {to - from, lo - from, hi - from};
    for (int c = 0; any && c < b->width; c++) {
        transform_line(w->block + c, &y, w);
    }
    const size_t rows = (size_t)(b->hi - b->lo);
    for (int j = lo; j < hi; j++) {
        memcpy(b->between + (rows * (size_t)(k - b->first_plane) + (size_t)(j - b->lo)) * BLOCK,
               w->block + (size_t)(j - from) * BLOCK, BLOCK * sizeof *b->between);
    }
}

/* The pass along z of the lines of row j, and the roots of what is wanted. */
static void block_slice(const block_job *b, int j, const lines *w)
{
    const wanted_row *row = &b->row[j];
    if (row->to == 0) {
        return;
    }
    const size_t rows = (size_t)(b->hi - b->lo);
    const int first = first_deciding(b, j);
    const line_part z = {after_deciding(b, j) - first, row->from - first, row->to - first};
    transform_block(b->between + (rows * (size_t)(first - b->first_plane) + (size_t)(j - b->lo)) * BLOCK, b->width, &z,
                    rows * BLOCK, w);
    for (int k = row->from; k < row->to; k++) {
        float *out = b->distance + find_row(b, j, k) * (size_t)b->n[0] + b->x;
        for (int c = 0; is_wanted(b, j, k) && c < b->width; c++) {
            const uint32_t squared = w->block[(size_t)(k - first) * BLOCK + (size_t)c];
            out[c] = squared == NONE ? INFINITY : sqrtf((float)squared);
        }
    }
}

/* One block's columns. @return 0 without memory */
static int transform_columns(block_job *b)
{
    const int n_z = b->after_plane - b->first_plane;
    const size_t voxels = (size_t)(b->hi - b->lo) * BLOCK * (size_t)n_z;
    b->between = malloc(voxels * sizeof *b->between);
    int out_of_memory = !b->between;
#pragma omp parallel reduction(| : out_of_memory) if (voxels >= 4 * MS_GRID_THREADS_FROM)
    {
        lines w = {0};
        const int ready = lines_alloc(&w, (size_t)(b->n[1] > n_z ? b->n[1] : n_z)) && b->between;
        out_of_memory |= !ready;
#pragma omp for schedule(dynamic, 4)
        for (int k = b->first_plane; k < b->after_plane; k++) {
            if (ready) {
                block_plane(b, k, &w);
            }
        }
#pragma omp for schedule(dynamic, 4)
        for (int j = b->lo; j < b->hi; j++) {
            if (ready) {
                block_slice(b, j, &w);
            }
        }
        lines_free(&w);
    }
    free(b->between);
    return !out_of_memory;
}

ms_status ms_distance_blocks(float *distance, const uint8_t *inside, const int n[3], const uint8_t *wanted,
                             ms_error *err)
{
    ms_status status = check_extents(n, err);
    if (status != MS_OK) {
        return status;
    }
    block_job b = {.distance = distance, .inside = inside, .n = n, .blocks = (n[0] + BLOCK - 1) / BLOCK};
    b.row = malloc((size_t)n[1] * sizeof *b.row);
    int done = b.row != NULL;
    for (int block = 0; block < b.blocks && done; block++) {
        b.x = block * BLOCK;
        b.width = block_width(n[0], b.x);
        b.wanted = wanted + block;
        done = !find_rows(&b) || transform_columns(&b);
    }
    free(b.row);
    return done ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for distances in columns of %d by %d", n[1], n[2]);
}
