#include "ms_mss_polish.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_mss_open.h"

/* Radii up to REACH voxels from the present one are tried, STEPS to a voxel. */
enum { SWEEPS = 4, REACH = 2, STEPS = 8, BINS = 2 * REACH * STEPS + 1 };

/* Voxels on a ball's surface but for rounding belong to it. */
static const double ON_SURFACE = 1e-9;

typedef struct polish {
    const ms_grid *grid;
    uint16_t *covers; /* how many spheres cover a voxel */
} polish;

/* What visits the voxels within a distance of a centre is told their distances. */
typedef void (*visit)(const polish *p, size_t voxel, double distance, void *context);

static void visit_ball(const polish *p, const double centre[3], double radius, visit visit_voxel, void *context)
{
    int lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = ms_mss_open_clamp(ceil(centre[a] - radius), 0, p->grid->n[a]);
        hi[a] = ms_mss_open_clamp(floor(centre[a] + radius) + 1, 0, p->grid->n[a]);
    }
    for (int k = lo[2]; k < hi[2]; k++) {
        for (int j = lo[1]; j < hi[1]; j++) {
            const double y = j - centre[1], z = k - centre[2];
            for (int i = lo[0]; i < hi[0]; i++) {
                const double x = i - centre[0], square = x * x + y * y + z * z;
                if (square <= radius * radius + ON_SURFACE) {
                    visit_voxel(p, ms_grid_index(p->grid, i, j, k), sqrt(square), context);
                }
            }
        }
    }
}

static void add_cover(const polish *p, size_t voxel, double distance, void *context)
{
    (void)distance;
    p->covers[voxel] = (uint16_t)(p->covers[voxel] + *(const int *)context);
}

static void count_ball(const polish *p, const ms_ball *ball, int times)
{
    visit_ball(p, ball->centre, ball->radius, add_cover, &times);
}

/* What a sphere gains by radii from `least` up: voxels inside less those outside that no other covers. */
typedef struct profile {
    double least;
    long gain[BINS];
} profile;

static void add_gain(const polish *p, size_t voxel, double distance, void *context)
{
    profile *f = context;
    if (p->covers[voxel] == 0) {
        const double bin = ceil((distance - f->least) * STEPS - ON_SURFACE);
        f->gain[bin > 0 ? (int)fmin(bin, BINS - 1) : 0] += p->grid->inside[voxel] ? 1 : -1;
    }
}

/* The best radius for a ball that is not among those that cover; the nearest to the present one of equals. */
static double best_radius(const polish *p, const ms_ball *ball, double least)
{
    profile f = {.least = fmax(ball->radius - REACH, least), .gain = {0}};
    visit_ball(p, ball->centre, f.least + 2 * REACH, add_gain, &f);
    double radius = f.least;
    long sum = 0, most = 0;
    for (int b = 0; b < BINS; b++) {
        const double here = f.least + (double)b / STEPS;
        sum += f.gain[b];
        if (b == 0 || sum > most || (sum == most && fabs(here - ball->radius) < fabs(radius - ball->radius))) {
            most = sum;
            radius = here;
        }
    }
    return radius;
}

static void sweep(const polish *p, ms_ball *ball, size_t count, ms_mss_run *m)
{
    const double least = fmax(m->run->stop.radius / p->grid->h, 0.5);
    for (size_t b = 0; b < count; b++) {
        ms_ball fitted = ball[b];
        count_ball(p, &ball[b], -1);
        fitted.radius = best_radius(p, &ball[b], least);
        if (ms_mss_run_confine(&fitted, m)) {
            ball[b] = fitted;
        }
        count_ball(p, &ball[b], 1);
    }
}

ms_status ms_mss_polish(ms_clump *clump, ms_mss_run *m, ms_error *err)
{
    const ms_grid *grid = &m->run->target->grid;
    const size_t voxels = ms_grid_voxels(grid);
    polish p = {grid, calloc(voxels, sizeof *p.covers)};
    ms_ball *ball = malloc((clump->n_spheres + 1) * sizeof *ball);
    if (!p.covers || !ball) {
        free(p.covers);
        free(ball);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to polish on %zu voxels; use fewer cells", voxels);
    }
    for (size_t b = 0; b < clump->n_spheres; b++) {
        ball[b] = ms_grid_ball(grid, &clump->sphere[b]);
        count_ball(&p, &ball[b], 1);
    }
    for (int s = 0; s < SWEEPS; s++) {
        sweep(&p, ball, clump->n_spheres, m);
    }
    for (size_t b = 0; b < clump->n_spheres; b++) {
        clump->sphere[b] = ms_grid_sphere(grid, &ball[b]);
    }
    free(p.covers);
    free(ball);
    return MS_OK;
}
