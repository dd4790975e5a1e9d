#include "ms_signed_distance.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

#include "mesh/ms_closest.h"
#include "ms_distance.h"

/* Of bounds: more than the rounding of the single precision that nodes are kept in. */
static const double SLACK = 1 + 1e-5;

/* The nodes of one step. */
typedef struct nodes {
    int step;
    float *phi;
    struct nodes *next;
} nodes;

struct ms_signed_distance_store {
    pthread_mutex_t lock; /* of the list; its nodes are each on their own */
    nodes *first;
};

ms_status ms_signed_distance_store_alloc(ms_signed_distance_store **out, ms_error *err)
{
    *out = calloc(1, sizeof **out);
    if (*out && pthread_mutex_init(&(*out)->lock, NULL) != 0) {
        free(*out);
        *out = NULL;
    }
    return *out ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the signed distances of a target");
}

void ms_signed_distance_store_free(ms_signed_distance_store *store)
{
    while (store && store->first) {
        nodes *gone = store->first;
        store->first = gone->next;
        free(gone->phi);
        free(gone);
    }
    if (store) {
        pthread_mutex_destroy(&store->lock);
    }
    free(store);
}

int ms_signed_distance_is_exact(const ms_signed_distance *field)
{
    return field->target->mesh && field->target->closed;
}

static size_t node_index(const ms_signed_distance *field, int i, int j, int k)
{
    return (size_t)i + (size_t)field->n[0] * ((size_t)j + (size_t)field->n[1] * (size_t)k);
}

/* The surface lies half-way between the centres of voxels inside and outside. */
static ms_status fill_from_voxels(ms_signed_distance *field, ms_error *err)
{
    const ms_grid *grid = &field->target->grid;
    const size_t voxels = ms_grid_voxels(grid);
    uint8_t *outside = malloc(voxels);
    float *away = malloc(voxels * sizeof *away);
    ms_status status = MS_OK;
    if (!outside || !away) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the distances of %zu voxels; use fewer cells", voxels);
    }
    for (size_t v = 0; status == MS_OK && v < voxels; v++) {
        outside[v] = !grid->inside[v];
    }
    if (status == MS_OK) {
        status = ms_distance(away, outside, grid->n, err);
    }
    for (int k = 0; status == MS_OK && k < field->n[2]; k++) {
        for (int j = 0; j < field->n[1]; j++) {
            for (int i = 0; i < field->n[0]; i++) {
                const int s = field->step;
                const size_t v = ms_grid_index(grid, i * s < grid->n[0] ? i * s : grid->n[0] - 1,
                                               j * s < grid->n[1] ? j * s : grid->n[1] - 1,
                                               k * s < grid->n[2] ? k * s : grid->n[2] - 1);
                field->phi[node_index(field, i, j, k)] =
                    outside[v] ? away[v] - 0.5f : 0.5f - field->target->distance[v];
            }
        }
    }
    free(outside);
    free(away);
    return status;
}

/* The nodes of the field's step, as yet unknown or from the voxels; NULL on failure. */
static nodes *make_nodes(ms_signed_distance *field, ms_error *err)
{
    const size_t count = (size_t)field->n[0] * (size_t)field->n[1] * (size_t)field->n[2];
    nodes *made = malloc(sizeof *made);
    field->phi = malloc(count * sizeof *field->phi);
    ms_status status = MS_OK;
    if (!made || !field->phi) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for signed distances at %zu nodes; use fewer cells", count);
    } else if (ms_signed_distance_is_exact(field)) {
        for (size_t v = 0; v < count; v++) {
            field->phi[v] = NAN;
        }
    } else {
        status = fill_from_voxels(field, err);
    }
    if (status != MS_OK) {
        free(field->phi);
        free(made);
        return NULL;
    }
    *made = (nodes){.step = field->step, .phi = field->phi};
    return made;
}

ms_status ms_signed_distance_open(ms_signed_distance *field, const ms_target *target, int step, ms_error *err)
{
    ms_signed_distance_store *store = target->signed_distance;
    *field = (ms_signed_distance){.target = target, .step = step};
    for (int a = 0; a < 3; a++) {
        field->n[a] = (target->grid.n[a] + step - 2) / step + 1;
    }
    pthread_mutex_lock(&store->lock);
    nodes *found = store->first;
    while (found && found->step != step) {
        found = found->next;
    }
    if (!found && (found = make_nodes(field, err)) != NULL) {
        found->next = store->first;
        store->first = found;
    }
    pthread_mutex_unlock(&store->lock);
    if (!found) {
        *field = (ms_signed_distance){0};
        return MS_ERR_NOMEM;
    }
    field->phi = found->phi;
    return MS_OK;
}

/* NAN: not known yet. */
static inline double read_node(const ms_signed_distance *field, size_t node)
{
    float phi;
#pragma omp atomic read
    phi = field->phi[node];
    return (double)phi;
}

/* What the distance at a node cannot exceed by those that are known next to it, in voxels: from one to the next it
 * changes by no more than the way. */
static double find_bound(const ms_signed_distance *field, const int on[3], size_t node)
{
    double least = HUGE_VAL;
    size_t stride = 1;
    for (int a = 0; a < 3; a++) {
        if (on[a] > 0) {
            least = fmin(least, fabs(read_node(field, node - stride))); /* NAN counts for nothing */
        }
        if (on[a] < field->n[a] - 1) {
            least = fmin(least, fabs(read_node(field, node + stride)));
        }
        stride *= (size_t)field->n[a];
    }
    return (least + field->step) * SLACK;
}

/* Farther from the surface than half a voxel's diagonal, all of the voxel about a node is on one side. */
static float compute_node(const ms_signed_distance *field, size_t node)
{
    const ms_grid *grid = &field->target->grid;
    const ms_closest *closest = field->target->closest;
    int on[3];
    ms_grid_voxel(on, field->n, node);
    const int i = on[0] * field->step, j = on[1] * field->step, k = on[2] * field->step;
    const double at[3] = {i, j, k};
    double place[3];
    ms_grid_place(place, grid, at);
    const double distance = ms_closest_distance(NULL, closest, place, find_bound(field, on, node) * grid->h);
    const double away = distance / grid->h;
    if (away > 0.9 && i < grid->n[0] && j < grid->n[1] && k < grid->n[2]) {
        return (float)(grid->inside[ms_grid_index(grid, i, j, k)] ? -away : away);
    }
    return (float)(ms_closest_side(NULL, closest, place, distance) / grid->h);
}

/* Two threads may compute a node at once: they find the same. */
static double node_value(const ms_signed_distance *field, size_t node)
{
    float phi = (float)read_node(field, node);
    if (phi != phi) {
        phi = compute_node(field, node);
#pragma omp atomic write
        field->phi[node] = phi;
    }
    return (double)phi;
}

/* The nodes about a place: the cell's corners are the second and the third of four along each axis. */
typedef struct stencil {
    size_t index[3][4]; /* those beyond the border are those on it */
    double part[3];     /* of the way from the second to the third */
} stencil;

/* Of corner c, bit a of which is its side along axis a; and of the node beyond it along an axis. */
static inline size_t find_corner(const stencil *s, int c)
{
    return s->index[0][1 + (c & 1)] + s->index[1][1 + (c >> 1 & 1)] + s->index[2][1 + (c >> 2)];
}

static inline size_t find_outer(const stencil *s, int c, int axis)
{
    const int side = c >> axis & 1;
    return find_corner(s, c) - s->index[axis][1 + side] + s->index[axis][3 * side];
}

static double interpolate_cell(const double corner[8], const double part[3])
{
    double along[4];
    for (int k = 0; k < 4; k++) { /* the edges along x */
        along[k] = corner[2 * k] + part[0] * (corner[2 * k + 1] - corner[2 * k]);
    }
    const double front = along[0] + part[1] * (along[1] - along[0]), back = along[2] + part[1] * (along[3] - along[2]);
    return front + part[2] * (back - front);
}

/* Along a line the cubic of Catmull and Rom is the linear look-up less t (1 - t) / 2 times that of the second
 * differences; here such a term for each axis. Exact for parabolas. */
static double look_up(const ms_signed_distance *field, const stencil *s)
{
    double corner[8], bent[8];
    for (int c = 0; c < 8; c++) {
        corner[c] = bent[c] = read_node(field, find_corner(s, c));
    }
    for (int a = 0; a < 3 && field->cubic; a++) {
        const double bend = s->part[a] * (1 - s->part[a]) / 2;
        for (int c = 0; c < 8; c++) {
            bent[c] -= bend * (read_node(field, find_outer(s, c, a)) - 2 * corner[c] + corner[c ^ 1 << a]);
        }
    }
    return interpolate_cell(bent, s->part);
}

static void need_nodes(const ms_signed_distance *field, const stencil *s)
{
    for (int c = 0; c < 8; c++) {
        node_value(field, find_corner(s, c));
        for (int a = 0; a < 3 && field->cubic; a++) {
            node_value(field, find_outer(s, c, a));
        }
    }
}

double ms_signed_distance_at(const ms_signed_distance *field, const double place[3])
{
    stencil s;
    double beyond = 0;
    size_t stride = 1;
    for (int a = 0; a < 3; a++) {
        const double x = place[a] / field->step, last = field->n[a] - 1;
        const double inside = x < 0 ? 0 : x > last ? last : x;
        const int at = (int)(inside < last - 1 ? inside : last - 1);
        s.part[a] = inside - at;
        for (int i = 0; i < 4; i++) {
            const int node = at + i - 1;
            s.index[a][i] = stride * (size_t)(node < 0 ? 0 : node < field->n[a] ? node : field->n[a] - 1);
        }
        stride *= (size_t)field->n[a];
        beyond += (x - inside) * (x - inside);
    }
    double phi = look_up(field, &s);
    if (phi != phi) { /* some node is not known yet */
        need_nodes(field, &s);
        phi = look_up(field, &s);
    }
    return beyond > 0 ? phi + sqrt(beyond) * field->step : phi;
}
