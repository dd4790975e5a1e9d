#include "ms_setcover_candidates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "mesh/ms_inertia.h"
#include "ms_medial.h"
#include "ms_setcover_roll.h"
#include "voxel/ms_distance.h"
#include "voxel/ms_voxelize.h"

/* A skeleton's grid of this size is allowed whatever the target's. */
static const double ALWAYS_FINE = 1 << 24;

/* ms_voxelize rounds coordinates to 2^-15 of a voxel; what is nearer to the surface may lie outside. */
static const double SURELY_INSIDE = 1.0 / (1 << 14);

/* Centres are put on the medial surface within this part of a skeleton's voxel, or of half the side of the cells that
 * they stand for: the best is looked at again. */
static const double FIT_TOLERANCE = 0.01;

/* And moved along it within this part of a voxel. */
static const double MOVE_TOLERANCE = 0.003;

/* The medial surface is less than so many of the skeleton's voxels beyond where a rolled sphere ends, mostly. */
static const double BEYOND = 1.5;

/* More than rounding adds to a distance, as a factor. */
static const double NEAR_ENOUGH = 1 + 1e-6;

static int is_by_mesh(const ms_target *target)
{
    return target->mesh && target->closed;
}

/* Axes of the skeleton's grid: p = origin + sum of q[a] axis[a]. */
typedef struct frame {
    double origin[3];
    double axis[3][3];
} frame;

static ms_status choose_frame(frame *f, const ms_target *target, int align, ms_error *err)
{
    static const frame INPUT = {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    ms_principal principal;
    *f = INPUT;
    if (!align) {
        return MS_OK;
    }
    ms_status status = ms_inertia_principal(&principal, &target->body, err);
    memcpy(f->axis, principal.axis, sizeof f->axis);
    memcpy(f->origin, target->body.centroid, sizeof f->origin);
    return status;
}

static void to_frame(double q[3], const frame *f, const double p[3])
{
    const double from[3] = {p[0] - f->origin[0], p[1] - f->origin[1], p[2] - f->origin[2]};
    for (int a = 0; a < 3; a++) {
        q[a] = ms_dot(from, f->axis[a]);
    }
}

/* The centre of a voxel of the skeleton's grid, in voxels of the target's. */
static void to_target(double out[3], const ms_grid *skeleton, const frame *f, size_t voxel, const ms_grid *grid)
{
    int at[3];
    ms_grid_voxel(at, skeleton->n, voxel);
    double p[3] = {f->origin[0], f->origin[1], f->origin[2]};
    for (int a = 0; a < 3; a++) {
        const double q = skeleton->origin[a] + skeleton->h * at[a];
        for (int c = 0; c < 3; c++) {
            p[c] += q * f->axis[a][c];
        }
    }
    ms_grid_at(out, grid, p);
}

static ms_status check_candidates(const double n[3], const ms_target *target, const ms_setcover_lattice *lattice,
                                  ms_error *err)
{
    const double voxels = n[0] * n[1] * n[2];
    if (voxels > ALWAYS_FINE && voxels > (double)ms_grid_voxels(&target->grid)) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "the skeleton's grid of %.6gx%.6gx%.6g voxels would be larger than that of the shape; use a "
                       "skeleton-deq below %g, or more cells",
                       n[0], n[1], n[2], lattice->deq);
    }
    return MS_OK;
}

/* Voxelises the mesh, turned into the frame. */
static ms_status grid_of_mesh(ms_grid *out, const ms_target *target, const frame *f, double h,
                              const ms_setcover_lattice *lattice, ms_error *err)
{
    ms_mesh turned = *target->mesh;
    double n[3];
    turned.vertex = malloc(turned.n_vertices * sizeof *turned.vertex);
    if (!turned.vertex) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to turn %zu vertices", turned.n_vertices);
    }
    for (size_t v = 0; v < turned.n_vertices; v++) {
        to_frame(turned.vertex[v], f, target->mesh->vertex[v]);
    }
    ms_voxelize_extents(n, &turned, h);
    ms_status status = check_candidates(n, target, lattice, err);
    if (status == MS_OK) {
        status = ms_voxelize(out, &turned, h, MS_VOXEL_CENTRE, err);
    }
    free(turned.vertex);
    return status;
}

/* The box of the target's voxels in the frame: of their centres. */
static void voxel_box(double lo[3], double hi[3], const ms_grid *grid, const frame *f)
{
    const uint8_t *inside = grid->inside;
    for (int a = 0; a < 3; a++) {
        lo[a] = HUGE_VAL;
        hi[a] = -HUGE_VAL;
    }
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                const double p[3] = {grid->origin[0] + grid->h * i, grid->origin[1] + grid->h * j,
                                     grid->origin[2] + grid->h * k};
                double q[3];
                if (!*inside++) {
                    continue;
                }
                to_frame(q, f, p);
                for (int a = 0; a < 3; a++) {
                    lo[a] = fmin(lo[a], q[a]);
                    hi[a] = fmax(hi[a], q[a]);
                }
            }
        }
    }
}

/* The target's voxel nearest to a place; SIZE_MAX beyond its grid. */
static size_t nearest_voxel(double place[3], const ms_grid *grid)
{
    for (int a = 0; a < 3; a++) {
        place[a] = rint(place[a]);
        if (!(place[a] >= 0 && place[a] < grid->n[a])) {
            return SIZE_MAX;
        }
    }
    return ms_grid_index(grid, (int)place[0], (int)place[1], (int)place[2]);
}

/* Samples the target's voxels on a lattice whose first point is on the first of them. */
static ms_status grid_of_voxels(ms_grid *out, const ms_target *target, const frame *f, double h,
                                const ms_setcover_lattice *lattice, ms_error *err)
{
    double lo[3], hi[3], extent[3], origin[3], place[3];
    int n[3];
    voxel_box(lo, hi, &target->grid, f);
    for (int a = 0; a < 3; a++) {
        extent[a] = floor((hi[a] - lo[a]) / h + 1e-9) + 1 + 2 * MS_GRID_HULL;
        origin[a] = lo[a] - MS_GRID_HULL * h;
    }
    ms_status status = check_candidates(extent, target, lattice, err);
    for (int a = 0; a < 3; a++) {
        n[a] = (int)fmin(extent[a], MS_GRID_MAX_EXTENT + 1); /* ms_grid_alloc refuses it */
    }
    if (status == MS_OK) {
        status = ms_grid_alloc(out, n, h, origin, err);
    }
    if (status != MS_OK) {
        return status;
    }
    const size_t voxels = ms_grid_voxels(out);
    for (size_t v = 0; v < voxels; v++) {
        to_target(place, out, f, v, &target->grid);
        const size_t nearest = nearest_voxel(place, &target->grid);
        out->inside[v] = nearest != SIZE_MAX && target->grid.inside[nearest];
    }
    return MS_OK;
}

/* The sphere about a voxel's centre as it lies. */
static void fit_candidate(ms_ball *ball, const ms_target *target, double step)
{
    const ms_grid *grid = &target->grid;
    if (is_by_mesh(target)) {
        ms_sphere sphere = ms_grid_sphere(grid, ball);
        sphere.radius = ms_closest_distance(NULL, target->closest, sphere.centre, HUGE_VAL);
        sphere.radius = sphere.radius > SURELY_INSIDE * step ? sphere.radius : 0;
        *ball = ms_grid_ball(grid, &sphere);
    } else {
        ball->radius = (double)target->distance[nearest_voxel(ball->centre, grid)] - 0.5;
    }
}

/* The maximal sphere of one that has rolled. The medial surface is looked for at first where the field saw it. */
static ms_sphere fit_start(const ms_setcover_start *start, const ms_closest *closest, double step)
{
    ms_sphere sphere = {.radius = start->distance > SURELY_INSIDE * step ? start->distance : 0};
    memcpy(sphere.centre, start->from, sizeof sphere.centre);
    if (sphere.radius > 0) {
        const double rolled = start->radius - start->distance, tolerance = FIT_TOLERANCE * fmax(step, start->scale / 2);
        sphere.radius =
            ms_medial_sphere(sphere.centre, sphere.radius, start->nearest, closest, rolled + BEYOND * step, tolerance);
    }
    return sphere;
}

/* Lists the voxels of the skeleton. */
static ms_status list_centres(ms_ball **ball, size_t *count, const ms_grid *skeleton, const frame *f,
                              const ms_grid *grid, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(skeleton);
    size_t found = 0;
    *count = ms_grid_count(skeleton);
    *ball = malloc((*count + 1) * sizeof **ball);
    if (!*ball) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu candidate spheres; use a smaller skeleton-deq", *count);
    }
    for (size_t v = 0; v < voxels; v++) {
        if (skeleton->inside[v]) {
            to_target((*ball)[found++].centre, skeleton, f, v, grid);
        }
    }
    return MS_OK;
}

/* Drops the spheres that came to nothing. */
static void drop_empty(ms_ball *ball, size_t *count)
{
    size_t kept = 0;
    for (size_t b = 0; b < *count; b++) {
        if (ball[b].radius > 0) {
            ball[kept++] = ball[b];
        }
    }
    *count = kept;
}

/* The spheres at all centres, which stay where they are. */
static void fit_all(ms_ball *ball, size_t *count, const ms_target *target, double step)
{
    const ptrdiff_t all = (ptrdiff_t)*count;
#pragma omp parallel for schedule(dynamic, 64)
    for (ptrdiff_t b = 0; b < all; b++) {
        fit_candidate(&ball[b], target, step);
    }
    drop_empty(ball, count);
}

/* Rolls spheres inward from all centres; which of them differ. */
static ms_status start_maximal(ms_setcover_pool *pool, const ms_setcover_field *field, ms_error *err)
{
    const ms_target *target = pool->target;
    pool->start = malloc((pool->count + 1) * sizeof *pool->start);
    if (!pool->start) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu candidate spheres; use a smaller skeleton-deq",
                       pool->count);
    }
    for (size_t b = 0; b < pool->count; b++) {
        ms_grid_place(pool->start[b].from, &target->grid, pool->ball[b].centre);
    }
    const ms_status status = ms_setcover_roll(pool->start, &pool->count, field, target->closest, err);
    for (size_t b = 0; status == MS_OK && b < pool->count; b++) {
        pool->ball[b].radius = 0;
    }
    return status;
}

void ms_setcover_pool_fit(const ms_setcover_pool *pool, double from, double below)
{
    const ptrdiff_t all = (ptrdiff_t)pool->count;
#pragma omp parallel for schedule(dynamic, 8)
    for (ptrdiff_t b = 0; b < all; b++) {
        if (pool->start[b].scale >= from && pool->start[b].scale < below) {
            const ms_sphere sphere = fit_start(&pool->start[b], pool->target->closest, pool->step);
            pool->ball[b] = ms_grid_ball(&pool->target->grid, &sphere);
        }
    }
}

ms_ball ms_setcover_pool_move(const ms_setcover_pool *pool, const ms_ball *ball, int axis, double by)
{
    const ms_grid *grid = &pool->target->grid;
    ms_sphere sphere = ms_grid_sphere(grid, ball);
    double nearest[3];
    sphere.centre[axis] += by * grid->h;
    sphere.radius = ms_closest_distance(nearest, pool->target->closest, sphere.centre,
                                        (sphere.radius + fabs(by) * grid->h) * NEAR_ENOUGH);
    if (sphere.radius > SURELY_INSIDE * pool->step) {
        sphere.radius = ms_medial_sphere(sphere.centre, sphere.radius, nearest, pool->target->closest, pool->step,
                                         MOVE_TOLERANCE * pool->step);
    }
    return ms_grid_ball(grid, &sphere);
}

void ms_setcover_pool_free(ms_setcover_pool *pool)
{
    free(pool->ball);
    free(pool->start);
    *pool = (ms_setcover_pool){0};
}

/* Thins the voxels; keeps those on the border, too, if asked for. */
static ms_status thin_shape(ms_grid *skeleton, ms_skeleton kind, int and_border, ms_error *err)
{
    const ptrdiff_t row = skeleton->n[0], plane = row * skeleton->n[1];
    const size_t voxels = ms_grid_voxels(skeleton);
    uint8_t *whole = malloc(voxels);
    if (!whole) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to thin %zu voxels; use a smaller skeleton-deq", voxels);
    }
    memcpy(whole, skeleton->inside, voxels);
    ms_status status = ms_thinning(skeleton->inside, skeleton->n, kind, err);
    for (size_t v = 0; status == MS_OK && and_border && v < voxels; v++) {
        const uint8_t *at = whole + v;
        if (*at && !(at[-1] & at[1] & at[-row] & at[row] & at[-plane] & at[plane])) {
            skeleton->inside[v] = 1;
        }
    }
    free(whole);
    return status;
}

/* The step of the skeleton's lattice, in the shape's unit. */
static double choose_spacing(const ms_target *target, const ms_setcover_lattice *lattice)
{
    const double h = target->grid.h, wanted = 2 * ms_target_equivalent_radius(target) / lattice->deq;
    if (is_by_mesh(target)) {
        return wanted;
    }
    return lattice->align ? fmax(h, wanted) : h * fmax(1, floor(wanted / h));
}

/* How deep the lattice's voxels lie, before they are thinned. */
static ms_status measure_depth(ms_setcover_field *field, float **depth, const ms_grid *skeleton, const frame *f,
                               ms_error *err)
{
    const size_t voxels = ms_grid_voxels(skeleton);
    *depth = malloc(voxels * sizeof **depth);
    if (!*depth) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the depth of %zu voxels; use a smaller skeleton-deq", voxels);
    }
    *field = (ms_setcover_field){.h = skeleton->h, .depth = *depth};
    memcpy(field->axis, f->axis, sizeof field->axis);
    memcpy(field->n, skeleton->n, sizeof field->n);
    for (int a = 0; a < 3; a++) {
        field->origin[a] = f->origin[a];
        for (int b = 0; b < 3; b++) {
            field->origin[a] += skeleton->origin[b] * f->axis[b][a];
        }
    }
    return ms_distance(*depth, skeleton->inside, skeleton->n, err);
}

/* The lattice's voxels from which there are spheres, and how deep all of them lie if spheres are to be rolled. */
static ms_status choose_voxels(ms_grid *skeleton, ms_setcover_field *field, float **depth, const frame *f,
                               const ms_setcover_pool *pool, const ms_setcover_lattice *lattice, ms_error *err)
{
    const ms_target *target = pool->target;
    const int by_mesh = is_by_mesh(target), maximal = by_mesh && lattice->centres != SETCOVER_ALL;
    const int medial = maximal && lattice->kind == MS_SKELETON_SURFACE && lattice->centres == SETCOVER_MEDIAL;
    ms_status status = by_mesh ? grid_of_mesh(skeleton, target, f, pool->step, lattice, err)
                               : grid_of_voxels(skeleton, target, f, pool->step, lattice, err);
    if (status == MS_OK && maximal) {
        status = measure_depth(field, depth, skeleton, f, err);
    }
    if (status == MS_OK && lattice->centres != SETCOVER_ALL) {
        status = thin_shape(skeleton, lattice->kind, medial, err);
    }
    return status;
}

ms_status ms_setcover_candidates(ms_setcover_pool *pool, const ms_target *target, const ms_setcover_lattice *lattice,
                                 ms_error *err)
{
    const int maximal = is_by_mesh(target) && lattice->centres != SETCOVER_ALL;
    ms_grid skeleton = {0};
    ms_setcover_field field;
    float *depth = NULL;
    frame f;
    *pool = (ms_setcover_pool){.target = target, .step = choose_spacing(target, lattice)};
    ms_status status = choose_frame(&f, target, lattice->align, err);
    if (status == MS_OK) {
        status = choose_voxels(&skeleton, &field, &depth, &f, pool, lattice, err);
    }
    if (status == MS_OK) {
        status = list_centres(&pool->ball, &pool->count, &skeleton, &f, &target->grid, err);
    }
    if (status == MS_OK && maximal) {
        status = start_maximal(pool, &field, err);
    } else if (status == MS_OK) {
        fit_all(pool->ball, &pool->count, target, pool->step);
    }
    ms_grid_free(&skeleton);
    free(depth);
    if (status == MS_OK && maximal && !lattice->later) {
        ms_setcover_pool_fit(pool, 0, HUGE_VAL);
        drop_empty(pool->ball, &pool->count);
        free(pool->start);
        pool->start = NULL;
    }
    return status;
}
