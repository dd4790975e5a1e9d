#include "ms_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

ms_status ms_grid_alloc(ms_grid *grid, const int n[3], double h, const double origin[3], ms_error *err)
{
    memset(grid, 0, sizeof *grid);
    for (int a = 0; a < 3; a++) {
        if (n[a] < 1) {
            return ms_fail(err, MS_ERR_ARG, "grid extent %d along %c is below 1", n[a], "xyz"[a]);
        }
        if (n[a] > MS_GRID_MAX_EXTENT) {
            return ms_fail(err, MS_ERR_LIMIT, "grid extent %d along %c is above %d; use fewer cells", n[a], "xyz"[a],
                           MS_GRID_MAX_EXTENT);
        }
    }
    if (!(h > 0) || !isfinite(h)) {
        return ms_fail(err, MS_ERR_ARG, "voxel size %g is not a positive number", h);
    }
    memcpy(grid->n, n, sizeof grid->n);
    memcpy(grid->origin, origin, sizeof grid->origin);
    grid->h = h;
    grid->inside = calloc(ms_grid_voxels(grid), 1);
    if (!grid->inside) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a grid of %dx%dx%d voxels; use fewer cells", n[0], n[1], n[2]);
    }
    return MS_OK;
}

ms_status ms_grid_enlarge(ms_grid *out, const ms_grid *grid, const double lo[3], const double hi[3], size_t max_voxels,
                          ms_error *err)
{
    double before[3], total = 1;
    int n[3];
    memset(out, 0, sizeof *out);
    for (int a = 0; a < 3; a++) {
        /* In voxels from the centre of the first; a hull stays around what is held. */
        double first = floor((lo[a] - grid->origin[a]) / grid->h) - 1;
        double last = ceil((hi[a] - grid->origin[a]) / grid->h) + 1;
        before[a] = fmax(0, -first);
        double extent = fmax(grid->n[a] - 1, last) + before[a] + 1;
        total *= extent;
        if (!(extent <= MS_GRID_MAX_EXTENT) || !(total <= (double)max_voxels)) {
            return ms_fail(err, MS_ERR_LIMIT,
                           "spheres reach so far beyond the shape (%g to %g along %c) that a grid for both is too "
                           "large; check units and frame of the spheres, or allow more memory",
                           lo[a], hi[a], "xyz"[a]);
        }
        n[a] = (int)extent;
    }
    double origin[3];
    for (int a = 0; a < 3; a++) {
        origin[a] = grid->origin[a] - before[a] * grid->h;
    }
    ms_status status = ms_grid_alloc(out, n, grid->h, origin, err);
    if (status != MS_OK) {
        return status;
    }
    out->cells = grid->cells;
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            memcpy(out->inside + ms_grid_index(out, (int)before[0], j + (int)before[1], k + (int)before[2]),
                   grid->inside + ms_grid_index(grid, 0, j, k), (size_t)grid->n[0]);
        }
    }
    return MS_OK;
}

void ms_grid_at(double at[3], const ms_grid *grid, const double place[3])
{
    for (int a = 0; a < 3; a++) {
        at[a] = (place[a] - grid->origin[a]) / grid->h;
    }
}

void ms_grid_place(double place[3], const ms_grid *grid, const double at[3])
{
    for (int a = 0; a < 3; a++) {
        place[a] = grid->origin[a] + grid->h * at[a];
    }
}

void ms_grid_corners(double corner[3][3], const ms_grid *grid, const ms_mesh *mesh, size_t triangle)
{
    for (int c = 0; c < 3; c++) {
        ms_grid_at(corner[c], grid, mesh->vertex[mesh->triangle[triangle][c]]);
    }
}

int ms_grid_holds(const ms_grid *grid, const double at[3])
{
    int voxel[3];
    for (int a = 0; a < 3; a++) {
        if (!(at[a] > -0.5 && at[a] < grid->n[a] - 0.5)) {
            return 0;
        }
        voxel[a] = (int)rint(at[a]);
    }
    return grid->inside[ms_grid_index(grid, voxel[0], voxel[1], voxel[2])];
}

ms_ball ms_grid_ball(const ms_grid *grid, const ms_sphere *sphere)
{
    ms_ball ball = {.radius = sphere->radius / grid->h};
    ms_grid_at(ball.centre, grid, sphere->centre);
    return ball;
}

ms_sphere ms_grid_sphere(const ms_grid *grid, const ms_ball *ball)
{
    ms_sphere sphere = {.radius = grid->h * ball->radius};
    ms_grid_place(sphere.centre, grid, ball->centre);
    return sphere;
}

size_t ms_grid_count(const ms_grid *grid)
{
    size_t count = 0;
    const size_t voxels = ms_grid_voxels(grid);
    for (size_t v = 0; v < voxels; v++) {
        count += grid->inside[v];
    }
    return count;
}

void ms_grid_free(ms_grid *grid)
{
    if (grid) {
        free(grid->inside);
        memset(grid, 0, sizeof *grid);
    }
}
