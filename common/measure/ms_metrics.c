#include "ms_metrics.h"

#include <math.h>
#include <omp.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_surface.h"
#include "voxel/ms_cut_cells.h"
#include "voxel/ms_raster.h"

ms_score ms_metrics_score(const ms_tally *sum, size_t target_voxels)
{
    const double target = (double)target_voxels, inside = (double)sum->inside, outside = (double)sum->outside;
    return (ms_score){
        .eta = (target - inside + outside) / target,
        .dice = 1 - 2 * inside / (target + inside + outside),
        .coverage = inside / target,
        .overshoot = outside / target,
        .off_volume = (inside + outside) / target,
        .inertia = (double)NAN,
        .coverage_cut = (double)NAN,
    };
}

/* Is the principal moment of this rank far enough from the others for its axis to mean something? */
static int axis_is_determined(const double moment[3], int rank)
{
    for (int other = 0; other < 3; other++) {
        if (other != rank && fabs(moment[other] - moment[rank]) <= 0.01 * moment[2]) {
            return 0;
        }
    }
    return 1;
}

static double axis_angle(const double a[3], const double b[3])
{
    const double cosine = fabs(ms_dot(a, b));
    return MS_VECTOR_DEGREES * acos(fmin(1, cosine));
}

ms_status ms_metrics_compare_inertia(ms_inertia_error *error, const ms_body *body, const ms_body *target, ms_error *err)
{
    ms_principal p, q;
    double difference = 0, total = 0, away = 0;
    memset(error, 0, sizeof *error);
    if (!(body->volume > 0) || !(target->volume > 0)) {
        return ms_fail(err, MS_ERR_SHAPE, "a body without volume has no inertia to compare");
    }
    ms_status status = ms_inertia_principal(&p, body, err);
    if (status == MS_OK) {
        status = ms_inertia_principal(&q, target, err);
    }
    if (status != MS_OK) {
        return status;
    }
    for (int m = 0; m < 3; m++) {
        error->moment[m] = p.moment[m] / q.moment[m] - 1;
        difference += fabs(p.moment[m] - q.moment[m]);
        total += q.moment[m];
        if (axis_is_determined(p.moment, m) && axis_is_determined(q.moment, m)) {
            error->angle = fmax(error->angle, axis_angle(p.axis[m], q.axis[m]));
        }
        away += (body->centroid[m] - target->centroid[m]) * (body->centroid[m] - target->centroid[m]);
    }
    error->weighted = difference / total;
    error->centre = sqrt(away) / cbrt(target->volume * 3 / (4 * acos(-1.0)));
    return MS_OK;
}

/* Does the clump fit into the grid? */
static int within_grid(const ms_grid *grid, const double lo[3], const double hi[3])
{
    for (int a = 0; a < 3; a++) {
        if (lo[a] < grid->origin[a] || hi[a] > grid->origin[a] + grid->h * (grid->n[a] - 1)) {
            return 0;
        }
    }
    return 1;
}

ms_score ms_metrics_full_score(const ms_tally *sum, const ms_grid *grid, const ms_target *target)
{
    ms_body body;
    ms_inertia_error error;
    ms_score score = ms_metrics_score(sum, target->voxels);
    ms_tally_body(&body, sum, grid);
    if (body.volume > 0 && ms_metrics_compare_inertia(&error, &body, &target->body, NULL) == MS_OK) {
        score.inertia = error.weighted;
    }
    if (target->grid.cells) {
        score.coverage_cut = (double)sum->cut / (double)target->grid.cells->total;
    }
    return score;
}

static ms_status count_union(ms_metrics *metrics, ms_score *curve, const ms_grid *grid, const ms_target *target,
                             const ms_clump *clump, ms_error *err)
{
    ms_raster raster;
    ms_tally sum = {0};
    ms_ball *balls = malloc(clump->n_spheres * sizeof *balls);
    if (!balls) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", clump->n_spheres);
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        balls[s] = ms_grid_ball(grid, &clump->sphere[s]);
    }
    ms_status status = ms_raster_alloc(&raster, grid, target->rule, err);
    if (status == MS_OK) {
        status = ms_raster_add(&raster, balls, clump->n_spheres, err);
    }
    for (size_t s = 0; status == MS_OK && s < clump->n_spheres; s++) {
        ms_tally_add(&sum, &raster.tally[s]);
        if (curve) {
            curve[s] = ms_metrics_full_score(&sum, grid, target);
        }
    }
    metrics->score = ms_metrics_full_score(&sum, grid, target);
    ms_tally_body(&metrics->body, &sum, grid);
    ms_raster_free(&raster);
    free(balls);
    return status;
}

static ms_status count_on_fitting_grid(ms_metrics *metrics, ms_score *curve, const ms_target *target,
                                       const ms_clump *clump, size_t max_voxels, ms_error *err)
{
    double lo[3], hi[3];
    memset(metrics, 0, sizeof *metrics);
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_ARG, "a clump without spheres cannot be measured");
    }
    ms_clump_box(lo, hi, clump);
    if (within_grid(&target->grid, lo, hi)) {
        return count_union(metrics, curve, &target->grid, target, clump, err);
    }
    ms_grid larger;
    ms_status status = ms_grid_enlarge(&larger, &target->grid, lo, hi, max_voxels, err);
    if (status == MS_OK) {
        status = count_union(metrics, curve, &larger, target, clump, err);
    }
    ms_grid_free(&larger);
    return status;
}

/* Measures of these kinds are not known until they are computed. */
#define FORGET_GOAL(name)
#define FORGET_UNION(name)
#define FORGET_SURFACE(name) metrics->name = (double)NAN;
#define FORGET_NORMAL(name) metrics->name = (double)NAN;
#define FORGET_SPHERES(name)
#define FORGET_COUNT(name)
#define FORGET_DESCRIPTOR(name) metrics->name = (double)NAN;
#define FORGET(kind, CODE, name, ...) FORGET_##kind(name)
static void forget_kinds(ms_metrics *metrics)
{
    MS_MEASURE_LIST(FORGET)
}

static void take_normals(ms_metrics *metrics, const ms_normals *normals)
{
    metrics->normal_median = normals->median;
    metrics->normal_95 = normals->most;
    metrics->edge_part = normals->edge_part;
    metrics->edge_normal_median = normals->edge_median;
    metrics->edge_normal_95 = normals->edge_most;
}

/* Which side of an open mesh is outside is not known. */
static ms_status measure_exposed(ms_metrics *metrics, unsigned kinds, const ms_target *target,
                                 const ms_clump_near *near, ms_error *err)
{
    const int protrudes = (kinds & MS_METRICS_KIND(SURFACE)) && target->mesh,
              inclined = kinds & MS_METRICS_KIND(NORMAL);
    ms_standout protrusion;
    ms_normals normals;
    if (!target->closed || (!protrudes && !inclined)) {
        return MS_OK;
    }
    const ms_status status =
        ms_surface_exposed(protrudes ? &protrusion : NULL, inclined ? &normals : NULL, target, near, err);
    if (status == MS_OK && protrudes) {
        metrics->protrusion_max = protrusion.max;
        metrics->protrusion_rms = protrusion.rms;
    }
    if (status == MS_OK && inclined) {
        take_normals(metrics, &normals);
    }
    return status;
}

static ms_status measure_gap(ms_metrics *metrics, const ms_target *target, const ms_clump_near *near, ms_error *err)
{
    ms_standout gap;
    const ms_status status = ms_surface_gap(&gap, target, near, err);
    if (status == MS_OK) {
        metrics->gap_max = gap.max;
        metrics->gap_rms = gap.rms;
    }
    return status;
}

/* What lies between the surfaces: both ways. */
static ms_status measure_surfaces(ms_metrics *metrics, unsigned kinds, const ms_target *target, const ms_clump *clump,
                                  ms_error *err)
{
    ms_clump_near near;
    if (!(kinds & (MS_METRICS_KIND(SURFACE) | MS_METRICS_KIND(NORMAL)))) {
        return MS_OK;
    }
    ms_status status = ms_clump_near_build(&near, clump, target->mesh, err);
    if (status == MS_OK) {
        status = measure_exposed(metrics, kinds, target, &near, err);
    }
    if (status == MS_OK && (kinds & MS_METRICS_KIND(SURFACE)) && target->mesh) {
        status = measure_gap(metrics, target, &near, err);
    }
    ms_clump_near_free(&near);
    return status;
}

/* With cut cells, if the target asks for them and has none. */
static ms_status count_with_cells(ms_metrics *metrics, ms_score *curve, const ms_target *target, const ms_clump *clump,
                                  size_t max_voxels, ms_error *err)
{
    ms_target cut = *target;
    ms_cut_cells *cells = NULL;
    ms_status status = MS_OK;
    if (target->count_cut && !cut.grid.cells) {
        status = ms_cut_cells_build(&cells, &target->grid, target->closed ? target->mesh : NULL, err);
        cut.grid.cells = cells;
    }
    if (status == MS_OK) {
        status = count_on_fitting_grid(metrics, curve, &cut, clump, max_voxels, err);
    }
    ms_cut_cells_free(cells);
    return status;
}

ms_status ms_metrics_score_clump(ms_score *score, ms_score *curve, const ms_target *target, const ms_clump *clump,
                                 size_t max_voxels, ms_error *err)
{
    ms_metrics metrics = {0};
    const ms_status status = count_with_cells(&metrics, curve, target, clump, max_voxels, err);
    *score = metrics.score;
    return status;
}

/* The descriptors of a shape. The hull of a mesh is work for one thread: where there are several, for one beside all
 * else that is measured. */
typedef struct shape_errand {
    const ms_target *target; /* NULL: not wanted */
    ms_descriptors of;
    ms_status status;
    ms_error err;
    int is_apart;
    pthread_t thread;
} shape_errand;

static void *describe_shape(void *argument)
{
    shape_errand *e = argument;
    e->status = ms_descriptors_of_target(&e->of, e->target, &e->err);
    return NULL;
}

static void *describe_shape_apart(void *argument)
{
    omp_set_num_threads(1);
    return describe_shape(argument);
}

static void begin_errand(shape_errand *e, unsigned kinds, const ms_target *target)
{
    e->target = kinds & MS_METRICS_KIND(DESCRIPTOR) ? target : NULL;
    e->is_apart = e->target && target->mesh && !target->descriptors && !omp_in_parallel() &&
                  omp_get_max_threads() > 1 && pthread_create(&e->thread, NULL, describe_shape_apart, e) == 0;
}

/* @param status so far: after a failure nothing is begun any more */
static ms_status end_errand(shape_errand *e, ms_status status, ms_error *err)
{
    if (e->is_apart) {
        pthread_join(e->thread, NULL);
    }
    if (status != MS_OK || !e->target) {
        return status;
    }
    if (e->target->descriptors) {
        e->of = *e->target->descriptors;
        return MS_OK;
    }
    if (!e->is_apart) {
        describe_shape(e);
    }
    return e->status == MS_OK ? MS_OK : ms_fail(err, e->status, "%s", e->err.text);
}

/* After the body of the union. */
static ms_status describe(ms_metrics *metrics, const ms_descriptors *of_shape, const ms_target *target,
                          const ms_clump *clump, ms_error *err)
{
    ms_descriptors of_clump;
    const ms_status status = ms_descriptors_of_clump(&of_clump, clump, &metrics->body, err);
    if (status == MS_OK) {
        metrics->voxel_limit = ms_descriptors_voxel_limit(of_shape, target->grid.h);
#define TAKE(X, CODE, name, ...)            \
    metrics->shape_##name = of_shape->name; \
    metrics->clump_##name = of_clump.name;
        MS_DESCRIPTOR_LIST(TAKE, )
#undef TAKE
    }
    return status;
}

static ms_status measure_spheres(ms_metrics *metrics, const ms_target *target, const ms_clump *clump, ms_error *err)
{
    metrics->spheres = clump->n_spheres;
    metrics->smallest_radius_ratio = ms_clump_smallest_radius(clump) / ms_target_equivalent_radius(target);
    metrics->work = (double)clump->n_spheres / metrics->smallest_radius_ratio;
    return ms_clump_pieces(&metrics->pieces, clump, err);
}

ms_status ms_metrics_compute_kinds(ms_metrics *metrics, ms_score *curve, unsigned kinds, const ms_target *target,
                                   const ms_clump *clump, size_t max_voxels, ms_error *err)
{
    memset(metrics, 0, sizeof *metrics);
    shape_errand shape;
    begin_errand(&shape, kinds, target);
    ms_status status = count_with_cells(metrics, curve, target, clump, max_voxels, err);
    forget_kinds(metrics);
    if (status == MS_OK) {
        status = measure_spheres(metrics, target, clump, err);
    }
    if (status == MS_OK) {
        status = measure_surfaces(metrics, kinds, target, clump, err);
    }
    status = end_errand(&shape, status, err);
    if (status == MS_OK && shape.target) {
        status = describe(metrics, &shape.of, target, clump, err);
    }
    if (status == MS_OK && metrics->body.volume > 0) {
        status = ms_metrics_compare_inertia(&metrics->inertia, &metrics->body, &target->body, err);
    } else {
        const double unknown = (double)NAN;
        metrics->inertia = (ms_inertia_error){{unknown, unknown, unknown}, unknown, unknown, unknown};
    }
    return status;
}

ms_status ms_metrics_compute(ms_metrics *metrics, ms_score *curve, const ms_target *target, const ms_clump *clump,
                             size_t max_voxels, ms_error *err)
{
    return ms_metrics_compute_kinds(metrics, curve, MS_METRICS_ALL, target, clump, max_voxels, err);
}
