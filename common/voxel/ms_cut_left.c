#include "ms_cut_left.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Squared distances that are as good as equal, as of ms_raster; of the box of a block, more than it is rounded by. */
static const double ON_SURFACE = 1e-9, BOX_ROUNDED = 1e-6;

/* What is left of the square of a chord, in a row. */
static double find_rest(const ms_ball *ball, double dy, double dz)
{
    return ball->radius * ball->radius + ON_SURFACE - dy * dy - dz * dz;
}

static int holds(const ms_ball *ball, const ms_cut_cell *cell)
{
    const double dx = (double)cell->at[0] - ball->centre[0];
    const double dy = (double)cell->at[1] - ball->centre[1], dz = (double)cell->at[2] - ball->centre[2];
    return dx * dx <= find_rest(ball, dy, dz);
}

static void keep_taken(ms_cut_taken *taken, ms_cut_cell cell)
{
    if (taken) {
        taken->cell[taken->count++ & (MS_CUT_TAKEN - 1)] = cell;
    }
}

/* Of the box of a block: -1 beyond the ball, 1 in it, 0 may be either. */
static int find_side(const ms_cut_block *block, const ms_ball *ball)
{
    const double square = ball->radius * ball->radius;
    double near = 0, far = 0;
    for (int a = 0; a < 3; a++) {
        const double below = (double)block->lo[a] - ball->centre[a], above = ball->centre[a] - (double)block->hi[a];
        const double outside = below > above ? below : above, across = below < above ? below : above;
        near += outside > 0 ? outside * outside : 0;
        far += across * across;
    }
    return near > square + BOX_ROUNDED ? -1 : far < square - BOX_ROUNDED;
}

/* What is left of the cells of a block; covers it, if `mark` is the same. */
static int64_t count_left_block(const ms_cut_left *left, ms_cut_left *mark, ms_cut_taken *taken, size_t b,
                                const ms_ball *ball)
{
    const ms_cut_block *block = &left->cells->block[b];
    const int side = left->in_block[b] > 0 ? find_side(block, ball) : -1;
    int64_t sum = 0;
    for (size_t c = block->first; side >= 0 && c < block[1].first; c++) {
        const ms_cut_cell *cell = &left->cells->cell[c];
        if (left->cell[c] && (side > 0 || holds(ball, cell))) {
            sum += cell->weight;
            if (mark) {
                mark->cell[c] = 0;
                mark->in_block[b]--;
                keep_taken(taken, *cell);
            }
        }
    }
    return sum;
}

/* The blocks from..to-1 along an axis that may have cells within reach: centroids lie within a voxel of the centre of
 * their voxel. */
static void find_blocks(int *from, int *to, const ms_cut_cells *cells, const ms_ball *ball, int axis)
{
    const double reach = ball->radius + 1 + BOX_ROUNDED, blocks = cells->blocks[axis];
    *from = (int)fmin(fmax(floor((ball->centre[axis] - reach) / MS_CUT_BLOCK), 0), blocks);
    *to = (int)fmin(fmax(floor((ball->centre[axis] + reach) / MS_CUT_BLOCK) + 1, *from), blocks);
}

static int64_t count_left_blocks(const ms_cut_left *left, ms_cut_left *mark, ms_cut_taken *taken, const ms_ball *ball)
{
    int from[3], to[3];
    int64_t sum = 0;
    for (int a = 0; a < 3; a++) {
        find_blocks(&from[a], &to[a], left->cells, ball, a);
    }
    for (int k = from[2]; k < to[2]; k++) {
        for (int j = from[1]; j < to[1]; j++) {
            const size_t row = ms_cut_cells_block(left->cells, 0, j, k);
            for (int i = from[0]; i < to[0]; i++) {
                sum += count_left_block(left, mark, taken, row + (size_t)i, ball);
            }
        }
    }
    return sum;
}

/* The voxels from..to-1 of a row whose centres a chord holds, by the very test of `holds`. */
static void find_chord(int *from, int *to, double x, double rest, int n)
{
    const double chord = sqrt(rest);
    *from = (int)fmin(fmax(ceil(x - chord) - 1, 0), n);
    *to = (int)fmin(fmax(floor(x + chord) + 2, *from), n);
    while (*from < *to && (*from - x) * (*from - x) > rest) {
        ++*from;
    }
    while (*from < *to && (*to - 1 - x) * (*to - 1 - x) > rest) {
        --*to;
    }
}

/* The sum of bytes that are 0 or 1, eight at a time. */
static int sum_flags(const uint8_t *flag, int n)
{
    int sum = 0, i = 0;
    for (; i + 8 <= n; i += 8) {
        uint64_t eight;
        memcpy(&eight, flag + i, sizeof eight);
        sum += (int)(eight * 0x0101010101010101u >> 56);
    }
    for (; i < n; i++) {
        sum += flag[i];
    }
    return sum;
}

static void take_left_voxels(ms_cut_left *mark, ms_cut_taken *taken, int from, int to, int j, size_t row, int k)
{
    uint8_t *voxel = mark->voxel + (size_t)mark->cells->n[0] * row;
    for (int i = from; i < to; i++) {
        if (voxel[i]) {
            voxel[i] = 0;
            mark->in_row[row]--;
            keep_taken(taken, (ms_cut_cell){{(float)i, (float)j, (float)k}, MS_CUT_WHOLE});
        }
    }
}

/* What is left of the whole voxels. */
static int64_t count_left_voxels(const ms_cut_left *left, ms_cut_left *mark, ms_cut_taken *taken, const ms_ball *ball)
{
    const int *n = left->cells->n;
    int64_t sum = 0;
    int from, to, j, rows, k, planes;
    find_chord(&k, &planes, ball->centre[2], find_rest(ball, 0, 0), n[2]);
    for (; k < planes; k++) {
        const double dz = k - ball->centre[2];
        for (find_chord(&j, &rows, ball->centre[1], fmax(find_rest(ball, 0, dz), 0), n[1]); j < rows; j++) {
            const size_t row = (size_t)j + (size_t)n[1] * (size_t)k;
            const double rest = left->in_row[row] > 0 ? find_rest(ball, j - ball->centre[1], dz) : -1;
            if (rest >= 0) {
                find_chord(&from, &to, ball->centre[0], rest, n[0]);
                const int found = sum_flags(left->voxel + (size_t)n[0] * row + from, to - from);
                sum += found;
                if (mark && found > 0) {
                    take_left_voxels(mark, taken, from, to, j, row, k);
                }
            }
        }
    }
    return sum * MS_CUT_WHOLE;
}

int64_t ms_cut_left_count(const ms_cut_left *left, const ms_ball *ball)
{
    return count_left_blocks(left, NULL, NULL, ball) + count_left_voxels(left, NULL, NULL, ball);
}

int64_t ms_cut_left_cover(ms_cut_left *left, const ms_ball *ball, ms_cut_taken *taken)
{
    return count_left_blocks(left, left, taken, ball) + count_left_voxels(left, left, taken, ball);
}

int64_t ms_cut_left_fallen(const ms_cut_taken *taken, uint64_t from, const ms_ball *ball)
{
    int64_t sum = 0;
    for (uint64_t t = from; t < taken->count; t++) {
        const ms_cut_cell *cell = &taken->cell[t & (MS_CUT_TAKEN - 1)];
        sum += holds(ball, cell) ? cell->weight : 0;
    }
    return sum;
}

ms_cut_left *ms_cut_left_build(const ms_cut_cells *cells)
{
    const size_t blocks = ms_cut_cells_block(cells, 0, 0, cells->blocks[2]);
    const size_t rows = (size_t)cells->n[1] * (size_t)cells->n[2], voxels = rows * (size_t)cells->n[0];
    ms_cut_left *left = calloc(1, sizeof *left);
    if (left) {
        *left = (ms_cut_left){.cells = cells,
                              .cell = malloc(cells->count + 1),
                              .voxel = malloc(voxels),
                              .in_block = malloc(blocks * sizeof *left->in_block),
                              .in_row = malloc(rows * sizeof *left->in_row)};
    }
    if (!left || !left->cell || !left->voxel || !left->in_block || !left->in_row) {
        ms_cut_left_free(left);
        return NULL;
    }
    memset(left->cell, 1, cells->count);
    memcpy(left->voxel, cells->whole, voxels);
    for (size_t b = 0; b < blocks; b++) {
        left->in_block[b] = (uint32_t)(cells->block[b + 1].first - cells->block[b].first);
    }
    for (size_t row = 0; row < rows; row++) {
        left->in_row[row] = (uint16_t)sum_flags(cells->whole + row * (size_t)cells->n[0], cells->n[0]);
    }
    return left;
}

void ms_cut_left_free(ms_cut_left *left)
{
    if (left) {
        free(left->cell);
        free(left->voxel);
        free(left->in_block);
        free(left->in_row);
        free(left);
    }
}
