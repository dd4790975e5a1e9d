/* Where the voxels of a grid of cubes, along x, y and z of space, lie among those of a file. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "ms_scan_store.h"

/* Spacings that programs have written with six digits still count as equal. */
#define CUBE_TOLERANCE 1e-5

/* Along an axis whose voxels are replaced by cubes: the header of a small file can claim edges of any ratio. */
enum { MOST_CUBES = 1 << 22 };

/* One axis of the file. */
typedef struct file_axis {
    size_t n, stride; /* voxels, and bytes from one to the next */
    int mirrored;
    double spacing, origin; /* of the voxel lowest in space */
} file_axis;

static int is_cubic(const ms_volume_header *header)
{
    int cubic = 1;
    for (int f = 1; f < 3; f++) {
        cubic &= fabs(header->spacing[f] - header->spacing[0]) <= CUBE_TOLERANCE * header->spacing[0];
    }
    return cubic;
}

static file_axis describe_axis(const ms_volume_header *header, int a)
{
    file_axis axis = {.stride = header->sample.size};
    int f = 0;
    for (; header->axis[f] != a; f++) {
        axis.stride *= (size_t)header->n[f];
    }
    axis.n = (size_t)header->n[f];
    axis.mirrored = header->mirrored[f];
    axis.spacing = header->spacing[f];
    axis.origin = header->origin[a] - (axis.mirrored ? axis.spacing * (double)(axis.n - 1) : 0);
    return axis;
}

/* Bytes to the voxel of the file that is the i-th upwards in space. */
static size_t byte_of(const file_axis *axis, double i)
{
    const size_t last = axis->n - 1, at = i > 0 ? (size_t)i : 0, within = at < last ? at : last;
    return axis->stride * (axis->mirrored ? last - within : within);
}

/* The i-th cube's centre is `start` + i * `step` voxels of the file above the lowest one. */
static void fill_table(ms_scan_axis *table, size_t n, const file_axis *axis, double start, double step)
{
    for (size_t i = 0; i < n; i++) {
        const double at = fmin(fmax(start + step * (double)i, 0), (double)(axis->n - 1));
        table->near[i] = byte_of(axis, floor(at + 0.5));
        table->low[i] = byte_of(axis, floor(at));
        table->high[i] = byte_of(axis, floor(at) + 1);
        table->weight[i] = at - floor(at);
    }
    table->step = axis->mirrored || step != 1.0 ? 0 : axis->stride;
}

static ms_status make_table(ms_scan_axis *table, size_t n, const char *path, ms_error *err)
{
    table->near = malloc(n * sizeof *table->near);
    table->low = malloc(n * sizeof *table->low);
    table->high = malloc(n * sizeof *table->high);
    table->weight = malloc(n * sizeof *table->weight);
    return table->near && table->low && table->high && table->weight
               ? MS_OK
               : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for an axis of %zu voxels", path, n);
}

ms_status ms_scan_store_lattice(ms_scan *scan, ms_error *err)
{
    const ms_volume_header *header = &scan->store->stored.header;
    const double *s = header->spacing;
    scan->is_resampled = !is_cubic(header);
    scan->spacing = scan->is_resampled ? fmin(s[0], fmin(s[1], s[2])) : s[0];
    for (int a = 0; a < 3; a++) {
        const file_axis axis = describe_axis(header, a);
        const double length = axis.spacing * (double)axis.n;
        const double n = scan->is_resampled ? fmax(1, round(length / scan->spacing)) : (double)axis.n;
        if (!(n <= (scan->is_resampled ? MOST_CUBES : INT_MAX))) {
            return ms_fail(err, MS_ERR_LIMIT,
                           "%s: its voxels are %g x %g x %g, which makes %.3g cubes along one axis; resample it",
                           scan->store->path, s[0], s[1], s[2], n);
        }
        scan->n[a] = (int)n;
        scan->stored_spacing[a] = axis.spacing;
        /* The cubes lie in the middle of the box of the voxels. */
        const double aside = scan->is_resampled ? (length - axis.spacing - scan->spacing * (n - 1)) / 2 : 0;
        scan->origin[a] = axis.origin + aside;
        const ms_status status = make_table(&scan->store->axis[a], (size_t)n, scan->store->path, err);
        if (status != MS_OK) {
            return status;
        }
        fill_table(&scan->store->axis[a], (size_t)n, &axis, aside / axis.spacing,
                   scan->is_resampled ? scan->spacing / axis.spacing : 1.0);
    }
    return MS_OK;
}
