#include "ms_mesh_edges.h"

#include <stdlib.h>

/* A side under its edge's vertex of lower number. */
typedef struct half_edge {
    uint32_t other, opposite, side;
} half_edge;

static int compare_entries(const void *a, const void *b)
{
    const half_edge *x = a;
    const half_edge *y = b;
    if (x->other != y->other) {
        return x->other < y->other ? -1 : 1;
    }
    if (x->opposite != y->opposite) {
        return x->opposite < y->opposite ? -1 : 1;
    }
    return (x->side > y->side) - (x->side < y->side);
}

static void sort_few(half_edge *list, size_t n)
{
    for (size_t k = 1; k < n; k++) {
        half_edge moved = list[k];
        size_t at = k;
        for (; at > 0 && compare_entries(&moved, &list[at - 1]) < 0; at--) {
            list[at] = list[at - 1];
        }
        list[at] = moved;
    }
}

/* Counting sort by the lower vertex, then a sort of each vertex's few sides. `first` has
   n_vertices + 1 zeros. */
static void sort_sides(half_edge *list, uint32_t *first, const ms_mesh *mesh)
{
    uint32_t n_sides = (uint32_t)(3 * mesh->n_triangles);
    for (uint32_t side = 0; side < n_sides; side++) {
        uint32_t a = ms_mesh_edges_side_from(mesh, side);
        uint32_t b = ms_side_to(mesh, side);
        first[a < b ? a : b]++;
    }
    uint32_t before = 0;
    for (size_t v = 0; v <= mesh->n_vertices; v++) {
        uint32_t count = first[v];
        first[v] = before;
        before += count;
    }
    for (uint32_t side = 0; side < n_sides; side++) {
        uint32_t a = ms_mesh_edges_side_from(mesh, side);
        uint32_t b = ms_side_to(mesh, side);
        list[first[a < b ? a : b]++] = (half_edge){a < b ? b : a, ms_side_opposite(mesh, side), side};
    }
    /* Each first[v] has moved on to where v + 1 begins. */
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        uint32_t begin = v == 0 ? 0 : first[v - 1];
        uint32_t n = first[v] - begin;
        if (n <= 16) {
            sort_few(list + begin, n);
        } else {
            qsort(list + begin, n, sizeof *list, compare_entries);
        }
    }
}

/* A vertex's list ends where the next one's begins: there the edge changes in any case. */
static void group_edges(ms_edges *edges, const half_edge *list, const ms_mesh *mesh)
{
    uint32_t n_sides = (uint32_t)(3 * mesh->n_triangles);
    uint32_t last_low = 0;
    for (uint32_t k = 0; k < n_sides; k++) {
        uint32_t from = ms_mesh_edges_side_from(mesh, list[k].side);
        uint32_t low = from < list[k].other ? from : ms_side_to(mesh, list[k].side);
        if (k == 0 || low != last_low || list[k].other != list[k - 1].other) {
            edges->start[edges->n++] = k;
        }
        edges->side[k] = list[k].side;
        edges->edge_of[list[k].side] = (uint32_t)(edges->n - 1);
        last_low = low;
    }
    edges->start[edges->n] = n_sides;
}

ms_status ms_edges_build(ms_edges *edges, const ms_mesh *mesh, ms_error *err)
{
    *edges = (ms_edges){0};
    if (mesh->n_triangles > MS_EDGES_MAX_TRIANGLES) {
        return ms_fail(err, MS_ERR_LIMIT, "a mesh of %zu triangles is too large to be checked; the limit is %zu",
                       mesh->n_triangles, (size_t)MS_EDGES_MAX_TRIANGLES);
    }
    size_t n_sides = 3 * mesh->n_triangles;
    half_edge *list = malloc((n_sides + 1) * sizeof *list);
    uint32_t *first = calloc(mesh->n_vertices + 1, sizeof *first);
    edges->start = malloc((n_sides + 1) * sizeof *edges->start);
    edges->side = malloc((n_sides + 1) * sizeof *edges->side);
    edges->edge_of = malloc((n_sides + 1) * sizeof *edges->edge_of);
    ms_status status = MS_OK;
    if (list && first && edges->start && edges->side && edges->edge_of) {
        sort_sides(list, first, mesh);
        group_edges(edges, list, mesh);
    } else {
        ms_mesh_edges_free(edges);
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the edges of %zu triangles", mesh->n_triangles);
    }
    free(list);
    free(first);
    return status;
}

void ms_mesh_edges_free(ms_edges *edges)
{
    free(edges->start);
    free(edges->side);
    free(edges->edge_of);
    *edges = (ms_edges){0};
}
