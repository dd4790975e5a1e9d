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

/* What ms_distance_box works with. */
typedef struct box_job {
    const uint8_t *inside;
    uint32_t *between; /* after x and y: the box's columns, all planes */
    int wide, high;    /* of the box, along x and y */
    int lo_x, n_x;
    line_part y, z;
} box_job;

/* The passes along x and y of plane k. */
static void box_plane(const box_job *job, uint32_t *rows, uint32_t *row, int k, const lines *w)
{
    for (int j = 0; j < job->y.n; j++) {
        row_distances(row, job->inside + ((size_t)k * job->y.n + (size_t)j) * job->n_x, job->n_x);
        memcpy(rows + (size_t)j * job->wide, row + job->lo_x, (size_t)job->wide * sizeof *rows);
    }
    transform_plane(job->between + (size_t)k * job->wide * job->high, rows, job->wide, &job->y, w);
}

/* All passes. @return 0 without memory */
static int transform_box(float *distance, const size_t apart[2], const box_job *job)
{
    const size_t plane = (size_t)job->wide * (size_t)job->high;
    int out_of_memory = 0;
#pragma omp parallel reduction(| : out_of_memory) if ((size_t)job->n_x * job->y.n * job->z.n >= MS_GRID_THREADS_FROM)
    {
        lines w = {0};
        uint32_t *rows = malloc((size_t)job->wide * job->y.n * sizeof *rows);
        uint32_t *row = malloc((size_t)job->n_x * sizeof *row);
        const int ready = lines_alloc(&w, (size_t)(job->y.n > job->z.n ? job->y.n : job->z.n)) && rows && row;
        out_of_memory = !ready;
#pragma omp for schedule(dynamic, 1)
        for (int k = 0; k < job->z.n; k++) {
            if (ready) {
                box_plane(job, rows, row, k, &w);
            }
        }
#pragma omp for schedule(dynamic, 1)
        for (int j = 0; j < job->high; j++) {
            if (ready) {
                transform_slice(distance + (size_t)j * apart[0], apart[1], job->between + (size_t)j * job->wide, plane,
                                job->wide, &job->z, &w);
            }
        }
        free(row);
        free(rows);
        lines_free(&w);
    }
    return !out_of_memory;
}

ms_status ms_distance_box(float *distance, const size_t apart[2], const uint8_t *inside, const int n[3],
                          const int lo[3], const int hi[3], ms_error *err)
{
    const ms_status status = check_extents(n, err);
    if (status != MS_OK) {
        return status;
    }
    for (int a = 0; a < 3; a++) {
        if (lo[a] < 0 || hi[a] <= lo[a] || hi[a] > n[a]) {
            return ms_fail(err, MS_ERR_ARG, "voxels %d to %d along %c are no part of a grid of %d", lo[a], hi[a],
                           "xyz"[a], n[a]);
        }
    }
    box_job job = {.inside = inside,
                   .wide = hi[0] - lo[0],
                   .high = hi[1] - lo[1],
                   .lo_x = lo[0],
                   .n_x = n[0],
                   .y = {n[1], lo[1], hi[1]},
                   .z = {n[2], lo[2], hi[2]}};
    const size_t between = (size_t)job.wide * (size_t)job.high * (size_t)n[2];
    job.between = malloc(between * sizeof *job.between);
    const int done = job.between && transform_box(distance, apart, &job);
    free(job.between);
    return done ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for distances of %zu voxels", between);
}
