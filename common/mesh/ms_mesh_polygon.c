#include "ms_mesh_polygon.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

/* A fan stays if what it has outside the polygon is no more than this part of it: rounding. */
#define ROUNDING 1e-6
/* Corners within this part of the polygon's area of a straight line are on it. */
#define FLAT 1e-12
/* About ten seconds. */
#define MAX_TESTS (UINT64_C(1) << 31)

typedef struct polygon {
    const double (*point)[2];
    uint32_t *next, *previous;
    uint32_t left; /* corners */
    double flat;   /* twice an area that counts as none */
    uint64_t *tests;
} polygon;

/* Twice the area vector of the polygon. Of its fan: Newell's normal. */
static void find_normal(double normal[3], const uint32_t (*fan)[3], size_t n, const double (*vertex)[3])
{
    normal[0] = normal[1] = normal[2] = 0;
    for (size_t t = 0; t < n; t++) {
        double cross[3];
        ms_vector_triangle(cross, vertex[fan[t][0]], vertex[fan[t][1]], vertex[fan[t][2]]);
        for (int k = 0; k < 3; k++) {
            normal[k] += cross[k];
        }
    }
}

/* Does the fan leave the polygon? It does where one of its triangles is turned over. */
static int fan_is_good(const double normal[3], const uint32_t (*fan)[3], size_t n, const double (*vertex)[3])
{
    double right = 0, wrong = 0;
    for (size_t t = 0; t < n; t++) {
        double one[3];
        find_normal(one, fan + t, 1, vertex);
        const double area = ms_dot(one, normal);
        right += area > 0 ? area : 0;
        wrong += area < 0 ? -area : 0;
    }
    return wrong <= ROUNDING * right || !isfinite(right);
}

static ms_status make_room(ms_polygon_work *work, size_t n, ms_error *err)
{
    if (n <= work->room) {
        return MS_OK;
    }
    ms_mesh_polygon_free(work);
    work->point = malloc(n * sizeof *work->point);
    work->corner = malloc(n * sizeof *work->corner);
    work->next = malloc(n * sizeof *work->next);
    work->previous = malloc(n * sizeof *work->previous);
    if (!work->point || !work->corner || !work->next || !work->previous) {
        ms_mesh_polygon_free(work);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to cut a face of %zu corners", n);
    }
    work->room = n;
    return MS_OK;
}

/* The corners in the plane across the normal, seen against it, from the first of them. */
static void lay_flat(ms_polygon_work *work, const uint32_t (*fan)[3], uint32_t n, const double (*vertex)[3],
                     const double normal[3])
{
    const double length = sqrt(ms_dot(normal, normal));
    double along[3] = {0}, up[3], right[3], unit[3];
    int least = 0;
    for (int k = 0; k < 3; k++) {
        unit[k] = normal[k] / length;
        least = fabs(unit[k]) < fabs(unit[least]) ? k : least;
    }
    along[least] = 1;
    ms_cross(right, unit, along);
    const double width = sqrt(ms_dot(right, right));
    for (int k = 0; k < 3; k++) {
        right[k] /= width;
    }
    ms_cross(up, unit, right);
    for (uint32_t c = 0; c < n; c++) {
        const uint32_t corner = c < 2 ? fan[0][c] : fan[c - 2][2];
        double from_first[3];
        for (int k = 0; k < 3; k++) {
            from_first[k] = vertex[corner][k] - vertex[fan[0][0]][k];
        }
        work->corner[c] = corner;
        work->point[c][0] = ms_dot(from_first, right);
        work->point[c][1] = ms_dot(from_first, up);
        work->next[c] = c + 1 < n ? c + 1 : 0;
        work->previous[c] = c > 0 ? c - 1 : n - 1;
    }
}

/* Twice the area of a triangle, positive where it is wound as the polygon is. */
static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int same_place(const double a[2], const double b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

/* Is the corner's triangle with its neighbours within the polygon? Outlines may visit a
 * corner twice (a slit to a hole): a point in the place of a corner is not in the way. */
static int is_ear(const polygon *p, uint32_t corner)
{
    const double *a = p->point[p->previous[corner]], *b = p->point[corner], *c = p->point[p->next[corner]];
    if (!(turn(a, b, c) > p->flat)) {
        return 0;
    }
    for (uint32_t k = p->next[p->next[corner]]; k != p->previous[corner]; k = p->next[k]) {
        const double *q = p->point[k];
        ++*p->tests;
        if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0 && !same_place(q, a) && !same_place(q, b) &&
            !same_place(q, c)) {
            return 0;
        }
    }
    return 1;
}

static int is_straight(const polygon *p, uint32_t corner)
{
    return fabs(turn(p->point[p->previous[corner]], p->point[corner], p->point[p->next[corner]])) <= p->flat;
}

/* The next corner to cut off: an ear; where there is none, one on a straight line, which
 * costs nothing; else (the outline crosses itself) the one at hand, as a fan would. */
static uint32_t find_ear(const polygon *p, uint32_t from)
{
    uint32_t corner = from;
    for (uint32_t k = 0; k < p->left && *p->tests < MAX_TESTS; k++, corner = p->next[corner]) {
        if (is_ear(p, corner)) {
            return corner;
        }
    }
    corner = from;
    for (uint32_t k = 0; k < p->left; k++, corner = p->next[corner]) {
        if (is_straight(p, corner)) {
            return corner;
        }
    }
    return from;
}

static ms_status clip_ears(uint32_t (*triangle)[3], polygon *p, const uint32_t *number, ms_error *err)
{
    uint32_t at = 1;
    for (uint32_t n = p->left; p->left > 2; p->left--, triangle++) {
        at = find_ear(p, at);
        if (*p->tests >= MAX_TESTS) {
            return ms_fail(err, MS_ERR_LIMIT,
                           "a concave face of %lu corners takes too long to cut; cut it into triangles",
                           (unsigned long)n);
        }
        const uint32_t before = p->previous[at], behind = p->next[at];
        (*triangle)[0] = number[before];
        (*triangle)[1] = number[at];
        (*triangle)[2] = number[behind];
        p->next[before] = behind;
        p->previous[behind] = before;
        at = p->next[behind]; /* not the neighbour: fewer slivers */
    }
    return MS_OK;
}

ms_status ms_mesh_polygon_cut(uint32_t (*fan)[3], size_t n_triangles, const double (*vertex)[3], ms_polygon_work *work,
                              ms_error *err)
{
    double normal[3];
    const uint32_t(*as_read)[3] = (const uint32_t(*)[3])fan;
    find_normal(normal, as_read, n_triangles, vertex);
    if (n_triangles < 2 || fan_is_good(normal, as_read, n_triangles, vertex)) {
        return MS_OK;
    }
    const double twice_area = sqrt(ms_dot(normal, normal));
    ms_status status = make_room(work, n_triangles + 2, err);
    if (status != MS_OK || !(twice_area > 0) || !isfinite(twice_area)) {
        return status;
    }
    lay_flat(work, as_read, (uint32_t)(n_triangles + 2), vertex, normal);
    polygon p = {.point = (const double(*)[2])work->point,
                 .next = work->next,
                 .previous = work->previous,
                 .left = (uint32_t)(n_triangles + 2),
                 .flat = FLAT * twice_area,
                 .tests = &work->tests};
    return clip_ears(fan, &p, work->corner, err);
}

void ms_mesh_polygon_free(ms_polygon_work *work)
{
    free(work->point);
    free(work->corner);
    free(work->next);
    free(work->previous);
    *work = (ms_polygon_work){.tests = work->tests};
}
