/* The variational generator against MSS with as many spheres, and many spheres against few. */
#include <omp.h>
#include <stdio.h>

#include "ms_generator.h"
#include "ms_mss.h"
#include "ms_shape.h"
#include "ms_variational.h"

static ms_status make_grain(ms_mesh *mesh, ms_error *err)
{
    double value[MS_SHAPE_MAX_PARAMETERS];
    const ms_shape_kind *kind = ms_shape_find("grain", err);
    for (size_t p = 0; kind && kind->parameters[p].name; p++) {
        value[p] = kind->parameters[p].fallback;
    }
    return kind ? ms_shape_make(mesh, kind, value, err) : MS_ERR_ARG;
}

static ms_status measure(double *seconds, const ms_target *target, const ms_generator *generator, size_t spheres,
                         ms_error *err)
{
    ms_settings settings = {0};
    ms_clump clump = {0};
    ms_stop_reason reason;
    ms_status status = ms_settings_init(&settings, generator->options, err);
    ms_run run = {.target = target, .stop = ms_stop_none(), .settings = &settings};
    run.stop.spheres = spheres;
    const double start = omp_get_wtime();
    if (status == MS_OK) {
        status = ms_generator_run(&clump, &reason, generator, &run, err);
    }
    *seconds = omp_get_wtime() - start;
    ms_clump_free(&clump);
    ms_settings_free(&settings);
    return status;
}

int main(void)
{
    double mss, few, many;
    ms_mesh mesh;
    ms_target target;
    ms_error err;
    ms_status status = make_grain(&mesh, &err);
    if (status == MS_OK) {
        /* The grain has the volume of a ball of radius 1. */
        status = ms_target_from_mesh(&target, &mesh, 1, 2.0 / 100, MS_VOXEL_HALF, &err);
    }
    if (status == MS_OK && (status = measure(&mss, &target, &ms_generator_mss, 70, &err)) == MS_OK &&
        (status = measure(&few, &target, &ms_generator_variational, 70, &err)) == MS_OK &&
        (status = measure(&many, &target, &ms_generator_variational, 700, &err)) == MS_OK) {
        printf("70 spheres: variational / mss %.2f; variational: 700 spheres / 70 spheres %.1f\n", few / mss,
               many / few);
    }
    if (status != MS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    return 0;
}
