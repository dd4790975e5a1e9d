#include "ms_coverage_count.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Voxels from..to-1 of row (j, k) whose centres the sphere holds. */
static int row_of(int range[2], const ms_ball *ball, const ms_grid *grid, int j, int k)
{
    const double dy = j - ball->centre[1], dz = k - ball->centre[2];
    const double rest = ball->radius * ball->radius - dy * dy - dz * dz;
    if (!(rest >= 0)) {
        return 0;
    }
    range[0] = (int)ceil(fmax(0, ball->centre[0] - sqrt(rest)));
    range[1] = (int)floor(fmin(grid->n[0] - 1, ball->centre[0] + sqrt(rest))) + 1;
    return range[0] < range[1];
}

/* Rows or planes from..to-1 that the sphere may meet. */
static void span_of(int range[2], const ms_ball *ball, const ms_grid *grid, int axis)
{
    range[0] = (int)ceil(fmin(grid->n[axis], fmax(0, ball->centre[axis] - ball->radius)));
    range[1] = (int)floor(fmax(-1, fmin(grid->n[axis] - 1, ball->centre[axis] + ball->radius))) + 1;
}

static void count_plane(uint16_t *covers, const ms_grid *grid, const ms_ball *ball, size_t count, int k)
{
    for (size_t b = 0; b < count; b++) {
        int rows[2], run[2];
        if (fabs(k - ball[b].centre[2]) > ball[b].radius) {
            continue;
        }
        span_of(rows, &ball[b], grid, 1);
        for (int j = rows[0]; j < rows[1]; j++) {
            if (row_of(run, &ball[b], grid, j, k)) {
                uint16_t *row = covers + ms_grid_index(grid, 0, j, k);
                for (int i = run[0]; i < run[1]; i++) {
                    row[i]++;
                }
            }
        }
    }
}

ms_status ms_coverage_count_open(ms_coverage_count *out, const ms_grid *grid, const ms_ball *ball, size_t count,
                                 ms_error *err)
{
    const size_t voxels = ms_grid_voxels(grid), plane = (size_t)grid->n[0] * (size_t)grid->n[1];
    uint16_t *covers = calloc(voxels, sizeof *covers);
    int64_t sum = 0;
    *out = (ms_coverage_count){.grid = grid, .covers = covers};
    if (!covers) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to compare spheres on %zu voxels; use fewer cells", voxels);
    }
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : sum)
    for (int k = 0; k < grid->n[2]; k++) {
        count_plane(covers, grid, ball, count, k);
        for (size_t v = (size_t)k * plane; v < (size_t)(k + 1) * plane; v++) {
            sum += (covers[v] > 0) != (grid->inside[v] != 0);
        }
    }
    out->mismatch = sum;
    return MS_OK;
}

void ms_coverage_count_close(ms_coverage_count *o)
{
    free(o->covers);
    memset(o, 0, sizeof *o);
}

/* Of the sphere's voxels that so many spheres cover: those inside less those outside. */
static inline int64_t count_balance(const ms_coverage_count *o, const ms_ball *ball, uint16_t covered)
{
    const ms_grid *grid = o->grid;
    int planes[2], rows[2], run[2];
    int64_t sum = 0;
    span_of(planes, ball, grid, 2);
    span_of(rows, ball, grid, 1);
    for (int k = planes[0]; k < planes[1]; k++) {
        for (int j = rows[0]; j < rows[1]; j++) {
            if (!row_of(run, ball, grid, j, k)) {
                continue;
            }
            const size_t row = ms_grid_index(grid, 0, j, k);
            const uint16_t *covers = o->covers + row;
            const uint8_t *inside = grid->inside + row;
            int part = 0;
            for (int i = run[0]; i < run[1]; i++) {
                part += (covers[i] == covered) * (2 * inside[i] - 1);
            }
            sum += part;
        }
    }
    return sum;
}

int64_t ms_coverage_count_loss(const ms_coverage_count *o, const ms_ball *ball)
{
    return count_balance(o, ball, 1);
}

int64_t ms_coverage_count_gain(const ms_coverage_count *o, const ms_ball *ball)
{
    return count_balance(o, ball, 0);
}

static void change_counts(ms_coverage_count *o, const ms_ball *ball, int by)
{
    int planes[2], rows[2], run[2];
    span_of(planes, ball, o->grid, 2);
    span_of(rows, ball, o->grid, 1);
    for (int k = planes[0]; k < planes[1]; k++) {
        for (int j = rows[0]; j < rows[1]; j++) {
            if (row_of(run, ball, o->grid, j, k)) {
                uint16_t *covers = o->covers + ms_grid_index(o->grid, 0, j, k);
                for (int i = run[0]; i < run[1]; i++) {
                    covers[i] = (uint16_t)(covers[i] + by);
                }
            }
        }
    }
}

void ms_coverage_count_add(ms_coverage_count *o, const ms_ball *ball)
{
    o->mismatch -= ms_coverage_count_gain(o, ball);
    change_counts(o, ball, 1);
}

void ms_coverage_count_remove(ms_coverage_count *o, const ms_ball *ball)
{
    o->mismatch += ms_coverage_count_loss(o, ball);
    change_counts(o, ball, -1);
}

void ms_coverage_count_clear(ms_grid *grid, const ms_ball *ball, size_t count)
{
    for (size_t b = 0; b < count; b++) {
        int planes[2], rows[2], run[2];
        span_of(planes, &ball[b], grid, 2);
        span_of(rows, &ball[b], grid, 1);
        for (int k = planes[0]; k < planes[1]; k++) {
            for (int j = rows[0]; j < rows[1]; j++) {
                if (row_of(run, &ball[b], grid, j, k)) {
                    memset(grid->inside + ms_grid_index(grid, run[0], j, k), 0, (size_t)(run[1] - run[0]));
                }
            }
        }
    }
}
