#include "ms_sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Across the rays: coordinates are integers in units of 2^-15 voxel. With extents below
 * 2^15 an edge function is below 2^62, so that int64_t holds it exactly. */
enum { ACROSS_BITS = 15, ACROSS = 1 << ACROSS_BITS };
enum { ALL_NEAR = (1 << MS_SWEEP_NEAR_RAYS) - 1, LAST_NEAR = 1 << (MS_SWEEP_NEAR_RAYS - 1) };

typedef struct vertex {
    int32_t b, c; /* across the rays, in 1/ACROSS voxel from the centre of the first voxel */
    double a;     /* along the rays, in voxels from the outer face of the first voxel */
} vertex;

/* One sweep of rays over the mesh. Rays run along axis a; planes are stacked along c. */
typedef struct sweep {
    const ms_mesh *mesh;
    ms_grid *grid;  /* without voxels where `take` takes the crossings */
    double cell[3]; /* sides of its voxels */
    double off[3];  /* of the middle of the mesh's box from that of the grid, in voxels */
    int a, b, c;
    int rays;   /* rays per voxel along b and along c */
    int parity; /* 0: inside by coverage; 1: sets bit a by the parity of crossings */
    ms_sweep_taker *take;
    void *context;
    vertex *vertices;
    size_t *plane_start;      /* n[c] + 1 offsets into plane_triangle */
    uint32_t *plane_triangle; /* the triangles that touch each plane's rays */
} sweep;

/* What one thread needs for one plane. */
typedef struct plane_work {
    int32_t *lines;  /* rows of voxels: what each is covered by, as steps along the row */
    uint32_t *start; /* of each ray, into sorted; one more at the end */
    ms_crossing *found, *sorted;
    size_t count, capacity; /* before the first crossing there is no array of them to point into */
    int out_of_memory;
} plane_work;

static void sweep_free(sweep *s)
{
    free(s->vertices);
    free(s->plane_start);
    free(s->plane_triangle);
}

/* @param from the centre of the box, voxels */
static int32_t place_across(const sweep *s, int axis, double from)
{
    return (int32_t)(rint(from * ACROSS) + (s->grid->n[axis] - 1) * (ACROSS / 2) + rint(s->off[axis] * ACROSS));
}

/* Measured from the centre of the box, so that mirrored vertices round to mirrored places. */
static void place_vertices(sweep *s)
{
    double lo[3], hi[3], centre[3];
    ms_mesh_box(lo, hi, s->mesh);
    for (int a = 0; a < 3; a++) {
        centre[a] = lo[a] + 0.5 * (hi[a] - lo[a]);
    }
    for (size_t v = 0; v < s->mesh->n_vertices; v++) {
        const double *p = s->mesh->vertex[v];
        double b = (p[s->b] - centre[s->b]) / s->cell[s->b], c = (p[s->c] - centre[s->c]) / s->cell[s->c];
        s->vertices[v].b = place_across(s, s->b, b);
        s->vertices[v].c = place_across(s, s->c, c);
        s->vertices[v].a = (p[s->a] - centre[s->a]) / s->cell[s->a] + 0.5 * s->grid->n[s->a] + s->off[s->a];
    }
}

static int floor_div(int64_t value, int64_t divisor)
{
    return (int)(value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor));
}

static size_t rays_of_plane(const sweep *s)
{
    return (size_t)s->grid->n[s->b] * (size_t)s->rays * (size_t)s->rays;
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

/* Which of the four rays infinitely near the given one pass through the triangle. */
static int near_rays_inside(const int64_t e[3], const int64_t db[3], const int64_t dc[3], int positive)
{
    int inside = 0;
    for (int near = 0; near < MS_SWEEP_NEAR_RAYS; near++) {
        const int sb = near & 1 ? 1 : -1, sc = near & 2 ? 1 : -1;
        int in = 1;
        for (int m = 0; m < 3; m++) {
            int side = e[m] != 0 ? e[m] > 0 : shifted_side(db[m], dc[m], sb, sc);
            in &= side == positive;
        }
        inside |= in << near;
    }
    return inside;
}

/* Keeps a crossing at x, in voxels from the outer face of the first. */
static void add_crossing(plane_work *w, uint32_t ray, double x, int sign, int near)
{
    if (w->count == w->capacity) {
        const size_t capacity = 2 * w->capacity + 1024;
        ms_crossing *found = realloc(w->found, capacity * sizeof *found);
        w->found = found ? found : w->found;
        ms_crossing *sorted = found ? realloc(w->sorted, capacity * sizeof *sorted) : NULL;
        w->sorted = sorted ? sorted : w->sorted;
        if (!sorted) {
            w->out_of_memory = 1;
            return;
        }
        w->capacity = capacity;
    }
    w->found[w->count++] =
        (ms_crossing){.ray = ray, .at = (int32_t)rint(x * MS_SWEEP_ALONG), .sign = (int8_t)sign, .near = (uint8_t)near};
}

/* By parity the row holds which voxel centres see the last of the near rays change sides. */
static void flip_beyond(int32_t *row, double x)
{
    row[(int)ceil(x - 0.5)] ^= 1;
}

/* From `at` on, so many near rays more (or fewer) run in matter. */
static void cover_beyond(int32_t *row, const sweep *s, int32_t at, int weight)
{
    int voxel = at >> MS_SWEEP_ALONG_BITS, part = at & (MS_SWEEP_ALONG - 1);
    if (s->rays == 1) {
        /* Only the centre counts; a face right through it covers it half. */
        part = part < MS_SWEEP_ALONG / 2 ? 0 : part == MS_SWEEP_ALONG / 2 ? MS_SWEEP_ALONG / 2 : MS_SWEEP_ALONG;
    }
    row[voxel] += weight * (MS_SWEEP_ALONG - part);
    row[voxel + 1] += weight * part;
}

static int by_place(const void *first, const void *second)
{
    const ms_crossing *a = first, *b = second;
    return (a->at > b->at) - (a->at < b->at);
}

/* Crossings of one ray; their order at one place does not matter. They are few, but for heaps of bodies. */
static void sort_along(ms_crossing *c, size_t count)
{
    if (count > 16) {
        qsort(c, count, sizeof *c, by_place);
        return;
    }
    for (size_t m = 1; m < count; m++) {
        const ms_crossing here = c[m];
        size_t to = m;
        for (; to > 0 && c[to - 1].at > here.at; to--) {
            c[to] = c[to - 1];
        }
        c[to] = here;
    }
}

/* Sorts the crossings by ray, and those of a ray along it. */
static void sort_crossings(plane_work *w, size_t rays)
{
    memset(w->start, 0, (rays + 1) * sizeof *w->start);
    for (size_t m = 0; m < w->count; m++) {
        w->start[w->found[m].ray + 1]++;
    }
    for (size_t ray = 0; ray < rays; ray++) {
        w->start[ray + 1] += w->start[ray];
    }
    for (size_t m = w->count; m-- > 0;) { /* fills each ray's part from its end, and moves the ends to the starts */
        w->sorted[--w->start[w->found[m].ray + 1]] = w->found[m];
    }
    memmove(w->start, w->start + 1, rays * sizeof *w->start);
    w->start[rays] = (uint32_t)w->count;
    for (size_t ray = 0; ray < rays; ray++) {
        sort_along(w->sorted + w->start[ray], w->start[ray + 1] - w->start[ray]);
    }
}

/* Matter begins where the winding number of a near ray rises above zero and ends where it
 * falls back, however many bodies overlap between. */
static void cover_rays(plane_work *w, const sweep *s)
{
    const size_t across = (size_t)s->grid->n[s->b] * (size_t)s->rays, row_length = (size_t)s->grid->n[s->a] + 1;
    sort_crossings(w, rays_of_plane(s));
    for (size_t ray = 0; ray < rays_of_plane(s); ray++) {
        int32_t *row = w->lines + ray % across / (size_t)s->rays * row_length;
        int winding[MS_SWEEP_NEAR_RAYS] = {0}, covered = 0;
        for (size_t m = w->start[ray]; m < w->start[ray + 1]; m++) {
            const ms_crossing *c = &w->sorted[m];
            int now = 0;
            for (int near = 0; near < MS_SWEEP_NEAR_RAYS; near++) {
                winding[near] += c->near >> near & 1 ? c->sign : 0;
                now += winding[near] > 0;
            }
            if (now != covered) {
                cover_beyond(row, s, c->at, now - covered);
            }
            covered = now;
        }
    }
}

/* The stretch of the row of rays at height c that the triangle may cover, widened a little:
 * the exact test decides. */
static int covered_stretch(int64_t *lo, int64_t *hi, const vertex *const v[3], int64_t c)
{
    double least = HUGE_VAL, most = -HUGE_VAL;
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
    if (!(least <= most)) {
        return 0;
    }
    *lo = (int64_t)least - 1;
    *hi = (int64_t)most + 1;
    return 1;
}

/* All rays of one row (number ray_c, at height c) through one triangle. */
static void cross_row(plane_work *w, const sweep *s, const vertex *const v[3], int ray_c, int64_t c)
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
    const int across = s->grid->n[s->b] * s->rays;
    const size_t row_length = (size_t)s->grid->n[s->a] + 1;
    for (int r = first; r <= last; r++) {
        int inside = ALL_NEAR;
        if (e[0] == 0 || e[1] == 0 || e[2] == 0) {
            inside = near_rays_inside(e, db, dc, positive);
        } else if ((e[0] > 0) != positive || (e[1] > 0) != positive || (e[2] > 0) != positive) {
            inside = 0;
        }
        if (inside) {
            double x =
                v[0]->a + ((double)e[1] * (v[1]->a - v[0]->a) + (double)e[2] * (v[2]->a - v[0]->a)) / (double)area;
            if (!s->parity) {
                add_crossing(w, (uint32_t)(r + across * ray_c), x, sign, inside);
            } else if (inside & LAST_NEAR) { /* parities cannot be shared out: one of the four decides */
                flip_beyond(w->lines + (size_t)r * row_length, x);
            }
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
    const int32_t full = s->rays * s->rays * MS_SWEEP_NEAR_RAYS * MS_SWEEP_ALONG;
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

static void sweep_plane(plane_work *w, const sweep *s, int plane)
{
    const int *n = s->grid->n;
    memset(w->lines, 0, (size_t)n[s->b] * ((size_t)n[s->a] + 1) * sizeof *w->lines);
    w->count = 0;
    for (size_t at = s->plane_start[plane]; at < s->plane_start[plane + 1]; at++) {
        const uint32_t *t = s->mesh->triangle[s->plane_triangle[at]];
        const vertex *v[3] = {&s->vertices[t[0]], &s->vertices[t[1]], &s->vertices[t[2]]};
        for (int ray = 0; ray < s->rays; ray++) {
            cross_row(w, s, v, ray, ray_first(s) + ((int64_t)plane * s->rays + ray) * ray_step(s));
        }
    }
    if (w->out_of_memory) {
        return;
    }
    if (s->take) {
        if (w->count > 0) {
            sort_crossings(w, rays_of_plane(s));
            s->take(s->context, plane, w->sorted, w->start);
        }
        return;
    }
    if (w->count > 0) {
        cover_rays(w, s);
    }
    emit_plane(w->lines, s, plane);
}

static plane_work plane_work_alloc(const sweep *s)
{
    const size_t across = (size_t)s->grid->n[s->b];
    plane_work w = {.lines = malloc(across * ((size_t)s->grid->n[s->a] + 1) * sizeof *w.lines),
                    .start = malloc((rays_of_plane(s) + 1) * sizeof *w.start)};
    w.out_of_memory = !w.lines || !w.start;
    return w;
}

static void plane_work_free(plane_work *w)
{
    free(w->lines);
    free(w->start);
    free(w->found);
    free(w->sorted);
}

static ms_status sweep_planes(const sweep *s, ms_error *err)
{
    const int worth_it = s->take || ms_grid_voxels(s->grid) >= MS_GRID_THREADS_FROM;
    int out_of_memory = 0;
#pragma omp parallel reduction(| : out_of_memory) if (worth_it)
    {
        plane_work w = plane_work_alloc(s);
#pragma omp for schedule(dynamic, 4)
        for (int plane = 0; plane < s->grid->n[s->c]; plane++) {
            if (!w.out_of_memory) {
                sweep_plane(&w, s, plane);
            }
        }
        out_of_memory = w.out_of_memory;
        plane_work_free(&w);
    }
    return out_of_memory ? ms_fail(err, MS_ERR_NOMEM, "no memory for planes of %dx%d voxels; use fewer cells",
                                   s->grid->n[s->a], s->grid->n[s->b])
                         : MS_OK;
}

static ms_status execute_sweep(sweep *s, ms_error *err)
{
    s->b = (s->a + 1) % 3;
    s->c = (s->a + 2) % 3;
    s->vertices = malloc(s->mesh->n_vertices * sizeof *s->vertices);
    s->plane_start = calloc((size_t)s->grid->n[s->c] + 1, sizeof *s->plane_start);
    if (!s->vertices || !s->plane_start) {
        sweep_free(s);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to voxelise %zu vertices", s->mesh->n_vertices);
    }
    place_vertices(s);
    ms_status status = sort_into_planes(s, err);
    if (status == MS_OK) {
        status = sweep_planes(s, err);
    }
    sweep_free(s);
    return status;
}

ms_status ms_sweep(ms_grid *grid, const ms_mesh *mesh, const double off[3], int axis, int rays, int parity,
                   ms_error *err)
{
    sweep s = {.mesh = mesh,
               .grid = grid,
               .cell = {grid->h, grid->h, grid->h},
               .off = {off[0], off[1], off[2]},
               .a = axis,
               .rays = rays,
               .parity = parity};
    return execute_sweep(&s, err);
}

ms_status ms_sweep_crossings(const ms_mesh *mesh, const int n[3], const double cell[3], int rays, ms_sweep_taker *take,
                             void *context, ms_error *err)
{
    ms_grid lattice = {.n = {n[0], n[1], n[2]}};
    sweep s = {.mesh = mesh,
               .grid = &lattice,
               .cell = {cell[0], cell[1], cell[2]},
               .rays = rays,
               .take = take,
               .context = context};
    return execute_sweep(&s, err);
}
