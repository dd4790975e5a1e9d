#include "ms_mesh_weld.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pairs beyond so many for each vertex, and so many in any case, are a mistaken tolerance. */
#define MAX_PAIRS_PER_VERTEX 64
#define MAX_PAIRS_IN_ANY_CASE 10000000

/* Cells are wider than the tolerance, so that most vertices have those near them in their own cell. */
#define WIDTH 4
/* How far to look: beyond the tolerance by more than the numbers of cells are rounded. */
#define REACH 1.01

#define NONE UINT32_MAX

/* A vertex of an open edge, and the cell of a lattice in which it lies. */
typedef struct seam_vertex {
    uint32_t vertex; /* of the mesh */
    uint32_t next;   /* in the same slot of the hash table */
    uint32_t leader; /* the first of those that are one with it */
    uint32_t mate;   /* they stand in a ring */
    double cell[3];
} seam_vertex;

typedef struct seam_pair {
    double distance;
    uint32_t a, b; /* a < b */
} seam_pair;

typedef struct seam {
    const ms_mesh *mesh;
    double tolerance;
    const double *origin; /* of the lattice */
    uint32_t n;
    seam_vertex *at; /* by their number in the mesh */
    uint32_t *slot;  /* of the hash table; the first vertex or NONE */
    size_t mask;
    seam_pair *pair;
    size_t n_pairs, room;
    seam_pair *edge; /* edges no longer than the tolerance; sorted by a, b */
    size_t n_edges;
} seam;

/* The largest difference of a coordinate: each is rounded by itself. */
static double distance(const seam *s, uint32_t a, uint32_t b)
{
    const double *p = s->mesh->vertex[s->at[a].vertex], *q = s->mesh->vertex[s->at[b].vertex];
    return fmax(fabs(p[0] - q[0]), fmax(fabs(p[1] - q[1]), fabs(p[2] - q[2])));
}

static size_t hash_cell(const double cell[3])
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        hash = (hash ^ (uint64_t)(int64_t)cell[k]) * UINT64_C(0x9E3779B97F4A7C15);
        hash ^= hash >> 32;
    }
    return (size_t)hash;
}

/* Marks the vertices of open edges in `number`, and counts them. */
static uint32_t mark_open(uint32_t *number, const ms_mesh *mesh, const ms_edges *edges)
{
    uint32_t n = 0;
    memset(number, 0xff, mesh->n_vertices * sizeof *number);
    for (size_t e = 0; e < edges->n; e++) {
        const uint32_t side = edges->side[edges->start[e]];
        const uint32_t end[2] = {ms_mesh_edges_side_from(mesh, side), ms_side_to(mesh, side)};
        for (int k = 0; k < 2 && ms_mesh_edges_is_open(edges, e); k++) {
            n += number[end[k]] == NONE;
            number[end[k]] = 0;
        }
    }
    return n;
}

/* The cell in which a vertex lies, moved by `by` along all axes. */
static void find_cell(double cell[3], const seam *s, uint32_t vertex, double by)
{
    for (int k = 0; k < 3; k++) {
        cell[k] = floor((s->mesh->vertex[vertex][k] - s->origin[k] + by) / (WIDTH * s->tolerance));
    }
}

/* Numbers the marked vertices and finds their cells. */
static void list_vertices(seam *s, uint32_t *number)
{
    for (uint32_t v = 0; v < s->mesh->n_vertices; v++) {
        if (number[v] == NONE) {
            continue;
        }
        const uint32_t i = number[v] = s->n++;
        seam_vertex *at = &s->at[i];
        s->origin = s->origin ? s->origin : s->mesh->vertex[v];
        find_cell(at->cell, s, v, 0);
        at->vertex = v;
        at->leader = at->mate = i;
    }
}

static ms_status add_pair(seam *s, uint32_t a, uint32_t b, ms_error *err)
{
    if (s->n_pairs >= MAX_PAIRS_IN_ANY_CASE && s->n_pairs / MAX_PAIRS_PER_VERTEX >= s->n) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "more than %zu pairs of corners at open edges lie within %g of each other; join them within a "
                       "smaller tolerance",
                       s->n_pairs, s->tolerance);
    }
    if (s->n_pairs == s->room) {
        const size_t room = 2 * s->room + 256;
        seam_pair *more = realloc(s->pair, room * sizeof *more);
        if (!more) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu pairs of corners", room);
        }
        s->pair = more;
        s->room = room;
    }
    s->pair[s->n_pairs++] = (seam_pair){distance(s, a, b), a, b};
    return MS_OK;
}

/* The pairs of a vertex with those that one cell holds so far. */
static ms_status pair_with_cell(seam *s, uint32_t b, const double cell[3], ms_error *err)
{
    ms_status status = MS_OK;
    uint32_t a = s->slot[hash_cell(cell) & s->mask];
    for (; a != NONE && status == MS_OK; a = s->at[a].next) {
        const double *own = s->at[a].cell;
        if (own[0] == cell[0] && own[1] == cell[1] && own[2] == cell[2] && distance(s, a, b) <= s->tolerance) {
            status = add_pair(s, a, b, err);
        }
    }
    return status;
}

/* Those of each vertex with the ones before it, which alone are in the lattice then. */
static ms_status find_pairs(seam *s, ms_error *err)
{
    const double reach = REACH * s->tolerance;
    ms_status status = MS_OK;
    memset(s->slot, 0xff, (s->mask + 1) * sizeof *s->slot);
    for (uint32_t b = 0; b < s->n && status == MS_OK; b++) {
        double lo[3], hi[3], cell[3];
        find_cell(lo, s, s->at[b].vertex, -reach);
        find_cell(hi, s, s->at[b].vertex, reach);
        for (cell[2] = lo[2]; cell[2] <= hi[2]; cell[2]++) {
            for (cell[1] = lo[1]; cell[1] <= hi[1]; cell[1]++) {
                for (cell[0] = lo[0]; cell[0] <= hi[0] && status == MS_OK; cell[0]++) {
                    status = pair_with_cell(s, b, cell, err);
                }
            }
        }
        uint32_t *slot = &s->slot[hash_cell(s->at[b].cell) & s->mask];
        s->at[b].next = *slot;
        *slot = b;
    }
    return status;
}

/* Edges come in the order of their vertices, and so do those that are short. */
static void find_short_edges(seam *s, const uint32_t *number, const ms_edges *edges)
{
    for (size_t e = 0; e < edges->n; e++) {
        const uint32_t side = edges->side[edges->start[e]];
        uint32_t a = number[ms_mesh_edges_side_from(s->mesh, side)], b = number[ms_side_to(s->mesh, side)];
        if (a != NONE && b != NONE && distance(s, a, b) <= s->tolerance) {
            s->edge[s->n_edges++] = (seam_pair){0, a < b ? a : b, a < b ? b : a};
        }
    }
}

static int compare_pairs(const void *x, const void *y)
{
    const seam_pair *p = x, *q = y;
    if (p->distance != q->distance) {
        return p->distance < q->distance ? -1 : 1;
    }
    if (p->a != q->a) {
        return p->a < q->a ? -1 : 1;
    }
    return (p->b > q->b) - (p->b < q->b);
}

static int may_be_one(const seam *s, uint32_t a, uint32_t b)
{
    const seam_pair wanted = {0, a < b ? a : b, a < b ? b : a};
    return distance(s, a, b) <= s->tolerance &&
           (s->n_edges == 0 || !bsearch(&wanted, s->edge, s->n_edges, sizeof wanted, compare_pairs));
}

/* Makes two vertices, and all that are one with either, one, if each of these may be one with each other. */
static void join_pair(seam *s, uint32_t a, uint32_t b)
{
    if (s->at[a].leader == s->at[b].leader) {
        return;
    }
    uint32_t i = a;
    do {
        uint32_t j = b;
        do {
            if (!may_be_one(s, i, j)) {
                return;
            }
            j = s->at[j].mate;
        } while (j != b);
        i = s->at[i].mate;
    } while (i != a);
    const uint32_t one = s->at[a].leader, two = s->at[b].leader, leader = one < two ? one : two;
    const uint32_t swap = s->at[a].mate; /* two rings become one */
    s->at[a].mate = s->at[b].mate;
    s->at[b].mate = swap;
    do {
        s->at[i].leader = leader;
        i = s->at[i].mate;
    } while (i != a);
}

static size_t renumber_corners(ms_mesh *mesh, const seam *s, const uint32_t *number)
{
    size_t joined = 0;
    for (size_t c = 0; c < 3 * mesh->n_triangles; c++) {
        uint32_t *corner = &mesh->triangle[c / 3][c % 3];
        if (number[*corner] != NONE) {
            *corner = s->at[s->at[number[*corner]].leader].vertex;
        }
    }
    for (uint32_t i = 0; i < s->n; i++) {
        joined += s->at[i].leader != i;
    }
    return joined;
}

/* Everything but the memory of `number`, which is one item per vertex of the mesh. */
static ms_status weld_seam(ms_mesh *mesh, size_t *joined, uint32_t *number, seam *s, const ms_edges *edges,
                           ms_error *err)
{
    const uint32_t n = mark_open(number, mesh, edges);
    if (n == 0) {
        return MS_OK;
    }
    s->mask = 63;
    while (s->mask < 2 * (size_t)n) {
        s->mask = 2 * s->mask + 1;
    }
    s->at = malloc(n * sizeof *s->at);
    s->slot = malloc((s->mask + 1) * sizeof *s->slot);
    s->edge = malloc(edges->n * sizeof *s->edge);
    if (!s->at || !s->slot || !s->edge) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to join the corners of %lu open edges", (unsigned long)n);
    }
    list_vertices(s, number);
    find_short_edges(s, number, edges);
    const ms_status status = find_pairs(s, err);
    if (status != MS_OK || s->n_pairs == 0) {
        return status;
    }
    qsort(s->pair, s->n_pairs, sizeof *s->pair, compare_pairs);
    for (size_t p = 0; p < s->n_pairs; p++) {
        join_pair(s, s->pair[p].a, s->pair[p].b);
    }
    *joined = renumber_corners(mesh, s, number);
    return MS_OK;
}

ms_status ms_mesh_weld(ms_mesh *mesh, size_t *joined, const ms_edges *edges, double tolerance, ms_error *err)
{
    seam s = {.mesh = mesh, .tolerance = tolerance};
    uint32_t *number = malloc(mesh->n_vertices * sizeof *number);
    *joined = 0;
    const ms_status status =
        number ? weld_seam(mesh, joined, number, &s, edges, err)
               : ms_fail(err, MS_ERR_NOMEM, "no memory to look for open edges of %zu vertices", mesh->n_vertices);
    free(number);
    free(s.at);
    free(s.slot);
    free(s.pair);
    free(s.edge);
    return status;
}
