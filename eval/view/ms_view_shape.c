#include "ms_view_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/ms_isosurface.h"
#include "mesh/ms_mesh_decimate.h"

/* Voxels along an axis from which on a volume is drawn by blocks of them, and how often its corners are smoothed. */
enum { MOST_VOXELS = 160, SMOOTH = 3 };

static int is_in_grid(const ms_grid *grid, const int at[3])
{
    return at[0] < grid->n[0] && at[1] < grid->n[1] && at[2] < grid->n[2];
}

/* Nonzero if half of the block or more is inside. */
static int is_block_inside(const ms_grid *grid, const int block[3], int step)
{
    int count = 0;
    for (int m = 0; m < step * step * step; m++) {
        const int at[3] = {step * block[0] + m % step, step * block[1] + m / step % step,
                           step * block[2] + m / step / step};
        count += is_in_grid(grid, at) && grid->inside[ms_grid_index(grid, at[0], at[1], at[2])];
    }
    return 2 * count >= step * step * step;
}

/* Each corner halfway to the mean of its neighbours, which takes the steps of voxels away. */
static ms_status smooth(ms_mesh *mesh, ms_error *err)
{
    double(*sum)[4] = malloc(mesh->n_vertices * sizeof *sum);
    if (!sum) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to draw the volume");
    }
    for (int pass = 0; pass < SMOOTH; pass++) {
        memset(sum, 0, mesh->n_vertices * sizeof *sum);
        for (size_t side = 0; side < 3 * mesh->n_triangles; side++) {
            const uint32_t from = mesh->triangle[side / 3][side % 3], to = mesh->triangle[side / 3][(side + 1) % 3];
            for (int k = 0; k < 3; k++) {
                sum[from][k] += mesh->vertex[to][k];
            }
            sum[from][3] += 1;
        }
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            for (int k = 0; k < 3; k++) {
                mesh->vertex[v][k] = (mesh->vertex[v][k] + sum[v][k] / sum[v][3]) / 2;
            }
        }
    }
    free(sum);
    return MS_OK;
}

/* The blocks have a layer of background around. */
static ms_status draw_grid(ms_mesh *mesh, const ms_grid *grid, ms_error *err)
{
    const int most = (int)fmax(grid->n[0], fmax(grid->n[1], grid->n[2])), step = (most - 1) / MOST_VOXELS + 1;
    ms_isosurface field = {.h = step * grid->h};
    size_t points = 1;
    for (int k = 0; k < 3; k++) {
        field.n[k] = (grid->n[k] + step - 1) / step + 2;
        field.origin[k] = grid->origin[k] + (0.5 * (step - 1) - step) * grid->h;
        points *= (size_t)field.n[k];
    }
    uint8_t *inside = malloc(points);
    if (!inside) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to draw the volume");
    }
    for (size_t p = 0; p < points; p++) {
        const size_t row = p / (size_t)field.n[0];
        const int at[3] = {(int)(p % (size_t)field.n[0]) - 1, (int)(row % (size_t)field.n[1]) - 1,
                           (int)(row / (size_t)field.n[1]) - 1};
        inside[p] = (uint8_t)(at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && is_block_inside(grid, at, step));
    }
    field.inside = inside;
    ms_status status = ms_isosurface_build(mesh, &field, err);
    free(inside);
    return status == MS_OK ? smooth(mesh, err) : status;
}

ms_status ms_view_shape_make(ms_view_shape *shape, const ms_target *target, size_t most_triangles, ms_error *err)
{
    ms_status status = MS_OK;
    *shape = (ms_view_shape){.mesh = target->mesh, .closest = target->closest};
    if (!shape->mesh) {
        status = draw_grid(&shape->made, &target->grid, err);
        shape->mesh = &shape->made;
    }
    if (status == MS_OK && !shape->closest) {
        status = ms_closest_build(&shape->made_closest, shape->mesh, err);
        shape->closest = shape->made_closest;
    }
    shape->shown = shape->mesh;
    if (status == MS_OK && shape->mesh->n_triangles > most_triangles) {
        status = ms_mesh_decimate(&shape->decimated, shape->mesh, most_triangles, err);
        shape->shown = &shape->decimated;
    }
    return status;
}

void ms_view_shape_free(ms_view_shape *shape)
{
    ms_closest_free(shape->made_closest);
    ms_mesh_free(&shape->made);
    ms_mesh_free(&shape->decimated);
}
