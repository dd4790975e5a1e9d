/** From a mesh to a voxel grid. */
#ifndef MS_VOXELIZE_H
#define MS_VOXELIZE_H

#include "mesh/ms_mesh.h"
#include "ms_grid.h"

MS_C_BEGIN

/** When a voxel counts as inside. One rule per run, for target and union alike. */
typedef enum ms_voxel_rule {
    MS_VOXEL_HALF,  /* more than half of it is covered (MSS eq. 5) */
    MS_VOXEL_CENTRE /* its centre is covered */
} ms_voxel_rule;

/**
 * The voxel size that gives that many voxels along the shortest side of the mesh's box.
 * @return MS_OK; MS_ERR_ARG unless cells is above 0; MS_ERR_SHAPE for a flat mesh
 */
MS_API ms_status ms_voxelize_size(double *h, const ms_mesh *mesh, double cells, ms_error *err);

/**
 * The voxel size of the finest grid that has at most so many voxels, its hull included, and a whole number of them
 * along the shortest side of the mesh's box.
 *
 * @return MS_OK; MS_ERR_ARG for a number that is not finite and above 0; MS_ERR_LIMIT if they are too few for one along
 *         the shortest side; MS_ERR_SHAPE for a flat mesh
 */
MS_API ms_status ms_voxelize_size_within(double *h, const ms_mesh *mesh, double max_voxels, ms_error *err);

/** The extents that ms_voxelize would use; doubles, since a bad h may ask for any number. */
MS_API void ms_voxelize_extents(double n[3], const ms_mesh *mesh, double h);

/**
 * Voxelises a closed mesh. The box of the mesh is centred in the grid, with MS_GRID_HULL
 * layers of background around it (eq. 6), so that a symmetric mesh gives a symmetric grid. Along
 * each axis the box takes the whole number of voxels that is nearest to its length: its faces lie
 * less than a quarter of a voxel from faces of voxels, and rounding cannot add or take a layer.
 *
 * Rays run along x, 4x4 of them through each voxel (one through the centre by the centre
 * rule), and add up what they cover exactly. Coordinates across the rays are rounded to
 * 2^-15 of a voxel, after which every decision is exact in integers: a ray through an edge
 * or a vertex is judged as four rays infinitely near it are, which leaves no leaks and keeps
 * mirror symmetry. Matter is where the winding number is positive: bodies that overlap
 * unite, cavities (wound inward) stay empty.
 *
 * @param[out] grid    the caller frees it; empty on failure
 * @param      mesh    closed and wound outward (ms_mesh_repair)
 * @param      h       lattice constant, in the mesh's unit
 * @param      rule    see ms_voxel_rule
 * @return MS_OK; MS_ERR_ARG; MS_ERR_LIMIT; MS_ERR_SHAPE if no voxel is inside; MS_ERR_NOMEM
 *
 * Cost: O(triangles + rays through surface voxels + voxels), all cores; the same bits at
 * any number of threads.
 */
MS_API ms_status ms_voxelize(ms_grid *grid, const ms_mesh *mesh, double h, ms_voxel_rule rule, ms_error *err);

/**
 * As ms_voxelize, with the lattice moved under the mesh, one voxel more along each axis along which it is.
 *
 * @param shift 0 or more and below 1, voxels: how far the lattice lies towards lower coordinates than that of
 *              ms_voxelize; NULL: nowhere
 */
MS_API ms_status ms_voxelize_moved(ms_grid *grid, const ms_mesh *mesh, double h, ms_voxel_rule rule,
                                   const double shift[3], ms_error *err);

/**
 * Voxelises a mesh with holes: the majority of the crossing parities along x, y and z at
 * each voxel's centre.
 *
 * @param[out] disagree voxels on which the three axes did not agree
 * @return as ms_voxelize
 */
MS_API ms_status ms_voxelize_open(ms_grid *grid, size_t *disagree, const ms_mesh *mesh, double h, ms_error *err);

/** As ms_voxelize_open, with the lattice moved as by ms_voxelize_moved. */
MS_API ms_status ms_voxelize_open_moved(ms_grid *grid, size_t *disagree, const ms_mesh *mesh, double h,
                                        const double shift[3], ms_error *err);

MS_C_END

#endif
