/** Private to mesh repair: which triangles meet at which edge. */
#ifndef MS_MESH_EDGES_H
#define MS_MESH_EDGES_H

#include "ms_mesh.h"

/**
 * Side s = 3 t + k runs from corner k of triangle t to corner k + 1. The sides of edge e are
 * side[start[e]] to side[start[e + 1] - 1], those with the same third corner next to each
 * other. Edges are in the order of their vertices.
 */
typedef struct ms_edges {
    size_t n;
    uint32_t *start;   /* n + 1 */
    uint32_t *side;    /* 3 per triangle */
    uint32_t *edge_of; /* of each side */
} ms_edges;

/** Sides are numbered in 32 bits. */
#define MS_EDGES_MAX_TRIANGLES (UINT32_MAX / 3)

/**
 * @param[out] edges freed by ms_mesh_edges_free; empty on failure
 * @return MS_OK; MS_ERR_LIMIT over MS_EDGES_MAX_TRIANGLES; MS_ERR_NOMEM
 * Cost: O(vertices + triangles log k), k the triangles that meet at one vertex.
 */
ms_status ms_edges_build(ms_edges *edges, const ms_mesh *mesh, ms_error *err);
void ms_mesh_edges_free(ms_edges *edges);

static inline uint32_t ms_mesh_edges_side_from(const ms_mesh *mesh, uint32_t side)
{
    return mesh->triangle[side / 3][side % 3];
}

static inline uint32_t ms_side_to(const ms_mesh *mesh, uint32_t side)
{
    return mesh->triangle[side / 3][(side % 3 + 1) % 3];
}

static inline uint32_t ms_side_opposite(const ms_mesh *mesh, uint32_t side)
{
    return mesh->triangle[side / 3][(side % 3 + 2) % 3];
}

/** Nonzero if an odd number of triangles meet at the edge. */
static inline int ms_mesh_edges_is_open(const ms_edges *edges, size_t e)
{
    return (edges->start[e + 1] - edges->start[e]) % 2 == 1;
}

/** Nonzero if the side runs from the vertex of lower number to the other. */
static inline int ms_side_rises(const ms_mesh *mesh, uint32_t side)
{
    return ms_mesh_edges_side_from(mesh, side) < ms_side_to(mesh, side);
}

#endif
