#include "ms_clump_surface.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "mesh/ms_isosurface.h"

/* Points along the edge of a block, and along an axis at most. */
enum { BLOCK = 8, MOST = 1 << 15 };

/* The lattice, and which spheres reach into which block of it or one edge beyond. */
typedef struct ball_lattice {
    const ms_clump *clump;
    ms_isosurface field;
    int blocks[3];
    size_t *start;  /* one for each block and one more: where its spheres begin in `near` */
    uint32_t *near; /* ascending in each block */
    uint8_t *inside;
} ball_lattice;

static size_t block_of(const ball_lattice *l, int i, int j, int k)
{
    return (size_t)i + (size_t)l->blocks[0] * ((size_t)j + (size_t)l->blocks[1] * (size_t)k);
}

static size_t count_ball_blocks(const ball_lattice *l)
{
    return (size_t)l->blocks[0] * (size_t)l->blocks[1] * (size_t)l->blocks[2];
}

static void place_point(double out[3], const ball_lattice *l, const int at[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = l->field.origin[k] + l->field.h * at[k];
    }
}

/* The blocks that the box of a sphere and an edge around it meets. */
static void find_ball_blocks(int lo[3], int hi[3], const ball_lattice *l, const ms_sphere *sphere)
{
    for (int k = 0; k < 3; k++) {
        const double at = (sphere->centre[k] - l->field.origin[k]) / l->field.h, r = sphere->radius / l->field.h;
        lo[k] = (int)fmax(0, floor((at - r - 2) / BLOCK));
        hi[k] = (int)fmin(l->blocks[k] - 1, floor((at + r + 2) / BLOCK));
    }
}

/* Passes over all pairs of a block and a sphere. @param fill zero: counts them into start, one block on */
static void pass_pairs(ball_lattice *l, size_t *next, int fill)
{
    for (size_t s = 0; s < l->clump->n_spheres; s++) {
        int lo[3], hi[3];
        find_ball_blocks(lo, hi, l, &l->clump->sphere[s]);
        for (int k = lo[2]; k <= hi[2]; k++) {
            for (int j = lo[1]; j <= hi[1]; j++) {
                for (int i = lo[0]; i <= hi[0]; i++) {
                    const size_t block = block_of(l, i, j, k);
                    if (fill) {
                        l->near[next[block]++] = (uint32_t)s;
                    } else {
                        l->start[block + 1]++;
                    }
                }
            }
        }
    }
}

static ms_status list_spheres(ball_lattice *l, ms_error *err)
{
    const size_t count = count_ball_blocks(l);
    size_t *next = malloc((count + 1) * sizeof *next);
    l->start = calloc(count + 1, sizeof *l->start);
    if (next && l->start) {
        pass_pairs(l, NULL, 0);
        for (size_t b = 0; b < count; b++) {
            l->start[b + 1] += l->start[b];
            next[b] = l->start[b];
        }
        l->near = malloc((l->start[count] + 1) * sizeof *l->near);
    }
    if (l->near) {
        pass_pairs(l, next, 1);
    }
    free(next);
    return l->near ? MS_OK
                   : ms_fail(err, MS_ERR_NOMEM, "no memory for the surface of %zu spheres", l->clump->n_spheres);
}

static int is_in_balls(const ball_lattice *l, const int at[3])
{
    double point[3];
    const size_t block = block_of(l, at[0] / BLOCK, at[1] / BLOCK, at[2] / BLOCK);
    place_point(point, l, at);
    for (size_t s = l->start[block]; s < l->start[block + 1]; s++) {
        const ms_sphere *sphere = &l->clump->sphere[l->near[s]];
        if (ms_squared_distance(point, sphere->centre) < sphere->radius * sphere->radius) {
            return 1;
        }
    }
    return 0;
}

static void find_inside(const ball_lattice *l)
{
    const int *n = l->field.n;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < n[2]; k++) {
        for (int j = 0; j < n[1]; j++) {
            uint8_t *row = l->inside + (size_t)n[0] * ((size_t)j + (size_t)n[1] * (size_t)k);
            for (int i = 0; i < n[0]; i++) {
                row[i] = (uint8_t)is_in_balls(l, (int[3]){i, j, k});
            }
        }
    }
}

/* Where a line from a to b leaves a sphere, if the part t of the way is inside; else t. */
static double leave_sphere(const ms_sphere *sphere, const double a[3], const double way[3], double t)
{
    const double from[3] = {a[0] - sphere->centre[0], a[1] - sphere->centre[1], a[2] - sphere->centre[2]};
    const double square = ms_dot(way, way), half = ms_dot(from, way);
    const double root = half * half - square * (ms_dot(from, from) - sphere->radius * sphere->radius);
    if (!(root > 0)) {
        return t;
    }
    const double enters = (-half - sqrt(root)) / square, leaves = (-half + sqrt(root)) / square;
    return enters <= t && t < leaves ? leaves : t;
}

/* Goes on from sphere to sphere until none holds the place. */
static double leave_union(const void *context, const int from[3], const int to[3])
{
    const ball_lattice *l = context;
    double a[3], b[3], t = 0, before;
    const size_t block = block_of(l, from[0] / BLOCK, from[1] / BLOCK, from[2] / BLOCK);
    place_point(a, l, from);
    place_point(b, l, to);
    const double way[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    do {
        before = t;
        for (size_t s = l->start[block]; s < l->start[block + 1]; s++) {
            t = leave_sphere(&l->clump->sphere[l->near[s]], a, way, t);
        }
    } while (t > before);
    return t;
}

/* Points from an edge and a half outside the box on, which no plane of symmetry meets. */
static ms_status lay_out(ball_lattice *l, double h, size_t max_points, ms_error *err)
{
    double lo[3], hi[3], points = 1;
    ms_clump_box(lo, hi, l->clump);
    for (int k = 0; k < 3; k++) {
        const double edges = ceil((hi[k] - lo[k]) / h) + 3;
        points *= edges + 1;
        l->field.n[k] = edges < MOST ? (int)edges + 1 : 0;
        l->field.origin[k] = lo[k] - 1.4619 * h;
        l->blocks[k] = l->field.n[k] / BLOCK + 1;
    }
    if (!(points <= (double)max_points) || l->field.n[0] == 0 || l->field.n[1] == 0 || l->field.n[2] == 0) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "a surface by cells of %g takes %.3g points, which is more than %zu; take fewer cells", h,
                       points, max_points);
    }
    l->field.h = h;
    l->inside = malloc((size_t)points);
    return l->inside ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for a surface of %.3g points", points);
}

ms_status ms_clump_surface(ms_mesh *mesh, const ms_clump *clump, double h, size_t max_points, ms_error *err)
{
    ball_lattice l = {.clump = clump};
    *mesh = (ms_mesh){0};
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_ARG, "no spheres have no surface");
    }
    ms_status status = lay_out(&l, h, max_points, err);
    if (status == MS_OK) {
        status = list_spheres(&l, err);
    }
    if (status == MS_OK) {
        find_inside(&l);
        l.field.inside = l.inside;
        l.field.crossing = leave_union;
        l.field.context = &l;
        status = ms_isosurface_build(mesh, &l.field, err);
    }
    free(l.inside);
    free(l.start);
    free(l.near);
    return status;
}
