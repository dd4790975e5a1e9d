#include "ms_mesh_holes.h"

#include <stdlib.h>
#include <string.h>

#include "ms_mesh_polygon.h"

/* An open edge, once from each of its ends. */
typedef struct rim {
    uint32_t side;  /* of the triangle at it; of several, one */
    uint32_t twin;  /* the same edge from its other end */
    uint32_t other; /* that end */
    uint32_t gone;  /* it was walked along */
} rim;

/* The walk along open edges; what it has passed since it last closed a ring is its path. */
typedef struct rim_walk {
    ms_mesh *mesh;
    ms_mesh_report *report;
    size_t max_edges;
    uint32_t *first; /* of each vertex in `rim`; one more at the end */
    rim *rim;
    uint32_t *place; /* of each vertex in the path, from 1; 0: not there */
    uint32_t *path;
    uint32_t n_path;
    ms_polygon_work work;
} rim_walk;

static size_t count_open(uint32_t *first, const ms_mesh *mesh, const ms_edges *edges)
{
    size_t n = 0;
    for (size_t e = 0; e < edges->n; e++) {
        const uint32_t side = edges->side[edges->start[e]];
        if (ms_mesh_edges_is_open(edges, e)) {
            first[ms_mesh_edges_side_from(mesh, side) + 1]++;
            first[ms_side_to(mesh, side) + 1]++;
            n++;
        }
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        first[v + 1] += first[v];
    }
    return n;
}

/* Lists the open edges at their vertices; `place` counts how many each vertex has already. */
static void list_open(rim_walk *w, const ms_edges *edges)
{
    for (size_t e = 0; e < edges->n; e++) {
        const uint32_t side = edges->side[edges->start[e]];
        if (ms_mesh_edges_is_open(edges, e)) {
            const uint32_t from = ms_mesh_edges_side_from(w->mesh, side), to = ms_side_to(w->mesh, side);
            const uint32_t a = w->first[from] + w->place[from]++, b = w->first[to] + w->place[to]++;
            w->rim[a] = (rim){.side = side, .twin = b, .other = to};
            w->rim[b] = (rim){.side = side, .twin = a, .other = from};
        }
    }
    memset(w->place, 0, w->mesh->n_vertices * sizeof *w->place);
}

/* The path from `begin` on is a ring: fills it, if it is small, and takes it off the path but for its first vertex. */
static ms_status close_ring(rim_walk *w, uint32_t begin, ms_error *err)
{
    ms_mesh *mesh = w->mesh;
    ms_status status = MS_OK;
    const uint32_t *corner = w->path + begin;
    const uint32_t n = w->n_path - begin;
    if (n <= w->max_edges) {
        uint32_t(*fan)[3] = mesh->triangle + mesh->n_triangles;
        for (uint32_t k = 0; k + 2 < n; k++) {
            fan[k][0] = corner[0];
            fan[k][1] = corner[k + 1];
            fan[k][2] = corner[k + 2];
        }
        mesh->n_triangles += n - 2;
        w->report->filled++;
        status = ms_mesh_polygon_cut(fan, n - 2, (const double(*)[3])mesh->vertex, &w->work, err);
    } else {
        w->report->holes++;
        w->report->largest_hole = n > w->report->largest_hole ? n : w->report->largest_hole;
    }
    for (uint32_t k = 1; k < n; k++) {
        w->place[corner[k]] = 0;
    }
    w->n_path = begin + 1;
    return status;
}

/* An edge that goes on from here: if there is one, against the way in which its triangle runs. NULL if none is left. */
static rim *choose_rim(const rim_walk *w, uint32_t v)
{
    rim *found = NULL;
    for (uint32_t k = w->first[v]; k < w->first[v + 1]; k++) {
        rim *r = &w->rim[k];
        if (!r->gone && (!found || ms_side_to(w->mesh, r->side) == v)) {
            found = r;
        }
    }
    return found;
}

/* Walks from a vertex until it is back there and no edge is left at it. */
static ms_status walk_from(rim_walk *w, uint32_t v, ms_error *err)
{
    ms_status status = MS_OK;
    rim *r;
    w->path[0] = v;
    w->place[v] = w->n_path = 1;
    while (status == MS_OK && (r = choose_rim(w, v))) {
        r->gone = w->rim[r->twin].gone = 1;
        v = r->other;
        if (w->place[v]) {
            status = close_ring(w, w->place[v] - 1, err);
        } else {
            w->path[w->n_path++] = v;
            w->place[v] = w->n_path;
        }
    }
    w->place[v] = 0;
    return status;
}

static ms_status walk_all_rims(rim_walk *w, const ms_edges *edges, ms_error *err)
{
    const size_t vertices = w->mesh->n_vertices;
    ms_status status = MS_OK;
    if (edges->n > UINT32_MAX / 2) {
        return ms_fail(err, MS_ERR_LIMIT, "%zu edges are too many for a mesh with holes; make it coarser", edges->n);
    }
    w->first = calloc(vertices + 1, sizeof *w->first);
    w->place = calloc(vertices, sizeof *w->place);
    const size_t n = w->first ? count_open(w->first, w->mesh, edges) : 0;
    w->rim = malloc((2 * n + 1) * sizeof *w->rim);
    w->path = malloc((n + 1) * sizeof *w->path);
    void *triangle = realloc(w->mesh->triangle, (w->mesh->n_triangles + n) * sizeof *w->mesh->triangle);
    w->mesh->triangle = triangle ? triangle : w->mesh->triangle;
    if (!w->first || !w->place || !w->rim || !w->path || !triangle) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to follow %zu open edges", n);
    }
    list_open(w, edges);
    for (uint32_t v = 0; v < vertices && status == MS_OK; v++) {
        if (choose_rim(w, v)) {
            status = walk_from(w, v, err);
        }
    }
    return status;
}

ms_status ms_mesh_holes(ms_mesh *mesh, ms_mesh_report *report, const ms_edges *edges, size_t max_edges, ms_error *err)
{
    rim_walk w = {.mesh = mesh, .report = report, .max_edges = max_edges};
    report->holes = report->largest_hole = 0;
    const ms_status status = walk_all_rims(&w, edges, err);
    ms_mesh_polygon_free(&w.work);
    free(w.first);
    free(w.rim);
    free(w.place);
    free(w.path);
    return status;
}
