/*
 * J.-F. Ferellec, G. R. McDowell, A method to model realistic particle shape and inertia in DEM, Granular Matter 12
 * (2010) 459. docs/methods/ferellec.md says what was left open and how it was decided.
 */
#include "ms_generator_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "base/ms_vector.h"
#include "mesh/ms_closest.h"
#include "shared/ms_nested.h"
#include "shared/ms_nodes.h"

enum { TOLERANCE, DISTANCE, VERTICES_MET };

static const ms_option OPTIONS[] = {
    [TOLERANCE] = {"tolerance", MS_OPTION_REAL, 0.5, 0.01, 100, NULL, "voxels",
                   "a sphere leaves the surface by no more than this"},
    [DISTANCE] = {"distance", MS_OPTION_REAL, 0.5, 0, 100, NULL, "voxels",
                  "a vertex in a sphere, or no farther from it than this, is met"},
    [VERTICES_MET] = {"vertices-met", MS_OPTION_REAL, 1, 0, 1, NULL, NULL, "ends when this share of vertices is met"},
    {0},
};

/* Steps of the search for a radius at most; a handful does as a rule. */
enum { MOST_STEPS = 100 };

/* The search ends when the sphere leaves the surface by no more than this, in voxels, above the tolerance. */
static const double EXACT = 1e-7;

/* Surface points, in voxels, and what has become of them. */
typedef struct ferellec {
    const ms_run *run;
    size_t count;
    double (*at)[3];
    double (*normal)[3]; /* outward; 0 where there is none */
    uint8_t *met;
    size_t n_met;
    size_t *order, next;
    int dropped;    /* nonzero: some spheres were smaller than the least radius */
    ms_nodes nodes; /* of a volume: the same points, to search */
    double beyond;  /* from a point to the surface: half a voxel for a volume, whose points are voxels */
} ferellec;

static void scale_to_unit(double v[3])
{
    const double length = sqrt(ms_dot(v, v));
    for (int a = 0; a < 3; a++) {
        v[a] = length > 0 ? v[a] / length : 0;
    }
}

/* Adds the normal of a triangle, weighted with its angle at each corner, to its corners. */
static void add_normals(double (*normal)[3], const ms_mesh *mesh, size_t triangle)
{
    const uint32_t *corner = mesh->triangle[triangle];
    for (int c = 0; c < 3; c++) {
        const double *p = mesh->vertex[corner[c]], *q = mesh->vertex[corner[(c + 1) % 3]],
                     *r = mesh->vertex[corner[(c + 2) % 3]];
        const double u[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, v[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
        double across[3];
        ms_cross(across, u, v);
        const double twice = sqrt(ms_dot(across, across)), angle = atan2(twice, ms_dot(u, v));
        for (int a = 0; a < 3 && twice > 0; a++) {
            normal[corner[c]][a] += angle * across[a] / twice;
        }
    }
}

/* From a voxel of the border to those outside among its 26 neighbours. */
static void find_voxel_normal(double normal[3], const ms_grid *grid, const double at[3])
{
    for (int n = 0; n < 27; n++) {
        const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        const size_t other = ms_grid_index(grid, (int)at[0] + step[0], (int)at[1] + step[1], (int)at[2] + step[2]);
        for (int a = 0; a < 3 && !grid->inside[other]; a++) {
            normal[a] += step[a];
        }
    }
}

/* The vertices of the mesh, or the border's voxels, and their normals. */
static void find_points(ferellec *f)
{
    const ms_target *target = f->run->target;
    for (size_t p = 0; p < f->count; p++) {
        if (target->mesh) {
            ms_grid_at(f->at[p], &target->grid, target->mesh->vertex[p]);
        } else {
            memcpy(f->at[p], f->nodes.at[p], sizeof *f->at);
            find_voxel_normal(f->normal[p], &target->grid, f->at[p]);
        }
    }
    for (size_t t = 0; target->mesh && t < target->mesh->n_triangles; t++) {
        add_normals(f->normal, target->mesh, t);
    }
    for (size_t p = 0; p < f->count; p++) {
        scale_to_unit(f->normal[p]);
    }
}

/* Any order, each with the same chance (Fisher & Yates). */
static void shuffle_points(ferellec *f, gsl_rng *random)
{
    for (size_t p = 0; p < f->count; p++) {
        const size_t other = (size_t)(gsl_rng_uniform(random) * (double)(p + 1));
        f->order[p] = f->order[other];
        f->order[other] = p;
    }
}

static ms_status open_points(ferellec *f, ms_error *err)
{
    const ms_target *target = f->run->target;
    ms_status status = target->mesh ? MS_OK : ms_nodes_of_target(&f->nodes, target, err);
    if (status != MS_OK) {
        return status;
    }
    f->count = target->mesh ? target->mesh->n_vertices : f->nodes.count;
    f->beyond = target->mesh ? 0 : 0.5;
    gsl_rng *random = ms_random_new((unsigned long)f->run->seed);
    f->at = malloc(f->count * sizeof *f->at);
    f->normal = calloc(f->count, sizeof *f->normal);
    f->met = calloc(f->count, sizeof *f->met);
    f->order = calloc(f->count, sizeof *f->order);
    if (f->at && f->normal && f->met && f->order && random) {
        find_points(f);
        shuffle_points(f, random);
    } else {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu vertices", f->count);
    }
    ms_random_free(random);
    return status;
}

static void close_points(ferellec *f)
{
    free(f->at);
    free(f->normal);
    free(f->met);
    free(f->order);
    ms_nodes_free(&f->nodes);
}

/* The point of the surface, or of a volume's border, that is nearest. @return its distance */
static double find_nearest(double nearest[3], const ferellec *f, const double place[3])
{
    const ms_target *target = f->run->target;
    double distance, from[3], to[3];
    if (!target->mesh) {
        memcpy(nearest, f->nodes.at[ms_nodes_nearest(&distance, &f->nodes, place, MS_NORM_EUCLIDEAN)], sizeof to);
        return distance;
    }
    ms_grid_place(from, &target->grid, place);
    distance = ms_closest_distance(to, target->closest, from, HUGE_VAL);
    ms_grid_at(nearest, &target->grid, to);
    return distance / target->grid.h;
}

/*
 * The largest sphere that touches the surface at a point p, on the side away from the unit normal N, and leaves the
 * surface by no more than t: |q - p + r N| >= r - t for each point q of the surface, or, with e = q - p and
 * s = -e.N - t > 0, r <= (e^2 - t^2) / (2 s). From a sphere that is too large on, the point nearest to the centre
 * bounds the radius (as in the shrinking balls of Ma, Bae & Choi, Vis. Comput. 28 (2012) 7, where t is 0).
 */
static double shrink_radius(double centre[3], const ferellec *f, const double p[3], const double normal[3], double t)
{
    const int *n = f->run->target->grid.n;
    double radius = n[0] + n[1] + n[2];
    for (int step = 0; step < MOST_STEPS; step++) {
        double q[3];
        for (int a = 0; a < 3; a++) {
            centre[a] = p[a] - radius * normal[a];
        }
        const double distance = find_nearest(q, f, centre);
        const double e[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, s = -ms_dot(e, normal) - t;
        if (distance >= radius - t - EXACT || s <= 0) {
            break;
        }
        radius = (ms_dot(e, e) - t * t) / (2 * s);
    }
    return radius;
}

/* The sphere of a point; 0 if there is none. A voxel with as much outside on either side has one about itself. */
static int fit_ball(ms_ball *ball, const ferellec *f, size_t point)
{
    const double *normal = f->normal[point];
    double touching[3];
    if (ms_dot(normal, normal) == 0) {
        memcpy(ball->centre, f->at[point], sizeof ball->centre);
        ball->radius = f->beyond;
        return ball->radius > 0;
    }
    for (int a = 0; a < 3; a++) {
        touching[a] = f->at[point][a] + f->beyond * normal[a];
    }
    ball->radius = shrink_radius(ball->centre, f, touching, normal, f->run->settings->value[TOLERANCE] + f->beyond);
    return ms_grid_holds(&f->run->target->grid, ball->centre);
}

static void meet_points(ferellec *f, const ms_ball *ball)
{
    const double reach = ball->radius + f->run->settings->value[DISTANCE];
    for (size_t p = 0; p < f->count; p++) {
        if (!f->met[p] && ms_squared_distance(f->at[p], ball->centre) <= reach * reach) {
            f->met[p] = 1;
            f->n_met++;
        }
    }
}

/* The sphere of the next point that is not met yet; ms_nested_choose. */
static ms_status choose_unmet(void *context, ms_ball *ball, ms_stop_reason *reason, const ms_raster *placed,
                              ms_error *err)
{
    ferellec *f = context;
    const double least = f->run->stop.radius / f->run->target->grid.h;
    const double wanted = f->run->settings->value[VERTICES_MET] * (double)f->count;
    (void)placed, (void)err;
    while (f->next < f->count && (double)f->n_met < wanted) {
        const size_t point = f->order[f->next++];
        if (f->met[point] || !fit_ball(ball, f, point)) {
            continue;
        }
        if (ball->radius < least) {
            f->dropped = 1;
            continue;
        }
        meet_points(f, ball);
        return MS_OK;
    }
    *reason = f->dropped && (double)f->n_met < wanted ? MS_STOP_RADIUS : MS_STOP_EXHAUSTED;
    return MS_OK;
}

static ms_status generate_by_ferellec(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    ferellec f = {.run = run};
    ms_status status = open_points(&f, err);
    if (status == MS_OK) {
        status = ms_nested_run(clump, reason, run, choose_unmet, &f, err);
    }
    close_points(&f);
    return status;
}

const ms_generator ms_generator_ferellec = {
    .name = "ferellec",
    .summary = "baseline: from vertices of the surface inward, the largest sphere that hardly leaves it",
    .source = "J.-F. Ferellec, G. R. McDowell, Granular Matter 12 (2010) 459",
    .nested = 1,
    .baseline = 1,
    .options = OPTIONS,
    .generate = generate_by_ferellec,
};
