/** A shape filled with random spheres that touch its surface (Westbrink & Schwung 2017, section 3). */
#ifndef MS_RANDOM_SPHERES_H
#define MS_RANDOM_SPHERES_H

#include "ms_generator.h"
#include "shared/ms_nodes.h"

MS_C_BEGIN

/** When the filling is complete, and when it is given up. */
typedef struct ms_random_spheres_rule {
    double nodes_covered; /* share of the nodes that have to be covered by a sphere, from 0 to 1 */
    double thinned;       /* nodes in one cube of this edge, in voxels, count as one; 0: each counts */
    int within;           /* nonzero: a sphere covers all nodes within it; else the one that it touches */
    size_t least;         /* as many spheres at least */
    ms_norm norm;         /* of the distance to a node */
    double offset;        /* added to each radius, in voxels */
    size_t tries;         /* centres drawn at most */
    uint64_t seed;
    ms_progress progress; /* told the number of filling spheres, D unknown; NULL: nobody listens */
    void *progress_context;
} ms_random_spheres_rule;

/**
 * Draws centres in the box of the shape. Those inside become spheres whose radius is the distance to the
 * nearest node (ms_nodes_of_target; eq. 1, a Euclidean norm). A sphere covers the node that it touches, or all within
 * it.
 *
 * Of a volume voxels are drawn, and half a voxel is added, since the surface lies beyond the centres of the
 * border's voxels.
 *
 * @param[out] ball  in voxels of the target's grid, in the order drawn; the caller frees it; NULL on failure
 * @param[out] count how many
 * @param[out] counted nodes, as far as they were counted: fewer where they were thinned
 * @param      nodes of the target
 * @return MS_OK; MS_ERR_LIMIT if the tries run out: the message says what share of the nodes was
 *         covered; MS_ERR_NOMEM
 *
 * Source: MT19937 of GSL for the random numbers. Cost: tries * O(log nodes), all cores; the same spheres at any
 * number of threads.
 */
ms_status ms_random_spheres(ms_ball **ball, size_t *count, size_t *counted, const ms_target *target,
                            const ms_nodes *nodes, const ms_random_spheres_rule *rule, ms_error *err);

/**
 * The radius that a sphere about a centre inside has.
 *
 * @param[out] touched the node that it touches; may be NULL
 */
double ms_random_spheres_radius(size_t *touched, const double centre[3], const ms_target *target, const ms_nodes *nodes,
                                const ms_random_spheres_rule *rule);

MS_C_END

#endif
