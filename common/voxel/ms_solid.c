#include "ms_solid.h"

#include <math.h>
#include <string.h>

#include "base/ms_vector.h"
#include "mesh/ms_mesh_touch.h"
#include "ms_sweep.h"

/* Rays across the box: RAYS in each of CELLS along y and z. */
enum { CELLS = 128, RAYS = 8 };

/* So much of one side of the box rays are displaced along y as z goes from end to end, and the
 * other way about: with rays along a face, a body along the axes would gain or lose a row. */
static const double SHEAR[2] = {0.0618, 0.0414};

/* Integrals of 1, x_i and x_i x_j (xx, yy, zz, xy, yz, zx) in cells, from the middle of the box. */
typedef struct moments {
    double volume, first[3], second[6];
} moments;

/* What the integrals over the mesh have too much and too little. */
typedef struct excess {
    moments more_often, inside_out;
} excess;

static const int PAIR[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};

/* A stretch of the ray at (y, z), as many times as `weight`. */
static void add_stretch(moments *m, double from, double to, double y, double z, double weight)
{
    const double length = weight * (to - from);
    const double middle = 0.5 * (from + to), at[3] = {middle, y, z};
    m->volume += length;
    for (int k = 0; k < 3; k++) {
        m->first[k] += length * at[k];
    }
    for (int k = 0; k < 6; k++) {
        m->second[k] += length * at[PAIR[k][0]] * at[PAIR[k][1]];
    }
    m->second[0] += length * (to - from) * (to - from) / 12;
}

/* Along one ray, with its four near rays a quarter each. */
static void follow_ray(excess *sum, const ms_crossing *crossing, size_t count, double y, double z)
{
    int winding[MS_SWEEP_NEAR_RAYS] = {0}, more_often = 0, inside_out = 0;
    for (size_t m = 0; m < count; m++) {
        if (m > 0 && (more_often || inside_out)) {
            const double from = crossing[m - 1].at / (double)MS_SWEEP_ALONG - 0.5 * CELLS;
            const double to = crossing[m].at / (double)MS_SWEEP_ALONG - 0.5 * CELLS;
            add_stretch(&sum->more_often, from, to, y, z, (double)more_often / MS_SWEEP_NEAR_RAYS);
            add_stretch(&sum->inside_out, from, to, y, z, (double)inside_out / MS_SWEEP_NEAR_RAYS);
        }
        more_often = inside_out = 0;
        for (int near = 0; near < MS_SWEEP_NEAR_RAYS; near++) {
            winding[near] += crossing[m].near >> near & 1 ? crossing[m].sign : 0;
            more_often += winding[near] > 1 ? winding[near] - 1 : 0;
            inside_out += winding[near] < 0 ? -winding[near] : 0;
        }
    }
}

/* Each plane has a sum of its own, so that no order of threads shows. */
static void take_plane(void *context, int plane, const ms_crossing *crossing, const uint32_t *start)
{
    excess *sum = (excess *)context + plane;
    for (int k = 0; k < RAYS; k++) {
        for (int j = 0; j < CELLS * RAYS; j++, start++) {
            const double y = (j + 0.5) / RAYS - 0.5 * CELLS, z = plane + (k + 0.5) / RAYS - 0.5 * CELLS;
            follow_ray(sum, crossing + start[0], start[1] - start[0], y, z);
        }
    }
}

static void add_moments(moments *sum, const moments *part)
{
    sum->volume += part->volume;
    for (int k = 0; k < 3; k++) {
        sum->first[k] += part->first[k];
    }
    for (int k = 0; k < 6; k++) {
        sum->second[k] += part->second[k];
    }
}

/* A lattice place q, in cells, is at origin + axis q in the mesh's frame. */
typedef struct lattice_frame {
    double origin[3], axis[3][3];
} lattice_frame;

static double find_determinant(const double m[3][3])
{
    double cross[3];
    ms_cross(cross, m[1], m[2]);
    return ms_dot(m[0], cross);
}

/* A stretch stands for the box around its ray. */
static ms_body body_of(const moments *m, const lattice_frame *f)
{
    ms_body body = {0};
    double second[3][3], turned[3][3] = {{0}}; /* about the centroid, in cells and in the mesh's unit */
    if (!(m->volume > 0)) {
        return body;
    }
    const double ray = fabs(find_determinant(f->axis)) / (RAYS * RAYS);
    body.volume = m->volume * ray;
    for (int k = 0; k < 6; k++) {
        const int i = PAIR[k][0], j = PAIR[k][1];
        second[i][j] = m->second[k] - m->first[i] * m->first[j] / m->volume;
        second[i][j] += k == 1 || k == 2 ? m->volume / (12 * RAYS * RAYS) : 0;
        second[j][i] = second[i][j];
    }
    for (int k = 0; k < 81; k++) {
        const int i = k / 27, j = k / 9 % 3, p = k / 3 % 3, q = k % 3;
        turned[i][j] += ray * f->axis[i][p] * second[p][q] * f->axis[j][q];
    }
    for (int i = 0; i < 3; i++) {
        body.centroid[i] = f->origin[i] + ms_dot(f->axis[i], m->first) / m->volume;
        for (int j = 0; j < 3; j++) {
            body.inertia[i][j] = (i == j ? turned[0][0] + turned[1][1] + turned[2][2] : 0) - turned[i][j];
        }
    }
    return body;
}

/* The mesh in a box about one unit long, displaced by SHEAR. `f` leads back, but for the cells. */
static ms_status shear_mesh(ms_mesh *sheared, lattice_frame *f, const ms_mesh *mesh, ms_error *err)
{
    double lo[3], hi[3], side[3];
    ms_status status = ms_mesh_alloc(sheared, mesh->n_vertices, mesh->n_triangles, err);
    if (status != MS_OK) {
        return status;
    }
    ms_mesh_box(lo, hi, mesh);
    for (int a = 0; a < 3; a++) {
        side[a] = hi[a] - lo[a];
        f->origin[a] = lo[a] + 0.5 * side[a];
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double p[3];
        for (int a = 0; a < 3; a++) {
            p[a] = (mesh->vertex[v][a] - f->origin[a]) / side[a];
        }
        sheared->vertex[v][0] = p[0];
        sheared->vertex[v][1] = p[1] + SHEAR[0] * p[2];
        sheared->vertex[v][2] = p[2] + SHEAR[1] * p[1];
    }
    memcpy(sheared->triangle, mesh->triangle, mesh->n_triangles * sizeof *mesh->triangle);
    const double stretch = 1 - SHEAR[0] * SHEAR[1];
    const double axis[3][3] = {{side[0], 0, 0},
                               {0, side[1] / stretch, -SHEAR[0] * side[1] / stretch},
                               {0, -SHEAR[1] * side[2] / stretch, side[2] / stretch}};
    memcpy(f->axis, axis, sizeof axis);
    return MS_OK;
}

/* From the middle of the sheared mesh's box, in cells of which CELLS go across it. */
static void count_in_cells(double cell[3], lattice_frame *f, const ms_mesh *sheared)
{
    double lo[3], hi[3], middle[3];
    ms_mesh_box(lo, hi, sheared);
    for (int a = 0; a < 3; a++) {
        cell[a] = (hi[a] - lo[a]) / CELLS;
        middle[a] = lo[a] + 0.5 * (hi[a] - lo[a]);
    }
    for (int i = 0; i < 3; i++) {
        f->origin[i] += ms_dot(f->axis[i], middle);
        for (int j = 0; j < 3; j++) {
            f->axis[i][j] *= cell[j];
        }
    }
}

static ms_status measure_excess(ms_body *more_often, ms_body *inside_out, const ms_mesh *mesh, ms_error *err)
{
    static const int n[3] = {CELLS, CELLS, CELLS};
    double cell[3];
    lattice_frame f;
    ms_mesh sheared;
    excess plane[CELLS];
    memset(plane, 0, sizeof plane);
    ms_status status = shear_mesh(&sheared, &f, mesh, err);
    if (status != MS_OK) {
        return status;
    }
    count_in_cells(cell, &f, &sheared);
    status = ms_sweep_crossings(&sheared, n, cell, RAYS, take_plane, plane, err);
    for (int k = 1; k < CELLS; k++) {
        add_moments(&plane[0].more_often, &plane[k].more_often);
        add_moments(&plane[0].inside_out, &plane[k].inside_out);
    }
    *more_often = body_of(&plane[0].more_often, &f);
    *inside_out = body_of(&plane[0].inside_out, &f);
    ms_mesh_free(&sheared);
    return status;
}

ms_status ms_solid_mesh(ms_solid *solid, const ms_mesh *mesh, ms_error *err)
{
    ms_body more_often = {0}, inside_out = {0};
    *solid = (ms_solid){0};
    ms_status status = ms_inertia_mesh(&solid->body, mesh, err);
    if (status == MS_OK) {
        status = ms_mesh_touch(&solid->touches, mesh, err);
    }
    if (status == MS_OK && solid->touches) {
        status = measure_excess(&more_often, &inside_out, mesh, err);
    }
    if (status != MS_OK) {
        *solid = (ms_solid){0};
        return status;
    }
    if (more_often.volume + inside_out.volume > MS_SOLID_OVERLAP * solid->body.volume) {
        solid->overlapping = 1;
        solid->more_often = more_often.volume;
        solid->inside_out = inside_out.volume;
        ms_inertia_add(&solid->body, &inside_out, 1);
        ms_inertia_add(&solid->body, &more_often, -1);
    }
    return MS_OK;
}
