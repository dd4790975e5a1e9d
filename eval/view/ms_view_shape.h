/** The shape as it is drawn, and distances to it. */
#ifndef MS_VIEW_SHAPE_H
#define MS_VIEW_SHAPE_H

#include "mesh/ms_closest.h"
#include "voxel/ms_target.h"

/** Pointers are to what is the target's or to what was made here. */
typedef struct ms_view_shape {
    const ms_mesh *mesh;       /* of the target; of a volume its surface, smoothed */
    const ms_mesh *shown;      /* the same, or of fewer triangles */
    const ms_closest *closest; /* on `mesh` */
    ms_mesh made, decimated;
    ms_closest *made_closest;
} ms_view_shape;

/**
 * @param[out] shape          ms_view_shape_free in any case; borrows of the target
 * @param      most_triangles of `shown`
 * @return MS_OK; MS_ERR_NOMEM; as ms_isosurface_build
 */
ms_status ms_view_shape_make(ms_view_shape *shape, const ms_target *target, size_t most_triangles, ms_error *err);

void ms_view_shape_free(ms_view_shape *shape);

#endif
