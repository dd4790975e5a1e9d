/** Descriptors of form: size, surface and proportions of a shape or a clump, by their usual definitions. */
#ifndef MS_DESCRIPTORS_H
#define MS_DESCRIPTORS_H

#include "clump/ms_clump.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/*
 * The one list, a row for each descriptor. Each is a field of ms_descriptors, and two measures in MS_MEASURE_LIST,
 * shape_NAME and clump_NAME. X is handed on to Y, for lists within lists.
 *
 *     Y(X, CODE, name, digits, unit, label, source, help)
 *
 * a >= b >= c are the semi-axes of the ellipsoid of the same volume centre and moments of inertia, L >= I >= S the
 * Feret dimensions (ms_feret.h).
 */
/* clang-format off */
#define MS_DESCRIPTOR_LIST(Y, X) \
    Y(X, EQUIVALENT_DIAMETER, equivalent_diameter, 4, "length", "equivalent diameter", "Wadell 1932", \
      "diameter of the ball of the same volume V, (6 V / pi)^(1/3)") \
    Y(X, AREA, area, 4, "length^2", "surface area", "Coeurjolly 2003", \
      "A; of voxels by their faces and normals, of the union of the spheres exact") \
    Y(X, SPHERICITY, sphericity, 4, NULL, "sphericity", "Wadell 1932", \
      "area of the ball of the same volume / A, pi^(1/3) (6 V)^(2/3) / A") \
    Y(X, ELONGATION, elongation, 4, NULL, "elongation, principal", "Zingg 1935", \
      "b / a, of the ellipsoid of the same moments of inertia") \
    Y(X, FLATNESS, flatness, 4, NULL, "flatness, principal", "Zingg 1935", \
      "c / b, of the ellipsoid of the same moments of inertia") \
    Y(X, FERET_ELONGATION, feret_elongation, 4, NULL, "elongation, Feret", "Zingg 1935, ISO 9276-6", \
      "I / L, of the Feret dimensions") \
    Y(X, FERET_FLATNESS, feret_flatness, 4, NULL, "flatness, Feret", "Zingg 1935, ISO 9276-6", \
      "S / I, of the Feret dimensions") \
    Y(X, COREY, corey, 4, NULL, "Corey shape factor", "Corey 1949", \
      "S / (L I)^(1/2), of the Feret dimensions") \
    Y(X, CONVEXITY, convexity, 4, NULL, "convexity", "ISO 9276-6, solidity", \
      "volume / volume of the convex hull")
/* clang-format on */

#define MS_DESCRIPTOR_FIELD(X, CODE, name, ...) double name;

/** Lengths are in the unit of the shape. What is not known is NAN. */
typedef struct ms_descriptors {
    double volume;
    double feret[3];                          /* L, I, S */
    MS_DESCRIPTOR_LIST(MS_DESCRIPTOR_FIELD, ) /* equivalent_diameter, area, ... */
} ms_descriptors;

/** Below this equivalent diameter in voxels the area of voxels is not told. */
#define MS_DESCRIPTORS_LEAST_DIAMETER 8

/** Nonzero if this build can tell those that rest on a convex hull: Feret dimensions and convexity (ms_hull.h). */
MS_API int ms_descriptors_has_hull(void);

/**
 * Those of a mesh. The area is that of its triangles, NAN where they lie inside the body.
 *
 * @param[out] out   all NAN on failure
 * @param      solid of the mesh; NULL for an open one, of which the Feret dimensions alone are known
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT. Cost: that of the hull of the vertices and of ms_feret_measure.
 */
MS_API ms_status ms_descriptors_of_mesh(ms_descriptors *out, const ms_mesh *mesh, const ms_solid *solid, ms_error *err);

/**
 * Those of voxels. The area is that of ms_voxel_area, NAN below MS_DESCRIPTORS_LEAST_DIAMETER. Feret dimensions are
 * of the hull of the centres of voxel faces; convexity compares numbers of voxels and is NAN where the centres lie in a
 * plane. Both say of a digitised convex body what is true of the body, but for the size of a voxel.
 *
 * @param body of the voxels: volume and inertia
 * @return as above
 */
MS_API ms_status ms_descriptors_of_grid(ms_descriptors *out, const ms_grid *grid, const ms_body *body, ms_error *err);

/** Those of a target: of its mesh; the area of its voxels where the mesh does not have it; of its voxels. */
MS_API ms_status ms_descriptors_of_target(ms_descriptors *out, const ms_target *target, ms_error *err);

/**
 * Those of the union of the spheres: volume and area exact (ms_union_measure), the hull by ms_clump_hull_build.
 *
 * @param body of the union, for the principal axes; its volume may be 0: none
 * @return as above
 */
MS_API ms_status ms_descriptors_of_clump(ms_descriptors *out, const ms_clump *clump, const ms_body *body,
                                         ms_error *err);

/** Computes those of a target once and for all, where ms_metrics_compute finds them. Not twice. @return as above */
MS_API ms_status ms_descriptors_add(ms_target *target, ms_error *err);

/** How finely voxels can tell: the least D that they can show of a surface, about A h / (4 V); NAN without area. */
MS_API double ms_descriptors_voxel_limit(const ms_descriptors *of, double h);

MS_C_END

#endif
