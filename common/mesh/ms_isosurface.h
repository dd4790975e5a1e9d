/** The closed surface between the inside and the outside of a lattice of points. */
#ifndef MS_ISOSURFACE_H
#define MS_ISOSURFACE_H

#include "ms_mesh.h"

/** Points of a lattice; x fastest. The outermost are outside. All borrowed. */
typedef struct ms_isosurface {
    int n[3];              /* points along each axis, at least 2 */
    double h;              /* lattice constant */
    double origin[3];      /* point (0, 0, 0) */
    const uint8_t *inside; /* n[0] n[1] n[2]; nonzero: inside */
    /** Which part of the way from a point inside to its neighbour outside is inside; NULL: half. */
    double (*crossing)(const void *context, const int from[3], const int to[3]);
    const void *context;
} ms_isosurface;

/**
 * Marching tetrahedra: each cube of the lattice is cut into six (Kuhn's), whose faces those of the next cube share, so
 * that the surface is closed and each edge has two triangles, whatever the points are. No corner is nearer to a point
 * than 1/64 of the lattice's edge: triangles do not shrink to nothing.
 *
 * @param[out] mesh freed by ms_mesh_free; wound outward; empty on failure
 * @return MS_OK; MS_ERR_SHAPE if no point is inside; MS_ERR_LIMIT over 2^32 corners; MS_ERR_NOMEM
 *
 * Source: Doi & Koide, IEICE Trans. E74 (1991) 214. Cost: O(points), memory of two layers of them beside the mesh.
 */
ms_status ms_isosurface_build(ms_mesh *mesh, const ms_isosurface *field, ms_error *err);

#endif
