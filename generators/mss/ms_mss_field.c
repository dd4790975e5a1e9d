#include "ms_mss_field.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_distance.h"

/* How far S~ may stand out of S, in voxels, beyond the distance to its background that E gives; write-back checks. */
enum { STAND_OUT = 3 };

static size_t count_box(const ms_mss_box *b)
{
    return (size_t)(b->hi[0] - b->lo[0]) * (size_t)(b->hi[1] - b->lo[1]) * (size_t)(b->hi[2] - b->lo[2]);
}

ms_mss_box ms_mss_field_grow(const ms_mss_box *box, int margin, const int n[3])
{
    ms_mss_box grown;
    for (int a = 0; a < 3; a++) {
        grown.lo[a] = box->lo[a] > margin ? box->lo[a] - margin : 0;
        grown.hi[a] = box->hi[a] < n[a] - margin ? box->hi[a] + margin : n[a];
    }
    return grown;
}

static ms_status add_changed(ms_mss_field *field, const ms_mss_box *box, ms_error *err)
{
    if (field->n_changed == field->room) {
        const size_t room = 2 * field->room + 16;
        ms_mss_box *grown = realloc(field->changed, room * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu boxes", room);
        }
        field->changed = grown;
        field->room = room;
    }
    field->changed[field->n_changed++] = *box;
    return MS_OK;
}

ms_status ms_mss_field_touch_all(ms_mss_field *field, ms_error *err)
{
    ms_mss_box all = {{0, 0, 0}, {0, 0, 0}};
    memcpy(all.hi, field->target->grid.n, sizeof all.hi);
    field->n_changed = 0;
    return add_changed(field, &all, err);
}

ms_status ms_mss_field_init(ms_mss_field *field, const ms_target *target, const ms_settings *settings, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(&target->grid);
    float deepest = 0;
    memset(field, 0, sizeof *field);
    field->target = target;
    field->weight = 1;
    field->within = calloc(voxels, sizeof *field->within);
    field->own_e = settings->n_planes ? malloc(voxels * sizeof *field->own_e) : NULL;
    if (!field->within || (settings->n_planes && !field->own_e)) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the field E~ of %zu voxels; use fewer cells", voxels);
    }
    if (settings->n_planes) {
        ms_planes_cut(field->own_e, target, settings);
    }
    field->e = settings->n_planes ? field->own_e : target->distance;
#pragma omp parallel for reduction(max : deepest) if (voxels >= MS_GRID_THREADS_FROM)
    for (size_t v = 0; v < voxels; v++) {
        deepest = field->e[v] > deepest ? field->e[v] : deepest;
    }
    field->deepest = deepest;
    const ms_status status = ms_mss_field_touch_all(field, err);
    return status == MS_OK ? ms_raster_alloc(&field->raster, &target->grid, target->rule, err) : status;
}

void ms_mss_field_free(ms_mss_field *field)
{
    ms_raster_free(&field->raster);
    free(field->within);
    free(field->own_e);
    free(field->changed);
}

/* Which voxels of a part S~ covers. */
static void copy_covered(uint8_t *covered, const ms_mss_field *field, const ms_mss_box *part)
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
    ms_status status = ms_mss_field_touch_all(field, err);
    uint8_t *covered = status == MS_OK ? malloc(voxels) : NULL;
    if (!covered) {
        return status != MS_OK
                   ? status
                   : ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", voxels);
    }
    copy_covered(covered, field, &field->changed[0]);
    status = ms_distance(field->within, covered, field->target->grid.n, err);
    free(covered);
    float deepest = 0;
#pragma omp parallel for reduction(max : deepest) if (voxels >= MS_GRID_THREADS_FROM)
    for (size_t v = 0; v < voxels; v++) {
        deepest = field->within[v] > deepest ? field->within[v] : deepest;
    }
    field->deepest_within = deepest;
    return status;
}

static int find_gap(int at, int lo, int hi)
{
    return at < lo ? lo - at : at >= hi ? at - hi + 1 : 0;
}

/* Takes in the voxels lo <= (i,j,k) < hi. */
static void include_box(ms_mss_box *b, const int lo[3], const int hi[3])
{
    for (int a = 0; a < 3; a++) {
        b->lo[a] = lo[a] < b->lo[a] ? lo[a] : b->lo[a];
        b->hi[a] = hi[a] > b->hi[a] ? hi[a] : b->hi[a];
    }
}

static void join_boxes(ms_mss_box *b, const ms_mss_box *other)
{
    include_box(b, other->lo, other->hi);
}
#pragma omp declare reduction(hull:ms_mss_box : join_boxes(&omp_out, &omp_in)) initializer(omp_priv = omp_orig)

/*
 * The voxels whose E~ may change by what has been covered in a box: those that are covered now, and those that had
 * their nearest background voxel among these, which then was as far as their old E~.
 */
static ms_mss_box find_changed(const ms_mss_field *field, const ms_mss_box *covered)
{
    const ms_grid *grid = &field->target->grid;
    const ms_mss_box reach = ms_mss_field_grow(covered, (int)ceilf(field->deepest_within), grid->n);
    ms_mss_box changed = *covered;
#pragma omp parallel for schedule(dynamic, 4) reduction(hull : changed) if (count_box(&reach) >= MS_GRID_THREADS_FROM)
    for (int k = reach.lo[2]; k < reach.hi[2]; k++) {
        for (int j = reach.lo[1]; j < reach.hi[1]; j++) {
            const int z = find_gap(k, covered->lo[2], covered->hi[2]), y = find_gap(j, covered->lo[1], covered->hi[1]);
            const float away = sqrtf((float)(z * z + y * y)); /* the distance is no less, and no less than along x */
            const float *within = field->within + ms_grid_index(grid, 0, j, k);
            int from = reach.lo[0], to = reach.hi[0];
            while (from < to && (within[from] < away || within[from] < (float)(covered->lo[0] - from))) {
                from++;
            }
            while (from < to && (within[to - 1] < away || within[to - 1] < (float)(to - covered->hi[0]))) {
                to--;
            }
            if (from < to) {
                include_box(&changed, (int[3]){from, j, k}, (int[3]){to, j + 1, k + 1});
            }
        }
    }
    return changed;
}

/* All voxels that may be the nearest background of one in the box: none is farther than E and what S~ stands out. */
static ms_mss_box find_surroundings(const ms_mss_field *field, const ms_mss_box *box)
{
    const ms_grid *grid = &field->target->grid;
    ms_mss_box part = *box;
#pragma omp parallel for reduction(hull : part) if (count_box(box) >= MS_GRID_THREADS_FROM)
    for (int k = box->lo[2]; k < box->hi[2]; k++) {
        for (int j = box->lo[1]; j < box->hi[1]; j++) {
            const float *e = field->target->distance + ms_grid_index(grid, 0, j, k);
            float deepest = 0;
            int lo = box->lo[0], hi = box->hi[0];
            for (int i = box->lo[0]; i < box->hi[0]; i++) {
                const int reach = (int)e[i] + 1 + STAND_OUT;
                deepest = e[i] > deepest ? e[i] : deepest;
                lo = i - reach < lo ? i - reach : lo;
                hi = i + reach >= hi ? i + reach + 1 : hi;
            }
            const int reach = (int)deepest + 1 + STAND_OUT;
            include_box(&part, (int[3]){lo, j - reach, k - reach}, (int[3]){hi, j + reach + 1, k + reach + 1});
        }
    }
    return ms_mss_field_grow(&part, 0, grid->n);
}

/* How far a voxel is from the outside of the part, where the part is not the grid's own end. */
static int find_depth(const ms_mss_box *part, const int n[3], int i, int j, int k)
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

/* Notes the largest E~ of a box; 0 if a distance in it may be to background beyond the part. */
static int check_exact(ms_mss_field *field, const ms_mss_box *part, const ms_mss_box *box)
{
    const ms_grid *grid = &field->target->grid;
    float deepest = field->deepest_within;
    int exact = 1;
#pragma omp parallel for reduction(& : exact) reduction(max : deepest) if (count_box(box) >= MS_GRID_THREADS_FROM)
    for (int k = box->lo[2]; k < box->hi[2]; k++) {
        for (int j = box->lo[1]; j < box->hi[1]; j++) {
            const float *within = field->within + ms_grid_index(grid, 0, j, k);
            for (int i = box->lo[0]; i < box->hi[0]; i++) {
                exact &= within[i] <= 1 + STAND_OUT || within[i] <= (float)find_depth(part, grid->n, i, j, k);
                deepest = within[i] > deepest ? within[i] : deepest;
            }
        }
    }
    field->deepest_within = deepest;
    return exact;
}

/* @param[out] done 0 if the part proved too small */
static ms_status update_part(int *done, ms_mss_field *field, const ms_mss_box *part, const ms_mss_box *box,
                             ms_error *err)
{
    const ms_grid *grid = &field->target->grid;
    int n[3], lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        n[a] = part->hi[a] - part->lo[a];
        lo[a] = box->lo[a] - part->lo[a];
        hi[a] = box->hi[a] - part->lo[a];
    }
    const size_t voxels = count_box(part), apart[2] = {(size_t)grid->n[0], (size_t)grid->n[0] * (size_t)grid->n[1]};
    uint8_t *covered = malloc(voxels);
    *done = 0;
    if (!covered) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", voxels);
    }
    copy_covered(covered, field, part);
    float *to = field->within + ms_grid_index(grid, box->lo[0], box->lo[1], box->lo[2]);
    const ms_status status = ms_distance_box(to, apart, covered, n, lo, hi, err);
    free(covered);
    *done = status == MS_OK && check_exact(field, part, box);
    return status;
}

/* Brings E~ up to date where one sphere has covered voxels; *cost grows by the voxels that it took. */
static ms_status update_around(int *done, size_t *cost, ms_mss_field *field, const ms_mss_box *covered, ms_error *err)
{
    const size_t all = ms_grid_voxels(&field->target->grid);
    const ms_mss_box box = find_changed(field, covered), part = find_surroundings(field, &box);
    const size_t columns =
        (size_t)(box.hi[0] - box.lo[0]) * (size_t)(box.hi[1] - box.lo[1]) * (size_t)(part.hi[2] - part.lo[2]);
    *cost += (count_box(&part) + columns + count_box(&box)) / 3;
    *done = 0;
    /* no more memory than the flags of the whole grid would take, and no more time */
    if (*cost > all || count_box(&part) + sizeof(float) * columns > all) {
        return MS_OK;
    }
    ms_status status = add_changed(field, &box, err);
    return status == MS_OK ? update_part(done, field, &part, &box, err) : status;
}

/* Adds spheres to S~; lists the boxes of what each has covered. */
static ms_status cover_balls(ms_mss_box *covered, size_t *n_covered, ms_mss_field *field, const ms_ball *balls,
                             size_t count, ms_error *err)
{
    const ms_raster *raster = &field->raster;
    ms_status status = MS_OK;
    *n_covered = 0;
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        status = ms_raster_add(&field->raster, &balls[b], 1, err);
        if (status == MS_OK && raster->hi[0] > raster->lo[0]) {
            ms_mss_box *next = &covered[(*n_covered)++];
            memcpy(next->lo, raster->lo, sizeof next->lo);
            memcpy(next->hi, raster->hi, sizeof next->hi);
        }
    }
    return status;
}

ms_status ms_mss_field_add(ms_mss_field *field, const ms_ball *balls, size_t count, ms_error *err)
{
    size_t n_covered = 0, cost = 0;
    int done = 1;
    ms_mss_box *covered = malloc((count + 1) * sizeof *covered);
    field->n_changed = 0;
    if (!covered) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    ms_status status = cover_balls(covered, &n_covered, field, balls, count, err);
    for (size_t b = 0; b < n_covered && done && status == MS_OK; b++) {
        status = update_around(&done, &cost, field, &covered[b], err);
    }
    free(covered);
    return done || status != MS_OK ? status : update_whole(field, err);
}
