#include "ms_mesh.h"

#include <stdlib.h>

ms_status ms_mesh_alloc(ms_mesh *mesh, size_t n_vertices, size_t n_triangles, ms_error *err)
{
    *mesh = (ms_mesh){0};
    if (n_vertices == 0 || n_triangles == 0) {
        return ms_fail(err, MS_ERR_ARG, "a mesh needs vertices and triangles, not %zu and %zu", n_vertices,
                       n_triangles);
    }
    if (n_vertices <= SIZE_MAX / sizeof *mesh->vertex && n_triangles <= SIZE_MAX / sizeof *mesh->triangle) {
        mesh->vertex = malloc(n_vertices * sizeof *mesh->vertex);
        mesh->triangle = malloc(n_triangles * sizeof *mesh->triangle);
    }
    if (!mesh->vertex || !mesh->triangle) {
        ms_mesh_free(mesh);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a mesh of %zu triangles; use a coarser one", n_triangles);
    }
    mesh->n_vertices = n_vertices;
    mesh->n_triangles = n_triangles;
    return MS_OK;
}

void ms_mesh_box(double lo[3], double hi[3], const ms_mesh *mesh)
{
    for (int axis = 0; axis < 3; axis++) {
        lo[axis] = hi[axis] = mesh->vertex[0][axis];
    }
    for (size_t v = 1; v < mesh->n_vertices; v++) {
        for (int axis = 0; axis < 3; axis++) {
            double x = mesh->vertex[v][axis];
            lo[axis] = x < lo[axis] ? x : lo[axis];
            hi[axis] = x > hi[axis] ? x : hi[axis];
        }
    }
}

void ms_mesh_free(ms_mesh *mesh)
{
    if (!mesh) {
        return;
    }
    free(mesh->vertex);
    free(mesh->triangle);
    *mesh = (ms_mesh){0};
}
