#include "ms_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_fibonacci.h"
#include "base/ms_vector.h"
#include "mesh/ms_closest.h"

/* Triangles are taken in chunks of this size, whatever the number of threads, so that sums
 * are always made in the same order. */
enum { CHUNK = 512 };

static const double PI = 3.14159265358979323846;

/* Sums over a piece of surface. */
typedef struct part {
    double area, square, max;
} part;

static void part_add(part *sum, double area, double distance)
{
    sum->area += area;
    sum->square += area * distance * distance;
    sum->max = fmax(sum->max, distance);
}

static void join_parts(ms_standout *out, const part *parts, size_t count)
{
    part sum = {0};
    for (size_t p = 0; p < count; p++) {
        sum.area += parts[p].area;
        sum.square += parts[p].square;
        sum.max = fmax(sum.max, parts[p].max);
    }
    out->max = sum.max;
    out->rms = sum.area > 0 ? sqrt(sum.square / sum.area) : 0;
}

/* What is measured of the exposed surface. */
typedef struct exposed_job {
    const ms_target *target;
    const ms_clump_near *near;
    int protrusion;                /* wanted */
    const ms_normals_shape *shape; /* NULL: normals are not wanted */
    double unit;                   /* of area in a tally */
} exposed_job;

/* Two voxels deep, the surface is more than the voxel's own size away. */
static int is_deep(const ms_target *target, const double point[3])
{
    const ms_grid *grid = &target->grid;
    int voxel[3], in_grid = 1;
    for (int a = 0; a < 3; a++) {
        const double at = rint((point[a] - grid->origin[a]) / grid->h);
        in_grid &= at >= 0 && at < grid->n[a];
        voxel[a] = in_grid ? (int)at : 0;
    }
    return in_grid && target->distance[ms_grid_index(grid, voxel[0], voxel[1], voxel[2])] > 2.5f;
}

/* A point that stands for some area. @param normal of the sphere */
static void add_exposed(part *sum, ms_normals_tally *tally, const exposed_job *job, const double point[3],
                        const double normal[3], double area)
{
    const int outside = job->protrusion && !is_deep(job->target, point);
    double distance = 0;
    if (job->shape) {
        distance = ms_normals_add(tally, job->shape, point, normal, (uint64_t)rint(area / job->unit));
    } else if (outside) {
        distance = ms_closest_signed_distance(job->target->closest, point);
    }
    part_add(sum, area, outside ? fmax(0, distance) : 0);
}

static part sphere_part(ms_normals_tally *tally, const exposed_job *job, size_t s)
{
    const ms_sphere *sphere = &job->near->clump->sphere[s];
    const double h = job->target->grid.h, area = 4 * PI * sphere->radius * sphere->radius;
    const int samples = (int)fmin(1000, fmax(32, ceil(area / (4 * h * h))));
    part sum = {0};
    for (int m = 0; m < samples; m++) {
        double normal[3], point[3];
        ms_fibonacci(normal, m, samples);
        for (int k = 0; k < 3; k++) {
            point[k] = sphere->centre[k] + sphere->radius * normal[k];
        }
        if (!ms_clump_near_hides(job->near, point, s)) {
            add_exposed(&sum, tally, job, point, normal, area / samples);
        }
    }
    return sum;
}

/* All spheres. @param parts one for each. @return nonzero without memory */
static int sample_spheres(part *parts, ms_normals_tally *sum, const exposed_job *job)
{
    const size_t n = job->near->clump->n_spheres;
    int out_of_memory = 0;
#pragma omp parallel reduction(| : out_of_memory)
    {
        ms_normals_tally *tally = calloc(1, sizeof *tally);
        out_of_memory = !tally;
#pragma omp for schedule(dynamic, 1)
        for (size_t s = 0; s < n; s++) {
            if (tally) {
                parts[s] = sphere_part(tally, job, s);
            }
        }
        if (tally && job->shape) {
#pragma omp critical
            ms_normals_join(sum, tally);
        }
        free(tally);
    }
    return out_of_memory;
}

/* Areas are told apart down to this part of that of all spheres. */
static double find_area_unit(const ms_clump *clump)
{
    double sum = 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        sum += 4 * PI * clump->sphere[s].radius * clump->sphere[s].radius;
    }
    return ldexp(sum, -50);
}

ms_status ms_surface_exposed(ms_standout *protrusion, ms_normals *normals, const ms_target *target,
                             const ms_clump_near *near, ms_error *err)
{
    const ms_clump *clump = near->clump;
    ms_normals_shape shape = {0};
    exposed_job job = {target, near, protrusion != NULL, normals ? &shape : NULL, find_area_unit(clump)};
    part *parts = calloc(clump->n_spheres + 1, sizeof *parts);
    ms_normals_tally *tally = calloc(1, sizeof *tally);
    ms_status status = MS_OK;
    if (normals) {
        status = ms_normals_open(&shape, target, ms_clump_smallest_radius(clump), err);
    }
    if (status == MS_OK && (!parts || !tally || sample_spheres(parts, tally, &job))) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to measure %zu spheres", clump->n_spheres);
    }
    if (status == MS_OK && protrusion) {
        join_parts(protrusion, parts, clump->n_spheres);
    }
    if (status == MS_OK && normals) {
        *normals = ms_normals_read(tally);
    }
    ms_normals_free(&shape);
    free(tally);
    free(parts);
    return status;
}

/* Points spread evenly over a triangle: the R2 sequence, folded from the square. */
static part triangle_part(const ms_target *target, const ms_clump_near *near, size_t triangle)
{
    const uint32_t *t = target->mesh->triangle[triangle];
    const double *a = target->mesh->vertex[t[0]], *b = target->mesh->vertex[t[1]], *c = target->mesh->vertex[t[2]];
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const double normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double area = 0.5 * sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const double samples = fmin(1e6, fmax(1, ceil(area / (4 * target->grid.h * target->grid.h))));
    part sum = {0};
    for (double m = 0; m < samples; m++) {
        double s = fmod(1 / 3.0 + m * 0.75487766624669276, 1), w = fmod(1 / 3.0 + m * 0.56984029099805327, 1);
        if (s + w > 1) {
            s = 1 - s;
            w = 1 - w;
        }
        const double point[3] = {a[0] + s * u[0] + w * v[0], a[1] + s * u[1] + w * v[1], a[2] + s * u[2] + w * v[2]};
        part_add(&sum, area / samples, ms_clump_near_distance(near, point));
    }
    return sum;
}

/* Corners stand out the most. */
static double largest_gap_of_vertices(const ms_mesh *mesh, const ms_clump_near *near)
{
    double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        largest = fmax(largest, ms_clump_near_distance(near, mesh->vertex[v]));
    }
    return largest;
}

ms_status ms_surface_gap(ms_standout *out, const ms_target *target, const ms_clump_near *near, ms_error *err)
{
    const size_t triangles = target->mesh->n_triangles, chunks = (triangles + CHUNK - 1) / CHUNK;
    part *parts = calloc(chunks + 1, sizeof *parts);
    memset(out, 0, sizeof *out);
    if (!parts) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to measure %zu triangles", triangles);
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        const size_t last = (chunk + 1) * CHUNK < triangles ? (chunk + 1) * CHUNK : triangles;
        for (size_t t = chunk * CHUNK; t < last; t++) {
            const part one = triangle_part(target, near, t);
            parts[chunk].area += one.area;
            parts[chunk].square += one.square;
            parts[chunk].max = fmax(parts[chunk].max, one.max);
        }
    }
    join_parts(out, parts, chunks);
    out->max = fmax(out->max, largest_gap_of_vertices(target->mesh, near));
    free(parts);
    return MS_OK;
}
