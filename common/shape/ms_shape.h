/** Analytic and test bodies as closed meshes, for examples, tests and comparisons. */
#ifndef MS_SHAPE_H
#define MS_SHAPE_H

#include "mesh/ms_mesh.h"

MS_C_BEGIN

/** One parameter of a kind of shape: the name that the user writes, its range, a help text. */
typedef struct ms_shape_parameter {
    const char *name;
    double fallback, min, max;
    const char *help;
    int whole; /* nonzero: whole numbers only */
} ms_shape_parameter;

/** No kind has more parameters than this. */
#define MS_SHAPE_MAX_PARAMETERS 8

/** A kind of shape; the table of kinds ends with a NULL name. */
typedef struct ms_shape_kind {
    const char *name;
    const char *summary;
    const ms_shape_parameter *parameters;                                 /* ends with a NULL name */
    ms_status (*make)(ms_mesh *mesh, const double *value, ms_error *err); /* one value per parameter */
    double (*volume)(const double *value); /* exact volume; NULL where there is no formula */
} ms_shape_kind;

MS_API extern const ms_shape_kind ms_shape_kinds[];

/** The kind of that name, or NULL with a message that lists the names. */
MS_API const ms_shape_kind *ms_shape_find(const char *name, ms_error *err);

/**
 * Makes a mesh of a kind: closed, wound outward, its centre of mass at the origin, with the
 * mirror symmetries of the body to the last bit.
 *
 * Parameter `fineness`: segments along a quarter turn of a curved body, along the longest
 * edge of a flat-faced one. The vertices of a curved body lie on its surface, so that its
 * mesh is a little small: volume errors fall as 1 / fineness^2 and are below 0.1 % at the
 * default. A grain is scaled to its volume instead.
 *
 * @param[out] mesh  the caller frees it; empty on failure
 * @param      value one per parameter of the kind, in the kind's order
 * @return MS_OK; MS_ERR_ARG if a value is out of range or two contradict; MS_ERR_NOMEM
 */
MS_API ms_status ms_shape_make(ms_mesh *mesh, const ms_shape_kind *kind, const double *value, ms_error *err);

MS_C_END

#endif
