/** The body of a mesh in cells that follow its surface, on two levels: what `coverage_cut` is counted by. */
#ifndef MS_CUT_CELLS_H
#define MS_CUT_CELLS_H

#include <stddef.h>
#include <stdint.h>

#include "mesh/ms_mesh.h"
#include "ms_grid.h"

MS_C_BEGIN

/* The weight of a whole voxel. */
enum { MS_CUT_WHOLE = 1 << 24 };

/* Voxels along an edge of a block of cells. */
enum { MS_CUT_BLOCK = 4 };

/** What lies in the body of a cell: half a voxel wide, or such a one with slivers of its neighbours. */
typedef struct ms_cut_cell {
    float at[3];     /* its centroid, in voxels of the grid */
    uint32_t weight; /* its volume, in 1 / MS_CUT_WHOLE voxel */
} ms_cut_cell;

/** The cells of 4^3 voxels. */
typedef struct ms_cut_block {
    size_t first;       /* up to that of the next one */
    float lo[3], hi[3]; /* of their centroids */
} ms_cut_block;

/** Voxels deep in the body whole, and cells along its surface. */
typedef struct ms_cut_cells {
    int n[3]; /* extents of the grid, its origin and its voxel */
    double origin[3], h;
    uint8_t *whole;      /* of each voxel: 1 if it is whole */
    int blocks[3];       /* along each axis */
    ms_cut_block *block; /* ms_cut_cells_block; one more, whose `first` is `count` */
    ms_cut_cell *cell;
    size_t count;
    int64_t total; /* of the weights, those of whole voxels among them */
} ms_cut_cells;

static inline size_t ms_cut_cells_block(const ms_cut_cells *cells, int i, int j, int k)
{
    return (size_t)i + (size_t)cells->blocks[0] * ((size_t)j + (size_t)cells->blocks[1] * (size_t)k);
}

/**
 * Cuts the voxels of a grid, and the half as large parts of those that the surface passes through, by the triangles of
 * a closed mesh.
 *
 * Volume and first moments of what lies in a part are surface integrals (divergence theorem, the fields along x alone)
 * over the triangles, clipped to the part (Sutherland & Hodgman, Comm. ACM 17 (1974) 32), and over its face of lower x,
 * whose share is what the parts before it in the row left: exact but for rounding, for any mesh and any number of
 * triangles in a part. Where bodies overlap, what is counted more than once counts once; only in parts that both
 * surfaces cut it may count more than the union holds, up to the whole part.
 *
 * Of a part that holds less than half of itself the centroid hugs the surface, where next to no sphere inside reaches
 * it. It is joined to the largest of the neighbours that hold at least half, across a face before across an edge or a
 * corner, volume and centroid with it (cell merging: Ye, Mittal, Udaykumar & Shyy, J. Comput. Phys. 156 (1999) 209);
 * without such a neighbour it stands alone. Whole voxels by the surface are parted for it.
 *
 * @param[out] out  freed by ms_cut_cells_free; NULL on failure
 * @param      grid holds the box of the mesh
 * @param      mesh closed, wound outward; NULL: the voxels inside the grid are the body (of a volume, an open mesh)
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: O(voxels + triangles + parts that they pass through), all cores, the same bits at any number of threads; 1.5
 * bytes a voxel, 16 a cell, 28 a part while it works.
 */
ms_status ms_cut_cells_build(ms_cut_cells **out, const ms_grid *grid, const ms_mesh *mesh, ms_error *err);

/* Bytes that they take at their peak, with what is left of them, for each voxel and each square of the surface
 * (ms_target_need). A surface passes through some 1.5 voxels a square, which have 8.7 parts with something inside;
 * whole voxels behind it make them 14 (a spheroid at d_eq/100). */
enum { MS_CUT_VOXEL_BYTES = 3, MS_CUT_SQUARE_BYTES = 420 };

void ms_cut_cells_free(ms_cut_cells *cells);

MS_C_END

#endif
