/** From the parts of cut voxels to cells of which none is a sliver. Private to ms_cut_cells. */
#ifndef MS_CUT_PARTS_H
#define MS_CUT_PARTS_H

#include "ms_cut_cells.h"

MS_C_BEGIN

/* The weight of a whole part of a voxel. */
enum { MS_CUT_PART = MS_CUT_WHOLE / 8 };

/** What lies in the body of a part of a voxel. */
typedef struct ms_cut_part {
    ms_cut_cell cell;
    int32_t place; /* in the row of voxels: 8 i + x + 2 y + 4 z, where x, y, z are 0 or 1 */
} ms_cut_part;

/** Those of a plane of voxels, by row and place. */
typedef struct ms_cut_plane {
    ms_cut_part *part;
    size_t count, room;
    size_t *end; /* of each row: how many there are up to its end */
} ms_cut_plane;

/**
 * Makes the cells of the parts. Whole voxels across a face from one that is not are cut into parts, too; what is less
 * than half a part is joined to a neighbour.
 *
 * @param cells have n, blocks and whole; block, cell, count and total are made
 * @param plane n[2] of them, whose parts are freed
 * @return 0 without memory
 *
 * Cost: O(voxels + parts); 28 bytes a part while it works.
 */
int ms_cut_parts_join(ms_cut_cells *cells, ms_cut_plane *plane);

MS_C_END

#endif
