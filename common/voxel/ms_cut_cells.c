/*
 * In a cell with its lower corner at 0 and sides of 1, in (u, v, w), what lies in the body has
 *
 *     V   = integral of (u - 1) n_u         over its surface
 *     M_u = integral of (u^2 - 1) / 2 n_u
 *     M_v = integral of v (u - 1) n_u,      M_w likewise with w
 *
 * n outward. The fields are 0 on the face u = 1, and n_u is 0 on those across v and w: there remain the triangles and
 * the face u = 0. Of that face the area A in the body and its moments B (of v) and C (of w) are all that is needed, and
 * those of the next cell's are less by the integrals of n_u, v n_u, w n_u over the triangles of this one.
 */
#include "ms_cut_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_cut_parts.h"

enum { FACE, FACE_V, FACE_W, VOLUME, MOMENT_U, MOMENT_V, MOMENT_W, INTEGRALS };
enum { MOST_CORNERS = 12 }; /* of a triangle cut by six planes: nine */

/* Below this part of a cell nothing is in it, or nothing is missing: the sums of a row round to less. */
static const double NOTHING = 1e-9;

typedef struct cut_polygon {
    int n;
    double corner[MOST_CORNERS][3];
} cut_polygon;

/* The integrals over the triangles in a cell. */
typedef struct piece {
    double sum[INTEGRALS];
} piece;

/* What one thread works with: a plane of voxels, which is two planes of half as large cells, four rows for each row. */
typedef struct cut_worker {
    const ms_grid *grid;
    const ms_mesh *mesh;
    uint8_t *whole; /* of each voxel of the grid */
    int fine[2];    /* cells along x and y */
    int plane;
    int32_t *piece_of; /* of each cell of the plane, -1: none */
    piece *piece;
    size_t n_pieces, piece_room;
    int failed;
} cut_worker;

/* What is on one side of a plane across an axis. */
static void clip(cut_polygon *out, const cut_polygon *in, int axis, double bound, double sign)
{
    out->n = 0;
    for (int c = 0; c < in->n; c++) {
        const double *from = in->corner[c], *to = in->corner[c + 1 < in->n ? c + 1 : 0];
        const double before = sign * (from[axis] - bound), after = sign * (to[axis] - bound);
        if (before >= 0) {
            memcpy(out->corner[out->n++], from, sizeof out->corner[0]);
        }
        if ((before > 0 && after < 0) || (before < 0 && after > 0)) {
            double *corner = out->corner[out->n++];
            for (int a = 0; a < 3; a++) {
                corner[a] = from[a] + before / (before - after) * (to[a] - from[a]);
            }
            corner[axis] = bound;
        }
    }
}

/* The layers of cells that a polygon passes through; of a face between two the upper one. */
static void find_layers(int *from, int *to, const cut_polygon *p, int axis, int n)
{
    double lo = p->corner[0][axis], hi = lo;
    for (int c = 1; c < p->n; c++) {
        lo = fmin(lo, p->corner[c][axis]);
        hi = fmax(hi, p->corner[c][axis]);
    }
    *from = (int)fmin(fmax(floor(lo), 0), n - 1);
    *to = (int)fmin(fmax(ceil(hi), *from + 1), n);
}

static void clip_to_layer(cut_polygon *out, const cut_polygon *in, int axis, int layer)
{
    cut_polygon above;
    clip(&above, in, axis, layer, 1);
    clip(out, &above, axis, layer + 1, -1);
}

/* Adds the integrals over a polygon in a cell, which are of polynomials of degree two: exact by the middles of the
 * edges of triangles. */
static void integrate(piece *sums, const cut_polygon *p, const int cell[3])
{
    for (int c = 1; c + 1 < p->n; c++) {
        const double *a = p->corner[0], *b = p->corner[c], *d = p->corner[c + 1];
        const double third = ((b[1] - a[1]) * (d[2] - a[2]) - (b[2] - a[2]) * (d[1] - a[1])) / 6;
        const double *edge[3][2] = {{a, b}, {b, d}, {d, a}};
        for (int e = 0; e < 3; e++) {
            const double u = 0.5 * (edge[e][0][0] + edge[e][1][0]) - cell[0];
            const double v = 0.5 * (edge[e][0][1] + edge[e][1][1]) - cell[1];
            const double w = 0.5 * (edge[e][0][2] + edge[e][1][2]) - cell[2];
            const double value[INTEGRALS] = {1, v, w, u - 1, 0.5 * (u * u - 1), v * (u - 1), w * (u - 1)};
            for (int m = 0; m < INTEGRALS; m++) {
                sums->sum[m] += third * value[m];
            }
        }
    }
}

static piece *find_piece(cut_worker *w, const int cell[3])
{
    const size_t at =
        (size_t)cell[0] + (size_t)w->fine[0] * ((size_t)cell[1] + (size_t)w->fine[1] * (size_t)(cell[2] & 1));
    if (w->piece_of[at] < 0) {
        if (w->n_pieces == w->piece_room) {
            const size_t room = 2 * w->piece_room + 1024;
            piece *more = realloc(w->piece, room * sizeof *more);
            if (!more) {
                w->failed = 1;
                return NULL;
            }
            w->piece = more;
            w->piece_room = room;
        }
        w->piece_of[at] = (int32_t)w->n_pieces;
        w->piece[w->n_pieces++] = (piece){{0}};
    }
    return &w->piece[w->piece_of[at]];
}

/* A polygon in one row of cells. */
static void add_to_row(cut_worker *w, const cut_polygon *p, int cell[3])
{
    int from, to;
    find_layers(&from, &to, p, 0, w->fine[0]);
    for (cell[0] = from; cell[0] < to; cell[0]++) {
        cut_polygon part;
        const cut_polygon *whole = p;
        if (to - from > 1) {
            clip_to_layer(&part, p, 0, cell[0]);
            whole = &part;
        }
        piece *sums = whole->n > 2 ? find_piece(w, cell) : NULL;
        if (sums) {
            integrate(sums, whole, cell);
        }
    }
}

static void cut_triangle(cut_worker *w, uint32_t triangle)
{
    cut_polygon whole = {.n = 3};
    double corner[3][3];
    ms_grid_corners(corner, w->grid, w->mesh, triangle);
    for (int c = 0; c < 3; c++) {
        for (int a = 0; a < 3; a++) {
            whole.corner[c][a] = 2 * corner[c][a] + 1;
        }
    }
    for (int half = 0; half < 2; half++) {
        cut_polygon slab, row;
        int from, to, cell[3] = {0, 0, 2 * w->plane + half};
        clip_to_layer(&slab, &whole, 2, cell[2]);
        if (slab.n < 3) {
            continue;
        }
        find_layers(&from, &to, &slab, 1, w->fine[1]);
        for (cell[1] = from; cell[1] < to; cell[1]++) {
            clip_to_layer(&row, &slab, 1, cell[1]);
            if (row.n > 2) {
                add_to_row(w, &row, cell);
            }
        }
    }
}

static void add_part(cut_worker *w, ms_cut_plane *out, const double at[3], double volume, int32_t place)
{
    const double weight = rint(volume * MS_CUT_WHOLE);
    if (out->count == out->room) {
        const size_t room = out->room + out->room / 2 + 1024;
        ms_cut_part *more = realloc(out->part, room * sizeof *more);
        if (!more) {
            w->failed = 1;
            return;
        }
        out->part = more;
        out->room = room;
    }
    if (weight > 0) {
        const ms_cut_cell cell = {{(float)at[0], (float)at[1], (float)at[2]}, (uint32_t)weight};
        out->part[out->count++] = (ms_cut_part){cell, place};
    }
}

/* Volume and centroid of the body in a cell, behind a face of area and moments face[0..2], which become those of the
 * next cell's. */
static double cut_cell(double centroid[3], double face[3], const piece *sums)
{
    static const piece NONE = {{0}};
    const double *sum = sums ? sums->sum : NONE.sum;
    const double volume = face[0] + sum[VOLUME];
    const double moment[3] = {face[0] / 2 + sum[MOMENT_U], face[1] + sum[MOMENT_V], face[2] + sum[MOMENT_W]};
    for (int a = 0; a < 3; a++) {
        centroid[a] = volume < 1 - NOTHING && volume > NOTHING ? fmin(fmax(moment[a] / volume, 0), 1) : 0.5;
        face[a] -= sum[FACE + a];
    }
    return fmin(fmax(volume, 0), 1);
}

/* Of a voxel that no triangle passes through: 1 whole, 0 empty, -1 to be looked at in its parts. */
static int find_uncut(const cut_worker *w, double face[4][3], int i, int j)
{
    double least = face[0][0], most = face[0][0];
    for (int row = 0; row < 4; row++) {
        const size_t y = (size_t)(2 * j + (row & 1)), z = (size_t)(row >> 1);
        const int32_t *both = w->piece_of + (size_t)(2 * i) + (size_t)w->fine[0] * (y + (size_t)w->fine[1] * z);
        if (both[0] >= 0 || both[1] >= 0) {
            return -1;
        }
        least = fmin(least, face[row][0]);
        most = fmax(most, face[row][0]);
    }
    return most < NOTHING ? 0 : least > 1 - NOTHING ? 1 : -1;
}

/* The voxels of a row, or their eight parts. */
static void cut_row(cut_worker *w, ms_cut_plane *out, int j)
{
    double face[4][3] = {{0}};
    for (int i = 0; i < w->grid->n[0] && !w->failed; i++) {
        double volume[8], centroid[8][3], whole = 8;
        const int uncut = find_uncut(w, face, i, j);
        if (uncut >= 0) {
            w->whole[ms_grid_index(w->grid, i, j, w->plane)] = (uint8_t)uncut;
            continue;
        }
        for (int part = 0; part < 8; part++) {
            const int x = part & 1, row = part >> 1, y = row & 1, z = row >> 1;
            const size_t at =
                (size_t)(2 * i + x) + (size_t)w->fine[0] * ((size_t)(2 * j + y) + (size_t)w->fine[1] * (size_t)z);
            const int32_t index = w->piece_of[at];
            volume[part] = cut_cell(centroid[part], face[row], index < 0 ? NULL : &w->piece[index]);
            whole = fmin(whole, volume[part]);
            centroid[part][0] = i + 0.5 * (x + centroid[part][0]) - 0.5;
            centroid[part][1] = j + 0.5 * (y + centroid[part][1]) - 0.5;
            centroid[part][2] = w->plane + 0.5 * (z + centroid[part][2]) - 0.5;
        }
        if (whole > 1 - NOTHING) {
            w->whole[ms_grid_index(w->grid, i, j, w->plane)] = 1;
            continue;
        }
        for (int part = 0; part < 8; part++) {
            if (volume[part] > NOTHING) {
                add_part(w, out, centroid[part], volume[part] / 8, 8 * i + part);
            }
        }
    }
}

/* The triangles of each plane of voxels, start[k] to start[k + 1] - 1 of `list`. */
typedef struct plane_lists {
    size_t *start;
    uint32_t *list;
} plane_lists;

static void find_planes(int *from, int *to, const ms_grid *grid, const ms_mesh *mesh, size_t triangle)
{
    double corner[3][3], lo = HUGE_VAL, hi = -HUGE_VAL;
    ms_grid_corners(corner, grid, mesh, triangle);
    for (int c = 0; c < 3; c++) {
        lo = fmin(lo, corner[c][2]);
        hi = fmax(hi, corner[c][2]);
    }
    *from = (int)fmin(fmax(floor(lo + 0.5), 0), grid->n[2] - 1);
    *to = (int)fmin(fmax(floor(hi + 0.5) + 1, *from + 1), grid->n[2]);
}

static int list_triangles(plane_lists *lists, const ms_grid *grid, const ms_mesh *mesh)
{
    int from, to;
    lists->start = calloc((size_t)grid->n[2] + 2, sizeof *lists->start);
    if (!lists->start) {
        return 0;
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        find_planes(&from, &to, grid, mesh, t);
        for (int k = from; k < to; k++) {
            lists->start[k + 2]++;
        }
    }
    for (int k = 2; k < grid->n[2] + 2; k++) {
        lists->start[k] += lists->start[k - 1];
    }
    lists->list = malloc((lists->start[grid->n[2] + 1] + 1) * sizeof *lists->list);
    for (size_t t = 0; lists->list && t < mesh->n_triangles; t++) {
        find_planes(&from, &to, grid, mesh, t);
        for (int k = from; k < to; k++) {
            lists->list[lists->start[k + 1]++] = (uint32_t)t;
        }
    }
    return lists->list != NULL;
}

static void cut_plane(cut_worker *w, ms_cut_plane *out, const plane_lists *lists)
{
    const size_t first = lists->start[w->plane], end = lists->start[w->plane + 1];
    out->end = calloc((size_t)w->grid->n[1], sizeof *out->end);
    w->failed |= !out->end;
    if (end > first) {
        memset(w->piece_of, 0xff, (size_t)w->fine[0] * (size_t)w->fine[1] * 2 * sizeof *w->piece_of);
        w->n_pieces = 0;
    }
    for (size_t t = first; t < end && !w->failed; t++) {
        cut_triangle(w, lists->list[t]);
    }
    for (int j = 0; j < w->grid->n[1] && !w->failed; j++) {
        if (end > first) {
            cut_row(w, out, j);
        }
        out->end[j] = out->count;
    }
}

static int cut_planes(ms_cut_plane *planes, ms_cut_cells *cells, const ms_grid *grid, const ms_mesh *mesh)
{
    plane_lists lists = {0};
    const int listed = list_triangles(&lists, grid, mesh);
    int failed = !listed;
#pragma omp parallel reduction(| : failed) if (ms_grid_voxels(grid) >= MS_GRID_THREADS_FROM)
    {
        cut_worker w = {.grid = grid,
                        .whole = cells->whole,
                        .mesh = mesh,
                        .fine = {2 * grid->n[0], 2 * grid->n[1]},
                        .failed = !listed}; /* of `failed` each thread has its own, which is 0 here */
        w.piece_of = malloc((size_t)w.fine[0] * (size_t)w.fine[1] * 2 * sizeof *w.piece_of);
        w.failed |= !w.piece_of;
#pragma omp for schedule(dynamic, 1)
        for (int k = 0; k < grid->n[2]; k++) {
            w.plane = k;
            if (!w.failed) {
                cut_plane(&w, &planes[k], &lists);
            }
        }
        free(w.piece_of);
        free(w.piece);
        failed |= w.failed;
    }
    free(lists.start);
    free(lists.list);
    return !failed;
}

/* Of a volume: its voxels. */
static void take_voxels_whole(ms_cut_cells *cells, const ms_grid *grid)
{
    memcpy(cells->whole, grid->inside, ms_grid_voxels(grid));
    cells->total = (int64_t)ms_grid_count(grid) * MS_CUT_WHOLE;
}

ms_status ms_cut_cells_build(ms_cut_cells **out, const ms_grid *grid, const ms_mesh *mesh, ms_error *err)
{
    ms_cut_cells *cells = calloc(1, sizeof *cells);
    ms_cut_plane *planes = calloc((size_t)grid->n[2], sizeof *planes);
    int complete = cells && planes;
    if (complete) {
        *cells = (ms_cut_cells){.h = grid->h};
        memcpy(cells->n, grid->n, sizeof cells->n);
        memcpy(cells->origin, grid->origin, sizeof cells->origin);
        for (int a = 0; a < 3; a++) {
            cells->blocks[a] = (grid->n[a] + MS_CUT_BLOCK - 1) / MS_CUT_BLOCK;
        }
        cells->block = calloc(ms_cut_cells_block(cells, 0, 0, cells->blocks[2]) + 1, sizeof *cells->block);
        cells->whole = calloc(ms_grid_voxels(grid), 1);
        complete = cells->block && cells->whole;
    }
    if (complete && mesh) {
        complete = cut_planes(planes, cells, grid, mesh) && ms_cut_parts_join(cells, planes);
    } else if (complete) {
        take_voxels_whole(cells, grid);
    }
    for (int k = 0; planes && k < grid->n[2]; k++) {
        free(planes[k].part);
        free(planes[k].end);
    }
    free(planes);
    *out = cells;
    if (!complete) {
        ms_cut_cells_free(cells);
        *out = NULL;
        return ms_fail(err, MS_ERR_NOMEM, "no memory to cut %zu voxels; use fewer cells", ms_grid_voxels(grid));
    }
    return MS_OK;
}

void ms_cut_cells_free(ms_cut_cells *cells)
{
    if (cells) {
        free(cells->whole);
        free(cells->block);
        free(cells->cell);
        free(cells);
    }
}
