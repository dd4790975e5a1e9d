/** Private: hierarchy of bounding boxes over the triangles of a mesh. */
#ifndef MS_BVH_H
#define MS_BVH_H

#include "ms_mesh.h"

/** A triangle by one corner and two edges, relative to the centre of the mesh's box. */
typedef struct ms_bvh_triangle {
    double a[3], ab[3], ac[3];
    double normal[3]; /* of length 1; 0 for a sliver */
    uint32_t id;      /* in the mesh */
    uint32_t sliver;  /* nonzero: so thin that its plane is ill defined */
} ms_bvh_triangle;

/**
 * Two boxes side by side, so that both are measured at once. Box c holds the triangles
 * first[c] to first[c] + count[c] - 1 or, where count[c] is 0, the boxes of node first[c].
 * The triangle of a mesh of one is in both.
 */
typedef struct ms_bvh_node {
    double lo[3][2], hi[3][2];
    uint32_t first[2], count[2];
} ms_bvh_node;

typedef struct ms_bvh {
    double centre[3]; /* of the box; all coordinates here are relative to it */
    double size;      /* longest edge of the box */
    size_t n_nodes;
    ms_bvh_node *node; /* node[0] is the root; the nodes of its boxes stand behind a node */
    ms_bvh_triangle *triangle;
} ms_bvh;

/** How well the boxes are cut. */
typedef enum ms_bvh_effort {
    MS_BVH_FOR_MANY_RAYS, /* the best of three axes */
    MS_BVH_FOR_ONE_WALK   /* the longest side: in half the time */
} ms_bvh_effort;

/** A stack of this many nodes is enough for any walk: the depth is bounded. */
#define MS_BVH_STACK 128

/**
 * @param[out] bvh freed by ms_bvh_free; empty on failure
 * @return MS_OK; MS_ERR_ARG if the mesh is empty; MS_ERR_LIMIT over 2^31 triangles; MS_ERR_NOMEM
 *
 * Source: binned surface area heuristic, Wald, On fast construction of SAH-based bounding
 * volume hierarchies (2007). Cost: O(triangles log triangles).
 */
ms_status ms_bvh_build(ms_bvh *bvh, const ms_mesh *mesh, ms_bvh_effort effort, ms_error *err);
void ms_bvh_free(ms_bvh *bvh);

#endif
