#include "ms_components.h"

#include <stdlib.h>
#include <string.h>

/* Voxels lo <= x < hi of a row. */
typedef struct voxel_run {
    int lo, hi;
    uint32_t parent; /* an earlier run of the same component, or itself */
} voxel_run;

typedef struct run_list {
    voxel_run *run;
    size_t count, capacity;
    size_t *first; /* run of each row; one more than there are rows */
    size_t ny, nz;
} run_list;

static void free_runs(run_list *list)
{
    free(list->run);
    free(list->first);
}

static ms_status append_run(run_list *list, int lo, int hi, ms_error *err)
{
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity ? list->capacity + list->capacity / 2 : 1024;
        voxel_run *grown = capacity < UINT32_MAX ? realloc(list->run, capacity * sizeof *grown) : NULL;
        if (!grown) {
            return ms_fail(err, capacity < UINT32_MAX ? MS_ERR_NOMEM : MS_ERR_LIMIT,
                           "no memory for %zu runs of voxels; crop the volume", capacity);
        }
        list->run = grown;
        list->capacity = capacity;
    }
    list->run[list->count] = (voxel_run){lo, hi, (uint32_t)list->count};
    list->count++;
    return MS_OK;
}

static uint32_t find_root(voxel_run *run, uint32_t r)
{
    while (run[r].parent != r) {
        run[r].parent = run[run[r].parent].parent;
        r = run[r].parent;
    }
    return r;
}

/* The first run of a component is its root. */
static void join(voxel_run *run, size_t a, size_t b)
{
    const uint32_t x = find_root(run, (uint32_t)a), y = find_root(run, (uint32_t)b);
    run[x > y ? x : y].parent = x < y ? x : y;
}

/* Joins the runs of the last row to those of an earlier one that they touch, or miss by no more than `reach`. */
static void join_row_pair(run_list *list, size_t row, size_t earlier, int reach)
{
    voxel_run *run = list->run;
    size_t a = list->first[row], b = list->first[earlier];
    while (a < list->count && b < list->first[earlier + 1]) {
        if (run[a].lo < run[b].hi + reach && run[b].lo < run[a].hi + reach) {
            join(run, a, b);
        }
        if (run[a].hi < run[b].hi) {
            a++;
        } else {
            b++;
        }
    }
}

/* Neighbours differ by 1 along at most `axes` axes. */
static void join_earlier_rows(run_list *list, size_t y, size_t z, int axes)
{
    const size_t row = z * list->ny + y;
    const int face = axes > 1; /* a row that shares a face: neighbours may be one aside as well */
    if (y > 0) {
        join_row_pair(list, row, row - 1, face);
    }
    if (z > 0) {
        join_row_pair(list, row, row - list->ny, face);
    }
    if (z > 0 && axes > 1 && y > 0) {
        join_row_pair(list, row, row - list->ny - 1, axes > 2);
    }
    if (z > 0 && axes > 1 && y + 1 < list->ny) {
        join_row_pair(list, row, row - list->ny + 1, axes > 2);
    }
}

static ms_status find_runs(run_list *list, const uint32_t *label, int nx, int axes, ms_error *err)
{
    for (size_t row = 0; row < list->ny * list->nz; row++) {
        const uint32_t *at = label + row * (size_t)nx;
        list->first[row] = list->count;
        for (int lo = 0, hi; lo < nx; lo = hi) {
            for (hi = lo; hi < nx && at[hi];) {
                hi++;
            }
            const ms_status status = hi > lo ? append_run(list, lo, hi, err) : MS_OK;
            if (status != MS_OK) {
                return status;
            }
            hi += hi == lo;
        }
        join_earlier_rows(list, row % list->ny, row / list->ny, axes);
    }
    list->first[list->ny * list->nz] = list->count;
    return MS_OK;
}

/* A root comes before the other runs of its component, whose parent becomes the number. */
static size_t number_runs(uint32_t *label, run_list *list, int nx)
{
    size_t count = 0;
    for (size_t r = 0; r < list->count; r++) {
        voxel_run *run = &list->run[r];
        run->parent = run->parent == r ? (uint32_t)++count : list->run[run->parent].parent;
    }
    for (size_t row = 0; row < list->ny * list->nz; row++) {
        for (size_t r = list->first[row]; r < list->first[row + 1]; r++) {
            for (int x = list->run[r].lo; x < list->run[r].hi; x++) {
                label[row * (size_t)nx + (size_t)x] = list->run[r].parent;
            }
        }
    }
    return count;
}

ms_status ms_components_label(uint32_t *label, size_t *count, const int n[3], int connectivity, ms_error *err)
{
    run_list list = {.ny = (size_t)n[1], .nz = (size_t)n[2]};
    const int axes = connectivity == 6 ? 1 : connectivity == 18 ? 2 : 3;
    *count = 0;
    if (connectivity != 6 && connectivity != 18 && connectivity != 26) {
        return ms_fail(err, MS_ERR_ARG, "a connectivity of %d is none of 6, 18 and 26", connectivity);
    }
    list.first = malloc((list.ny * list.nz + 1) * sizeof *list.first);
    ms_status status = list.first ? find_runs(&list, label, n[0], axes, err)
                                  : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu rows of voxels", list.ny * list.nz);
    if (status == MS_OK) {
        for (size_t r = 0; r < list.count; r++) {
            list.run[r].parent = find_root(list.run, (uint32_t)r);
        }
        *count = number_runs(label, &list, n[0]);
    }
    free_runs(&list);
    return status;
}

/* Which component has most voxels; the first of equal ones. */
static uint32_t find_largest(size_t *voxels, size_t components, const ms_volume *volume, size_t count)
{
    uint32_t largest = 1;
    for (size_t i = 0; i < count; i++) {
        voxels[volume->label[i]] += volume->label[i] != 0;
    }
    for (size_t c = 2; c <= components; c++) {
        largest = voxels[c] > voxels[largest] ? (uint32_t)c : largest;
    }
    return largest;
}

ms_status ms_components_keep_largest(ms_volume *volume, size_t *count, int connectivity, ms_error *err)
{
    const size_t voxels = (size_t)volume->n[0] * (size_t)volume->n[1] * (size_t)volume->n[2];
    uint32_t label = 0;
    for (size_t i = 0; i < voxels && label == 0; i++) {
        label = volume->label[i];
    }
    const ms_status status = ms_components_label(volume->label, count, volume->n, connectivity, err);
    if (status != MS_OK) {
        return status;
    }
    size_t *size = calloc(*count + 1, sizeof *size);
    const uint32_t largest = size ? find_largest(size, *count, volume, voxels) : 0;
    for (size_t i = 0; i < voxels; i++) {
        const int stays = largest ? volume->label[i] == largest : volume->label[i] != 0;
        volume->label[i] = stays ? label : 0;
    }
    free(size);
    return largest ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the sizes of %zu pieces", *count);
}
