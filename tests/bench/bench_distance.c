/* The distance transform of a ball against a copy of its float field, on one thread, and how
 * its cost grows with the grid. Ratios within one run: times alone say little on a shared
 * machine. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_distance.h"

enum { REPEATS = 5 };

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *seconds)
{
    qsort(seconds, REPEATS, sizeof *seconds, compare);
    return seconds[REPEATS / 2];
}

static void fill_ball(uint8_t *inside, int side)
{
    const double middle = 0.5 * (side - 1), radius = 0.5 * side - 2;
    for (int k = 0; k < side; k++) {
        for (int j = 0; j < side; j++) {
            for (int i = 0; i < side; i++) {
                const double x = i - middle, y = j - middle, z = k - middle;
                *inside++ = x * x + y * y + z * z < radius * radius;
            }
        }
    }
}

/* A copy into memory that was just allocated: what a program that copies a field pays. */
static double copy_fresh(const float *field, size_t bytes, double *checksum)
{
    const double start = omp_get_wtime();
    float *copy = malloc(bytes);
    if (!copy) {
        return (double)NAN;
    }
    memcpy(copy, field, bytes);
    const double seconds = omp_get_wtime() - start;
    *checksum += (double)copy[bytes / sizeof *copy / 2];
    free(copy);
    return seconds;
}

static int measure(int side, double *per_voxel, double *checksum)
{
    const int n[3] = {side, side, side};
    const size_t voxels = (size_t)side * (size_t)side * (size_t)side, bytes = voxels * sizeof(float);
    uint8_t *inside = malloc(voxels);
    float *field = malloc(bytes), *copy = malloc(bytes);
    double transform[REPEATS], warm[REPEATS], fresh[REPEATS];
    const int ready = inside && field && copy;
    if (ready) {
        memset(copy, 0, bytes);
        memset(field, 0, bytes);
        fill_ball(inside, side);
    }
    for (int r = 0; ready && r < REPEATS; r++) {
        const double start = omp_get_wtime();
        ms_distance(field, inside, n, NULL);
        const double done = omp_get_wtime();
        memcpy(copy, field, bytes);
        warm[r] = omp_get_wtime() - done;
        transform[r] = done - start;
        *checksum += (double)copy[voxels / 2];
        fresh[r] = copy_fresh(field, bytes, checksum);
    }
    if (ready) {
        const double t = median(transform);
        *per_voxel = t / (double)voxels;
        printf("ball in %d^3: %.2f ns/voxel; / copy into fresh memory %.1f; / copy into memory in use %.1f\n", side,
               1e9 * *per_voxel, t / median(fresh), t / median(warm));
    }
    free(inside);
    free(field);
    free(copy);
    return ready;
}

int main(void)
{
    double small = 0, middle = 0, large = 0, checksum = 0;
    omp_set_num_threads(1);
    if (!measure(128, &small, &checksum) || !measure(256, &middle, &checksum) || !measure(512, &large, &checksum)) {
        fputs("not enough memory for a grid of 512^3\n", stderr);
        return 1;
    }
    printf("cost per voxel, 256^3 / 128^3: %.2f, 512^3 / 128^3: %.2f (checksum %g)\n", middle / small, large / small,
           checksum);
    return 0;
}
