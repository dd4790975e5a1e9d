/* Bytes per voxel that MSS needs at its peak, grid and distance field included, and how its
 * parts share the time. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#include "bench_support.h"
#include "ms_generator.h"
#include "ms_generator_list.h"

static double peak_bytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss; /* Linux counts kibibytes */
}

/* The smallest side of the grain is about 1.6. */
static ms_status run_mss(const ms_mesh *mesh, double h, ms_error *err)
{
    ms_target target;
    ms_settings settings = {0};
    ms_clump clump = {0};
    ms_stop_reason reason;
    const double before = peak_bytes(), start = omp_get_wtime();
    ms_status status = ms_target_voxels_from_mesh(&target, mesh, 1, h, MS_VOXEL_HALF, err);
    const double voxelized = omp_get_wtime();
    if (status != MS_OK || (status = ms_target_add_distance(&target, err)) != MS_OK) {
        return status;
    }
    const double made = omp_get_wtime();
    status = ms_option_settings_init(&settings, ms_generator_mss.options, err);
    ms_run run = {.target = &target, .settings = &settings};
    run.stop.spheres = 70;
    if (status == MS_OK) {
        status = ms_generator_run(&clump, &reason, &ms_generator_mss, &run, err);
    }
    const double done = omp_get_wtime(), voxels = (double)ms_grid_voxels(&target.grid);
    if (status == MS_OK) {
        printf("grain, %.1f million voxels, %zu spheres: %.1f bytes/voxel at peak\n", voxels / 1e6, clump.n_spheres,
               (peak_bytes() - before) / voxels);
        printf("shares: voxels %.0f %%, distance field %.0f %%, spheres %.0f %%; spheres / distance field %.1f\n",
               100 * (voxelized - start) / (done - start), 100 * (made - voxelized) / (done - start),
               100 * (done - made) / (done - start), (done - made) / (made - voxelized));
    }
    ms_clump_free(&clump);
    ms_option_settings_free(&settings);
    ms_target_free(&target);
    return status;
}

int main(void)
{
    ms_mesh mesh;
    ms_error err;
    ms_status status = make_grain(&mesh, &err);
    if (status == MS_OK) {
        status = run_mss(&mesh, 1.6 / 250, &err);
        ms_mesh_free(&mesh);
    }
    if (status != MS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    return 0;
}
