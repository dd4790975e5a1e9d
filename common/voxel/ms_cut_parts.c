#include "ms_cut_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The parts of all planes: row[j + n[1] k] to the next one less 1 are of the voxels (., j, k). */
typedef struct cut_parts {
    ms_cut_cells *cells;
    size_t *row, count;
    ms_cut_cell *cell;
    int32_t *place; /* of each, as of ms_cut_part */
    size_t *into;   /* which it is joined to; itself, if it stays */
} cut_parts;

static size_t find_cut_row(const ms_cut_cells *cells, int j, int k)
{
    return (size_t)j + (size_t)cells->n[1] * (size_t)k;
}

/* Is a voxel whole, and one across a face from it not? */
static int is_by_the_surface(const ms_cut_cells *cells, int i, int j, int k)
{
    const int at[3] = {i, j, k};
    const size_t step[3] = {1, (size_t)cells->n[0], (size_t)cells->n[0] * (size_t)cells->n[1]};
    const uint8_t *voxel = cells->whole + (size_t)i + step[1] * find_cut_row(cells, j, k);
    int open = 0;
    for (int a = 0; a < 3 && *voxel; a++) {
        open |= at[a] == 0 || at[a] + 1 == cells->n[a] || !*(voxel - step[a]) || !*(voxel + step[a]);
    }
    return open;
}

static void put_part(cut_parts *p, size_t at, ms_cut_cell cell, int32_t place)
{
    p->cell[at] = cell;
    p->place[at] = place;
}

static void put_whole_parts(cut_parts *p, size_t at, int i, int j, int k)
{
    for (int part = 0; part < 8; part++) {
        const double x = i - 0.25 + 0.5 * (part & 1), y = j - 0.25 + 0.5 * (part >> 1 & 1);
        const double z = k - 0.25 + 0.5 * (part >> 2);
        put_part(p, at + (size_t)part, (ms_cut_cell){{(float)x, (float)y, (float)z}, MS_CUT_PART}, 8 * i + part);
    }
}

/* Puts the parts of a row where row[] says, or counts them: those of a plane, and of whole voxels by the surface. */
static size_t fill_part_row(cut_parts *p, const ms_cut_plane *plane, int j, int k, int fill)
{
    const size_t first = p->row[find_cut_row(p->cells, j, k)];
    size_t at = first, next = j > 0 ? plane->end[j - 1] : 0;
    for (int i = 0; i < p->cells->n[0]; i++) {
        if (is_by_the_surface(p->cells, i, j, k)) {
            if (fill) {
                put_whole_parts(p, at, i, j, k);
            }
            at += 8;
        }
        for (; next < plane->end[j] && plane->part[next].place / 8 == i; next++, at++) {
            if (fill) {
                put_part(p, at, plane->part[next].cell, plane->part[next].place);
            }
        }
    }
    return at - first;
}

static void fill_plane(cut_parts *p, ms_cut_plane *plane, int k)
{
    for (int j = 0; j < p->cells->n[1]; j++) {
        fill_part_row(p, plane, j, k, 1);
    }
    free(plane->part);
    free(plane->end);
    *plane = (ms_cut_plane){0};
}

/* Puts the planes one after the other. */
static int fill_planes(cut_parts *p, ms_cut_plane *plane)
{
    const ms_cut_cells *cells = p->cells;
    const size_t rows = find_cut_row(cells, 0, cells->n[2]);
    size_t *count = calloc(rows + 1, sizeof *count);
    p->row = calloc(rows + 1, sizeof *p->row);
    for (int k = 0; p->row && count && k < cells->n[2]; k++) {
        for (int j = 0; j < cells->n[1]; j++) {
            count[find_cut_row(cells, j, k)] = fill_part_row(p, &plane[k], j, k, 0);
        }
    }
    for (size_t row = 0; p->row && count && row < rows; row++) {
        p->row[row + 1] = p->row[row] + count[row];
    }
    p->count = p->row ? p->row[rows] : 0;
    p->cell = malloc((p->count + 1) * sizeof *p->cell);
    p->place = malloc((p->count + 1) * sizeof *p->place);
    const int complete = p->row && count && p->cell && p->place;
    free(count);
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < cells->n[2] * complete; k++) {
        fill_plane(p, &plane[k], k);
    }
    return complete;
}

/* Whole voxels of which the parts have been put are whole no longer. */
static void clear_parted(const cut_parts *p)
{
    const ms_cut_cells *cells = p->cells;
    for (size_t row = 0; row < find_cut_row(cells, 0, cells->n[2]); row++) {
        for (size_t c = p->row[row]; c < p->row[row + 1]; c++) {
            cells->whole[(size_t)(p->place[c] / 8) + (size_t)cells->n[0] * row] = 0;
        }
    }
}

/* The part at (x, y, z), counted in parts; SIZE_MAX: there is none. */
static size_t find_part(const cut_parts *p, int x, int y, int z)
{
    const ms_cut_cells *cells = p->cells;
    if (x < 0 || y < 0 || z < 0 || x >= 2 * cells->n[0] || y >= 2 * cells->n[1] || z >= 2 * cells->n[2]) {
        return SIZE_MAX;
    }
    const size_t row = find_cut_row(cells, y / 2, z / 2), end = p->row[row + 1];
    const int32_t place = 8 * (x / 2) + x % 2 + 2 * (y % 2) + 4 * (z % 2);
    size_t from = p->row[row], to = end;
    while (from < to) {
        const size_t middle = from + (to - from) / 2;
        if (p->place[middle] < place) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    return from < end && p->place[from] == place ? from : SIZE_MAX;
}

/* Where a sliver goes: of the neighbours with half a part or more the largest, one across a face before one across an
 * edge or a corner; of equals the first. Itself, if there is none. */
static size_t find_neighbour(const cut_parts *p, size_t sliver, int j, int k)
{
    const int32_t place = p->place[sliver];
    const int x = 2 * (place / 8) + (place & 1), y = 2 * j + (place >> 1 & 1), z = 2 * k + (place >> 2 & 1);
    size_t best = sliver;
    for (int apart = 1; apart <= 3 && best == sliver; apart++) {
        uint32_t most = MS_CUT_PART / 2 - 1;
        for (int n = 0; n < 27; n++) {
            const int dx = n % 3 - 1, dy = n / 3 % 3 - 1, dz = n / 9 - 1;
            const size_t other = abs(dx) + abs(dy) + abs(dz) == apart ? find_part(p, x + dx, y + dy, z + dz) : SIZE_MAX;
            if (other != SIZE_MAX && p->cell[other].weight > most) {
                most = p->cell[other].weight;
                best = other;
            }
        }
    }
    return best;
}

static void choose_neighbours(cut_parts *p)
{
    const ms_cut_cells *cells = p->cells;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < cells->n[2]; k++) {
        for (int j = 0; j < cells->n[1]; j++) {
            for (size_t c = p->row[find_cut_row(cells, j, k)]; c < p->row[find_cut_row(cells, j, k) + 1]; c++) {
                p->into[c] = p->cell[c].weight < MS_CUT_PART / 2 ? find_neighbour(p, c, j, k) : c;
            }
        }
    }
}

/* Joins the slivers, which are none that another one goes to. */
static void join_slivers(cut_parts *p)
{
    for (size_t c = 0; c < p->count; c++) {
        ms_cut_cell *to = &p->cell[p->into[c]], *from = &p->cell[c];
        if (to != from) {
            const double share = (double)from->weight / ((double)from->weight + to->weight);
            for (int a = 0; a < 3; a++) {
                to->at[a] = (float)((double)to->at[a] + share * ((double)from->at[a] - (double)to->at[a]));
            }
            to->weight += from->weight;
        }
    }
}

/* Drops what was joined, which takes a third of the memory before the cells are sorted. */
static void drop_joined(cut_parts *p)
{
    size_t kept = 0, next = 0;
    for (size_t row = 0; row < find_cut_row(p->cells, 0, p->cells->n[2]); row++) {
        for (const size_t end = p->row[row + 1]; next < end; next++) {
            if (p->into[next] == next) {
                put_part(p, kept++, p->cell[next], p->place[next]);
            }
        }
        p->row[row + 1] = kept;
    }
    p->count = kept;
    free(p->into);
    p->into = NULL;
    ms_cut_cell *cell = realloc(p->cell, (kept + 1) * sizeof *cell);
    int32_t *place = realloc(p->place, (kept + 1) * sizeof *place);
    p->cell = cell ? cell : p->cell;
    p->place = place ? place : p->place;
}

/* The block of a cell of a row. */
static size_t find_block(const cut_parts *p, size_t row, size_t cell)
{
    const int j = (int)(row % (size_t)p->cells->n[1]), k = (int)(row / (size_t)p->cells->n[1]);
    return ms_cut_cells_block(p->cells, p->place[cell] / 8 / MS_CUT_BLOCK, j / MS_CUT_BLOCK, k / MS_CUT_BLOCK);
}

static void put_in_block(ms_cut_cells *cells, ms_cut_block *block, ms_cut_cell cell)
{
    for (int a = 0; a < 3; a++) {
        block->lo[a] = fminf(block->lo[a], cell.at[a]);
        block->hi[a] = fmaxf(block->hi[a], cell.at[a]);
    }
    cells->cell[block[1].first++] = cell;
}

/* Sorts the cells by block; while they are put, block[b + 1].first is where the next one of block b goes. */
static int sort_into_blocks(const cut_parts *p)
{
    ms_cut_cells *cells = p->cells;
    const size_t rows = find_cut_row(cells, 0, cells->n[2]);
    const size_t blocks = ms_cut_cells_block(cells, 0, 0, cells->blocks[2]);
    cells->count = p->count;
    cells->cell = malloc((cells->count + 1) * sizeof *cells->cell);
    if (!cells->cell) {
        return 0;
    }
    for (size_t row = 0; row < rows; row++) {
        for (size_t c = p->row[row]; c < p->row[row + 1]; c++) {
            cells->block[find_block(p, row, c) + 1].first++;
        }
    }
    for (size_t b = 0, sum = 0; b < blocks; b++) {
        const size_t count = cells->block[b + 1].first;
        cells->block[b + 1].first = sum;
        sum += count;
        for (int a = 0; a < 3; a++) {
            cells->block[b].lo[a] = HUGE_VALF;
            cells->block[b].hi[a] = -HUGE_VALF;
        }
    }
    for (size_t row = 0; row < rows; row++) {
        for (size_t c = p->row[row]; c < p->row[row + 1]; c++) {
            put_in_block(cells, &cells->block[find_block(p, row, c)], p->cell[c]);
        }
    }
    return 1;
}

static void sum_weights(ms_cut_cells *cells)
{
    for (size_t c = 0; c < cells->count; c++) {
        cells->total += cells->cell[c].weight;
    }
    for (size_t v = 0; v < (size_t)cells->n[0] * find_cut_row(cells, 0, cells->n[2]); v++) {
        cells->total += cells->whole[v] ? MS_CUT_WHOLE : 0;
    }
}

int ms_cut_parts_join(ms_cut_cells *cells, ms_cut_plane *plane)
{
    cut_parts p = {.cells = cells};
    int complete = fill_planes(&p, plane);
    p.into = complete ? malloc((p.count + 1) * sizeof *p.into) : NULL;
    complete = p.into != NULL;
    if (complete) {
        clear_parted(&p);
        choose_neighbours(&p);
        join_slivers(&p);
        drop_joined(&p);
        complete = sort_into_blocks(&p);
    }
    if (complete) {
        sum_weights(cells);
    }
    free(p.row);
    free(p.cell);
    free(p.place);
    free(p.into);
    return complete;
}
