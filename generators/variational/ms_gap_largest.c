#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_gap.h"

/* Of the largest distance, in voxels; and the size of parts that are cut no more. */
static const double TOLERANCE = 0.01, SMALLEST = 1e-3;

/* A place and its nearest sphere. */
typedef struct farthest {
    ms_gap_far far;
    size_t nearest;
} farthest;

static void look_at(farthest *out, const double place[3], const ms_ball *all, size_t count, double bound)
{
    double least = HUGE_VAL;
    size_t nearest = 0;
    for (size_t b = 0; b < count; b++) {
        const double reach = all[b].radius + least, square = ms_squared_distance(place, all[b].centre);
        if (reach > 0 && square < reach * reach) {
            least = sqrt(square) - all[b].radius;
            nearest = b;
        }
    }
    if (least > bound && least > out->far.away) {
        out->far.away = least;
        out->nearest = nearest;
        memcpy(out->far.place, place, sizeof out->far.place);
    }
}

/* No part of a triangle is farther from a sphere than its farthest corner. */
static double find_upper(const double corner[3][3], const ms_ball *all, size_t count)
{
    double least = HUGE_VAL;
    for (size_t b = 0; b < count; b++) {
        double most = 0;
        for (int c = 0; c < 3; c++) {
            most = fmax(most, ms_squared_distance(corner[c], all[b].centre));
        }
        least = fmin(least, sqrt(most) - all[b].radius);
    }
    return least;
}

static void search_part(farthest *out, const double corner[3][3], const ms_ball *all, size_t count, double bound)
{
    const double upper = find_upper(corner, all, count);
    double middle[3][3], size = 0;
    if (upper <= bound) {
        return;
    }
    for (int c = 0; c < 3; c++) {
        look_at(out, corner[c], all, count, bound);
        for (int a = 0; a < 3; a++) {
            middle[c][a] = 0.5 * (corner[(c + 1) % 3][a] + corner[(c + 2) % 3][a]);
        }
        size = fmax(size, ms_squared_distance(corner[c], corner[(c + 1) % 3]));
    }
    if (upper <= out->far.away + TOLERANCE) {
        return;
    }
    if (size < SMALLEST * SMALLEST) { /* nothing is sure */
        look_at(out, middle[0], all, count, -HUGE_VAL);
        out->far.away = fmax(out->far.away, upper);
        return;
    }
    search_part(out, (const double(*)[3])middle, all, count, bound);
    for (int c = 0; c < 3; c++) {
        double part[3][3];
        memcpy(part[0], corner[c], sizeof part[0]);
        memcpy(part[1], middle[(c + 2) % 3], sizeof part[1]);
        memcpy(part[2], middle[(c + 1) % 3], sizeof part[2]);
        search_part(out, (const double(*)[3])part, all, count, bound);
    }
}

static void search_face(farthest *out, const ms_target *target, size_t triangle, const ms_ball *all, size_t count,
                        double bound)
{
    double corner[3][3];
    ms_grid_corners(corner, &target->grid, target->mesh, triangle);
    search_part(out, (const double(*)[3])corner, all, count, bound);
}

static void search_voxel(farthest *out, const ms_grid *grid, size_t v, const ms_ball *all, size_t count, double bound)
{
    if (ms_gap_is_border(grid, v)) {
        int voxel[3];
        ms_grid_voxel(voxel, grid->n, v);
        const double at[3] = {voxel[0], voxel[1], voxel[2]};
        look_at(out, at, all, count, bound);
    }
}

ms_status ms_gap_largest(double *largest, ms_gap_far *far, const ms_target *target, const ms_ball *all, size_t count,
                         double bound, ms_error *err)
{
    enum { CHUNK = 4096 };
    const size_t parts = target->mesh ? target->mesh->n_triangles : ms_grid_voxels(&target->grid);
    farthest *found = malloc(CHUNK * sizeof *found);
    *largest = bound;
    if (!found) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to find the largest gap");
    }
    for (size_t b = 0; far && b < count; b++) {
        far[b] = (ms_gap_far){.away = 0};
    }
    for (size_t from = 0; from < parts; from += CHUNK) {
        const size_t to = from + CHUNK < parts ? from + CHUNK : parts;
#pragma omp parallel for schedule(dynamic, 64)
        for (size_t p = from; p < to; p++) {
            farthest *out = &found[p - from];
            *out = (farthest){.far.away = -HUGE_VAL};
            if (target->mesh) {
                search_face(out, target, p, all, count, bound);
            } else {
                search_voxel(out, &target->grid, p, all, count, bound);
            }
        }
        for (size_t p = 0; p < to - from; p++) {
            *largest = fmax(*largest, found[p].far.away);
            if (far && found[p].far.away > far[found[p].nearest].away) {
                far[found[p].nearest] = found[p].far;
            }
        }
    }
    free(found);
    return MS_OK;
}
