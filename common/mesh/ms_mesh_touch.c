#include "ms_mesh_touch.h"

#include <math.h>

#include "base/ms_vector.h"
#include "ms_bvh.h"

/* Closer than this part of the longest side of the mesh, triangles meet. */
#define MARGIN 1e-9

/* A box of the hierarchy: box c of a node. */
typedef struct box_name {
    uint32_t node;
    int c;
} box_name;

/* Two boxes whose triangles are still to be compared. */
typedef struct box_pair {
    box_name first, second;
} box_pair;

/* A step down replaces a pair by three at most, of which one is next; each of the two boxes has so many steps. */
enum { PAIRS = 2 * 2 * MS_BVH_STACK + 1 };

typedef struct search {
    const ms_mesh *mesh;
    const ms_bvh *bvh;
    double margin;
} search;

/* A triangle, or one of its edges as a triangle of two equal corners. */
typedef struct corners {
    double p[3][3];
} corners;

static int separates(const double axis[3], const corners *a, const corners *b, double margin)
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 3; k++) {
        const double at[2] = {ms_dot(axis, a->p[k]), ms_dot(axis, b->p[k])};
        for (int m = 0; m < 2; m++) {
            lo[m] = at[m] < lo[m] ? at[m] : lo[m];
            hi[m] = at[m] > hi[m] ? at[m] : hi[m];
        }
    }
    const double gap = fmax(lo[1] - hi[0], lo[0] - hi[1]);
    return gap > 0 && gap * gap > margin * margin * ms_dot(axis, axis);
}

static void find_edges(double edge[3][3], const corners *t)
{
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++) {
            edge[k][a] = t->p[(k + 1) % 3][a] - t->p[k][a];
        }
    }
}

/* Disjoint convex figures are separated along the normal of one of them, across an edge in a
 * plane of theirs, or along the common perpendicular of two edges. */
static int meet(const corners *a, const corners *b, double margin)
{
    double edge[2][3][3], normal[2][3], axis[3];
    find_edges(edge[0], a);
    find_edges(edge[1], b);
    for (int m = 0; m < 2; m++) {
        ms_cross(normal[m], edge[m][0], edge[m][1]);
        if (separates(normal[m], a, b, margin)) {
            return 0;
        }
    }
    for (int m = 0; m < 12; m++) { /* in both planes, for an edge has none */
        ms_cross(axis, normal[m / 6], edge[m / 3 % 2][m % 3]);
        if (separates(axis, a, b, margin)) {
            return 0;
        }
    }
    for (int m = 0; m < 9; m++) {
        ms_cross(axis, edge[0][m / 3], edge[1][m % 3]);
        if (separates(axis, a, b, margin)) {
            return 0;
        }
    }
    return 1;
}

/* The edge across from a corner. */
static corners opposite_edge(const corners *t, int corner)
{
    corners edge = *t;
    for (int a = 0; a < 3; a++) {
        edge.p[corner][a] = edge.p[(corner + 1) % 3][a];
    }
    return edge;
}

static corners corners_of(const ms_bvh_triangle *t)
{
    corners c;
    for (int a = 0; a < 3; a++) {
        c.p[0][a] = t->a[a];
        c.p[1][a] = t->a[a] + t->ab[a];
        c.p[2][a] = t->a[a] + t->ac[a];
    }
    return c;
}

/* The vertices that two triangles have in common: how many, and where the last stands in both. */
static int count_common(int *of_a, int *of_b, const uint32_t a[3], const uint32_t b[3])
{
    int common = 0;
    for (int m = 0; m < 9; m++) {
        if (a[m / 3] == b[m % 3]) {
            common++;
            *of_a = m / 3;
            *of_b = m % 3;
        }
    }
    return common;
}

/* Does a triangle but for one corner lie on one side of a plane through that corner? */
static int stands_off(const corners *t, int corner, const double normal[3], double margin)
{
    double height[2];
    for (int m = 0; m < 2; m++) {
        double from_corner[3];
        for (int a = 0; a < 3; a++) {
            from_corner[a] = t->p[(corner + 1 + m) % 3][a] - t->p[corner][a];
        }
        height[m] = ms_dot(from_corner, normal);
    }
    const double least = fmin(fabs(height[0]), fabs(height[1]));
    return height[0] * height[1] > 0 && least * least > margin * margin * ms_dot(normal, normal);
}

/* What else triangles with a common vertex share reaches from there to the edge across from it of one of them. */
static int meet_beyond(const search *s, const ms_bvh_triangle *t, int of_t, const ms_bvh_triangle *u, int of_u)
{
    double normal[3];
    const corners first = corners_of(t), second = corners_of(u);
    ms_cross(normal, u->ab, u->ac);
    if (stands_off(&first, of_t, normal, s->margin)) {
        return 0;
    }
    ms_cross(normal, t->ab, t->ac);
    if (stands_off(&second, of_u, normal, s->margin)) {
        return 0;
    }
    const corners edge = opposite_edge(&first, of_t), other = opposite_edge(&second, of_u);
    return meet(&edge, &second, s->margin) || meet(&first, &other, s->margin);
}

static int triangles_meet(const search *s, const ms_bvh_triangle *t, const ms_bvh_triangle *u)
{
    int of_t = 0, of_u = 0;
    const int common = count_common(&of_t, &of_u, s->mesh->triangle[t->id], s->mesh->triangle[u->id]);
    if (common == 1) {
        return meet_beyond(s, t, of_t, u, of_u);
    }
    const corners first = corners_of(t), second = corners_of(u);
    return common == 0 && meet(&first, &second, s->margin);
}

static int boxes_meet(const search *s, const box_pair *pair)
{
    const ms_bvh_node *a = &s->bvh->node[pair->first.node], *b = &s->bvh->node[pair->second.node];
    const int c = pair->first.c, d = pair->second.c;
    int apart = 0;
    for (int k = 0; k < 3; k++) {
        apart |= a->lo[k][c] - b->hi[k][d] > s->margin || b->lo[k][d] - a->hi[k][c] > s->margin;
    }
    return !apart;
}

/* All triangles of two leaves, or of one among themselves. */
static int leaves_meet(const search *s, const ms_bvh_node *a, int c, const ms_bvh_node *b, int d)
{
    const ms_bvh_triangle *triangle = s->bvh->triangle;
    const int same = a == b && c == d;
    for (uint32_t i = 0; i < a->count[c]; i++) {
        for (uint32_t j = same ? i + 1 : 0; j < b->count[d]; j++) {
            if (triangles_meet(s, &triangle[a->first[c] + i], &triangle[b->first[d] + j])) {
                return 1;
            }
        }
    }
    return 0;
}

static double box_size(const ms_bvh_node *node, int c)
{
    return fmax(node->hi[0][c] - node->lo[0][c],
                fmax(node->hi[1][c] - node->lo[1][c], node->hi[2][c] - node->lo[2][c]));
}

/* Puts the parts of a pair of which one at least is no leaf; returns how many. */
static int split_pair(box_pair parts[3], const search *s, const box_pair *pair)
{
    const ms_bvh_node *a = &s->bvh->node[pair->first.node], *b = &s->bvh->node[pair->second.node];
    const int c = pair->first.c, d = pair->second.c;
    if (a == b && c == d) {
        for (int m = 0; m < 3; m++) {
            parts[m] = (box_pair){{a->first[c], m / 2}, {a->first[c], (m + 1) / 2}};
        }
        return 3;
    }
    const int split_first = a->count[c] == 0 && (b->count[d] > 0 || box_size(a, c) >= box_size(b, d));
    for (int m = 0; m < 2; m++) {
        parts[m] = split_first ? (box_pair){{a->first[c], m}, pair->second} : (box_pair){pair->first, {b->first[d], m}};
    }
    return 2;
}

static int find_meeting(const search *s)
{
    box_pair stack[PAIRS];
    int waiting = 0;
    for (int m = 0; m < 3; m++) {
        stack[waiting++] = (box_pair){{0, m / 2}, {0, (m + 1) / 2}};
    }
    while (waiting > 0) {
        const box_pair pair = stack[--waiting];
        const ms_bvh_node *a = &s->bvh->node[pair.first.node], *b = &s->bvh->node[pair.second.node];
        if (!boxes_meet(s, &pair)) {
            continue;
        }
        if (a->count[pair.first.c] == 0 || b->count[pair.second.c] == 0) {
            waiting += split_pair(stack + waiting, s, &pair);
        } else if (leaves_meet(s, a, pair.first.c, b, pair.second.c)) {
            return 1;
        }
    }
    return 0;
}

ms_status ms_mesh_touch(int *touches, const ms_mesh *mesh, ms_error *err)
{
    ms_bvh bvh;
    *touches = 0;
    ms_status status = ms_bvh_build(&bvh, mesh, MS_BVH_FOR_ONE_WALK, err);
    if (status == MS_OK) {
        const search s = {.mesh = mesh, .bvh = &bvh, .margin = MARGIN * bvh.size};
        *touches = find_meeting(&s);
    }
    ms_bvh_free(&bvh);
    return status;
}
