/** Rays through a mesh, along one axis of a lattice. Private. */
#ifndef MS_SWEEP_H
#define MS_SWEEP_H

#include "mesh/ms_mesh.h"
#include "ms_grid.h"

/**
 * Sends rays x rays parallel rays through each voxel and marks what they find inside.
 *
 * @param[in,out] grid   with the box of the mesh within it and a hull around it
 * @param         off    how far the middle of the box lies from that of the grid along each axis, voxels
 * @param         mesh   all coordinates finite; at least one triangle
 * @param         axis   along which the rays run: 0, 1, 2
 * @param         rays   per voxel and axis across: a power of two up to 8
 * @param         parity 0: 1 in voxels of which more than half of the rays' length runs in
 *                       matter (with one ray: whose centre does); 1: sets the bit `axis` in
 *                       voxels beyond whose centre the number of crossings is odd
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_sweep(ms_grid *grid, const ms_mesh *mesh, const double off[3], int axis, int rays, int parity,
                   ms_error *err);

/** A ray counts as the four rays infinitely near it; a set of them has a bit for each. */
enum { MS_SWEEP_NEAR_RAYS = 4 };
/** Along the rays crossings are integers in units of 2^-12 cell. */
enum { MS_SWEEP_ALONG_BITS = 12, MS_SWEEP_ALONG = 1 << MS_SWEEP_ALONG_BITS };

/** A face that a ray passes through. */
typedef struct ms_crossing {
    uint32_t ray; /* of those of the plane */
    int32_t at;   /* along the ray, in 1/MS_SWEEP_ALONG cell from the outer face of the first cell */
    int8_t sign;  /* 1 into matter, -1 out of it */
    uint8_t near; /* the near rays that pass */
} ms_crossing;

/**
 * Takes the crossings of a plane of cells across z: rays x rays for each cell of a row, those
 * of one height after another. Called from several threads, once for each plane that has any.
 *
 * @param crossing in the order of the rays, and of each along it
 * @param start    of each ray, in `crossing`; one more at the end
 */
typedef void ms_sweep_taker(void *context, int plane, const ms_crossing *crossing, const uint32_t *start);

/**
 * Sends rays x rays rays along x through each cell of a lattice around the middle of the mesh's box.
 *
 * @param n    cells along the axes
 * @param cell their sides, as many units long as the mesh's box has or more
 * @param rays as in ms_sweep
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_sweep_crossings(const ms_mesh *mesh, const int n[3], const double cell[3], int rays, ms_sweep_taker *take,
                             void *context, ms_error *err);

#endif
