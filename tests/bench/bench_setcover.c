/* Set cover to 95 % and 99 % coverage at d_eq/100, on one thread, against voxelising the shape and
 * its distance transform in the same run. */
#include <omp.h>
#include <stdio.h>

#include "bench_support.h"
#include "ms_generator.h"
#include "ms_generator_list.h"

static ms_status run_setcover(const ms_target *target, double target_seconds, double coverage, const char *candidates,
                              ms_error *err)
{
    ms_settings settings = {0};
    ms_clump clump = {0};
    ms_stop_reason reason;
    ms_status status = ms_option_settings_init(&settings, ms_generator_setcover.options, err);
    if (status == MS_OK) {
        status = ms_option_settings_set(&settings, "candidates", candidates, err);
    }
    ms_run run = {.target = target, .settings = &settings};
    run.stop.coverage = coverage;
    const double start = omp_get_wtime();
    if (status == MS_OK) {
        status = ms_generator_run(&clump, &reason, &ms_generator_setcover, &run, err);
    }
    if (status == MS_OK) {
        printf("%-8s candidates, coverage %.2f: %zu spheres (%s); time / (voxelise + distance transform) %.1f\n",
               candidates, coverage, clump.n_spheres, ms_stop_name(reason), (omp_get_wtime() - start) / target_seconds);
    }
    ms_clump_free(&clump);
    ms_option_settings_free(&settings);
    return status;
}

int main(void)
{
    ms_mesh mesh;
    ms_target target;
    ms_error err;
    omp_set_num_threads(1);
    ms_status status = make_grain(&mesh, &err);
    const double start = omp_get_wtime();
    if (status == MS_OK) {
        /* The grain has the volume of a ball of radius 1. */
        status = ms_target_from_mesh(&target, &mesh, 1, 2.0 / 100, MS_VOXEL_HALF, &err);
    }
    const double target_seconds = omp_get_wtime() - start;
    for (int c = 0; c < 4 && status == MS_OK; c++) {
        status = run_setcover(&target, target_seconds, c % 2 ? 0.99 : 0.95, c < 2 ? "medial" : "skeleton", &err);
    }
    if (status != MS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    return 0;
}
