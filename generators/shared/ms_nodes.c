#include "ms_nodes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* Ranges of so few points are not split. */
enum { LEAF = 8 };

/* Points first to below end. */
typedef struct node_range {
    size_t first, end;
} node_range;

static size_t middle_of(node_range r)
{
    return r.first + (r.end - r.first) / 2;
}

static uint8_t widest_axis(double (*at)[3], node_range r)
{
    double lo[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t p = r.first; p < r.end; p++) {
        for (int a = 0; a < 3; a++) {
            lo[a] = fmin(lo[a], at[p][a]);
            hi[a] = fmax(hi[a], at[p][a]);
        }
    }
    uint8_t widest = 0;
    for (uint8_t a = 1; a < 3; a++) {
        if (hi[a] - lo[a] > hi[widest] - lo[widest]) {
            widest = a;
        }
    }
    return widest;
}

static void swap_nodes(double a[3], double b[3])
{
    double keep[3];
    memcpy(keep, a, sizeof keep);
    memmove(a, b, sizeof keep); /* a point may be swapped with itself */
    memcpy(b, keep, sizeof keep);
}

/* Puts the middle point of a range in its place: none before it is larger, none behind it smaller
 * (Hoare 1961, as Wirth has it). */
static void select_middle(double (*at)[3], node_range r, int axis)
{
    const ptrdiff_t middle = (ptrdiff_t)middle_of(r);
    ptrdiff_t first = (ptrdiff_t)r.first, last = (ptrdiff_t)r.end - 1;
    while (first < last) {
        const double pivot = at[middle][axis];
        ptrdiff_t up = first, down = last;
        while (up <= down) {
            while (at[up][axis] < pivot) {
                up++;
            }
            while (at[down][axis] > pivot) {
                down--;
            }
            if (up <= down) {
                swap_nodes(at[up++], at[down--]);
            }
        }
        first = down < middle ? up : first;
        last = middle < up ? down : last;
    }
}

static void split_range(ms_nodes *nodes, node_range r)
{
    while (r.end - r.first > LEAF) {
        const size_t middle = middle_of(r);
        nodes->axis[middle] = widest_axis(nodes->at, r);
        select_middle(nodes->at, r, nodes->axis[middle]);
        split_range(nodes, (node_range){r.first, middle});
        r.first = middle + 1;
    }
}

ms_status ms_nodes_build(ms_nodes *nodes, const double (*at)[3], size_t count, ms_error *err)
{
    memset(nodes, 0, sizeof *nodes);
    if (count == 0) {
        return ms_fail(err, MS_ERR_ARG, "there are no nodes to search");
    }
    nodes->at = malloc(count * sizeof *nodes->at);
    nodes->axis = calloc(count, sizeof *nodes->axis);
    if (!nodes->at || !nodes->axis) {
        ms_nodes_free(nodes);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a search tree of %zu nodes", count);
    }
    nodes->count = count;
    memcpy(nodes->at, at, count * sizeof *at);
    split_range(nodes, (node_range){0, count});
    return MS_OK;
}

/* Grids have a layer of background around the shape. */
static int is_border(const ms_grid *grid, size_t voxel)
{
    const size_t row = (size_t)grid->n[0], plane = row * (size_t)grid->n[1];
    const uint8_t *v = grid->inside + voxel;
    return *v && !(v[1] && *(v - 1) && v[row] && *(v - row) && v[plane] && *(v - plane));
}

/* The border voxels; only counts them if there is no room. */
static size_t list_border_nodes(double (*at)[3], const ms_grid *grid)
{
    size_t count = 0, voxel = 0;
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++, voxel++) {
                if (!grid->inside[voxel] || !is_border(grid, voxel)) {
                    continue;
                }
                if (at) {
                    const double place[3] = {i, j, k};
                    memcpy(at[count], place, sizeof place);
                }
                count++;
            }
        }
    }
    return count;
}

ms_status ms_nodes_of_target(ms_nodes *nodes, const ms_target *target, ms_error *err)
{
    const ms_mesh *mesh = target->mesh;
    const size_t count = mesh ? mesh->n_vertices : list_border_nodes(NULL, &target->grid);
    double(*at)[3] = malloc((count + 1) * sizeof *at);
    memset(nodes, 0, sizeof *nodes);
    if (!at) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu nodes", count);
    }
    if (!mesh) {
        list_border_nodes(at, &target->grid);
    }
    for (size_t v = 0; mesh && v < count; v++) {
        ms_grid_at(at[v], &target->grid, mesh->vertex[v]);
    }
    const ms_status status = ms_nodes_build(nodes, (const double(*)[3])at, count, err);
    free(at);
    return status;
}

/* The nearest point so far. */
typedef struct finding {
    const double *place;
    ms_norm norm;
    double away; /* of the Euclidean distance the square */
    size_t index;
} finding;

static void try_node(finding *best, const ms_nodes *nodes, size_t p)
{
    const double *a = nodes->at[p], *b = best->place;
    const double away = best->norm == MS_NORM_EUCLIDEAN ? ms_squared_distance(a, b)
                                                        : fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]);
    if (away < best->away) {
        best->away = away;
        best->index = p;
    }
}

static void search_range(finding *best, const ms_nodes *nodes, node_range r)
{
    while (r.end - r.first > LEAF) {
        const size_t middle = middle_of(r);
        const int axis = nodes->axis[middle];
        const double beyond = best->place[axis] - nodes->at[middle][axis];
        const node_range lower = {r.first, middle}, upper = {middle + 1, r.end};
        try_node(best, nodes, middle);
        search_range(best, nodes, beyond < 0 ? lower : upper);
        if ((best->norm == MS_NORM_EUCLIDEAN ? beyond * beyond : fabs(beyond)) >= best->away) {
            return;
        }
        r = beyond < 0 ? upper : lower;
    }
    for (size_t p = r.first; p < r.end; p++) {
        try_node(best, nodes, p);
    }
}

size_t ms_nodes_nearest(double *distance, const ms_nodes *nodes, const double place[3], ms_norm norm)
{
    finding best = {.place = place, .norm = norm, .away = HUGE_VAL};
    search_range(&best, nodes, (node_range){0, nodes->count});
    *distance = norm == MS_NORM_EUCLIDEAN ? sqrt(best.away) : best.away;
    return best.index;
}

/* A node by the cube that it is in. */
typedef struct cubed_node {
    int32_t cube[3];
    size_t index;
} cubed_node;

static int compare_cubes(const void *a, const void *b)
{
    const cubed_node *x = a, *y = b;
    for (int k = 0; k < 3; k++) {
        if (x->cube[k] != y->cube[k]) {
            return x->cube[k] < y->cube[k] ? -1 : 1;
        }
    }
    return 0;
}

ms_status ms_nodes_group(size_t **group, size_t *n_groups, const ms_nodes *nodes, double edge, ms_error *err)
{
    cubed_node *sorted = malloc(nodes->count * sizeof *sorted);
    *group = malloc(nodes->count * sizeof **group);
    *n_groups = 0;
    if (!sorted || !*group) {
        free(sorted);
        free(*group);
        *group = NULL;
        return ms_fail(err, MS_ERR_NOMEM, "no memory to thin %zu nodes", nodes->count);
    }
    for (size_t p = 0; p < nodes->count; p++) {
        sorted[p].index = p;
        for (int a = 0; a < 3; a++) {
            sorted[p].cube[a] = (int32_t)floor(nodes->at[p][a] / edge);
        }
    }
    qsort(sorted, nodes->count, sizeof *sorted, compare_cubes);
    for (size_t p = 0; p < nodes->count; p++) {
        *n_groups += p == 0 || compare_cubes(&sorted[p - 1], &sorted[p]) != 0;
        (*group)[sorted[p].index] = *n_groups - 1;
    }
    free(sorted);
    return MS_OK;
}

/* Where nodes are visited, and by whom. */
typedef struct visiting {
    const ms_nodes *nodes;
    const double *place;
    double radius;
    ms_nodes_visit visit;
    void *context;
} visiting;

static void visit_node(const visiting *v, size_t p)
{
    if (ms_squared_distance(v->nodes->at[p], v->place) <= v->radius * v->radius) {
        v->visit(v->context, p);
    }
}

static void visit_range(const visiting *v, node_range r)
{
    while (r.end - r.first > LEAF) {
        const size_t middle = middle_of(r);
        const int axis = v->nodes->axis[middle];
        const double beyond = v->place[axis] - v->nodes->at[middle][axis];
        const node_range lower = {r.first, middle}, upper = {middle + 1, r.end};
        visit_node(v, middle);
        if (fabs(beyond) <= v->radius) {
            visit_range(v, lower);
        }
        r = beyond < -v->radius ? lower : upper;
    }
    for (size_t p = r.first; p < r.end; p++) {
        visit_node(v, p);
    }
}

void ms_nodes_visit_within(const ms_nodes *nodes, const double place[3], double radius, ms_nodes_visit visit,
                           void *context)
{
    const visiting v = {nodes, place, radius, visit, context};
    visit_range(&v, (node_range){0, nodes->count});
}

void ms_nodes_free(ms_nodes *nodes)
{
    if (nodes) {
        free(nodes->at);
        free(nodes->axis);
        memset(nodes, 0, sizeof *nodes);
    }
}
