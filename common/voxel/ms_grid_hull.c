#include "ms_grid_hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/ms_hull.h"

/* Points on a face are taken to lie on it within this, in voxels: vertices are voxels, so that planes pass through
 * others or miss them by 1 / (extent of a face)^2 or more. */
static const double ON_FACE = 1e-9;

/* First and last voxel of each row, as points in voxels: the others lie between them. @return how many */
static size_t list_ends(double (*point)[3], const ms_grid *grid)
{
    size_t count = 0;
    const uint8_t *row = grid->inside;
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++, row += grid->n[0]) {
            const uint8_t *first = memchr(row, 1, (size_t)grid->n[0]);
            if (!first) {
                continue;
            }
            int last = grid->n[0] - 1;
            while (!row[last]) {
                last--;
            }
            const double a[3] = {(double)(first - row), j, k}, b[3] = {last, j, k};
            memcpy(point[count++], a, sizeof a);
            if (last > first - row) {
                memcpy(point[count++], b, sizeof b);
            }
        }
    }
    return count;
}

/* Points half a voxel away from each along each axis, six times as many. */
static void list_faces(double (*face)[3], const double (*point)[3], size_t count)
{
    for (size_t p = 0; p < count; p++) {
        for (int side = 0; side < 6; side++) {
            memcpy(face[6 * p + side], point[p], sizeof *face);
            face[6 * p + side][side / 2] += side % 2 ? 0.5 : -0.5;
        }
    }
}

static ms_status no_memory(ms_error *err)
{
    return ms_fail(err, MS_ERR_NOMEM, "no memory for the convex hull of the voxels");
}

/* Around points, of which the hull of the centres has been sought. */
static ms_status build_faces(ms_mesh *faces, const double (*point)[3], size_t count, ms_error *err)
{
    double(*face)[3] = malloc(6 * count * sizeof *face);
    if (!face) {
        return no_memory(err);
    }
    list_faces(face, point, count);
    const ms_status status = ms_hull_build(faces, (const double(*)[3])face, 6 * count, err);
    free(face);
    return status;
}

ms_status ms_grid_hull_build(ms_mesh *centres, ms_mesh *faces, const ms_grid *grid, ms_error *err)
{
    const size_t rows = (size_t)grid->n[1] * (size_t)grid->n[2];
    memset(centres, 0, sizeof *centres);
    memset(faces, 0, sizeof *faces);
    double(*point)[3] = malloc((2 * rows + 1) * sizeof *point);
    if (!point) {
        return no_memory(err);
    }
    const size_t count = list_ends(point, grid);
    ms_status status = count ? ms_hull_build(centres, (const double(*)[3])point, count, err)
                             : ms_fail(err, MS_ERR_SHAPE, "no voxel is inside, so that there is no convex hull");
    const int flat = count && status == MS_ERR_SHAPE;
    if (status == MS_OK) {
        status = build_faces(faces, (const double(*)[3])centres->vertex, centres->n_vertices, err);
    } else if (flat) {
        const ms_status of_faces = build_faces(faces, (const double(*)[3])point, count, NULL);
        status = of_faces == MS_OK ? status : ms_fail(err, of_faces, "the voxels have no convex hull");
    }
    free(point);
    if (status != MS_OK && !(flat && status == MS_ERR_SHAPE)) {
        ms_mesh_free(centres);
        ms_mesh_free(faces);
    }
    return status;
}

/* The part of each row (j, k) along x within the hull. */
typedef struct row_span {
    double from, to;
} row_span;

/* Twice the area of the triangle in the plane of y and z. */
static double area_about(const double a[3], const double b[3], double y, double z)
{
    return (b[1] - a[1]) * (z - a[2]) - (b[2] - a[2]) * (y - a[1]);
}

/* Ends the rows that pass through a triangle: where its plane is, which lies at the hull or outside everywhere. */
static void take_triangle(row_span *span, const double at[3][3], const int n[3])
{
    const double area = area_about(at[0], at[1], at[2][1], at[2][2]);
    double lo[3], hi[3];
    if (fabs(area) < ON_FACE) {
        return; /* along x */
    }
    for (int a = 1; a < 3; a++) {
        lo[a] = ceil(fmin(at[0][a], fmin(at[1][a], at[2][a])) - ON_FACE);
        hi[a] = floor(fmax(at[0][a], fmax(at[1][a], at[2][a])) + ON_FACE);
    }
    for (int k = (int)fmax(0, lo[2]); k <= hi[2] && k < n[2]; k++) {
        for (int j = (int)fmax(0, lo[1]); j <= hi[1] && j < n[1]; j++) {
            const double u = area_about(at[1], at[2], j, k) / area, v = area_about(at[2], at[0], j, k) / area,
                         w = 1 - u - v;
            if (u >= -ON_FACE && v >= -ON_FACE && w >= -ON_FACE) {
                row_span *s = &span[(size_t)j + (size_t)n[1] * (size_t)k];
                const double x = u * at[0][0] + v * at[1][0] + w * at[2][0];
                if (area > 0) { /* looks to +x */
                    s->to = fmin(s->to, x);
                } else {
                    s->from = fmax(s->from, x);
                }
            }
        }
    }
}

ms_status ms_grid_hull_count(size_t *count, const ms_mesh *hull, const ms_grid *grid, ms_error *err)
{
    const size_t rows = (size_t)grid->n[1] * (size_t)grid->n[2];
    row_span *span = malloc(rows * sizeof *span);
    *count = 0;
    if (!span) {
        return no_memory(err);
    }
    for (size_t r = 0; r < rows; r++) {
        span[r] = (row_span){-HUGE_VAL, HUGE_VAL};
    }
    for (size_t t = 0; t < hull->n_triangles; t++) {
        double at[3][3];
        for (int c = 0; c < 3; c++) {
            memcpy(at[c], hull->vertex[hull->triangle[t][c]], sizeof at[c]);
        }
        take_triangle(span, (const double(*)[3])at, grid->n);
    }
    for (size_t r = 0; r < rows; r++) {
        if (isfinite(span[r].from) && isfinite(span[r].to)) {
            *count += (size_t)fmax(0, floor(span[r].to + ON_FACE) - ceil(span[r].from - ON_FACE) + 1);
        }
    }
    free(span);
    return MS_OK;
}
