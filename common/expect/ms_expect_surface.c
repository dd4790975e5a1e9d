#include "ms_expect_surface.h"

#include <stdlib.h>

/* The sum of weights is 64: from here on a voxel counts as inside. Never reached exactly, so that no crossing lies on a
 * voxel's centre. */
static const double HALF = 31.5;

typedef struct net {
    const ms_grid *grid;
    uint8_t *part;    /* of each voxel inside, of 64 */
    uint32_t *vertex; /* of the cube from a voxel to the next along each axis */
    size_t step[3];   /* to the next voxel along each axis */
} net;

static void average_lines(uint8_t *part, const net *n, int axis)
{
    const size_t count = ms_grid_voxels(n->grid), step = n->step[axis];
    for (int turn = 0; turn < 2; turn++) { /* 1 1 twice is 1 2 1, once up and once down */
        for (size_t k = step; k < count; k++) {
            const size_t at = turn == 0 ? count - 1 - (k - step) : k - step;
            const size_t other = turn == 0 ? at - step : at + step;
            part[at] = (uint8_t)(part[at] + part[other]);
        }
    }
}

static int is_inside(const net *n, size_t voxel)
{
    return n->part[voxel] > HALF;
}

/* Whether the surface passes between a voxel and the next along an axis. */
static int is_crossed(const net *n, size_t voxel, int axis)
{
    return is_inside(n, voxel) != is_inside(n, voxel + n->step[axis]);
}

/* The mean of the crossings along the twelve edges of the cube; 0 if there are none. */
static int place_vertex(double at[3], const net *n, size_t cube)
{
    int count = 0;
    at[0] = at[1] = at[2] = 0;
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int corner = 0; corner < 4; corner++) {
            const size_t voxel = cube + (corner & 1) * n->step[u] + (size_t)(corner >> 1) * n->step[v];
            if (is_crossed(n, voxel, axis)) {
                const double a = n->part[voxel], b = n->part[voxel + n->step[axis]];
                at[axis] += (HALF - a) / (b - a);
                at[u] += corner & 1;
                at[v] += corner >> 1;
                count++;
            }
        }
    }
    for (int axis = 0; axis < 3 && count > 0; axis++) {
        at[axis] /= count;
    }
    return count;
}

/* Calls for each voxel but those at the upper border. */
static void walk(net *n, void (*call)(net *n, const int at[3], size_t voxel, ms_mesh *mesh), ms_mesh *mesh)
{
    int at[3];
    for (at[2] = 0; at[2] + 1 < n->grid->n[2]; at[2]++) {
        for (at[1] = 0; at[1] + 1 < n->grid->n[1]; at[1]++) {
            for (at[0] = 0; at[0] + 1 < n->grid->n[0]; at[0]++) {
                call(n, at, ms_grid_index(n->grid, at[0], at[1], at[2]), mesh);
            }
        }
    }
}

static void count_parts(net *n, const int at[3], size_t voxel, ms_mesh *mesh)
{
    double place[3];
    (void)at;
    mesh->n_vertices += place_vertex(place, n, voxel) > 0;
    for (int axis = 0; axis < 3; axis++) {
        mesh->n_triangles += is_crossed(n, voxel, axis) ? 2 : 0;
    }
}

static void add_vertex(net *n, const int at[3], size_t voxel, ms_mesh *mesh)
{
    double place[3];
    if (place_vertex(place, n, voxel) > 0) {
        for (int a = 0; a < 3; a++) {
            mesh->vertex[mesh->n_vertices][a] = n->grid->origin[a] + n->grid->h * (at[a] + place[a]);
        }
        n->vertex[voxel] = (uint32_t)mesh->n_vertices++;
    }
}

/* Two triangles across each crossed edge, between the four cubes about it. */
static void add_triangles(net *n, const int at[3], size_t voxel, ms_mesh *mesh)
{
    (void)at;
    for (int axis = 0; axis < 3; axis++) {
        if (is_crossed(n, voxel, axis)) {
            const size_t u = n->step[(axis + 1) % 3], v = n->step[(axis + 2) % 3];
            const uint32_t a = n->vertex[voxel - u - v], c = n->vertex[voxel];
            const uint32_t low = n->vertex[voxel - v], high = n->vertex[voxel - u];
            const int outward = is_inside(n, voxel); /* the axis leaves the body */
            const uint32_t b = outward ? low : high, d = outward ? high : low;
            const uint32_t quad[2][3] = {{a, b, c}, {a, c, d}};
            for (int t = 0; t < 2; t++) {
                for (int k = 0; k < 3; k++) {
                    mesh->triangle[mesh->n_triangles][k] = quad[t][k];
                }
                mesh->n_triangles++;
            }
        }
    }
}

static ms_status make_mesh(ms_mesh *mesh, net *n, ms_error *err)
{
    ms_mesh count = {0};
    walk(n, count_parts, &count);
    if (count.n_triangles == 0) {
        return ms_fail(err, MS_ERR_SHAPE, "the voxels are too few or too thin to have a smooth surface");
    }
    if (count.n_vertices > UINT32_MAX) {
        return ms_fail(err, MS_ERR_LIMIT, "a surface of %zu vertices is too large", count.n_vertices);
    }
    const ms_status status = ms_mesh_alloc(mesh, count.n_vertices, count.n_triangles, err);
    if (status == MS_OK) {
        mesh->n_vertices = mesh->n_triangles = 0;
        walk(n, add_vertex, mesh);
        walk(n, add_triangles, mesh);
    }
    return status;
}

ms_status ms_expect_surface(ms_mesh *mesh, const ms_grid *grid, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(grid);
    net n = {grid, calloc(voxels, sizeof *n.part), calloc(voxels, sizeof *n.vertex), {1}};
    ms_status status = MS_OK;
    *mesh = (ms_mesh){0};
    n.step[1] = (size_t)grid->n[0];
    n.step[2] = n.step[1] * (size_t)grid->n[1];
    if (!n.part || !n.vertex) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the surface of %zu voxels", voxels);
    } else {
        for (size_t k = 0; k < voxels; k++) {
            n.part[k] = grid->inside[k] != 0;
        }
        for (int axis = 0; axis < 3; axis++) {
            average_lines(n.part, &n, axis);
        }
        status = make_mesh(mesh, &n, err);
    }
    free(n.part);
    free(n.vertex);
    return status;
}
