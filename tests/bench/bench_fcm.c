/* Clustering 5000 spheres that fill a grain into 50, at one m, against MSS with as many spheres on the same
 * grain; and against itself with more spheres and more clusters. One thread. */
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_support.h"
#include "fcm/ms_cluster.h"
#include "fcm/ms_random_spheres.h"
#include "ms_generator.h"
#include "ms_generator_list.h"

enum { MOST = 100 };

static ms_status time_mss(double *seconds, const ms_target *target, ms_error *err)
{
    ms_settings settings = {0};
    ms_clump clump = {0};
    ms_stop_reason reason;
    ms_status status = ms_option_settings_init(&settings, ms_generator_mss.options, err);
    ms_run run = {.target = target, .settings = &settings};
    run.stop.spheres = 50;
    const double start = omp_get_wtime();
    if (status == MS_OK) {
        status = ms_generator_run(&clump, &reason, &ms_generator_mss, &run, err);
    }
    *seconds = omp_get_wtime() - start;
    ms_clump_free(&clump);
    ms_option_settings_free(&settings);
    return status;
}

/* Start and descent, as fcm does them. */
static ms_status time_clusters(double *seconds, size_t *iterations, const ms_ball *ball, size_t filling, size_t n,
                               double m, ms_error *err)
{
    const ms_cluster_rule rule = {.fuzzifier = m, .tolerance = 1e-3, .iterations = 500};
    ms_cluster *cluster = NULL;
    ms_cluster_result result = {0};
    double(*point)[4] = malloc(filling * sizeof *point), centre[MOST][4];
    ms_status status = point ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu points", filling);
    for (size_t b = 0; status == MS_OK && b < filling; b++) {
        memcpy(point[b], ball[b].centre, sizeof ball[b].centre);
        point[b][3] = ball[b].radius;
    }
    const double start = omp_get_wtime();
    if (status == MS_OK && (status = ms_cluster_build(&cluster, (const double(*)[4])point, filling, err)) == MS_OK &&
        (status = ms_cluster_start(centre, 0, n, cluster, MS_CLUSTER_FAR, 1, err)) == MS_OK) {
        status = ms_cluster_run(&result, centre, n, cluster, &rule, err);
    }
    *seconds = omp_get_wtime() - start;
    *iterations = result.iterations;
    ms_cluster_free(cluster);
    free(point);
    return status;
}

static ms_status compare(const ms_target *target, const ms_ball *ball, ms_error *err)
{
    static const double M[] = {1, 1.5, 2, 3};
    double mss, base, more, wider;
    size_t its, its_more, its_wider;
    ms_status status = time_mss(&mss, target, err);
    for (int m = 0; m < 4 && status == MS_OK; m++) {
        status = time_clusters(&base, &its, ball, 5000, 50, M[m], err);
        if (status == MS_OK && (status = time_clusters(&more, &its_more, ball, 20000, 50, M[m], err)) == MS_OK &&
            (status = time_clusters(&wider, &its_wider, ball, 5000, 100, M[m], err)) == MS_OK) {
            printf("m %.1f: 5000 spheres into 50, %zu iterations, %.2f ns a pair; time / mss %.2f; per iteration "
                   "20000 spheres / 5000: %.1f, 100 clusters / 50: %.1f\n",
                   M[m], its, 1e9 * base / (double)its / 5000 / 50, base / mss,
                   more / (double)its_more / (base / (double)its), wider / (double)its_wider / (base / (double)its));
        }
    }
    return status;
}

int main(void)
{
    const ms_random_spheres_rule rule = {.least = 20000, .tries = 10000000, .seed = 1};
    ms_mesh mesh;
    ms_target target = {0};
    ms_nodes nodes = {0};
    ms_ball *ball = NULL;
    size_t count, counted;
    ms_error err;
    omp_set_num_threads(1);
    ms_status status = make_grain(&mesh, &err);
    if (status == MS_OK) {
        /* The grain has the volume of a ball of radius 1. */
        status = ms_target_from_mesh(&target, &mesh, 1, 2.0 / 100, MS_VOXEL_HALF, &err);
    }
    if (status == MS_OK && (status = ms_nodes_of_target(&nodes, &target, &err)) == MS_OK &&
        (status = ms_random_spheres(&ball, &count, &counted, &target, &nodes, &rule, &err)) == MS_OK) {
        status = compare(&target, ball, &err);
    }
    if (status != MS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    free(ball);
    ms_nodes_free(&nodes);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    return 0;
}
