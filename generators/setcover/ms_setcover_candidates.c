#include "ms_setcover_candidates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "mesh/ms_inertia.h"
#include "ms_medial.h"
#include "voxel/ms_voxelize.h"

/* A skeleton's grid of this size is allowed whatever the target's. */
static const double ALWAYS_FINE = 1 << 24;

/* ms_voxelize rounds coordinates to 2^-15 of a voxel; what is nearer to the surface may lie outside. */
static const double SURELY_INSIDE = 1.0 / (1 << 14);

/* Centres are moved to the medial surface within this part of a skeleton's voxel. */
static const double MEDIAL_TOLERANCE = 0.01;

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
    const size_t nx = (size_t)skeleton->n[0], ny = (size_t)skeleton->n[1];
    const size_t at[3] = {voxel % nx, voxel / nx % ny, voxel / nx / ny};
    double p[3] = {f->origin[0], f->origin[1], f->origin[2]};
    for (int a = 0; a < 3; a++) {
        const double q = skeleton->origin[a] + skeleton->h * (double)at[a];
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

/* The sphere about a voxel's centre, in the mesh's unit: at the centre, or moved from there to the
 * medial surface. 0 where the centre may not be inside. */
static double fit_to_mesh(double centre[3], const ms_closest *closest, double step, int move)
{
    const double radius = ms_closest_distance(NULL, closest, centre, HUGE_VAL);
    if (!(radius > SURELY_INSIDE * step)) {
        return 0;
    }
    return move ? ms_medial_sphere(centre, closest, step, MEDIAL_TOLERANCE * step) : radius;
}

/* The inscribed sphere of a candidate; a centre among voxels moves onto the nearest one. */
static void fit_candidate(ms_ball *ball, const ms_target *target, double step, int move)
{
    const ms_grid *grid = &target->grid;
    if (is_by_mesh(target)) {
        ms_sphere sphere = ms_grid_sphere(grid, ball);
        sphere.radius = fit_to_mesh(sphere.centre, target->closest, step, move);
        *ball = ms_grid_ball(grid, &sphere);
    } else {
        ball->radius = (double)target->distance[nearest_voxel(ball->centre, grid)] - 0.5;
    }
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

/* The spheres at all centres; drops those that came to nothing. */
static void fit_all(ms_ball *ball, size_t *count, const ms_target *target, double step, int move)
{
    const ptrdiff_t all = (ptrdiff_t)*count;
    size_t kept = 0;
#pragma omp parallel for schedule(dynamic, 64)
    for (ptrdiff_t b = 0; b < all; b++) {
        fit_candidate(&ball[b], target, step, move);
    }
    for (size_t b = 0; b < *count; b++) {
        if (ball[b].radius > 0) {
            ball[kept++] = ball[b];
        }
    }
    *count = kept;
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

ms_status ms_setcover_candidates(ms_ball **ball, size_t *count, const ms_target *target,
                                 const ms_setcover_lattice *lattice, ms_error *err)
{
    const double step = choose_spacing(target, lattice);
    const int medial =
        is_by_mesh(target) && lattice->kind == MS_SKELETON_SURFACE && lattice->centres == SETCOVER_MEDIAL;
    ms_grid skeleton = {0};
    frame f;
    *ball = NULL;
    *count = 0;
    ms_status status = choose_frame(&f, target, lattice->align, err);
    if (status == MS_OK) {
        status = is_by_mesh(target) ? grid_of_mesh(&skeleton, target, &f, step, lattice, err)
                                    : grid_of_voxels(&skeleton, target, &f, step, lattice, err);
    }
    if (status == MS_OK && lattice->centres != SETCOVER_ALL) {
        status = thin_shape(&skeleton, lattice->kind, medial, err);
    }
    if (status == MS_OK) {
        status = list_centres(ball, count, &skeleton, &f, &target->grid, err);
    }
    if (status == MS_OK) {
        fit_all(*ball, count, target, step, lattice->centres != SETCOVER_ALL);
    }
    ms_grid_free(&skeleton);
    return status;
}
