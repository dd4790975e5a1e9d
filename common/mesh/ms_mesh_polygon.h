/** Cuts concave polygons into triangles: those of mesh files, and holes. Private. */
#ifndef MS_MESH_POLYGON_H
#define MS_MESH_POLYGON_H

#include "ms_mesh.h"

/** What one cut needs; zeroed before the first polygon, then passed from one to the next. */
typedef struct ms_polygon_work {
    double (*point)[2];        /* the corners, in the plane */
    uint32_t *corner;          /* as the mesh numbers them */
    uint32_t *next, *previous; /* of the corners that are left */
    size_t room;               /* corners that the arrays hold */
    uint64_t tests;            /* of a point against a triangle, so far */
} ms_polygon_work;

/**
 * Cuts a polygon into triangles that stay within it.
 *
 * The polygon comes as the fan around its first corner. The fan stays where it leaves the
 * polygon nowhere (all convex ones), else ears are clipped in the plane across the polygon's
 * Newell normal. In any case n_triangles triangles, wound as the polygon is, use its edges
 * once each. An outline that crosses itself has no such cut: what is left of it without an
 * ear stays a fan.
 *
 * @param[in,out] fan         of n_triangles + 2 corners: {0, 1, 2}, {0, 2, 3}, ...
 * @param         vertex      all that the fan names are finite
 * @param[in,out] work        freed by ms_mesh_polygon_free
 * @return MS_OK; MS_ERR_LIMIT where concave polygons are so many or so large that it would
 *         take very long; MS_ERR_NOMEM
 *
 * Source: Sutherland, Sproull & Schumacker, A characterization of ten hidden-surface
 * algorithms, ACM Comput. Surv. 6 (1974) 1 (Newell's normal); Meisters, Polygons have ears,
 * Amer. Math. Monthly 82 (1975) 648. Cost: O(corners) for a fan that stays, else mostly
 * O(corners^2).
 */
ms_status ms_mesh_polygon_cut(uint32_t (*fan)[3], size_t n_triangles, const double (*vertex)[3], ms_polygon_work *work,
                              ms_error *err);

void ms_mesh_polygon_free(ms_polygon_work *work);

#endif
