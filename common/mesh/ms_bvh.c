#include "ms_bvh.h"

#include <math.h>
#include <stdlib.h>

enum {
    LEAF = 4,      /* triangles in a leaf, at most */
    BINS = 16,     /* candidate cuts along an axis */
    BALANCED = 48, /* from this depth on nodes are halved: 48 + 31 levels at most */
};

typedef struct box {
    double lo[3], hi[3];
} box;

static const box no_box = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

static void grow_box(box *b, const double lo[3], const double hi[3])
{
    for (int k = 0; k < 3; k++) {
        b->lo[k] = lo[k] < b->lo[k] ? lo[k] : b->lo[k];
        b->hi[k] = hi[k] > b->hi[k] ? hi[k] : b->hi[k];
    }
}

static double half_area(const box *b)
{
    double x = b->hi[0] - b->lo[0];
    double y = b->hi[1] - b->lo[1];
    double z = b->hi[2] - b->lo[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

/* A triangle while it is being sorted into the tree. */
typedef struct item {
    box bounds;
    double centre[3];
    uint32_t id;
} item;

typedef struct builder {
    item *list;
    ms_bvh_node *node;
    uint32_t n_nodes;
    ms_bvh_effort effort;
} builder;

/* A list that is still to be cut in two, for the boxes of `node`. */
typedef struct task {
    uint32_t node, first, n, depth;
} task;

typedef struct bin {
    box bounds;
    uint32_t n;
} bin;

static int bin_of(double centre, double lo, double extent)
{
    int k = (int)((centre - lo) / extent * BINS);
    return k < 0 ? 0 : k >= BINS ? BINS - 1 : k;
}

/* The cut of least cost: sum over both parts of area times triangles. `cut` is the first bin
   of the upper part. */
static double best_cut(int *cut, const bin bins[BINS])
{
    double upper_cost[BINS];
    box upper = no_box;
    uint32_t n = 0;
    for (int k = BINS - 1; k > 0; k--) {
        grow_box(&upper, bins[k].bounds.lo, bins[k].bounds.hi);
        n += bins[k].n;
        upper_cost[k] = half_area(&upper) * n;
    }
    box lower = no_box;
    n = 0;
    double least = HUGE_VAL;
    for (int k = 1; k < BINS; k++) {
        grow_box(&lower, bins[k - 1].bounds.lo, bins[k - 1].bounds.hi);
        n += bins[k - 1].n;
        double cost = half_area(&lower) * n + upper_cost[k];
        if (cost < least) {
            least = cost;
            *cut = k;
        }
    }
    return least;
}

static void swap_items(item *a, item *b)
{
    item keep = *a;
    *a = *b;
    *b = keep;
}

/* Moves the items of lower bins to the front; returns how many. */
static uint32_t partition_items(item *list, uint32_t n, int axis, int cut, const box *centres)
{
    double extent = centres->hi[axis] - centres->lo[axis];
    uint32_t front = 0;
    for (uint32_t k = 0; k < n; k++) {
        if (bin_of(list[k].centre[axis], centres->lo[axis], extent) < cut) {
            swap_items(&list[front++], &list[k]);
        }
    }
    return front;
}

static int is_longest(const box *b, int axis)
{
    const double extent = b->hi[axis] - b->lo[axis];
    return extent >= b->hi[0] - b->lo[0] && extent >= b->hi[1] - b->lo[1] && extent >= b->hi[2] - b->lo[2];
}

/* Cuts a node's list in two; returns the size of the first part. */
static uint32_t split_items(item *list, uint32_t n, uint32_t depth, ms_bvh_effort effort)
{
    box centres = no_box;
    for (uint32_t k = 0; k < n; k++) {
        grow_box(&centres, list[k].centre, list[k].centre);
    }
    int best_axis = -1;
    int cut = 0;
    double least = HUGE_VAL;
    for (int axis = 0; axis < 3 && depth < BALANCED; axis++) {
        double extent = centres.hi[axis] - centres.lo[axis];
        if (!(extent > 0) || (effort == MS_BVH_FOR_ONE_WALK && !is_longest(&centres, axis))) {
            continue;
        }
        bin bins[BINS];
        for (int k = 0; k < BINS; k++) {
            bins[k] = (bin){no_box, 0};
        }
        for (uint32_t k = 0; k < n; k++) {
            bin *b = &bins[bin_of(list[k].centre[axis], centres.lo[axis], extent)];
            grow_box(&b->bounds, list[k].bounds.lo, list[k].bounds.hi);
            b->n++;
        }
        int at = 0;
        double cost = best_cut(&at, bins);
        if (cost < least) {
            least = cost;
            best_axis = axis;
            cut = at;
        }
    }
    uint32_t front = best_axis < 0 ? 0 : partition_items(list, n, best_axis, cut, &centres);
    return front == 0 || front == n ? n / 2 : front;
}

static void put_box(ms_bvh_node *node, int c, const item *list, uint32_t first, uint32_t n)
{
    box bounds = no_box;
    for (uint32_t k = 0; k < n; k++) {
        grow_box(&bounds, list[first + k].bounds.lo, list[first + k].bounds.hi);
    }
    for (int k = 0; k < 3; k++) {
        node->lo[k][c] = bounds.lo[k];
        node->hi[k][c] = bounds.hi[k];
    }
    node->first[c] = first;
    node->count[c] = n;
}

static void build_nodes(builder *b, uint32_t n)
{
    /* One part waits while the other is cut: never more tasks than levels. */
    task stack[MS_BVH_STACK];
    int waiting = 0;
    stack[waiting++] = (task){0, 0, n, 0};
    b->n_nodes = 1;
    while (waiting > 0) {
        task now = stack[--waiting];
        uint32_t front = now.n > LEAF ? split_items(b->list + now.first, now.n, now.depth, b->effort) : now.n / 2;
        const uint32_t first[2] = {now.first, now.first + front};
        /* A single triangle stands in both boxes: none is ever empty. */
        const uint32_t count[2] = {front > 0 ? front : 1, now.n - front};
        for (int c = 0; c < 2; c++) {
            ms_bvh_node *node = &b->node[now.node];
            put_box(node, c, b->list, first[c], count[c]);
            if (count[c] > LEAF) {
                stack[waiting++] = (task){b->n_nodes, first[c], count[c], now.depth + 1};
                node->first[c] = b->n_nodes++;
                node->count[c] = 0;
            }
        }
    }
}

static void put_item(item *out, const ms_mesh *mesh, uint32_t t, const double centre[3])
{
    out->bounds = no_box;
    out->id = t;
    for (int corner = 0; corner < 3; corner++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = mesh->vertex[mesh->triangle[t][corner]][k] - centre[k];
        }
        grow_box(&out->bounds, p, p);
    }
    for (int k = 0; k < 3; k++) {
        out->centre[k] = (out->bounds.lo[k] + out->bounds.hi[k]) / 2;
    }
}

/* Thinner than this part of its longest edge, a triangle's plane is mostly rounding. */
#define SLIVER 1e-6

static void put_leaf_triangle(ms_bvh_triangle *out, const ms_mesh *mesh, uint32_t t, const double centre[3])
{
    const uint32_t *corner = mesh->triangle[t];
    double normal[3], longest = 0, twice_area = 0;
    out->id = t;
    for (int k = 0; k < 3; k++) {
        out->a[k] = mesh->vertex[corner[0]][k] - centre[k];
        out->ab[k] = mesh->vertex[corner[1]][k] - mesh->vertex[corner[0]][k];
        out->ac[k] = mesh->vertex[corner[2]][k] - mesh->vertex[corner[0]][k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3;
        int j = (k + 2) % 3;
        normal[k] = out->ab[i] * out->ac[j] - out->ab[j] * out->ac[i];
        double bc = out->ac[k] - out->ab[k];
        longest = fmax(longest, fmax(fabs(bc), fmax(fabs(out->ab[k]), fabs(out->ac[k]))));
    }
    twice_area = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    out->sliver = !(twice_area > SLIVER * longest * longest);
    for (int k = 0; k < 3; k++) {
        out->normal[k] = out->sliver ? 0 : normal[k] / twice_area;
    }
}

static void find_frame(ms_bvh *bvh, const ms_mesh *mesh)
{
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    for (int k = 0; k < 3; k++) {
        bvh->centre[k] = lo[k] + (hi[k] - lo[k]) / 2;
        bvh->size = fmax(bvh->size, hi[k] - lo[k]);
    }
}

ms_status ms_bvh_build(ms_bvh *bvh, const ms_mesh *mesh, ms_bvh_effort effort, ms_error *err)
{
    *bvh = (ms_bvh){0};
    if (mesh->n_triangles == 0) {
        return ms_fail(err, MS_ERR_ARG, "a mesh without triangles has no surface");
    }
    if (mesh->n_triangles > UINT32_MAX / 2) {
        return ms_fail(err, MS_ERR_LIMIT, "a mesh of %zu triangles is too large; the limit is 2^31", mesh->n_triangles);
    }
    uint32_t n = (uint32_t)mesh->n_triangles;
    builder b = {.list = malloc(n * sizeof *b.list), .node = malloc(n * sizeof *b.node), .effort = effort};
    bvh->triangle = malloc(n * sizeof *bvh->triangle);
    if (!b.list || !b.node || !bvh->triangle) {
        free(b.list);
        free(b.node);
        ms_bvh_free(bvh);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the boxes of %lu triangles", (unsigned long)n);
    }
    find_frame(bvh, mesh);
    for (uint32_t t = 0; t < n; t++) {
        put_item(&b.list[t], mesh, t, bvh->centre);
    }
    build_nodes(&b, n);
    for (uint32_t k = 0; k < n; k++) {
        put_leaf_triangle(&bvh->triangle[k], mesh, b.list[k].id, bvh->centre);
    }
    free(b.list);
    ms_bvh_node *fitted = realloc(b.node, b.n_nodes * sizeof *fitted);
    bvh->node = fitted ? fitted : b.node;
    bvh->n_nodes = b.n_nodes;
    return MS_OK;
}

void ms_bvh_free(ms_bvh *bvh)
{
    free(bvh->node);
    free(bvh->triangle);
    *bvh = (ms_bvh){0};
}
