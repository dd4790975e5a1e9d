/** One clump, and the shape for which it stands, as the viewer takes it: a JSON object within a page. */
#ifndef MS_VIEW_SCENE_H
#define MS_VIEW_SCENE_H

#include <stdio.h>

#include "clump/ms_clump.h"
#include "voxel/ms_target.h"

/** What is shown; all borrowed. */
typedef struct ms_view_scene {
    const char *name; /* text from outside, above the picture */
    const ms_clump *clump;
    const ms_target *target; /* NULL: the clump alone */
    int ordered;             /* the first k spheres are a clump, too */
    size_t most_triangles;   /* more are decimated */
    int with_field;          /* distances in space, for colours on the spheres; about 90 kB */
} ms_view_scene;

/**
 * Writes `{"spheres": ..., ...}`. Lengths in it are from the middle of all that is shown, its radius 1; `scale` is that
 * radius in the clump's unit. Arrays are little-endian, in base64:
 *
 *     name        text
 *     spheres     x, y, z, r, single precision
 *     mass        of each sphere, kg, single precision; where there are masses
 *     protrusion  of each sphere, how far what is exposed of it is outside the shape at most, in the clump's unit,
 *                 single precision; where the shape is closed
 *     mesh        low, high: its box; corners: parts of it, 16 bits; faces: 16 bits, 32 where there are over 65536
 *                 corners; of: triangles that the shape has
 *     field       n, low, h: a lattice around the clump; values: signed distance to the shape, outside positive, parts
 *                 of range, 8 bits
 *
 * @return MS_OK; MS_ERR_ARG where the radius of all is not finite; MS_ERR_NOMEM; as ms_view_shape_make
 * Cost: a search of the mesh for each of 70,000 points of the lattice and 256 of each sphere; all cores.
 */
ms_status ms_view_scene_write(FILE *stream, const ms_view_scene *scene, ms_error *err);

#endif
