/** Pictures of shapes and clumps: orthographic, grey, shaded by their normals; PNG. */
#ifndef MS_RENDER_H
#define MS_RENDER_H

#include <stdint.h>
#include <stdio.h>

#include "clump/ms_clump.h"
#include "voxel/ms_target.h"

/** Grey pixels, rows from the top. */
typedef struct ms_picture {
    int width, height;
    uint8_t *grey;
    float *depth;   /* towards the viewer; -HUGE_VALF: nothing there */
    uint32_t *part; /* which sphere, from 1; MS_RENDER_SHAPE of a shape; 0 where nothing is */
} ms_picture;

#define MS_RENDER_SHAPE UINT32_MAX

/** How a square of a picture looks at the world. */
typedef struct ms_view {
    double axis[3][3]; /* right, up, towards the viewer; unit vectors */
    double centre[3];  /* of the square */
    double scale;      /* pixels in a unit of length */
    int x, y, size;    /* left, top and edge of the square, pixels; nothing is drawn beyond */
} ms_view;

/** A white picture. @param[out] picture the caller frees it @return MS_OK; MS_ERR_NOMEM */
ms_status ms_render_picture_alloc(ms_picture *picture, int width, int height, ms_error *err);

/**
 * A view of all of a target: its longest principal axis to the right, its shortest side towards the viewer, turned a
 * little about both so that depth is seen.
 * @return MS_OK; as ms_inertia_principal
 */
ms_status ms_render_view(ms_view *view, const ms_target *target, int x, int y, int size, ms_error *err);

/** The same of a clump alone. @return as above; MS_ERR_NOMEM; as ms_particle_from_spheres */
ms_status ms_render_clump_view(ms_view *view, const ms_clump *clump, int x, int y, int size, ms_error *err);

/** The mesh of the target, or the faces of its voxels, with a dark line around it. Cost: triangles + pixels. */
void ms_render_target(ms_picture *picture, const ms_view *view, const ms_target *target);

/** Spheres, with a dark line where one ends. Cost: spheres x pixels of one. */
void ms_render_clump(ms_picture *picture, const ms_view *view, const ms_clump *clump);

/** Writes a PNG. @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM */
ms_status ms_render_picture_write(const ms_picture *picture, const char *path, ms_error *err);

/** The same to an open file. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_render_picture_put(FILE *stream, const ms_picture *picture, ms_error *err);

void ms_render_picture_free(ms_picture *picture);

#endif
