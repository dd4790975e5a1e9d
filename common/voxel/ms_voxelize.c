#include "ms_voxelize.h"

#include <math.h>
#include <string.h>

#include "ms_sweep.h"

ms_status ms_voxelize_size(double *h, const ms_mesh *mesh, double cells, ms_error *err)
{
    double lo[3], hi[3];
    *h = 0;
    if (!(cells > 0)) {
        return ms_fail(err, MS_ERR_ARG, "%g cells are not a number above 0", cells);
    }
    ms_mesh_box(lo, hi, mesh);
    const double side = fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2]));
    if (!(side > 0)) {
        return ms_fail(err, MS_ERR_SHAPE, "the mesh is flat, it encloses nothing");
    }
    *h = side / cells;
    return MS_OK;
}

void ms_voxelize_extents(double n[3], const ms_mesh *mesh, double h)
{
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    for (int a = 0; a < 3; a++) {
        /* The whole number nearest to the side: with the box in the middle its faces then lie less than a quarter of
         * a voxel from the faces of voxels. Half a voxel away, where one more would do, a hair would decide whether a
         * whole layer is inside. A side just between two numbers takes the lower one, whatever its rounding. */
        n[a] = fmax(1, ceil((hi[a] - lo[a]) / h - 0.5 - 1e-6)) + 2 * MS_GRID_HULL;
    }
}

/* Voxels of a grid; more than any number where an extent is beyond the limit. */
static double count_voxels(const ms_mesh *mesh, double h)
{
    double n[3];
    ms_voxelize_extents(n, mesh, h);
    return fmax(n[0], fmax(n[1], n[2])) <= MS_GRID_MAX_EXTENT ? n[0] * n[1] * n[2] : HUGE_VAL;
}

ms_status ms_voxelize_size_within(double *h, const ms_mesh *mesh, double max_voxels, ms_error *err)
{
    double side, few = 1, many = MS_GRID_MAX_EXTENT;
    *h = 0;
    if (!(max_voxels > 0) || !isfinite(max_voxels)) {
        return ms_fail(err, MS_ERR_ARG, "%g voxels are not a number above 0", max_voxels);
    }
    const ms_status status = ms_voxelize_size(&side, mesh, 1, err);
    if (status != MS_OK) {
        return status;
    }
    if (!(count_voxels(mesh, side) <= max_voxels)) {
        return ms_fail(
            err, MS_ERR_LIMIT,
            "%.0f voxels are too few: a grid of one along the shortest side of the mesh has %.6g; allow more",
            max_voxels, count_voxels(mesh, side));
    }
    while (many - few > 1) { /* cells along the shortest side: `few` fit, `many` do not */
        const double middle = floor(0.5 * (few + many));
        if (count_voxels(mesh, side / middle) <= max_voxels) {
            few = middle;
        } else {
            many = middle;
        }
    }
    *h = side / few;
    return MS_OK;
}

static int is_finite(const ms_mesh *mesh)
{
    int finite = 1;
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        const double *p = mesh->vertex[v];
        finite &= isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
    }
    return finite;
}

/* The grid around the mesh, with the box of the mesh in its middle, or `off` that by so many voxels. */
static ms_status alloc_around(ms_grid *grid, double off[3], const ms_mesh *mesh, double h, const double *shift,
                              ms_error *err)
{
    double lo[3], hi[3], extent[3], origin[3];
    int n[3];
    memset(grid, 0, sizeof *grid);
    if (mesh->n_triangles == 0) {
        return ms_fail(err, MS_ERR_ARG, "the mesh has no triangles to voxelise");
    }
    if (!(h > 0) || !isfinite(h)) {
        return ms_fail(err, MS_ERR_ARG, "voxel size %g is not a positive number", h);
    }
    if (!is_finite(mesh)) {
        return ms_fail(err, MS_ERR_ARG, "a vertex of the mesh has a coordinate that is not a finite number");
    }
    ms_voxelize_extents(extent, mesh, h);
    ms_mesh_box(lo, hi, mesh);
    for (int a = 0; a < 3; a++) {
        if (!(extent[a] <= MS_GRID_MAX_EXTENT)) {
            return ms_fail(err, MS_ERR_LIMIT, "%.0f voxels along %c are more than %d; use a larger voxel size",
                           extent[a], "xyz"[a], MS_GRID_MAX_EXTENT);
        }
        if (shift && !(shift[a] >= 0 && shift[a] < 1)) {
            return ms_fail(err, MS_ERR_ARG, "a lattice is moved by 0 or more and less than 1 voxel, not by %g",
                           shift[a]);
        }
        n[a] = (int)extent[a];
        origin[a] = lo[a] + 0.5 * (hi[a] - lo[a]) - 0.5 * h * (n[a] - 1);
        off[a] = 0;
        if (shift && shift[a] > 0) { /* one voxel more at the upper end, where less than one is missing now */
            n[a]++;
            origin[a] -= h * shift[a];
            off[a] = shift[a] - 0.5;
        }
    }
    return ms_grid_alloc(grid, n, h, origin, err);
}

/* Frees the grid where the voxelisation failed or holds nothing. */
static ms_status finish_grid(ms_grid *grid, ms_status status, ms_error *err)
{
    if (status == MS_OK && !memchr(grid->inside, 1, ms_grid_voxels(grid))) {
        status = ms_fail(err, MS_ERR_SHAPE, "no voxel of size %g is inside the shape; use more cells", grid->h);
    }
    if (status != MS_OK) {
        ms_grid_free(grid);
    }
    return status;
}

ms_status ms_voxelize(ms_grid *grid, const ms_mesh *mesh, double h, ms_voxel_rule rule, ms_error *err)
{
    return ms_voxelize_moved(grid, mesh, h, rule, NULL, err);
}

ms_status ms_voxelize_moved(ms_grid *grid, const ms_mesh *mesh, double h, ms_voxel_rule rule, const double shift[3],
                            ms_error *err)
{
    double off[3];
    ms_status status = alloc_around(grid, off, mesh, h, shift, err);
    if (status != MS_OK) {
        return status;
    }
    return finish_grid(grid, ms_sweep(grid, mesh, off, 0, rule == MS_VOXEL_HALF ? 4 : 1, 0, err), err);
}

ms_status ms_voxelize_open(ms_grid *grid, size_t *disagree, const ms_mesh *mesh, double h, ms_error *err)
{
    return ms_voxelize_open_moved(grid, disagree, mesh, h, NULL, err);
}

ms_status ms_voxelize_open_moved(ms_grid *grid, size_t *disagree, const ms_mesh *mesh, double h, const double shift[3],
                                 ms_error *err)
{
    *disagree = 0;
    double off[3];
    ms_status status = alloc_around(grid, off, mesh, h, shift, err);
    for (int axis = 0; axis < 3 && status == MS_OK; axis++) {
        status = ms_sweep(grid, mesh, off, axis, 1, 1, err);
    }
    if (status == MS_OK) {
        const size_t voxels = ms_grid_voxels(grid);
        for (size_t v = 0; v < voxels; v++) {
            const int votes = (grid->inside[v] & 1) + (grid->inside[v] >> 1 & 1) + (grid->inside[v] >> 2);
            *disagree += votes == 1 || votes == 2;
            grid->inside[v] = votes >= 2;
        }
    }
    return finish_grid(grid, status, err);
}
