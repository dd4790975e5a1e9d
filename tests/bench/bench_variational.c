/* The variational generator against the others with as many spheres: time, and how rough the surfaces are; and the
 * time against their number. */
#include <math.h>
#include <omp.h>
#include <stdio.h>

#include "base/ms_vector.h"
#include "bench_support.h"
#include "measure/ms_metrics.h"
#include "mesh/ms_closest.h"
#include "ms_generator.h"
#include "ms_generator_list.h"
#include "voxel/ms_raster.h"

enum { POINTS = 1000 };

static int is_exposed(const double point[3], const ms_clump *clump, size_t self)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double r = clump->sphere[s].radius;
        if (s != self && ms_squared_distance(point, clump->sphere[s].centre) < r * r) {
            return 0;
        }
    }
    return 1;
}

/* Cosine of the angle between a normal and the slope of the signed distance, by central differences. */
static double cosine_to_shape(const ms_target *target, const double point[3], const double normal[3])
{
    double slope[3];
    for (int a = 0; a < 3; a++) {
        double to[3] = {point[0], point[1], point[2]}, from[3] = {point[0], point[1], point[2]};
        to[a] += 0.25 * target->grid.h;
        from[a] -= 0.25 * target->grid.h;
        slope[a] = ms_closest_signed_distance(target->closest, to) - ms_closest_signed_distance(target->closest, from);
    }
    return ms_dot(slope, normal) / fmax(sqrt(ms_dot(slope, slope)), 1e-12 * target->grid.h);
}

/* RMS angle between the normals of exposed sphere surface and the shape's nearest surface, in degrees. */
static double rms_angle(const ms_target *target, const ms_clump *clump)
{
    double area = 0, sum = 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *sphere = &clump->sphere[s];
        for (int p = 0; p < POINTS; p++) {
            const double z = 1 - (2 * p + 1.0) / POINTS, ring = sqrt(1 - z * z), turn = 2.399963229728653 * p;
            const double normal[3] = {ring * cos(turn), ring * sin(turn), z};
            double point[3];
            for (int a = 0; a < 3; a++) {
                point[a] = sphere->centre[a] + sphere->radius * normal[a];
            }
            if (is_exposed(point, clump, s)) {
                const double angle = acos(fmin(1, fmax(-1, cosine_to_shape(target, point, normal))));
                area += sphere->radius * sphere->radius;
                sum += sphere->radius * sphere->radius * angle * angle;
            }
        }
    }
    return sqrt(sum / area) * 180 / acos(-1.0);
}

static ms_status measure(double *seconds, const ms_target *target, const ms_generator *generator, size_t spheres,
                         ms_error *err)
{
    ms_settings settings = {0};
    ms_clump clump = {0};
    ms_stop_reason reason;
    ms_metrics metrics;
    ms_status status = ms_option_settings_init(&settings, generator->options, err);
    ms_run run = {.target = target, .settings = &settings};
    run.stop.spheres = spheres;
    const double start = omp_get_wtime();
    if (status == MS_OK) {
        status = ms_generator_run(&clump, &reason, generator, &run, err);
    }
    *seconds = omp_get_wtime() - start;
    if (status == MS_OK) {
        status = ms_metrics_compute(&metrics, NULL, target, &clump, 1u << 28, err);
    }
    if (status == MS_OK) {
        const double h = target->grid.h;
        printf(
            "%zu spheres by %s: D %.4f, rms protrusion %.2f and gap %.2f voxels, rms angle of normals %.1f degrees\n",
            spheres, generator->name, metrics.score.dice, metrics.protrusion_rms / h, metrics.gap_rms / h,
            rms_angle(target, &clump));
    }
    ms_clump_free(&clump);
    ms_option_settings_free(&settings);
    return status;
}

int main(void)
{
    static const size_t N[] = {10, 70, 200, 700};
    double mss, cover, few, many;
    ms_mesh mesh;
    ms_target target;
    ms_error err;
    ms_status status = make_grain(&mesh, &err);
    if (status == MS_OK) {
        /* The grain has the volume of a ball of radius 1. */
        status = ms_target_from_mesh(&target, &mesh, 1, 2.0 / 100, MS_VOXEL_HALF, &err);
    }
    if (status == MS_OK && (status = measure(&mss, &target, &ms_generator_mss, 70, &err)) == MS_OK &&
        (status = measure(&cover, &target, &ms_generator_setcover, 70, &err)) == MS_OK &&
        (status = measure(&few, &target, &ms_generator_variational, 70, &err)) == MS_OK) {
        printf("time, 70 spheres: variational / mss %.2f, / setcover %.2f\n", few / mss, few / cover);
    }
    for (size_t i = 0; i < sizeof N / sizeof *N && status == MS_OK; i++) {
        status = measure(&many, &target, &ms_generator_variational, N[i], &err);
        if (status == MS_OK) {
            printf("variational, %zu spheres: %.2f times the time of 70\n", N[i], many / few);
        }
    }
    if (status != MS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    return 0;
}
