#include "ms_mesh_decimate.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_inertia.h"

/* A vertex and its cell. */
typedef struct member {
    uint64_t cell;
    uint32_t vertex;
} member;

/* By cell, then by number, so that the order is one on every machine. */
static int compare_cell_members(const void *a, const void *b)
{
    const member *first = a, *second = b;
    if (first->cell != second->cell) {
        return first->cell < second->cell ? -1 : 1;
    }
    return (first->vertex > second->vertex) - (first->vertex < second->vertex);
}

static void sort_members(member *members, const ms_mesh *mesh, double cell)
{
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        members[v] = (member){0, (uint32_t)v};
        for (int k = 0; k < 3; k++) {
            const double at = floor((mesh->vertex[v][k] - lo[k]) / cell);
            members[v].cell = members[v].cell << 21 | (uint64_t)fmin(at, (1 << 21) - 1);
        }
    }
    qsort(members, mesh->n_vertices, sizeof *members, compare_cell_members);
}

/* The vertex of a cell nearest to the mean of its own. */
static uint32_t find_middle(const ms_mesh *mesh, const member *members, size_t count)
{
    double mean[3] = {0}, least = HUGE_VAL;
    uint32_t middle = members[0].vertex;
    for (size_t m = 0; m < count; m++) {
        for (int k = 0; k < 3; k++) {
            mean[k] += mesh->vertex[members[m].vertex][k] / (double)count;
        }
    }
    for (size_t m = 0; m < count; m++) {
        const double square = ms_squared_distance(mesh->vertex[members[m].vertex], mean);
        if (square < least) {
            least = square;
            middle = members[m].vertex;
        }
    }
    return middle;
}

/* The vertices left and the number that each of the mesh has among them. @return how many are left */
static size_t join_vertices(double (*vertex)[3], uint32_t *number, const ms_mesh *mesh, const member *members)
{
    size_t left = 0;
    for (size_t from = 0, to; from < mesh->n_vertices; from = to) {
        for (to = from; to < mesh->n_vertices && members[to].cell == members[from].cell; to++) {
            number[members[to].vertex] = (uint32_t)left;
        }
        memcpy(vertex[left++], mesh->vertex[find_middle(mesh, members + from, to - from)], sizeof *vertex);
    }
    return left;
}

/* Triangles whose corners are still three. */
static size_t keep_triangles(uint32_t (*triangle)[3], const uint32_t *number, const ms_mesh *mesh)
{
    size_t left = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *corner = mesh->triangle[t];
        const uint32_t a = number[corner[0]], b = number[corner[1]], c = number[corner[2]];
        if (a != b && b != c && c != a) {
            memcpy(triangle[left++], (uint32_t[3]){a, b, c}, sizeof *triangle);
        }
    }
    return left;
}

ms_status ms_mesh_decimate(ms_mesh *out, const ms_mesh *mesh, size_t most_triangles, ms_error *err)
{
    member *members = malloc(mesh->n_vertices * sizeof *members);
    uint32_t *number = malloc(mesh->n_vertices * sizeof *number);
    ms_status status = members && number ? ms_mesh_alloc(out, mesh->n_vertices, mesh->n_triangles, err)
                                         : ms_fail(err, MS_ERR_NOMEM, "no memory for fewer triangles");
    if (status == MS_OK) {
        /* a plane of squares has two triangles in each */
        double cell = sqrt(2 * ms_mesh_area(mesh) / (double)most_triangles);
        do {
            sort_members(members, mesh, cell);
            out->n_vertices = join_vertices(out->vertex, number, mesh, members);
            out->n_triangles = keep_triangles(out->triangle, number, mesh);
            cell *= 1.15;
        } while (out->n_triangles > most_triangles);
    } else {
        *out = (ms_mesh){0};
    }
    free(members);
    free(number);
    return status;
}
