#include "ms_feret.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_mesh_edges.h"

/* The sphere of directions is in cells of a cube, this many along each side; arcs are cut into pieces of their size. */
enum { CELLS = 40, ALL_CELLS = CELLS * CELLS * CELLS };
static const double CELL = 2.0 / CELLS;

/* A piece of the arc of directions that look at an edge: those between the normals of its two faces. */
typedef struct arc {
    double middle[3], half; /* half its angle */
    uint32_t from, to;      /* the vertices of the edge */
} arc;

/* A hull on its way to its width. */
typedef struct calipers {
    const ms_mesh *hull;
    ms_edges edges;
    uint32_t *start, *next; /* of each vertex the vertices that share an edge with it: next[start[v]] ... */
    double (*normal)[3];    /* of each triangle, of length 1 */
    arc *arcs;
    size_t n_arcs, capacity;
    uint32_t *cell; /* of each cell the first of its arcs, which are in the order of the cells; one more */
    uint32_t high, low;
    double width, direction[3]; /* the least so far */
} calipers;

/* The vertex that lies farthest along a direction, from another one: on a convex body every way up leads there. */
static uint32_t climb(const calipers *c, uint32_t at, const double direction[3], double sign)
{
    double best = sign * ms_dot(c->hull->vertex[at], direction);
    for (int higher = 1; higher;) {
        higher = 0;
        const uint32_t from = at;
        for (uint32_t e = c->start[from]; e < c->start[from + 1]; e++) {
            const double value = sign * ms_dot(c->hull->vertex[c->next[e]], direction);
            if (value > best) {
                best = value;
                at = c->next[e];
                higher = 1;
            }
        }
    }
    return at;
}

static void try_direction(calipers *c, const double direction[3])
{
    c->high = climb(c, c->high, direction, 1);
    c->low = climb(c, c->low, direction, -1);
    const double width = ms_dot(c->hull->vertex[c->high], direction) - ms_dot(c->hull->vertex[c->low], direction);
    if (width < c->width) {
        c->width = width;
        memcpy(c->direction, direction, sizeof c->direction);
    }
}

/* @return 0 for a triangle without area */
static int find_facet_normal(double normal[3], const ms_mesh *mesh, size_t triangle)
{
    const uint32_t *t = mesh->triangle[triangle];
    const double *a = mesh->vertex[t[0]], *b = mesh->vertex[t[1]], *c = mesh->vertex[t[2]];
    ms_vector_triangle(normal, a, b, c);
    const double length = sqrt(ms_dot(normal, normal));
    if (!(length > 1e-12 * fmax(ms_squared_distance(a, b), ms_squared_distance(a, c)))) {
        memset(normal, 0, 3 * sizeof *normal);
        return 0;
    }
    for (int k = 0; k < 3; k++) {
        normal[k] /= length;
    }
    return 1;
}

/* Across which of its sides the neighbour of a triangle without area lies whose face it is part of: the longest. */
static uint32_t find_outer_side(const ms_mesh *mesh, size_t triangle)
{
    uint32_t longest = (uint32_t)(3 * triangle);
    double most = -1;
    for (uint32_t s = (uint32_t)(3 * triangle); s < 3 * triangle + 3; s++) {
        const double length =
            ms_squared_distance(mesh->vertex[ms_mesh_edges_side_from(mesh, s)], mesh->vertex[ms_side_to(mesh, s)]);
        if (length > most) {
            most = length;
            longest = s;
        }
    }
    return longest;
}

/* The other side of an edge of two triangles; the same where it has others. */
static uint32_t across(const ms_edges *edges, uint32_t side)
{
    const uint32_t e = edges->edge_of[side], first = edges->start[e];
    return edges->start[e + 1] - first != 2 ? side
           : edges->side[first] == side     ? edges->side[first + 1]
                                            : edges->side[first];
}

/* A triangle without area, which qhull leaves where corners of a face lie on a line, takes the normal of its face. */
static ms_status find_normals(calipers *c, ms_error *err)
{
    const ms_mesh *hull = c->hull;
    size_t flat = 0, before = 0;
    for (size_t t = 0; t < hull->n_triangles; t++) {
        flat += !find_facet_normal(c->normal[t], hull, t);
    }
    if (flat == hull->n_triangles) {
        return ms_fail(err, MS_ERR_SHAPE, "a hull without area has no Feret dimensions");
    }
    while (flat && flat != before) {
        before = flat;
        for (size_t t = 0; t < hull->n_triangles; t++) {
            const double *other = c->normal[across(&c->edges, find_outer_side(hull, t)) / 3];
            if (ms_dot(c->normal[t], c->normal[t]) == 0 && ms_dot(other, other) > 0) {
                memcpy(c->normal[t], other, sizeof c->normal[t]);
                flat--;
            }
        }
    }
    return MS_OK;
}

/* Every edge once in each way: the hull is closed and wound alike. */
static void link_vertices(calipers *c)
{
    const ms_mesh *hull = c->hull;
    const uint32_t sides = (uint32_t)(3 * hull->n_triangles);
    for (uint32_t s = 0; s < sides; s++) {
        c->start[ms_mesh_edges_side_from(hull, s) + 1]++;
    }
    for (size_t v = 0; v < hull->n_vertices; v++) {
        c->start[v + 1] += c->start[v];
    }
    for (uint32_t s = sides; s-- > 0;) { /* fills from behind, with the starts one too far on; then shifts them */
        const uint32_t from = ms_mesh_edges_side_from(hull, s);
        c->next[--c->start[from + 1]] = ms_side_to(hull, s);
    }
    memmove(c->start, c->start + 1, hull->n_vertices * sizeof *c->start);
    c->start[hull->n_vertices] = sides;
}

static ms_status add_arc(calipers *c, const arc *one, ms_error *err)
{
    if (c->n_arcs == c->capacity) {
        const size_t capacity = 2 * c->capacity + 64;
        arc *larger = realloc(c->arcs, capacity * sizeof *larger);
        if (!larger) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the edges of the convex hull");
        }
        c->arcs = larger;
        c->capacity = capacity;
    }
    c->arcs[c->n_arcs++] = *one;
    return MS_OK;
}

/* The arc from one normal to another, in pieces. */
static ms_status cut_arc(calipers *c, const double a[3], const double b[3], uint32_t from, uint32_t to, ms_error *err)
{
    double across_both[3];
    ms_status status = MS_OK;
    ms_cross(across_both, a, b);
    const double angle = atan2(sqrt(ms_dot(across_both, across_both)), ms_dot(a, b));
    const int pieces = (int)ceil(angle / CELL);
    for (int p = 0; p < pieces && status == MS_OK && angle > 1e-12; p++) {
        arc one = {.half = angle / pieces / 2, .from = from, .to = to};
        const double part = (p + 0.5) / pieces, wa = sin((1 - part) * angle), wb = sin(part * angle);
        for (int m = 0; m < 3; m++) {
            one.middle[m] = (wa * a[m] + wb * b[m]) / sin(angle);
        }
        status = add_arc(c, &one, err);
    }
    return status;
}

/* Place of a direction among the cells along an axis. */
static int place(double at)
{
    const int cell = (int)((at + 1) / CELL);
    return cell < 0 ? 0 : cell < CELLS ? cell : CELLS - 1;
}

static size_t cell_of(const arc *one)
{
    return ((size_t)place(one->middle[2]) * CELLS + (size_t)place(one->middle[1])) * CELLS +
           (size_t)place(one->middle[0]);
}

static ms_status sort_arcs(calipers *c, ms_error *err)
{
    arc *sorted = malloc((c->n_arcs + 1) * sizeof *sorted);
    c->cell = calloc(ALL_CELLS + 2, sizeof *c->cell);
    if (!sorted || !c->cell) {
        free(sorted);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the edges of the convex hull");
    }
    for (size_t a = 0; a < c->n_arcs; a++) {
        c->cell[cell_of(&c->arcs[a]) + 2]++;
    }
    for (size_t k = 2; k < ALL_CELLS + 2; k++) {
        c->cell[k] += c->cell[k - 1];
    }
    for (size_t a = 0; a < c->n_arcs; a++) { /* cell k ends where k + 1 begins, when all are in */
        sorted[c->cell[cell_of(&c->arcs[a]) + 1]++] = c->arcs[a];
    }
    free(c->arcs);
    c->arcs = sorted;
    return MS_OK;
}

static ms_status make_arcs(calipers *c, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t e = 0; e < c->edges.n && status == MS_OK; e++) {
        const uint32_t side = c->edges.side[c->edges.start[e]], other = across(&c->edges, side);
        if (other != side) {
            status = cut_arc(c, c->normal[side / 3], c->normal[other / 3], ms_mesh_edges_side_from(c->hull, side),
                             ms_side_to(c->hull, side), err);
        }
    }
    return status == MS_OK ? sort_arcs(c, err) : status;
}

/* Two edges with parallel planes through them that hold the body: where an arc crosses the mirror image of another. */
static void try_edges(calipers *c, const arc *p, const arc *q)
{
    const double(*v)[3] = (const double(*)[3])c->hull->vertex;
    double along[2][3], direction[3], reach = p->half + q->half, apart = 0;
    for (int a = 0; a < 3; a++) {
        apart += (p->middle[a] + q->middle[a]) * (p->middle[a] + q->middle[a]);
        along[0][a] = v[p->to][a] - v[p->from][a];
        along[1][a] = v[q->to][a] - v[q->from][a];
    }
    if (apart > reach * reach) {
        return;
    }
    ms_cross(direction, along[0], along[1]);
    const double length = sqrt(ms_dot(direction, direction));
    const double sign = ms_dot(direction, p->middle) < 0 ? -1 : 1;
    if (!(length > 0)) {
        return;
    }
    for (int a = 0; a < 3; a++) {
        direction[a] *= sign / length;
    }
    const double slack = 1e-9, width = ms_dot(v[p->from], direction) - ms_dot(v[q->from], direction);
    if (width < c->width && ms_dot(direction, p->middle) >= cos(p->half + slack) - slack &&
        -ms_dot(direction, q->middle) >= cos(q->half + slack) - slack) {
        try_direction(c, direction);
    }
}

/* Those that may cross the mirror image of an arc are in the cells around its middle's. */
static void try_row(calipers *c, const arc *p, int x, int y, int z)
{
    const size_t row = ((size_t)z * CELLS + (size_t)y) * CELLS;
    const size_t from = row + (size_t)(x > 0 ? x - 1 : 0), to = row + (size_t)(x < CELLS - 1 ? x + 1 : x);
    for (uint32_t q = c->cell[from]; q < c->cell[to + 1]; q++) {
        if (&c->arcs[q] > p) {
            try_edges(c, p, &c->arcs[q]);
        }
    }
}

static void try_all_edges(calipers *c)
{
    for (size_t a = 0; a < c->n_arcs; a++) {
        const arc *p = &c->arcs[a];
        const int x = place(-p->middle[0]), y = place(-p->middle[1]), z = place(-p->middle[2]);
        for (int k = z > 0 ? z - 1 : 0; k <= z + 1 && k < CELLS; k++) {
            for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < CELLS; j++) {
                try_row(c, p, x, j, k);
            }
        }
    }
}

/* A corner of the projection. */
typedef struct corner {
    double x, y;
} corner;

static int compare_corners(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    if (p->x != q->x) {
        return p->x < q->x ? -1 : 1;
    }
    return (p->y > q->y) - (p->y < q->y);
}

static double corner_turn(const corner *a, const corner *b, const corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

/* Corners that lie together but for rounding, as those of two parallel faces do, tell no direction. */
static size_t drop_doubles(corner *out, size_t n)
{
    size_t kept = 0, left = 0, right = 0;
    for (size_t p = 1; p < n; p++) {
        left = out[p].x < out[left].x ? p : left;
        right = out[p].x > out[right].x ? p : right;
    }
    const double together = 1e-7 * hypot(out[right].x - out[left].x, out[right].y - out[left].y);
    for (size_t p = 0; p < n; p++) {
        const corner *before = &out[kept > 0 ? kept - 1 : n - 1];
        if (hypot(out[p].x - before->x, out[p].y - before->y) > together) {
            out[kept++] = out[p];
        }
    }
    return kept;
}

/* Hull of points in the plane, counter-clockwise. Source: Andrew, Inf. Process. Lett. 9 (1979) 216.
 * @param[out] out room for count + 1 */
static size_t outline(corner *out, corner *point, size_t count)
{
    size_t n = 0;
    qsort(point, count, sizeof *point, compare_corners);
    for (size_t p = 0; p < count; p++) {
        while (n >= 2 && corner_turn(&out[n - 2], &out[n - 1], &point[p]) <= 0) {
            n--;
        }
        out[n++] = point[p];
    }
    const size_t lower = n + 1;
    for (size_t p = count - 1; p-- > 0;) {
        while (n >= lower && corner_turn(&out[n - 2], &out[n - 1], &point[p]) <= 0) {
            n--;
        }
        out[n++] = point[p];
    }
    return drop_doubles(out, n - 1);
}

/* Least width of a convex outline, and its extent at right angles to that. */
static void measure_outline(double *width, double *length, const corner *out, size_t n)
{
    *width = HUGE_VAL;
    *length = 0;
    for (size_t i = 0, far = 1; i < n; i++) {
        const corner *a = &out[i], *b = &out[(i + 1) % n];
        const double side = hypot(b->x - a->x, b->y - a->y);
        for (size_t steps = 0; steps < n && corner_turn(a, b, &out[(far + 1) % n]) > corner_turn(a, b, &out[far]);
             steps++) {
            far = (far + 1) % n;
        }
        if (side > 0 && corner_turn(a, b, &out[far]) / side < *width) {
            double least = HUGE_VAL, most = -HUGE_VAL;
            *width = corner_turn(a, b, &out[far]) / side;
            for (size_t m = 0; m < n; m++) {
                const double at = (out[m].x * (b->x - a->x) + out[m].y * (b->y - a->y)) / side;
                least = fmin(least, at);
                most = fmax(most, at);
            }
            *length = most - least;
        }
    }
}

/* The other two dimensions: those of the projection along the width. */
static ms_status measure_projection(double feret[3], const calipers *c, ms_error *err)
{
    const size_t n = c->hull->n_vertices;
    const double *d = c->direction;
    const double aside[3] = {fabs(d[0]) < 0.6, fabs(d[0]) >= 0.6, 0};
    double x[3], y[3];
    corner *point = malloc((2 * n + 1) * sizeof *point);
    if (!point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the outline of the convex hull");
    }
    ms_cross(x, d, aside);
    const double length = sqrt(ms_dot(x, x));
    for (int a = 0; a < 3; a++) {
        x[a] /= length;
    }
    ms_cross(y, d, x);
    for (size_t v = 0; v < n; v++) {
        point[v] = (corner){ms_dot(c->hull->vertex[v], x), ms_dot(c->hull->vertex[v], y)};
    }
    corner *out = point + n;
    measure_outline(&feret[1], &feret[0], out, outline(out, point, n));
    feret[2] = c->width;
    free(point);
    return MS_OK;
}

static ms_status measure_width(calipers *c, ms_error *err)
{
    ms_status status = find_normals(c, err);
    if (status == MS_OK) {
        link_vertices(c);
        for (size_t t = 0; t < c->hull->n_triangles; t++) {
            if (ms_dot(c->normal[t], c->normal[t]) > 0) {
                try_direction(c, c->normal[t]);
            }
        }
        status = make_arcs(c, err);
    }
    if (status == MS_OK) {
        try_all_edges(c);
    }
    return status;
}

ms_status ms_feret_measure(double feret[3], const ms_mesh *hull, ms_error *err)
{
    calipers c = {.hull = hull, .width = HUGE_VAL};
    memset(feret, 0, 3 * sizeof *feret);
    ms_status status = ms_edges_build(&c.edges, hull, err);
    if (status != MS_OK) {
        return status;
    }
    c.start = calloc(hull->n_vertices + 2, sizeof *c.start);
    c.next = malloc((3 * hull->n_triangles + 1) * sizeof *c.next);
    c.normal = malloc((hull->n_triangles + 1) * sizeof *c.normal);
    status = c.start && c.next && c.normal ? measure_width(&c, err)
                                           : ms_fail(err, MS_ERR_NOMEM, "no memory to measure the convex hull");
    if (status == MS_OK) {
        status = measure_projection(feret, &c, err);
    }
    ms_mesh_edges_free(&c.edges);
    free(c.start);
    free(c.next);
    free(c.normal);
    free(c.arcs);
    free(c.cell);
    return status;
}
