#include "ms_voxelize.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Across the rays: coordinates are integers in units of 2^-15 voxel. With extents below
 * 2^15 an edge function is below 2^62, so that int64_t holds it exactly. */
enum { ACROSS_BITS = 15, ACROSS = 1 << ACROSS_BITS };
/* Along the rays: crossings are integers in units of 2^-12 voxel. */
enum { ALONG_BITS = 12, ALONG = 1 << ALONG_BITS };
/* A ray that no edge touches counts as the four rays infinitely near it. */
enum { RAY_WEIGHT = 4 };

typedef struct vertex {
    int32_t b, c; /* across the rays, in 1/ACROSS voxel from the centre of the first voxel */
    double a;     /* along the rays, in voxels from the outer face of the first voxel */
} vertex;

/* One sweep of rays over the mesh. Rays run along axis a; planes are stacked along c. */
typedef struct sweep {
    const ms_mesh *mesh;
    ms_grid *grid;
    int a, b, c;
    int rays;   /* rays per voxel along b and along c */
    int parity; /* 0: inside by coverage; 1: sets bit a by the parity of crossings */
    vertex *vertices;
    size_t *plane_start;      /* n[c] + 1 offsets into plane_triangle */
    uint32_t *plane_triangle; /* the triangles that touch each plane's rays */
} sweep;

void ms_voxelize_extents(double n[3], const ms_mesh *mesh, double h)
{
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    for (int a = 0; a < 3; a++) {
        /* A side that is a whole number of voxels but for rounding gets just that number. */
        n[a] = fmax(1, ceil((hi[a] - lo[a]) / h - 1e-6)) + 2 * MS_GRID_HULL;
    }
}

/* The grid around the mesh, with the box of the mesh in its middle. */
static ms_status alloc_around(ms_grid *grid, const ms_mesh *mesh, double h, ms_error *err)
{
    double lo[3], hi[3], extent[3], origin[3];
    int n[3];
    memset(grid, 0, sizeof *grid);
    if (mesh->n_triangles == 0) {
        return ms_fail(err, MS_ERR_ARG, "the mesh has no triangles to voxelise");
    }
    if (!(h > 0) || !isfinite(h)) {
        return ms_fail(err, MS_ERR_ARG, "voxel size %g is not a positive number", h);
    }
    ms_voxelize_extents(extent, mesh, h);
    ms_mesh_box(lo, hi, mesh);
    for (int a = 0; a < 3; a++) {
        if (!(extent[a] <= MS_GRID_MAX_EXTENT)) {
            return ms_fail(err, MS_ERR_LIMIT, "%.0f voxels along %c are more than %d; use a larger voxel size",
                           extent[a], "xyz"[a], MS_GRID_MAX_EXTENT);
        }
        n[a] = (int)extent[a];
        origin[a] = lo[a] + 0.5 * (hi[a] - lo[a]) - 0.5 * h * (n[a] - 1);
    }
    return ms_grid_alloc(grid, n, h, origin, err);
}

static void sweep_free(sweep *s)
{
    free(s->vertices);
    free(s->plane_start);
    free(s->plane_triangle);
}

/* Measured from the centre of the box, so that mirrored vertices round to mirrored places. */
static void place_vertices(sweep *s)
{
    const ms_grid *grid = s->grid;
    double lo[3], hi[3], centre[3];
    ms_mesh_box(lo, hi, s->mesh);
    for (int a = 0; a < 3; a++) {
        centre[a] = lo[a] + 0.5 * (hi[a] - lo[a]);
    }
    for (size_t v = 0; v < s->mesh->n_vertices; v++) {
        const double *p = s->mesh->vertex[v];
        double b = (p[s->b] - centre[s->b]) / grid->h, c = (p[s->c] - centre[s->c]) / grid->h;
        s->vertices[v].b = (int32_t)(rint(b * ACROSS) + (grid->n[s->b] - 1) * (ACROSS / 2));
        s->vertices[v].c = (int32_t)(rint(c * ACROSS) + (grid->n[s->c] - 1) * (ACROSS / 2));
        s->vertices[v].a = (p[s->a] - centre[s->a]) / grid->h + 0.5 * grid->n[s->a];
    }
}

static int floor_div(int64_t value, int64_t divisor)
{
    return (int)(value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor));
}

/* Rays are numbered across all voxels: ray r crosses at ray_first + r * ray_step. */
static int64_t ray_step(const sweep *s)
{
    return ACROSS / s->rays;
}

static int64_t ray_first(const sweep *s)
{
    return (ray_step(s) - ACROSS) / 2;
}

/* The rays first..last (numbers) that lie between lo and hi. */
static void ray_range(int *first, int *last, const sweep *s, int axis, int64_t lo, int64_t hi)
{
    *first = -floor_div(-(lo - ray_first(s)), ray_step(s));
    *last = floor_div(hi - ray_first(s), ray_step(s));
    if (*first < 0) {
        *first = 0;
    }
    if (*last >= s->grid->n[axis] * s->rays) {
        *last = s->grid->n[axis] * s->rays - 1;
    }
}

static void triangle_planes(int *first, int *last, const sweep *s, size_t triangle)
{
    const uint32_t *t = s->mesh->triangle[triangle];
    int32_t lo = s->vertices[t[0]].c, hi = lo;
    for (int m = 1; m < 3; m++) {
        int32_t c = s->vertices[t[m]].c;
        lo = c < lo ? c : lo;
        hi = c > hi ? c : hi;
    }
    ray_range(first, last, s, s->c, lo, hi);
    *first /= s->rays;
    *last = *last < 0 ? -1 : *last / s->rays;
}

/* Counting sort of the triangles by the planes that they touch. */
static ms_status sort_into_planes(sweep *s, ms_error *err)
{
    const int planes = s->grid->n[s->c];
    int first, last;
    for (size_t t = 0; t < s->mesh->n_triangles; t++) {
        triangle_planes(&first, &last, s, t);
        for (int k = first; k <= last; k++) {
            s->plane_start[k + 1]++;
        }
    }
    for (int k = 0; k < planes; k++) {
        s->plane_start[k + 1] += s->plane_start[k];
    }
    s->plane_triangle = malloc((s->plane_start[planes] + 1) * sizeof *s->plane_triangle);
    size_t *next = malloc((size_t)planes * sizeof *next);
    if (!s->plane_triangle || !next) {
        free(next);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to sort %zu triangles into %d planes", s->mesh->n_triangles,
                       planes);
    }
    memcpy(next, s->plane_start, (size_t)planes * sizeof *next);
    for (size_t t = 0; t < s->mesh->n_triangles; t++) {
        triangle_planes(&first, &last, s, t);
        for (int k = first; k <= last; k++) {
            s->plane_triangle[next[k]++] = (uint32_t)t;
        }
    }
    free(next);
    return MS_OK;
}

/* Does the ray shifted by (e sb, e^2 sc), e infinitely small, pass on the positive side of
 * an edge (db, dc) on which the ray itself lies? */
static int shifted_side(int64_t db, int64_t dc, int sb, int sc)
{
    return dc != 0 ? -dc * sb > 0 : db * sc > 0;
}

/* How many of the four rays infinitely near the given one pass through the triangle. */
static int near_rays_inside(const int64_t e[3], const int64_t db[3], const int64_t dc[3], int positive, int parity)
{
    int inside = 0;
    for (int sb = -1; sb <= 1; sb += 2) {
        for (int sc = -1; sc <= 1; sc += 2) {
            int in = 1;
            for (int m = 0; m < 3; m++) {
                int side = e[m] != 0 ? e[m] > 0 : shifted_side(db[m], dc[m], sb, sc);
                in &= side == positive;
            }
            if (parity && sb > 0 && sc > 0) {
                return in * RAY_WEIGHT; /* parities cannot be shared out: one of the four decides */
            }
            inside += in;
        }
    }
    return inside;
}

/* Adds a crossing at x, in voxels from the outer face of the first: all beyond is covered. */
static void add_crossing(int32_t *row, const sweep *s, double x, int weight)
{
    int64_t at = (int64_t)rint(x * ALONG);
    int voxel = (int)(at >> ALONG_BITS), part = (int)(at & (ALONG - 1));
    if (s->rays == 1) {
        /* Only the centre counts; a face right through it covers it half. */
        part = part < ALONG / 2 ? 0 : part == ALONG / 2 ? ALONG / 2 : ALONG;
    }
    if (s->parity) {
        row[voxel + (part > ALONG / 2)] ^= 1;
        return;
    }
    row[voxel] += weight * (ALONG - part);
    row[voxel + 1] += weight * part;
}

/* The stretch of the row of rays at height c that the triangle may cover, widened a little:
 * the exact test decides. */
static int covered_stretch(int64_t *lo, int64_t *hi, const vertex *const v[3], int64_t c)
{
    double least = INFINITY, most = -INFINITY;
    for (int m = 0; m < 3; m++) {
        const vertex *p = v[m], *q = v[(m + 1) % 3];
        if ((p->c < c && q->c < c) || (p->c > c && q->c > c)) {
            continue;
        }
        double from = p->b, to = q->b;
        if (p->c != q->c) {
            from = p->b + ((double)q->b - p->b) * ((double)(c - p->c) / ((double)q->c - p->c));
            to = from;
        }
        least = fmin(least, fmin(from, to));
        most = fmax(most, fmax(from, to));
    }
    *lo = (int64_t)least - 1;
    *hi = (int64_t)most + 1;
    return least <= most;
}

/* All rays of one row (fixed c) through one triangle. `lines` holds the plane's rows. */
static void cross_row(int32_t *lines, const sweep *s, const vertex *const v[3], int64_t c)
{
    int64_t lo, hi, db[3], dc[3], e[3], area = 0;
    int first, last;
    if (!covered_stretch(&lo, &hi, v, c)) {
        return;
    }
    ray_range(&first, &last, s, s->b, lo, hi);
    const int64_t b0 = ray_first(s) + first * ray_step(s);
    for (int m = 0; m < 3; m++) { /* edge m lies opposite vertex m */
        const vertex *p = v[(m + 1) % 3], *q = v[(m + 2) % 3];
        db[m] = (int64_t)q->b - p->b;
        dc[m] = (int64_t)q->c - p->c;
        e[m] = db[m] * (c - p->c) - dc[m] * (b0 - p->b);
        area += e[m];
    }
    if (area == 0) {
        return; /* parallel to the rays: crosses none of the nearby ones */
    }
    const int positive = area > 0, sign = positive ? -1 : 1; /* a face towards +a ends matter */
    const size_t row_length = (size_t)s->grid->n[s->a] + 1;
    for (int r = first; r <= last; r++) {
        int inside = RAY_WEIGHT;
        if (e[0] == 0 || e[1] == 0 || e[2] == 0) {
            inside = near_rays_inside(e, db, dc, positive, s->parity);
        } else if ((e[0] > 0) != positive || (e[1] > 0) != positive || (e[2] > 0) != positive) {
            inside = 0;
        }
        if (inside) {
            double x = v[0]->a +
                       ((double)e[1] * (v[1]->a - v[0]->a) + (double)e[2] * (v[2]->a - v[0]->a)) / (double)area;
            add_crossing(lines + (size_t)(r / s->rays) * row_length, s, x, sign * inside);
        }
        for (int m = 0; m < 3; m++) {
            e[m] -= dc[m] * ray_step(s);
        }
    }
}

/* Sums up each row of the plane and writes what is inside. */
static void emit_plane(const int32_t *lines, const sweep *s, int plane)
{
    const int *n = s->grid->n;
    const size_t stride[3] = {1, (size_t)n[0], (size_t)n[0] * (size_t)n[1]};
    const int32_t full = s->rays * s->rays * RAY_WEIGHT * ALONG;
    for (int j = 0; j < n[s->b]; j++) {
        const int32_t *row = lines + (size_t)j * ((size_t)n[s->a] + 1);
        uint8_t *voxel = s->grid->inside + stride[s->b] * (size_t)j + stride[s->c] * (size_t)plane;
        int32_t sum = 0;
        for (int i = 0; i < n[s->a]; i++, voxel += stride[s->a]) {
            sum += row[i];
            *voxel |= (uint8_t)(s->parity ? (sum & 1) << s->a : 2 * sum > full);
        }
    }
}

static void sweep_plane(int32_t *lines, const sweep *s, int plane)
{
    const int *n = s->grid->n;
    memset(lines, 0, (size_t)n[s->b] * ((size_t)n[s->a] + 1) * sizeof *lines);
    for (size_t at = s->plane_start[plane]; at < s->plane_start[plane + 1]; at++) {
        const uint32_t *t = s->mesh->triangle[s->plane_triangle[at]];
        const vertex *v[3] = {&s->vertices[t[0]], &s->vertices[t[1]], &s->vertices[t[2]]};
        for (int ray = 0; ray < s->rays; ray++) {
            cross_row(lines, s, v, ray_first(s) + ((int64_t)plane * s->rays + ray) * ray_step(s));
        }
    }
    emit_plane(lines, s, plane);
}

static ms_status sweep_run(const ms_mesh *mesh, ms_grid *grid, int axis, int rays, int parity, ms_error *err)
{
    sweep s = {.mesh = mesh, .grid = grid, .a = axis, .b = (axis + 1) % 3, .c = (axis + 2) % 3, .rays = rays,
               .parity = parity};
    const size_t line_count = (size_t)grid->n[s.b] * ((size_t)grid->n[s.a] + 1);
    int out_of_memory = 0;
    s.vertices = malloc(mesh->n_vertices * sizeof *s.vertices);
    s.plane_start = calloc((size_t)grid->n[s.c] + 1, sizeof *s.plane_start);
    if (!s.vertices || !s.plane_start) {
        sweep_free(&s);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to voxelise %zu vertices", mesh->n_vertices);
    }
    place_vertices(&s);
    ms_status status = sort_into_planes(&s, err);
    if (status == MS_OK) {
#pragma omp parallel reduction(| : out_of_memory)
        {
            int32_t *lines = malloc(line_count * sizeof *lines);
            out_of_memory = !lines;
#pragma omp for schedule(dynamic, 4)
            for (int plane = 0; plane < grid->n[s.c]; plane++) {
                if (lines) {
                    sweep_plane(lines, &s, plane);
                }
            }
            free(lines);
        }
        if (out_of_memory) {
            status = ms_fail(err, MS_ERR_NOMEM, "no memory for a plane of %zu voxels; use fewer cells", line_count);
        }
    }
    sweep_free(&s);
    return status;
}

/* Frees the grid where the voxelisation failed or holds nothing. */
static ms_status finish(ms_grid *grid, ms_status status, ms_error *err)
{
    if (status == MS_OK && ms_grid_count(grid) == 0) {
        status = ms_fail(err, MS_ERR_SHAPE, "no voxel of size %g is inside the shape; use more cells", grid->h);
    }
    if (status != MS_OK) {
        ms_grid_free(grid);
    }
    return status;
}

ms_status ms_voxelize(ms_grid *grid, const ms_mesh *mesh, double h, ms_voxel_rule rule, ms_error *err)
{
    ms_status status = alloc_around(grid, mesh, h, err);
    if (status != MS_OK) {
        return status;
    }
    return finish(grid, sweep_run(mesh, grid, 0, rule == MS_VOXEL_HALF ? 4 : 1, 0, err), err);
}

ms_status ms_voxelize_open(ms_grid *grid, size_t *disagree, const ms_mesh *mesh, double h, ms_error *err)
{
    *disagree = 0;
    ms_status status = alloc_around(grid, mesh, h, err);
    for (int axis = 0; axis < 3 && status == MS_OK; axis++) {
        status = sweep_run(mesh, grid, axis, 1, 1, err);
    }
    if (status == MS_OK) {
        const size_t voxels = ms_grid_voxels(grid);
        for (size_t v = 0; v < voxels; v++) {
            const int votes = (grid->inside[v] & 1) + (grid->inside[v] >> 1 & 1) + (grid->inside[v] >> 2);
            *disagree += votes == 1 || votes == 2;
            grid->inside[v] = votes >= 2;
        }
    }
    return finish(grid, status, err);
}
