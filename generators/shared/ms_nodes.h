/** Points in space, and which of them is nearest. */
#ifndef MS_NODES_H
#define MS_NODES_H

#include "voxel/ms_target.h"

MS_C_BEGIN

/** How far apart two points are. */
typedef enum ms_norm {
    MS_NORM_EUCLIDEAN,
    MS_NORM_SUM /* |x| + |y| + |z| */
} ms_norm;

/** A search tree: each range of points is split at its middle one. Threads may share one. */
typedef struct ms_nodes {
    size_t count;
    double (*at)[3]; /* in the tree's order */
    uint8_t *axis;   /* across which each point splits its range */
} ms_nodes;

/**
 * @param[out] nodes the caller frees it; empty on failure
 * @param      at    `count` points, finite
 * @return MS_OK; MS_ERR_ARG without a point; MS_ERR_NOMEM
 *
 * Source: Bentley, Commun. ACM 18 (1975) 509. Cost: O(count log count).
 */
ms_status ms_nodes_build(ms_nodes *nodes, const double (*at)[3], size_t count, ms_error *err);

/**
 * The nodes of a target, in voxels of its grid: the vertices of its mesh; of a volume the centres of
 * the voxels inside that have a face in common with one outside.
 *
 * @return as ms_nodes_build
 */
ms_status ms_nodes_of_target(ms_nodes *nodes, const ms_target *target, ms_error *err);

/**
 * @param[out] distance to the nearest point
 * @return its index in the tree's order
 *
 * Cost: O(log count) typical; all points where all are about as far.
 */
size_t ms_nodes_nearest(double *distance, const ms_nodes *nodes, const double place[3], ms_norm norm);

/**
 * Sorts nodes into groups: those in one cube of a lattice are one. Groups are numbered from 0 on.
 *
 * @param[out] group    nodes->count values, in the tree's order; the caller frees it; NULL on failure
 * @param[out] n_groups how many
 * @param      edge     of the cubes, above 0
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: O(count log count).
 */
ms_status ms_nodes_group(size_t **group, size_t *n_groups, const ms_nodes *nodes, double edge, ms_error *err);

/** Is told of a node, by its index in the tree's order. */
typedef void (*ms_nodes_visit)(void *context, size_t index);

/** Visits the nodes no farther from a place than `radius` (Euclidean). Cost: O(log count + visited) typical. */
void ms_nodes_visit_within(const ms_nodes *nodes, const double place[3], double radius, ms_nodes_visit visit,
                           void *context);

void ms_nodes_free(ms_nodes *nodes);

MS_C_END

#endif
