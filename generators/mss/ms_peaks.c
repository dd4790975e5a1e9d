#include "ms_peaks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_grid.h"

/* Slopes below this difference are parallel: fields hold roots of whole numbers in float. */
static const double PARALLEL = 1e-5;

/* Not below any of the 26 neighbours. */
static int is_peak(const float *field, size_t v, size_t sy, size_t sz)
{
    const float here = field[v];
    if (!(here > 0) || field[v - 1] > here || field[v + 1] > here) {
        return 0;
    }
    for (int k = -1; k <= 1; k++) {
        for (int j = -1; j <= 1; j++) {
            const float *row = field + (ptrdiff_t)v + k * (ptrdiff_t)sz + j * (ptrdiff_t)sy;
            if (row[-1] > here || row[0] > here || row[1] > here) {
                return 0;
            }
        }
    }
    return 1;
}

typedef struct peak_list {
    size_t *voxel;
    size_t count, capacity;
} peak_list;

static int list_add(peak_list *l, size_t voxel)
{
    if (l->count == l->capacity) {
        size_t capacity = l->capacity ? 2 * l->capacity : 64;
        size_t *grown = realloc(l->voxel, capacity * sizeof *grown);
        if (!grown) {
            return 0;
        }
        l->voxel = grown;
        l->capacity = capacity;
    }
    l->voxel[l->count++] = voxel;
    return 1;
}

static int find_in_plane(peak_list *found, const float *field, const int n[3], const int lo[3], const int hi[3], int k)
{
    const size_t sy = (size_t)n[0], sz = sy * (size_t)n[1];
    for (int j = lo[1]; j < hi[1]; j++) {
        for (int i = lo[0]; i < hi[0]; i++) {
            size_t v = (size_t)i + sy * (size_t)j + sz * (size_t)k;
            if (is_peak(field, v, sy, sz) && !list_add(found, v)) {
                return 0;
            }
        }
    }
    return 1;
}

/* Joins the planes' lists in order. */
static ms_status join_planes(size_t **voxel, size_t *count, peak_list *plane, int planes, int complete, ms_error *err)
{
    size_t total = 0;
    for (int k = 0; k < planes; k++) {
        total += plane[k].count;
    }
    *voxel = complete ? malloc((total + 1) * sizeof **voxel) : NULL;
    *count = 0;
    for (int k = 0; k < planes; k++) {
        if (*voxel && plane[k].count) {
            memcpy(*voxel + *count, plane[k].voxel, plane[k].count * sizeof **voxel);
            *count += plane[k].count;
        }
        free(plane[k].voxel);
    }
    free(plane);
    return *voxel ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu local maxima", total);
}

ms_status ms_peaks_find(size_t **voxel, size_t *count, const float *field, const int n[3], const int lo[3],
                        const int hi[3], ms_error *err)
{
    int from[3], to[3], complete = 1;
    for (int a = 0; a < 3; a++) {
        from[a] = lo[a] < 1 ? 1 : lo[a];
        to[a] = hi[a] > n[a] - 1 ? n[a] - 1 : hi[a];
    }
    const int planes = to[2] > from[2] ? to[2] - from[2] : 0;
    const size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)planes;
    peak_list *plane = calloc((size_t)planes + 1, sizeof *plane);
    *voxel = NULL;
    *count = 0;
    if (!plane) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %d planes", planes);
    }
#pragma omp parallel for schedule(dynamic, 4) reduction(& : complete) if (voxels >= MS_GRID_THREADS_FROM)
    for (int k = 0; k < planes; k++) {
        complete &= find_in_plane(&plane[k], field, n, from, to, from[2] + k);
    }
    return join_planes(voxel, count, plane, planes, complete, err);
}

/* The field on the five voxels i*-2 .. i*+2 (eq. 11); e points to the middle. */
static void five_values(double e[5], const float *field, size_t voxel, size_t stride)
{
    for (int d = 0; d < 5; d++) {
        e[d] = (double)field[voxel - 2 * stride + (size_t)d * stride];
    }
}

/* Where g(-2,-1) crosses g(0,1) (eqs. 12 to 16), as shift and value; e[2] is the voxel. */
static void cross_left(double *shift, double *value, const double e[5])
{
    const double rise = e[1] - e[0], top = e[2] - e[1], fall = e[3] - e[2];
    *shift = 0;
    *value = e[2];
    if (rise - fall > PARALLEL) {
        *shift = (top - rise) / (rise - fall);
        *value = e[2] + *shift * rise + (rise - top);
    }
}

/* Where g(-1,0) crosses g(1,2) (eqs. 17 to 21): the mirror image. */
static void cross_right(double *shift, double *value, const double e[5])
{
    const double mirrored[5] = {e[4], e[3], e[2], e[1], e[0]};
    cross_left(shift, value, mirrored);
    *shift = -*shift;
}

/* Eq. 22, made symmetric. */
static void refine_axis(double *shift, double *value, const double e[5])
{
    double left, right, at_left, at_right;
    cross_left(&left, &at_left, e);
    cross_right(&right, &at_right, e);
    *shift = 0;
    *value = e[2];
    if (at_left > e[2] && at_left - at_right > PARALLEL) {
        *shift = left;
        *value = at_left;
    } else if (at_right > e[2] && at_right - at_left > PARALLEL) {
        *shift = right;
        *value = at_right;
    }
}

void ms_peaks_refine(ms_peak *peak, const float *field, const int n[3], size_t voxel)
{
    const size_t stride[3] = {1, (size_t)n[0], (size_t)n[0] * (size_t)n[1]};
    ms_grid_voxel(peak->voxel, n, voxel);
    peak->value = 0;
    for (int a = 0; a < 3; a++) {
        double e[5], value;
        five_values(e, field, voxel, stride[a]);
        refine_axis(&peak->shift[a], &value, e);
        peak->value = fmax(peak->value, value);
    }
}

double ms_peaks_value(const ms_peak *peak, const float *field, const int n[3])
{
    const size_t stride[3] = {1, (size_t)n[0], (size_t)n[0] * (size_t)n[1]};
    const size_t voxel =
        (size_t)peak->voxel[0] + (size_t)peak->voxel[1] * stride[1] + (size_t)peak->voxel[2] * stride[2];
    double largest = 0;
    for (int a = 0; a < 3; a++) {
        const double s = peak->shift[a];
        double e[5], value;
        five_values(e, field, voxel, stride[a]);
        if (s < 0) { /* g(-2,-1) and g(0,1) */
            value = fmin(e[1] + (s + 1) * (e[1] - e[0]), e[2] + s * (e[3] - e[2]));
        } else if (s > 0) { /* g(-1,0) and g(1,2) */
            value = fmin(e[2] + s * (e[2] - e[1]), e[3] + (s - 1) * (e[4] - e[3]));
        } else {
            value = e[2];
        }
        largest = fmax(largest, value);
    }
    return largest;
}
