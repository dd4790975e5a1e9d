/** The built-in shapes on which methods fail. */
#ifndef MS_HARD_SHAPES_H
#define MS_HARD_SHAPES_H

#include "base/ms_choice.h"
#include "cli/ms_input.h"

/** A shape of ms_shape and what is done to it. A table of them ends with a NULL name. */
typedef struct ms_hard_shape {
    const char *name;
    const char *kind;
    double value[8]; /* the parameters of the kind */
    double deq;      /* voxel size = diameter of the ball of equal volume / this, where no flag says another */
    int only;        /* nonzero: no flag changes that */
    double holes;    /* part of the triangles that is taken away */
    double apart;    /* a copy of it stands so far along x: two bodies that overlap; 0: none */
} ms_hard_shape;

extern const ms_hard_shape ms_hard_shapes[];

/* Room for the name of each of them. */
enum { MS_HARD_SHAPES_MOST = 32 };

/** The shape that was typed; NULL if it is none of these, and all are offered. */
const ms_hard_shape *ms_hard_shapes_find(ms_choice *choice);

/**
 * Makes a shape, as ms_input_read does a file. A mesh with holes is taken as --allow-open does, its voxel size from the
 * body before.
 *
 * @param[out]    input freed by ms_input_free; empty on failure
 * @param[in,out] flags get its voxel size, where they do not name another
 * @return MS_OK; as ms_shape_make, ms_mesh_repair
 */
ms_status ms_hard_shapes_read(ms_input *input, const ms_hard_shape *shape, ms_input_flags *flags, ms_error *err);

#endif
