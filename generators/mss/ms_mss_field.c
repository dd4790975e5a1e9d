#include "ms_mss_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_distance.h"

/* A part of the grid up to a fifth of it is transformed by itself: its flags and distances, five
 * bytes a voxel, then take no more memory than the flags of the whole grid would. */
enum { LARGEST_PART = 5 };

typedef struct voxel_box {
    int lo[3], hi[3];
} voxel_box;

static size_t box_voxels(const voxel_box *b)
{
    return (size_t)(b->hi[0] - b->lo[0]) * (size_t)(b->hi[1] - b->lo[1]) * (size_t)(b->hi[2] - b->lo[2]);
}

static voxel_box box_grow(const voxel_box *b, int margin, const int n[3])
{
    voxel_box grown;
    for (int a = 0; a < 3; a++) {
        grown.lo[a] = b->lo[a] > margin ? b->lo[a] - margin : 0;
        grown.hi[a] = b->hi[a] < n[a] - margin ? b->hi[a] + margin : n[a];
    }
    return grown;
}

static void box_include(voxel_box *b, int from, int to, int j, int k)
{
    const int lo[3] = {from, j, k}, hi[3] = {to, j + 1, k + 1};
    for (int a = 0; a < 3; a++) {
        b->lo[a] = lo[a] < b->lo[a] ? lo[a] : b->lo[a];
        b->hi[a] = hi[a] > b->hi[a] ? hi[a] : b->hi[a];
    }
}

ms_status ms_mss_field_init(ms_mss_field *field, const ms_target *target, const ms_settings *settings, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(&target->grid);
    float deepest = 0;
    memset(field, 0, sizeof *field);
    field->target = target;
    field->weight = 1;
    field->star = malloc(voxels * sizeof *field->star);
    field->own_e = settings->n_planes ? malloc(voxels * sizeof *field->own_e) : NULL;
    if (!field->star || (settings->n_planes && !field->own_e)) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the field E* of %zu voxels; use fewer cells", voxels);
    }
    if (settings->n_planes) {
        ms_planes_cut(field->own_e, target, settings);
    }
    field->e = settings->n_planes ? field->own_e : target->distance;
#pragma omp parallel for reduction(max : deepest) if (voxels >= MS_GRID_THREADS_FROM)
    for (size_t v = 0; v < voxels; v++) {
        field->star[v] = 2 * field->e[v];
        deepest = field->e[v] > deepest ? field->e[v] : deepest;
    }
    field->deepest = deepest;
    memcpy(field->hi, target->grid.n, sizeof field->hi);
    return ms_raster_alloc(&field->raster, &target->grid, target->rule, err);
}

void ms_mss_field_free(ms_mss_field *field)
{
    ms_raster_free(&field->raster);
    free(field->star);
    free(field->own_e);
}

/* E* = E + w (E - E~), and back. */
static float star_of(const ms_mss_field *field, float e, float e_union)
{
    return (1 + field->weight) * e - field->weight * e_union;
}

static float union_of(const ms_mss_field *field, float e, float star)
{
    return ((1 + field->weight) * e - star) / field->weight;
}

/* Which voxels of a part S~ covers. */
static void copy_covered(uint8_t *covered, const ms_mss_field *field, const voxel_box *part)
{
    const size_t row = (size_t)(part->hi[0] - part->lo[0]), plane = row * (size_t)(part->hi[1] - part->lo[1]);
#pragma omp parallel for if (plane * (size_t)(part->hi[2] - part->lo[2]) >= MS_GRID_THREADS_FROM)
    for (int k = part->lo[2]; k < part->hi[2]; k++) {
        for (int j = part->lo[1]; j < part->hi[1]; j++) {
            const uint16_t *from = field->raster.first + ms_grid_index(&field->target->grid, part->lo[0], j, k);
            uint8_t *to = covered + plane * (size_t)(k - part->lo[2]) + row * (size_t)(j - part->lo[1]);
            for (size_t i = 0; i < row; i++) {
                to[i] = from[i] != MS_RASTER_NONE;
            }
        }
    }
}

static ms_status update_whole(ms_mss_field *field, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(&field->target->grid);
    voxel_box all = {{0, 0, 0}, {0, 0, 0}};
    memcpy(all.hi, field->target->grid.n, sizeof all.hi);
    memcpy(field->lo, all.lo, sizeof field->lo);
    memcpy(field->hi, all.hi, sizeof field->hi);
    uint8_t *covered = malloc(voxels);
    if (!covered) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", voxels);
    }
    copy_covered(covered, field, &all);
    ms_status status = ms_distance(field->star, covered, all.hi, err);
    free(covered);
    float deepest = 0;
#pragma omp parallel for reduction(max : deepest) if (voxels >= MS_GRID_THREADS_FROM)
    for (size_t v = 0; v < voxels; v++) {
        deepest = field->star[v] > deepest ? field->star[v] : deepest;
        field->star[v] = star_of(field, field->e[v], field->star[v]);
    }
    field->deepest_union = deepest;
    return status;
}

static double find_gap(int at, int lo, int hi)
{
    return at < lo ? lo - at : at >= hi ? at - hi + 1 : 0;
}

static void box_join(voxel_box *b, const voxel_box *other)
{
    for (int a = 0; a < 3; a++) {
        b->lo[a] = other->lo[a] < b->lo[a] ? other->lo[a] : b->lo[a];
        b->hi[a] = other->hi[a] > b->hi[a] ? other->hi[a] : b->hi[a];
    }
}
#pragma omp declare reduction(hull:voxel_box : box_join(&omp_out, &omp_in)) initializer(omp_priv = omp_orig)

/*
 * The voxels whose E~ may change: those that are covered now, and those that had their
 * nearest background voxel among these, which then was within their old E~.
 */
static voxel_box changed_box(const ms_mss_field *field)
{
    const ms_grid *grid = &field->target->grid;
    voxel_box covered, changed;
    memcpy(covered.lo, field->raster.lo, sizeof covered.lo);
    memcpy(covered.hi, field->raster.hi, sizeof covered.hi);
    const voxel_box reach = box_grow(&covered, (int)ceilf(field->deepest_union) + 1, grid->n);
    changed = covered;
#pragma omp parallel for schedule(dynamic, 4) reduction(hull \
                                                        : changed) if (ms_grid_voxels(grid) >= MS_GRID_THREADS_FROM)
    for (int k = reach.lo[2]; k < reach.hi[2]; k++) {
        for (int j = reach.lo[1]; j < reach.hi[1]; j++) {
            const double dz = find_gap(k, covered.lo[2], covered.hi[2]), dy = find_gap(j, covered.lo[1], covered.hi[1]);
            const float away = (float)sqrt(dz * dz + dy * dy) - 0.01f; /* E~ is known up to rounding */
            const size_t start = ms_grid_index(grid, 0, j, k);
            const float *e = field->e + start, *star = field->star + start;
            int from = reach.lo[0], to = reach.hi[0];
            while (from < to &&
                   union_of(field, e[from], star[from]) < fmaxf(away, (float)(covered.lo[0] - from) - 0.01f)) {
                from++;
            }
            while (from < to &&
                   union_of(field, e[to - 1], star[to - 1]) < fmaxf(away, (float)(to - covered.hi[0]) - 0.01f)) {
                to--;
            }
            if (from < to) {
                box_include(&changed, from, to, j, k);
            }
        }
    }
    return changed;
}

static float deepest_in(const ms_mss_field *field, const voxel_box *b)
{
    float deepest = 0;
    for (int k = b->lo[2]; k < b->hi[2]; k++) {
        for (int j = b->lo[1]; j < b->hi[1]; j++) {
            const float *e = field->target->distance + ms_grid_index(&field->target->grid, 0, j, k);
            for (int i = b->lo[0]; i < b->hi[0]; i++) {
                deepest = e[i] > deepest ? e[i] : deepest;
            }
        }
    }
    return deepest;
}

/* How far a voxel is from the outside of the part, where the part is not the grid's own end. */
static int depth_in_part(const voxel_box *part, const int n[3], int i, int j, int k)
{
    const int at[3] = {i, j, k};
    int depth = MS_GRID_MAX_EXTENT;
    for (int a = 0; a < 3; a++) {
        if (part->lo[a] > 0 && at[a] - part->lo[a] + 1 < depth) {
            depth = at[a] - part->lo[a] + 1;
        }
        if (part->hi[a] < n[a] && part->hi[a] - at[a] < depth) {
            depth = part->hi[a] - at[a];
        }
    }
    return depth;
}

/* Writes E* of the changed voxels; 0 if a distance may be to background beyond the part. */
static int write_star(ms_mss_field *field, const float *distance, const voxel_box *part, const voxel_box *changed)
{
    const ms_grid *grid = &field->target->grid;
    const size_t row = (size_t)(part->hi[0] - part->lo[0]), plane = row * (size_t)(part->hi[1] - part->lo[1]);
    float deepest = field->deepest_union;
    int exact = 1;
#pragma omp parallel for reduction(& : exact) reduction(max : deepest) \
    if (plane * (size_t)(part->hi[2] - part->lo[2]) >= MS_GRID_THREADS_FROM)
    for (int k = changed->lo[2]; k < changed->hi[2]; k++) {
        for (int j = changed->lo[1]; j < changed->hi[1]; j++) {
            const float *from = distance + plane * (size_t)(k - part->lo[2]) + row * (size_t)(j - part->lo[1]);
            const size_t start = ms_grid_index(grid, 0, j, k);
            for (int i = changed->lo[0]; i < changed->hi[0]; i++) {
                const float d = from[i - part->lo[0]];
                exact &= d <= (float)depth_in_part(part, grid->n, i, j, k);
                deepest = d > deepest ? d : deepest;
                field->star[start + (size_t)i] = star_of(field, field->e[start + (size_t)i], d);
            }
        }
    }
    field->deepest_union = deepest;
    return exact;
}

/* @param[out] done 0 if the part proved too small */
static ms_status update_part(int *done, ms_mss_field *field, const voxel_box *part, const voxel_box *changed,
                             ms_error *err)
{
    const size_t voxels = box_voxels(part);
    const int n[3] = {part->hi[0] - part->lo[0], part->hi[1] - part->lo[1], part->hi[2] - part->lo[2]};
    uint8_t *covered = malloc(voxels);
    float *distance = malloc(voxels * sizeof *distance);
    ms_status status = MS_OK;
    *done = 0;
    if (!covered || !distance) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", voxels);
    } else {
        copy_covered(covered, field, part);
        status = ms_distance(distance, covered, n, err);
    }
    if (status == MS_OK) {
        *done = write_star(field, distance, part, changed);
        memcpy(field->lo, changed->lo, sizeof field->lo);
        memcpy(field->hi, changed->hi, sizeof field->hi);
    }
    free(covered);
    free(distance);
    return status;
}

ms_status ms_mss_field_add(ms_mss_field *field, const ms_ball *balls, size_t count, ms_error *err)
{
    const int *n = field->target->grid.n;
    ms_status status = ms_raster_add(&field->raster, balls, count, err);
    memset(field->lo, 0, sizeof field->lo);
    memset(field->hi, 0, sizeof field->hi);
    if (status != MS_OK || field->raster.hi[0] == field->raster.lo[0]) {
        return status; /* failed, or nothing newly covered */
    }
    /* Background is at most as far as that of the target, and spheres may stand out of it by
     * a voxel or so; write_star checks. */
    const voxel_box changed = changed_box(field);
    const voxel_box part = box_grow(&changed, (int)ceilf(deepest_in(field, &changed)) + 2, n);
    int done = 0;
    if (box_voxels(&part) <= ms_grid_voxels(&field->target->grid) / LARGEST_PART) {
        status = update_part(&done, field, &part, &changed, err);
    }
    return done || status != MS_OK ? status : update_whole(field, err);
}

ms_status ms_mss_field_set_weight(ms_mss_field *field, float weight, ms_error *err)
{
    field->weight = weight;
    return update_whole(field, err);
}
