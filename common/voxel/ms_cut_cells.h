/** The body of a mesh in cells that its surface cuts exactly, on two levels: what `coverage_cut` is counted by. */
#ifndef MS_CUT_CELLS_H
#define MS_CUT_CELLS_H

#include <stddef.h>
#include <stdint.h>

#include "mesh/ms_mesh.h"
#include "ms_grid.h"

MS_C_BEGIN

/* The weight of a whole voxel. */
enum { MS_CUT_WHOLE = 1 << 24 };

/** The part of a cell that lies in the body. */
typedef struct ms_cut_cell {
    float at[3];     /* its centroid, in voxels of the grid */
    uint32_t weight; /* its volume, in 1 / MS_CUT_WHOLE voxel */
} ms_cut_cell;

/** Voxels that the surface leaves whole, and of the others those of their eight parts that hold some of the body. */
typedef struct ms_cut_cells {
    int n[3]; /* extents of the grid, its origin and its voxel */
    double origin[3], h;
    uint8_t *whole; /* of each voxel: 1 if it lies in the body */
    size_t *row;    /* cells row[j + n[1] k] to row[j + n[1] k + 1] - 1 are of the voxels (., j, k), by i */
    ms_cut_cell *cell;
    size_t count;
    int64_t total; /* of the weights, those of whole voxels among them */
} ms_cut_cells;

/**
 * Cuts the voxels of a grid, and the half as large parts of those that the surface passes through, by the triangles of
 * a closed mesh.
 *
 * Volume and first moments of what lies in a cell are surface integrals (divergence theorem, the fields along x alone)
 * over the triangles, clipped to the cell (Sutherland & Hodgman, Comm. ACM 17 (1974) 32), and over the cell's face of
 * lower x, whose share is what the cells before it in the row left: exact but for rounding, for any mesh and any number
 * of triangles in a cell. Where bodies overlap, what is counted more than once counts once; only in cells that both
 * surfaces cut it may count more than the union holds, up to the whole cell.
 *
 * @param[out] out  freed by ms_cut_cells_free; NULL on failure
 * @param      grid holds the box of the mesh
 * @param      mesh closed, wound outward; NULL: the voxels inside the grid are the body (of a volume, an open mesh)
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: O(voxels + triangles + cells that they pass through), all cores, the same bits at any number of threads; 1
 * byte a voxel, 16 a cut cell.
 */
ms_status ms_cut_cells_build(ms_cut_cells **out, const ms_grid *grid, const ms_mesh *mesh, ms_error *err);

/** What is not covered yet: a byte for each cell, behind them for each voxel; all of it. The caller frees it.
 * NULL without memory. */
uint8_t *ms_cut_cells_left(const ms_cut_cells *cells);

/**
 * The weight of what is left and whose centroid a ball holds (on its surface counts).
 *
 * @param left as ms_cut_cells_left
 * @param ball in voxels
 * Cost: a test for each cut cell in the ball, and a byte for each voxel.
 */
int64_t ms_cut_cells_count(const ms_cut_cells *cells, const uint8_t *left, const ms_ball *ball);

/** The same, and covers it. */
int64_t ms_cut_cells_cover(const ms_cut_cells *cells, uint8_t *left, const ms_ball *ball);

void ms_cut_cells_free(ms_cut_cells *cells);

MS_C_END

#endif
