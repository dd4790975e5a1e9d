/* What is expected of one number of spheres and of all, against MSS with 50 spheres at 100 cells. Of a grain, or of the
 * mesh that is named. One thread, CPU seconds, the least of three. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <time.h>

#include "bench_support.h"
#include "expect/ms_expect.h"
#include "mesh/formats/ms_mesh_read.h"
#include "ms_generator.h"
#include "ms_generator_list.h"

enum { TURNS = 3, CELLS = 100 };

static double now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Voxels, distances and spheres: what `mskit generate` does. */
static ms_status run_mss(ms_target *target, const ms_mesh *mesh, ms_error *err)
{
    ms_settings settings = {0};
    ms_clump clump = {0};
    ms_stop_reason reason;
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    const double h = fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2])) / CELLS;
    ms_status status = ms_target_from_mesh(target, mesh, 1, h, MS_VOXEL_HALF, err);
    if (status == MS_OK) {
        status = ms_option_settings_init(&settings, ms_generator_mss.options, err);
    }
    ms_run run = {.target = target, .settings = &settings};
    run.stop.spheres = 50;
    if (status == MS_OK) {
        status = ms_generator_run(&clump, &reason, &ms_generator_mss, &run, err);
    }
    ms_clump_free(&clump);
    ms_option_settings_free(&settings);
    return status;
}

/* spheres: 0 for all numbers */
static ms_status time_expect(double *seconds, const ms_target *target, double spheres, ms_error *err)
{
    ms_expect expect;
    ms_status status = MS_OK;
    *seconds = HUGE_VAL;
    for (int turn = 0; turn < TURNS && status == MS_OK; turn++) {
        const double start = now();
        status =
            spheres > 0 ? ms_expect_near(&expect, target, spheres, err) : ms_expect_mesh(&expect, target->mesh, err);
        *seconds = fmin(*seconds, now() - start);
    }
    return status;
}

static ms_status compare(const ms_mesh *mesh, ms_error *err)
{
    static const double NUMBERS[] = {0, 10, 20, 50, 100, 200};
    ms_target target = {0};
    double mss = HUGE_VAL;
    ms_status status = MS_OK;
    for (int turn = 0; turn < TURNS && status == MS_OK; turn++) {
        ms_target_free(&target);
        const double start = now();
        status = run_mss(&target, mesh, err);
        mss = fmin(mss, now() - start);
    }
    printf("mss, 50 spheres: %.3f s\n", mss);
    for (size_t i = 0; i < sizeof NUMBERS / sizeof *NUMBERS && status == MS_OK; i++) {
        double seconds;
        status = time_expect(&seconds, &target, NUMBERS[i], err);
        if (NUMBERS[i] > 0) {
            printf("expected of %g spheres alone: %.3f s, %.3f of mss\n", NUMBERS[i], seconds, seconds / mss);
        } else {
            printf("expected of all numbers: %.3f s, %.3f of mss\n", seconds, seconds / mss);
        }
    }
    ms_target_free(&target);
    return status;
}

int main(int argc, char **argv)
{
    ms_mesh mesh = {0};
    ms_mesh_report report;
    ms_error err;
    omp_set_num_threads(1);
    ms_status status = argc > 1 ? ms_mesh_read(&mesh, argv[1], &err) : make_grain(&mesh, &err);
    if (status == MS_OK && (status = ms_mesh_repair(&mesh, &report, &err)) == MS_OK) {
        status = compare(&mesh, &err);
    }
    ms_mesh_free(&mesh);
    if (status != MS_OK) {
        fprintf(stderr, "%s\n", err.text);
    }
    return status != MS_OK;
}
