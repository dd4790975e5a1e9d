/** The built-in shapes on which methods fail. */
#ifndef MS_HARD_SHAPES_H
#define MS_HARD_SHAPES_H

#include "cli/ms_input.h"

/** A shape of ms_shape and what is done to it. A table of them ends with a NULL name. */
typedef struct ms_hard_shape {
    const char *name;
    const char *kind;
    double value[8]; /* the parameters of the kind */
    double deq;      /* voxel size = diameter of the ball of equal volume / this, where no flag says another */
    int only;        /* nonzero: no flag changes that */
    double holes;    /* part of the triangles that is taken away */
} ms_hard_shape;

extern const ms_hard_shape ms_hard_shapes[];

/**
 * Makes a shape and its target. A mesh with holes is taken as --allow-open does, its voxel size from the body before.
 *
 * @param[out] input freed by ms_input_free; empty on failure
 * @return MS_OK; as ms_shape_make, ms_input_target
 */
ms_status ms_hard_shapes_make(ms_input *input, const ms_hard_shape *shape, const ms_input_flags *flags, ms_error *err);

#endif
