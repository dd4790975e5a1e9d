/* What balls hold of cells that were cut. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_cut_cells.h"

/* Squared distances that are as good as equal, as of ms_raster. */
static const double ON_SURFACE = 1e-9;

/* The first cell of a row that may lie beyond x; cells of one voxel are in no order. */
static size_t find_in_row(const ms_cut_cells *cells, size_t from, size_t to, double x)
{
    while (from < to) {
        const size_t middle = from + (to - from) / 2;
        if ((double)cells->cell[middle].at[0] < x - 1) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    return from;
}

/* What is left of the cut cells of a row; covers it, if `mark` is `left`. */
static int64_t count_cells(const ms_cut_cells *cells, const uint8_t *left, uint8_t *mark, const ms_ball *ball,
                           size_t row, double chord)
{
    const double *centre = ball->centre, square = ball->radius * ball->radius + ON_SURFACE;
    const size_t start = cells->row[row], end = cells->row[row + 1];
    int64_t sum = 0;
    if (start == end) {
        return 0;
    }
    for (size_t c = find_in_row(cells, start, end, centre[0] - chord); c < end; c++) {
        const ms_cut_cell *cell = &cells->cell[c];
        const double dx = (double)cell->at[0] - centre[0];
        if (dx > chord + 1) {
            break;
        }
        if (!left[c]) {
            continue;
        }
        const double dy = (double)cell->at[1] - centre[1], dz = (double)cell->at[2] - centre[2];
        if (dx * dx + dy * dy + dz * dz <= square) {
            sum += cell->weight;
            if (mark) {
                mark[c] = 0;
            }
        }
    }
    return sum;
}

/* What is left of the whole voxels (., j, k). */
static int64_t count_uncut_voxels(const ms_cut_cells *cells, const uint8_t *left, uint8_t *mark, const ms_ball *ball,
                                  int j, int k)
{
    const double x = ball->centre[0], dy = j - ball->centre[1], dz = k - ball->centre[2];
    const double rest = ball->radius * ball->radius + ON_SURFACE - dy * dy - dz * dz;
    if (!(rest >= 0)) {
        return 0;
    }
    const double chord = sqrt(rest);
    const size_t row = (size_t)cells->n[0] * ((size_t)j + (size_t)cells->n[1] * (size_t)k), first = cells->count + row;
    const int from = (int)fmin(fmax(ceil(x - chord), 0), cells->n[0]);
    const int to = (int)fmin(fmax(floor(x + chord) + 1, from), cells->n[0]);
    int sum = 0;
    for (int i = from; i < to; i++) {
        sum += left[first + (size_t)i];
    }
    if (mark) {
        memset(mark + first + from, 0, (size_t)(to - from));
    }
    return (int64_t)sum * MS_CUT_WHOLE;
}

/* The rows from..to-1 that may hold something within `reach`. */
static void find_cut_rows(int *from, int *to, double centre, double reach, int n)
{
    *from = (int)fmin(fmax(ceil(centre - reach - 0.5), 0), n);
    *to = (int)fmin(fmax(floor(centre + reach + 0.5) + 1, *from), n);
}

static int64_t weigh_ball(const ms_cut_cells *cells, const uint8_t *left, uint8_t *mark, const ms_ball *ball)
{
    const double reach = ball->radius + ON_SURFACE;
    int64_t sum = 0;
    int k, planes, j, rows;
    for (find_cut_rows(&k, &planes, ball->centre[2], reach, cells->n[2]); k < planes; k++) {
        const double dz = fmax(0, fabs(k - ball->centre[2]) - 0.5), disc = sqrt(fmax(0, reach * reach - dz * dz));
        for (find_cut_rows(&j, &rows, ball->centre[1], disc, cells->n[1]); j < rows; j++) {
            const double dy = fmax(0, fabs(j - ball->centre[1]) - 0.5);
            const double chord = sqrt(fmax(0, disc * disc - dy * dy)) + ON_SURFACE;
            sum += count_cells(cells, left, mark, ball, (size_t)j + (size_t)cells->n[1] * (size_t)k, chord);
            sum += count_uncut_voxels(cells, left, mark, ball, j, k);
        }
    }
    return sum;
}

static size_t voxels_of(const ms_cut_cells *cells)
{
    return (size_t)cells->n[0] * (size_t)cells->n[1] * (size_t)cells->n[2];
}

uint8_t *ms_cut_cells_left(const ms_cut_cells *cells)
{
    uint8_t *left = malloc(cells->count + voxels_of(cells));
    if (left) {
        memset(left, 1, cells->count);
        memcpy(left + cells->count, cells->whole, voxels_of(cells));
    }
    return left;
}

int64_t ms_cut_cells_count(const ms_cut_cells *cells, const uint8_t *left, const ms_ball *ball)
{
    return weigh_ball(cells, left, NULL, ball);
}

int64_t ms_cut_cells_cover(const ms_cut_cells *cells, uint8_t *left, const ms_ball *ball)
{
    return weigh_ball(cells, left, left, ball);
}
