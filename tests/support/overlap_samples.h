/** Boxes that overlap, touch or stand apart, together in one mesh and turned askew. */
#ifndef OVERLAP_SAMPLES_H
#define OVERLAP_SAMPLES_H

#include "grid_samples.h"

/** From lo to hi along the axes, before the turn. */
typedef struct box_sample {
    double lo[3], hi[3];
} box_sample;

/** Rows of a turn whose numbers are fractions: no axis stays one. */
static const double askew[3][3] = {
    {2.0 / 7, 3.0 / 7, 6.0 / 7}, {-6.0 / 7, -2.0 / 7, 3.0 / 7}, {3.0 / 7, -6.0 / 7, 2.0 / 7}};
static const double upright[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static inline void turn_body(ms_mesh *mesh, const double turn[3][3])
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double *p = mesh->vertex[v], q[3];
        for (int k = 0; k < 3; k++) {
            q[k] = turn[k][0] * p[0] + turn[k][1] * p[1] + turn[k][2] * p[2];
        }
        memcpy(p, q, sizeof q);
    }
}

/** Each a shell of its own, repaired. */
static inline ms_mesh boxes_together(const box_sample *box, size_t n, const double turn[3][3])
{
    ms_mesh mesh = {0};
    for (size_t k = 0; k < n; k++) {
        add_part(&mesh, cuboid(box[k].lo[0], box[k].hi[0], box[k].lo[1], box[k].hi[1], box[k].lo[2], box[k].hi[2]));
    }
    turn_body(&mesh, turn);
    weld_body(&mesh);
    repair_body(&mesh);
    return mesh;
}

#endif
