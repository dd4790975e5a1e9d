/** Grids for tests: made from meshes, compared, mirrored. */
#ifndef GRID_SAMPLES_H
#define GRID_SAMPLES_H

#include <omp.h>

#include "body_samples.h"
#include "voxel/ms_voxelize.h"

static inline ms_grid voxels_of(const ms_mesh *mesh, double h, ms_voxel_rule rule)
{
    ms_grid grid;
    ms_error err = {{0}};
    if (ms_voxelize(&grid, mesh, h, rule, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return grid;
}

/** An empty grid with voxel (0, 0, 0) at the origin. */
static inline ms_grid empty_grid(int nx, int ny, int nz, double h)
{
    ms_grid grid;
    const int n[3] = {nx, ny, nz};
    const double origin[3] = {0};
    assert_int_equal(ms_grid_alloc(&grid, n, h, origin, NULL), MS_OK);
    return grid;
}

static inline int inside_at(const ms_grid *grid, int i, int j, int k)
{
    return grid->inside[ms_grid_index(grid, i, j, k)];
}

static inline void centre_of(double at[3], const ms_grid *grid, int i, int j, int k)
{
    const int voxel[3] = {i, j, k};
    for (int a = 0; a < 3; a++) {
        at[a] = grid->origin[a] + grid->h * voxel[a];
    }
}

static inline int same_voxels(const ms_grid *a, const ms_grid *b)
{
    return memcmp(a->n, b->n, sizeof a->n) == 0 && memcmp(a->inside, b->inside, ms_grid_voxels(a)) == 0;
}

static inline void expect_mirrored(const ms_grid *grid)
{
    const int *n = grid->n;
    for (int k = 0; k < n[2]; k++) {
        for (int j = 0; j < n[1]; j++) {
            for (int i = 0; i < n[0]; i++) {
                const int here = inside_at(grid, i, j, k);
                if (here != inside_at(grid, n[0] - 1 - i, j, k) || here != inside_at(grid, i, n[1] - 1 - j, k) ||
                    here != inside_at(grid, i, j, n[2] - 1 - k)) {
                    fail_msg("voxel (%d, %d, %d) of %dx%dx%d has no mirror image", i, j, k, n[0], n[1], n[2]);
                }
            }
        }
    }
}

static inline void expect_hull(const ms_grid *grid)
{
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                const int at[3] = {i, j, k};
                for (int a = 0; a < 3; a++) {
                    if (at[a] < MS_GRID_HULL || at[a] >= grid->n[a] - MS_GRID_HULL) {
                        assert_int_equal(inside_at(grid, i, j, k), 0);
                    }
                }
            }
        }
    }
}

/** A cuboid from lo to hi, twelve triangles. */
static inline ms_mesh cuboid(double x0, double x1, double y0, double y1, double z0, double z1)
{
    const double lo[3] = {x0, y0, z0}, hi[3] = {x1, y1, z1};
    ms_mesh mesh = unit_cube();
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        for (int a = 0; a < 3; a++) {
            mesh.vertex[v][a] = mesh.vertex[v][a] > 0 ? hi[a] : lo[a];
        }
    }
    return mesh;
}

static inline double between(uint64_t *state, double lo, double hi)
{
    return lo + (hi - lo) * next_uniform(state);
}

/** A whole number from 0 to below n. */
static inline int pick(uint64_t *state, int n)
{
    return (int)(next_uniform(state) * n);
}

#endif
