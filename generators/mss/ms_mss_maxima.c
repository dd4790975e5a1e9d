#include "ms_mss_maxima.h"

#include <stdlib.h>
#include <string.h>

/* A maximum and its place depend on so many voxels around (eq. 11). */
enum { AROUND = 2 };

/* E* is computed for so many planes at a time, and AROUND more on either side. */
enum { SLAB = 48 };

typedef struct maxima_list {
    ms_mss_maximum *item;
    size_t count, room;
} maxima_list;

static int holds_voxel(const ms_mss_box *box, const int at[3])
{
    for (int a = 0; a < 3; a++) {
        if (at[a] < box->lo[a] - AROUND || at[a] >= box->hi[a] + AROUND) {
            return 0;
        }
    }
    return 1;
}

/* Is a voxel in one of the first boxes? */
static int is_in_boxes(const ms_mss_field *field, size_t boxes, size_t voxel)
{
    int at[3];
    ms_grid_voxel(at, field->target->grid.n, voxel);
    for (size_t b = 0; b < boxes; b++) {
        if (holds_voxel(&field->changed[b], at)) {
            return 1;
        }
    }
    return 0;
}

int ms_mss_maxima_is_stale(const ms_mss_field *field, size_t voxel)
{
    return is_in_boxes(field, field->n_changed, voxel);
}

static void fill_star(float *star, const ms_mss_field *field, const ms_mss_box *part)
{
    const int row = part->hi[0] - part->lo[0];
    const size_t plane = (size_t)row * (size_t)(part->hi[1] - part->lo[1]);
#pragma omp parallel for if (plane * (size_t)(part->hi[2] - part->lo[2]) >= MS_GRID_THREADS_FROM)
    for (int k = part->lo[2]; k < part->hi[2]; k++) {
        for (int j = part->lo[1]; j < part->hi[1]; j++) {
            const size_t from = ms_grid_index(&field->target->grid, part->lo[0], j, k);
            float *to = star + plane * (size_t)(k - part->lo[2]) + (size_t)row * (size_t)(j - part->lo[1]);
            for (int i = 0; i < row; i++) {
                to[i] = ms_mss_field_star(field, from + (size_t)i);
            }
        }
    }
}

static int list_reserve(maxima_list *l, size_t more)
{
    if (l->count + more > l->room) {
        const size_t room = l->count + l->count / 2 + more;
        ms_mss_maximum *grown = realloc(l->item, room * sizeof *grown);
        if (!grown) {
            return 0;
        }
        l->item = grown;
        l->room = room;
    }
    return 1;
}

/* Takes the maxima of a part into the list, but for those of earlier boxes. */
static int take_maxima(maxima_list *l, const float *star, const ms_mss_field *field, const ms_mss_box *part, size_t box,
                       const size_t *voxel, size_t count)
{
    const int n[3] = {part->hi[0] - part->lo[0], part->hi[1] - part->lo[1], part->hi[2] - part->lo[2]};
    if (!list_reserve(l, count)) {
        return 0;
    }
    for (size_t p = 0; p < count; p++) {
        ms_mss_maximum m;
        ms_peaks_refine(&m.peak, star, n, voxel[p]);
        for (int a = 0; a < 3; a++) {
            m.peak.voxel[a] += part->lo[a];
        }
        m.voxel = ms_grid_index(&field->target->grid, m.peak.voxel[0], m.peak.voxel[1], m.peak.voxel[2]);
        if (!is_in_boxes(field, box, m.voxel)) {
            l->item[l->count++] = m;
        }
    }
    return 1;
}

/* The maxima in a slab; `star` has room for the slab and AROUND voxels around it. */
static ms_status find_in_slab(maxima_list *l, float *star, const ms_mss_field *field, const ms_mss_box *slab,
                              size_t box, ms_error *err)
{
    const ms_mss_box part = ms_mss_field_grow(slab, AROUND, field->target->grid.n);
    int n[3], lo[3], hi[3];
    size_t *voxel, count;
    for (int a = 0; a < 3; a++) {
        n[a] = part.hi[a] - part.lo[a];
        lo[a] = slab->lo[a] - part.lo[a];
        hi[a] = slab->hi[a] - part.lo[a];
    }
    fill_star(star, field, &part);
    ms_status status = ms_peaks_find(&voxel, &count, star, n, lo, hi, err);
    if (status == MS_OK && !take_maxima(l, star, field, &part, box, voxel, count)) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu maxima; use fewer cells", l->count + count);
    }
    free(voxel);
    return status;
}

static ms_status find_in_box(maxima_list *l, const ms_mss_field *field, size_t box, ms_error *err)
{
    const int *n = field->target->grid.n;
    ms_mss_box whole = ms_mss_field_grow(&field->changed[box], AROUND, n), slab = whole;
    const ms_mss_box around = ms_mss_field_grow(&whole, AROUND, n);
    const int planes =
        around.hi[2] - around.lo[2] < SLAB + 2 * AROUND ? around.hi[2] - around.lo[2] : SLAB + 2 * AROUND;
    const size_t plane = (size_t)(around.hi[0] - around.lo[0]) * (size_t)(around.hi[1] - around.lo[1]);
    float *star = malloc(plane * (size_t)planes * sizeof *star);
    ms_status status = star ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the field E* of %d planes", planes);
    for (int k = whole.lo[2]; k < whole.hi[2] && status == MS_OK; k += SLAB) {
        slab.lo[2] = k;
        slab.hi[2] = k + SLAB < whole.hi[2] ? k + SLAB : whole.hi[2];
        status = find_in_slab(l, star, field, &slab, box, err);
    }
    free(star);
    return status;
}

ms_status ms_mss_maxima_find(ms_mss_maximum **found, size_t *count, const ms_mss_field *field, ms_error *err)
{
    maxima_list list = {0};
    ms_status status = MS_OK;
    for (size_t b = 0; b < field->n_changed && status == MS_OK; b++) {
        status = find_in_box(&list, field, b, err);
    }
    if (status != MS_OK) {
        free(list.item);
        list = (maxima_list){0};
    }
    *found = list.item;
    *count = list.count;
    return status;
}
