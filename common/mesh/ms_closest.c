#include "ms_closest.h"

#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_bvh.h"

/* Planes that are measured at once: a leaf's. */
enum { AT_ONCE = 4 };

/* Triangles that a slab may hold: of larger patches the boxes tell as much. */
enum { PATCH = 256 };

/*
 * What is in box c of a node lies between two parallel planes, lo[c] <= normal . x <= hi[c]: of a smooth patch they are
 * closer together than the sides of the box, by the square of its extent. In single precision and in units of the
 * mesh's size, as the planes of triangles; all 0 where no patch is meant.
 */
typedef struct slab {
    float normal[3][2], lo[2], hi[2];
} slab;

/*
 * The planes of the triangles k of a leaf of n, for a first judgement: normal[a] at a n + k, the distance from the
 * centre at 3 n + k, so that a leaf's are together. Of single precision and in units of the mesh's size, which is
 * enough to tell that a plane is too far (find_plane_limit).
 */
struct ms_closest {
    ms_bvh bvh;
    float *plane; /* a leaf's at 4 times its first triangle; AT_ONCE more */
    slab *slab;   /* of each node */
};

static void put_planes(float *plane, const ms_bvh *bvh, uint32_t first, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        const ms_bvh_triangle *t = &bvh->triangle[first + k];
        for (uint32_t a = 0; a < 3; a++) {
            plane[a * count + k] = (float)t->normal[a];
        }
        plane[3 * count + k] = (float)(ms_dot(t->normal, t->a) / bvh->size);
    }
}

/* The planes of all leaves below a node. */
static void put_all_planes(float *plane, const ms_bvh *bvh)
{
    uint32_t stack[MS_BVH_STACK];
    int waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const ms_bvh_node *node = &bvh->node[stack[--waiting]];
        for (int c = 0; c < 2; c++) {
            if (node->count[c] == 0) {
                stack[waiting++] = node->first[c];
            } else {
                put_planes(plane + 4 * (size_t)node->first[c], bvh, node->first[c], node->count[c]);
            }
        }
    }
}

/* The slab of the triangles from `first` to `end` - 1. */
static void put_slab(slab *out, int c, const ms_bvh *bvh, uint32_t first, uint32_t end)
{
    double sum[3] = {0, 0, 0}, lo = HUGE_VAL, hi = -HUGE_VAL;
    for (uint32_t t = first; t < end; t++) {
        for (int a = 0; a < 3; a++) {
            sum[a] += bvh->triangle[t].normal[a];
        }
    }
    const double length = sqrt(ms_dot(sum, sum));
    for (int a = 0; a < 3; a++) {
        out->normal[a][c] = length > 0 ? (float)(sum[a] / length) : 0;
        sum[a] = (double)out->normal[a][c] / bvh->size;
    }
    for (uint32_t t = first; t < end; t++) {
        const ms_bvh_triangle *at = &bvh->triangle[t];
        const double a = ms_dot(sum, at->a), b = a + ms_dot(sum, at->ab), d = a + ms_dot(sum, at->ac);
        lo = fmin(lo, fmin(a, fmin(b, d)));
        hi = fmax(hi, fmax(a, fmax(b, d)));
    }
    out->lo[c] = (float)lo;
    out->hi[c] = (float)hi;
}

/* The slabs of all boxes of at most PATCH triangles. Boxes of a node stand behind it. @return 0 without memory */
static int put_all_slabs(slab *out, const ms_bvh *bvh)
{
    typedef uint32_t range[2];
    range *held =
        malloc(bvh->n_nodes * sizeof *held); /* the triangles of each node, from the first to before the last */
    for (size_t n = bvh->n_nodes; held && n-- > 0;) {
        const ms_bvh_node *node = &bvh->node[n];
        range of[2];
        out[n] = (slab){0};
        for (int c = 0; c < 2; c++) {
            const int leaf = node->count[c] > 0;
            of[c][0] = leaf ? node->first[c] : held[node->first[c]][0];
            of[c][1] = leaf ? node->first[c] + node->count[c] : held[node->first[c]][1];
            if (of[c][1] - of[c][0] <= PATCH) {
                put_slab(&out[n], c, bvh, of[c][0], of[c][1]);
            }
        }
        held[n][0] = of[0][0];
        held[n][1] = of[1][1];
    }
    free(held);
    return held != NULL;
}

ms_status ms_closest_build(ms_closest **out, const ms_mesh *mesh, ms_error *err)
{
    ms_closest *closest = calloc(1, sizeof *closest);
    ms_status status = closest ? ms_bvh_build(&closest->bvh, mesh, MS_BVH_FOR_MANY_RAYS, err) : MS_ERR_NOMEM;
    *out = NULL;
    if (status == MS_OK) {
        closest->plane = calloc(4 * mesh->n_triangles + AT_ONCE, sizeof *closest->plane);
        closest->slab = malloc(closest->bvh.n_nodes * sizeof *closest->slab);
        status = closest->plane && closest->slab && put_all_slabs(closest->slab, &closest->bvh) ? MS_OK : MS_ERR_NOMEM;
    }
    if (status != MS_OK) {
        ms_closest_free(closest);
        return status == MS_ERR_NOMEM ? ms_fail(err, MS_ERR_NOMEM, "no memory for a search structure") : status;
    }
    put_all_planes(closest->plane, &closest->bvh);
    *out = closest;
    return MS_OK;
}

void ms_closest_free(ms_closest *closest)
{
    if (closest) {
        ms_bvh_free(&closest->bvh);
        free(closest->plane);
        free(closest->slab);
        free(closest);
    }
}

/* Where on a triangle: at a corner, on an edge, or within. */
typedef enum region { CORNER_A, CORNER_B, CORNER_C, EDGE, FACE } region;

/* A point as a + v ab + w ac. */
typedef struct triangle_place {
    double v, w;
    region at;
} triangle_place;

/* Ericson 5.1.5: the region of the triangle's plane (corner, edge or face) in which the
   point's projection lies. ap, bp, cp run from the corners to the point. */
static triangle_place nearest_place(const ms_bvh_triangle *t, const double ap[3])
{
    double d1 = ms_dot(t->ab, ap);
    double d2 = ms_dot(t->ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        return (triangle_place){0, 0, CORNER_A};
    }
    double bp[3], cp[3];
    for (int k = 0; k < 3; k++) {
        bp[k] = ap[k] - t->ab[k];
        cp[k] = ap[k] - t->ac[k];
    }
    double d3 = ms_dot(t->ab, bp);
    double d4 = ms_dot(t->ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        return (triangle_place){1, 0, CORNER_B};
    }
    double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return (triangle_place){d1 / (d1 - d3), 0, EDGE};
    }
    double d5 = ms_dot(t->ab, cp);
    double d6 = ms_dot(t->ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        return (triangle_place){0, 1, CORNER_C};
    }
    double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return (triangle_place){0, d2 / (d2 - d6), EDGE};
    }
    double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (triangle_place){1 - w, w, EDGE};
    }
    double sum = va + vb + vc;
    return (triangle_place){vb / sum, vc / sum, FACE};
}

/* Squared distance to a place; `offset` is from the triangle's corner a to the place. */
static double distance_to(double offset[3], const ms_bvh_triangle *t, const double ap[3], triangle_place at)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        offset[k] = at.v * t->ab[k] + at.w * t->ac[k];
        square += (ap[k] - offset[k]) * (ap[k] - offset[k]);
    }
    return square;
}

static double clamp_to_unit(double x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0; /* 0 for NaN, of a segment without length */
}

/* In a sliver the regions drown in rounding: its three edges are tried one by one. */
static triangle_place nearest_on_edges(const ms_bvh_triangle *t, const double ap[3])
{
    double bc[3], bp[3], offset[3];
    for (int k = 0; k < 3; k++) {
        bc[k] = t->ac[k] - t->ab[k];
        bp[k] = ap[k] - t->ab[k];
    }
    double along_bc = clamp_to_unit(ms_dot(bc, bp) / ms_dot(bc, bc));
    const triangle_place tried[4] = {{clamp_to_unit(ms_dot(t->ab, ap) / ms_dot(t->ab, t->ab)), 0, EDGE},
                                     {0, clamp_to_unit(ms_dot(t->ac, ap) / ms_dot(t->ac, t->ac)), EDGE},
                                     {1 - along_bc, along_bc, EDGE},
                                     nearest_place(t, ap)};
    int best = 0;
    double least = HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        double square = distance_to(offset, t, ap, tried[k]);
        if (square < least) {
            least = square;
            best = k;
        }
    }
    return tried[best];
}

/* Squared distances from a point to the two boxes of a node. */
static void distances_to_boxes(double square[2], const ms_bvh_node *node, const double p[3])
{
#pragma omp simd
    for (int c = 0; c < 2; c++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            const double below = node->lo[k][c] - p[k], above = p[k] - node->hi[k][c];
            const double out = below > above ? below : above, outside = out > 0 ? out : 0;
            sum += outside * outside;
        }
        square[c] = sum;
    }
}

typedef struct nearest_search {
    const ms_bvh *bvh;
    double point[3]; /* relative to the centre */
    double best;     /* squared: what is farther is of no interest */
    const float *plane;
    const slab *slab;
    float place[3];    /* the point, in units of the mesh's size */
    float plane_limit; /* planes farther than that are of no interest */
    double nearest[3];
    int found;
    int side_wanted; /* the second pass: `best` stays, `side` and `normal` are summed */
    double side;     /* above 0 outside */
    double normal[3];
} nearest_search;

/* The angle-weighted pseudonormal tells inside from outside at corners and edges too; where
   several places are equally near, each says the same. Source: Baerentzen & Aanaes, Signed
   distance computation using the angle weighted pseudonormal, IEEE TVCG 11 (2005) 243. */
static void add_side(nearest_search *s, const ms_bvh_triangle *t, const double ap[3], const double offset[3], region at)
{
    double normal[3], from[3], bc[3];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3;
        int j = (k + 2) % 3;
        normal[k] = t->ab[i] * t->ac[j] - t->ab[j] * t->ac[i];
        from[k] = ap[k] - offset[k];
        bc[k] = t->ac[k] - t->ab[k];
    }
    double twice_area = sqrt(ms_dot(normal, normal));
    if (t->sliver || !(twice_area > 0)) {
        return;
    }
    double cosine = at == CORNER_A ? ms_dot(t->ab, t->ac) : at == CORNER_B ? -ms_dot(t->ab, bc) : ms_dot(t->ac, bc);
    double angle = at == FACE ? 2 * M_PI : at == EDGE ? M_PI : atan2(twice_area, cosine);
    s->side += angle * ms_dot(normal, from) / twice_area;
    for (int k = 0; k < 3; k++) {
        s->normal[k] += angle * normal[k] / twice_area;
    }
}

/*
 * Planes farther than this, in units of the mesh's size and of single precision, are farther than the best for sure. In
 * the depth of a round body the boxes of most faces are near enough and their planes are not. Rounding is below 4e-7 of
 * |x| + |y| + |z| + size; so far away that numbers might overflow nothing is left out.
 */
static float find_plane_limit(const nearest_search *s)
{
    const double reach = fabs(s->point[0]) + fabs(s->point[1]) + fabs(s->point[2]), size = s->bvh->size;
    return reach < 1e6 * size ? (float)fmin(sqrt(s->best) / size + 1e-6 * (reach / size + 1), 1e30) : HUGE_VALF;
}

static void search_triangle(nearest_search *s, const ms_bvh_triangle *t)
{
    double ap[3], offset[3];
    for (int i = 0; i < 3; i++) {
        ap[i] = s->point[i] - t->a[i];
    }
    const triangle_place at = t->sliver ? nearest_on_edges(t, ap) : nearest_place(t, ap);
    const double square = distance_to(offset, t, ap, at);
    if (square < s->best && s->side_wanted) {
        add_side(s, t, ap, offset, at.at);
    } else if (square < s->best) {
        s->best = square;
        s->plane_limit = find_plane_limit(s);
        s->found = 1;
        for (int i = 0; i < 3; i++) {
            s->nearest[i] = t->a[i] + offset[i];
        }
    }
}

static void search_leaf(nearest_search *s, uint32_t first, uint32_t count)
{
    const float *x = s->plane + 4 * (size_t)first, *y = x + count, *z = y + count, *d = z + count;
    const float px = s->place[0], py = s->place[1], pz = s->place[2];
    float off[AT_ONCE];
    for (int k = 0; k < AT_ONCE; k++) { /* of all, though there be fewer: so they are measured at once */
        off[k] = x[k] * px + y[k] * py + z[k] * pz - d[k];
    }
    for (uint32_t k = 0; k < count; k++) {
        if (!(fabsf(off[k]) > s->plane_limit)) {
            search_triangle(s, &s->bvh->triangle[first + k]);
        }
    }
}

/* How far a place is outside a slab; below 0 within. */
static float distance_to_slab(const slab *of, int c, const float p[3])
{
    const float at = of->normal[0][c] * p[0] + of->normal[1][c] * p[1] + of->normal[2][c] * p[2];
    const float below = of->lo[c] - at, above = at - of->hi[c];
    return below > above ? below : above;
}

/* The nearer box is searched first; the other waits and is dropped if a point nearer than it
   turns up. */
static void search_tree(nearest_search *s)
{
    struct {
        double square;
        float beyond;
        uint32_t first, count;
    } stack[MS_BVH_STACK];
    int waiting = 0;
    uint32_t at = 0;
    for (;;) {
        const ms_bvh_node *node = &s->bvh->node[at];
        double square[2];
        distances_to_boxes(square, node, s->point);
        int near = square[1] < square[0];
        for (int turn = 0; turn < 2; turn++) {
            int c = turn == 0 ? !near : near;
            const float beyond = square[c] < s->best ? distance_to_slab(&s->slab[at], c, s->place) : HUGE_VALF;
            if (square[c] < s->best && !(beyond > s->plane_limit)) {
                stack[waiting].square = square[c];
                stack[waiting].beyond = beyond;
                stack[waiting].first = node->first[c];
                stack[waiting++].count = node->count[c];
            }
        }
        uint32_t count;
        do {
            do {
                if (waiting == 0) {
                    return;
                }
                waiting--;
            } while (!(stack[waiting].square < s->best) || stack[waiting].beyond > s->plane_limit);
            at = stack[waiting].first;
            count = stack[waiting].count;
            if (count > 0) {
                search_leaf(s, at, count);
            }
        } while (count > 0);
    }
}

static void begin_search(nearest_search *s, const ms_closest *closest, const double point[3], double at_most)
{
    *s = (nearest_search){.bvh = &closest->bvh,
                          .plane = closest->plane,
                          .slab = closest->slab,
                          .best = at_most > 0 ? at_most * at_most : 0};
    for (int k = 0; k < 3; k++) {
        s->point[k] = point[k] - closest->bvh.centre[k];
        s->place[k] = (float)(s->point[k] / closest->bvh.size);
    }
    s->plane_limit = find_plane_limit(s);
}

double ms_closest_distance(double nearest[3], const ms_closest *closest, const double point[3], double at_most)
{
    nearest_search s;
    begin_search(&s, closest, point, at_most);
    search_tree(&s);
    if (!s.found) {
        return at_most;
    }
    for (int k = 0; nearest && k < 3; k++) {
        nearest[k] = s.nearest[k] + closest->bvh.centre[k];
    }
    return fmin(sqrt(s.best), at_most);
}

double ms_closest_side(double normal[3], const ms_closest *closest, const double point[3], double distance)
{
    nearest_search s;
    /* All triangles as near as that, but for rounding. */
    begin_search(&s, closest, point, distance + 1e-12 * (distance + closest->bvh.size));
    s.side_wanted = 1;
    search_tree(&s);
    for (int k = 0; normal && k < 3; k++) {
        normal[k] = s.normal[k];
    }
    return s.side < 0 ? -distance : distance;
}

double ms_closest_signed_normal(double normal[3], const ms_closest *closest, const double point[3])
{
    return ms_closest_side(normal, closest, point, ms_closest_distance(NULL, closest, point, HUGE_VAL));
}

double ms_closest_signed_distance(const ms_closest *closest, const double point[3])
{
    return ms_closest_signed_normal(NULL, closest, point);
}
