/** The table of measures: what is in it is in the stop rule, reports, JSON, columns, tolerances, charts and docs. */
#ifndef MS_MEASURE_H
#define MS_MEASURE_H

#include "base/ms_error.h"
#include "ms_descriptors.h"

MS_C_BEGIN

/*
 * The one list, a row for each measure. Each is a field of its name: of the kinds GOAL and UNION of ms_score, of the
 * others of ms_metrics; ms_metrics.c computes it. S are the voxels of the shape, U those of the union of the spheres.
 *
 *     X(kind, CODE, name, better, digits, curve, unit, axis,
 *       label, source,
 *       help, in compare, in stability)
 *
 * kind    GOAL: of S and U, known of each prefix of a clump, better with more spheres: it can be asked for
 *         UNION: of S and U as well, but nothing to ask for
 *         SURFACE: distances to a mesh, NAN without one
 *         NORMAL: angles to the surface of a closed mesh or a volume, NAN of an open mesh
 *         SPHERES: of the spheres themselves; COUNT: the same, a whole number
 *         DESCRIPTOR: of the form of the shape or of the union, NAN where it is not known
 * better  LESS, MORE, or ONE: 1 is best; SHAPE: what the shape has; NONE: it is what it is
 * digits  behind the point, in words
 * curve   1: a column of the curves of --curve
 * unit    NULL without; "length" is the mesh's
 * axis    what a chart of it over the number of spheres says at its axis; NULL: no chart
 * label   what it is called in words
 * in ...  the column's name there, where it was published under another one; else NULL
 */
/* clang-format off */
#define MS_MEASURE_OF_DESCRIPTOR(X, CODE, name, digits, unit, label, source, help) \
    X(DESCRIPTOR, SHAPE_##CODE, shape_##name, NONE, digits, 0, unit, NULL, label " of the shape", source, help, NULL, \
      NULL) \
    X(DESCRIPTOR, CLUMP_##CODE, clump_##name, SHAPE, digits, 0, unit, NULL, label " of the clump", source, help, NULL, \
      NULL)
#define MS_MEASURE_LIST(X) \
    X(GOAL, ETA, eta, LESS, 5, 1, NULL, NULL, \
      "eta, |S xor U| / |S|", "MSS eq. 7", \
      "|S xor U| / |S|: what is missing and what is too much, over the shape", NULL, NULL) \
    X(GOAL, DICE, dice, LESS, 5, 1, NULL, "mismatch D", \
      "D, Dice mismatch", "MSS eq. 27", \
      "1 - 2 |S and U| / (|S| + |U|). The Dice coefficient is 1 - D", NULL, NULL) \
    X(GOAL, COVERAGE, coverage, MORE, 5, 1, NULL, NULL, \
      "coverage", "Yuan, V_cl / V_p", \
      "|S and U| / |S|: the part of the shape inside spheres", NULL, NULL) \
    X(UNION, OVERSHOOT, overshoot, LESS, 5, 1, NULL, NULL, \
      "overshoot", "mskit", \
      "|U outside S| / |S|: volume of spheres outside the shape, over the shape", NULL, NULL) \
    X(UNION, OFF_VOLUME, off_volume, ONE, 5, 0, NULL, NULL, \
      "volume of union / of shape", "Westbrink eq. 2", \
      "|U| / |S|", NULL, NULL) \
    X(SURFACE, PROTRUSION, protrusion_max, LESS, 5, 0, "length", NULL, \
      "largest protrusion", "mskit", \
      "how far the outer surface of the spheres stands out of the mesh at most", NULL, NULL) \
    X(SURFACE, PROTRUSION_RMS, protrusion_rms, LESS, 5, 0, "length", NULL, \
      "protrusion, rms", "mskit", \
      "its root mean square over all of that surface (0 where it is inside)", NULL, NULL) \
    X(SURFACE, GAP, gap_max, LESS, 5, 0, "length", NULL, \
      "largest gap", "mskit", \
      "how far the surface of the mesh is from the nearest sphere at most", NULL, NULL) \
    X(SURFACE, GAP_RMS, gap_rms, LESS, 5, 0, "length", NULL, \
      "gap, rms", "mskit", \
      "its root mean square over all of the mesh (0 where it is inside a sphere)", NULL, NULL) \
    X(NORMAL, NORMAL_MEDIAN, normal_median, LESS, 2, 0, "degrees", "median error of the normals, degrees", \
      "error of the normals, median", "mskit", \
      "angle between the outer surface of the spheres and that of the shape where it is nearest; median by area", \
      NULL, NULL) \
    X(NORMAL, NORMAL_95, normal_95, LESS, 2, 0, "degrees", NULL, \
      "error of the normals, 95 %", "mskit", \
      "the same angle, which 95 % of that surface keep to. Both are without what is near sharp edges", NULL, NULL) \
    X(NORMAL, EDGE_PART, edge_part, NONE, 4, 0, NULL, NULL, \
      "part near sharp edges", "mskit", \
      "part of that surface nearer than the least radius to a sharp edge of the mesh, where faces turn by over 30 "  \
      "degrees", NULL, NULL) \
    X(NORMAL, EDGE_NORMAL_MEDIAN, edge_normal_median, LESS, 2, 0, "degrees", NULL, \
      "normals near sharp edges, median", "mskit", \
      "the angle there; median by area", NULL, NULL) \
    X(NORMAL, EDGE_NORMAL_95, edge_normal_95, LESS, 2, 0, "degrees", NULL, \
      "normals near sharp edges, 95 %", "mskit", \
      "the angle there, which 95 % keep to", NULL, NULL) \
    X(SPHERES, SMALLEST_RADIUS, smallest_radius_ratio, MORE, 4, 0, NULL, NULL, \
      "smallest / equivalent radius", "mskit", \
      "least radius / radius of the ball of equal volume. Small spheres force small time steps by the " \
      "convention of the Rayleigh time", NULL, NULL) \
    X(SPHERES, WORK, work, LESS, 2, 0, NULL, NULL, \
      "work, n r_eq / r_min", "LIGGGHTS, fix check/timestep/gran", \
      "number of spheres x equivalent / least radius: pairs to try x time steps, if the least sphere sets the step", \
      NULL, NULL) \
    X(COUNT, PIECES, pieces, ONE, 0, 0, "pieces", NULL, \
      "connected", "Yuan 3, note on fig. 4", \
      "number of pieces; spheres that overlap belong together", NULL, NULL) \
    X(GOAL, INERTIA, inertia, LESS, 5, 0, NULL, "error of the moments", \
      "their weighted mean (Yuan)", "Yuan 4, eps_w", \
      "sum of |I_k(union) - I_k(shape)| / sum of I_k(shape), I_k the principal moments; "  \
      "in JSON `inertia_error.weighted_mean`", "inertia_union", "inertia_error") \
    X(GOAL, COVERAGE_CUT, coverage_cut, MORE, 5, 0, NULL, NULL, \
      "coverage of cut cells", "Yuan 3.1, V_cl / V_p", \
      "the same of cells that follow the surface: each weighs what is inside, and is covered where its centroid is", \
      NULL, NULL) \
    X(DESCRIPTOR, VOXEL_LIMIT, voxel_limit, LESS, 5, 0, NULL, NULL, \
      "voxel limit of D", "mskit", \
      "A h / (4 V) of the shape, h the size of a voxel: a D below it is below what voxels can tell", NULL, NULL) \
    MS_DESCRIPTOR_LIST(MS_MEASURE_OF_DESCRIPTOR, X)
/* clang-format on */

#define MS_MEASURE_ENUM(kind, CODE, ...) MS_MEASURE_##CODE,
typedef enum ms_measure_code { MS_MEASURE_LIST(MS_MEASURE_ENUM) MS_MEASURES } ms_measure_code;
#undef MS_MEASURE_ENUM

/* The names of what can be asked for, a comma behind each, and of the columns of curves, one before each. */
#define MS_MEASURE_GOAL_NAME_GOAL(name) #name ", "
#define MS_MEASURE_GOAL_NAME_UNION(name)
#define MS_MEASURE_GOAL_NAME_SURFACE(name)
#define MS_MEASURE_GOAL_NAME_NORMAL(name)
#define MS_MEASURE_GOAL_NAME_SPHERES(name)
#define MS_MEASURE_GOAL_NAME_COUNT(name)
#define MS_MEASURE_GOAL_NAME_DESCRIPTOR(name)
#define MS_MEASURE_GOAL_NAME(kind, CODE, name, ...) MS_MEASURE_GOAL_NAME_##kind(name)
#define MS_MEASURE_GOAL_NAMES MS_MEASURE_LIST(MS_MEASURE_GOAL_NAME)
#define MS_MEASURE_CURVE_NAME_0(name)
#define MS_MEASURE_CURVE_NAME_1(name) "," #name
#define MS_MEASURE_CURVE_NAME(kind, CODE, name, better, digits, curve, ...) MS_MEASURE_CURVE_NAME_##curve(name)
#define MS_MEASURE_CURVE_NAMES MS_MEASURE_LIST(MS_MEASURE_CURVE_NAME)

typedef enum ms_measure_kind {
    MS_MEASURE_KIND_GOAL,
    MS_MEASURE_KIND_UNION,
    MS_MEASURE_KIND_SURFACE,
    MS_MEASURE_KIND_NORMAL,
    MS_MEASURE_KIND_SPHERES,
    MS_MEASURE_KIND_COUNT,
    MS_MEASURE_KIND_DESCRIPTOR
} ms_measure_kind;

typedef enum ms_measure_better {
    MS_BETTER_LESS,
    MS_BETTER_MORE,
    MS_BETTER_ONE,
    MS_BETTER_SHAPE,
    MS_BETTER_NONE
} ms_measure_better;

struct ms_score;
struct ms_metrics;

/** One measure, with the fields of its row in MS_MEASURE_LIST. */
typedef struct ms_measure {
    const char *name; /* key in JSON, what --until takes, column */
    ms_measure_kind kind;
    ms_measure_better better;
    int digits, curve;
    const char *unit, *axis, *label, *source, *help;
    const char *in_compare, *in_stability; /* NULL where it is `name`: ms_measure_column */
    double (*of_score)(const struct ms_score *score);
    double (*of_metrics)(const struct ms_metrics *metrics);
} ms_measure;

/** All of them, by ms_measure_code; a row with a NULL name ends them. */
MS_API extern const ms_measure ms_measures[];

/** The name of its column: `published`, which is in_compare or in_stability, or its own where that is NULL. */
MS_API const char *ms_measure_column(const ms_measure *measure, const char *published);

/** Nonzero if it is a field of ms_score: of_score gives it. Of the others of_score is NULL. */
MS_API int ms_measure_is_of_score(const ms_measure *measure);

/** Nonzero if a value is as good as what was asked for. NAN never is. @param measure a GOAL */
MS_API int ms_measure_is_reached(const ms_measure *measure, double value, double asked);

/** The GOAL of that name, or NULL with a message that lists them. */
MS_API const ms_measure *ms_measure_find_goal(const char *name, ms_error *err);

MS_C_END

#endif
