/** Sums over voxels, from which all measures of a union on a grid follow. */
#ifndef MS_TALLY_H
#define MS_TALLY_H

#include <stdint.h>

#include "mesh/ms_inertia.h"
#include "voxel/ms_grid.h"

MS_C_BEGIN

/** Sums over a set of voxels; exact, in voxel indices. */
typedef struct ms_tally {
    int64_t inside;    /* voxels inside the target */
    int64_t outside;   /* voxels outside the target */
    int64_t first[3];  /* sum of i, j, k over all of them */
    int64_t second[6]; /* sum of ii, jj, kk, jk, ik, ij */
    int64_t cut;       /* weight of the grid's cut cells (ms_cut_cells.h); 0 without them */
} ms_tally;

/** Adds the sums of one set to those of another. */
MS_API void ms_tally_add(ms_tally *sum, const ms_tally *part);

/** Volume, centroid and inertia of the voxels as cubes of unit density; zeros if there are none. */
MS_API void ms_tally_body(ms_body *body, const ms_tally *sum, const ms_grid *grid);

MS_C_END

#endif
