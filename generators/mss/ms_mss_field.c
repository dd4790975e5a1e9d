#include "ms_mss_field.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_distance.h"

/* A box is seen in at most so many cells along an axis where a bound on a distance is enough. */
enum { CELLS = 24 };

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

/* The blocks of a row of the grid. */
static size_t count_blocks(const ms_mss_field *field)
{
    return ((size_t)field->target->grid.n[0] + MS_DISTANCE_BLOCK - 1) / MS_DISTANCE_BLOCK;
}

static size_t count_rows(const ms_mss_field *field)
{
    return (size_t)field->target->grid.n[1] * (size_t)field->target->grid.n[2];
}

static float find_deepest_e(const float *distance, size_t voxels)
{
    float deepest = 0;
#pragma omp parallel for reduction(max : deepest) if (voxels >= MS_GRID_THREADS_FROM)
    for (size_t v = 0; v < voxels; v++) {
        deepest = distance[v] > deepest ? distance[v] : deepest;
    }
    return deepest;
}

ms_status ms_mss_field_init(ms_mss_field *field, const ms_target *target, const ms_settings *settings, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(&target->grid);
    memset(field, 0, sizeof *field);
    field->target = target;
    field->weight = 1;
    field->own_e = settings->n_planes ? malloc(voxels * sizeof *field->own_e) : NULL;
    if (settings->n_planes && !field->own_e) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the field E of %zu voxels; use fewer cells", voxels);
    }
    if (settings->n_planes) {
        ms_planes_cut(field->own_e, target, settings);
    }
    field->e = settings->n_planes ? field->own_e : target->distance;
    field->deepest = find_deepest_e(field->e, voxels);
    return ms_raster_alloc(&field->raster, &target->grid, target->rule, err);
}

void ms_mss_field_free(ms_mss_field *field)
{
    ms_raster_free(&field->raster);
    free(field->within);
    free(field->covered);
    free(field->stale);
    free(field->own_e);
    free(field->changed);
}

/* Takes in the voxels lo <= (i,j,k) < hi. */
static void include_box(ms_mss_box *b, const int lo[3], const int hi[3])
{
    for (int a = 0; a < 3; a++) {
        b->lo[a] = lo[a] < b->lo[a] ? lo[a] : b->lo[a];
        b->hi[a] = hi[a] > b->hi[a] ? hi[a] : b->hi[a];
    }
}

/* Spheres that were added, and the box of what they have covered first. */
typedef struct covered_box {
    size_t first_new;
    ms_mss_box box;
} covered_box;

/* How far the voxels in the cells of a box are from those that new spheres have covered first, at least. */
typedef struct cell_map {
    int n[3], size;
    float *away;
} cell_map;

/* A cell and those that touch it: the distance to these, in cells, is a bound on that of voxels. */
static void clear_around(uint8_t *clear, const cell_map *map, int i, int j, int k)
{
    const int *n = map->n;
    if (clear[i + n[0] * (j + n[1] * k)] == 2) {
        return; /* done before */
    }
    for (int z = k > 0 ? k - 1 : 0; z <= k + 1 && z < n[2]; z++) {
        for (int y = j > 0 ? j - 1 : 0; y <= j + 1 && y < n[1]; y++) {
            for (int x = i > 0 ? i - 1 : 0; x <= i + 1 && x < n[0]; x++) {
                uint8_t *cell = &clear[x + n[0] * (y + n[1] * z)];
                *cell = *cell == 2 ? 2 : 0;
            }
        }
    }
    clear[i + n[0] * (j + n[1] * k)] = 2;
}

static int holds_new(const uint16_t *first, int from, int to, size_t first_new)
{
    int any = 0;
    for (int i = from; i < to; i++) {
        any |= (first[i] >= first_new) & (first[i] != MS_RASTER_NONE);
    }
    return any;
}

static void mark_cells(uint8_t *clear, const cell_map *map, const ms_mss_field *field, const ms_mss_box *box,
                       const covered_box *covered)
{
    const ms_mss_box *own = &covered->box;
    for (int k = own->lo[2]; k < own->hi[2]; k++) {
        for (int j = own->lo[1]; j < own->hi[1]; j++) {
            const uint16_t *first = field->raster.first + ms_grid_index(&field->target->grid, 0, j, k);
            for (int i = own->lo[0]; i < own->hi[0];) {
                const int cell = (i - box->lo[0]) / map->size, end = box->lo[0] + (cell + 1) * map->size;
                const int to = end < own->hi[0] ? end : own->hi[0];
                if (holds_new(first, i, to, covered->first_new)) {
                    clear_around(clear, map, cell, (j - box->lo[1]) / map->size, (k - box->lo[2]) / map->size);
                }
                i = to;
            }
        }
    }
}

static ms_status map_cells(cell_map *map, const ms_mss_field *field, const ms_mss_box *box, const covered_box *covered,
                           size_t count, ms_error *err)
{
    int longest = 0;
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        longest = box->hi[a] - box->lo[a] > longest ? box->hi[a] - box->lo[a] : longest;
    }
    map->size = longest > 2 * CELLS ? (longest + CELLS - 1) / CELLS : 2;
    for (int a = 0; a < 3; a++) {
        map->n[a] = (box->hi[a] - box->lo[a] + map->size - 1) / map->size;
        cells *= (size_t)map->n[a];
    }
    uint8_t *clear = malloc(cells);
    map->away = malloc(cells * sizeof *map->away);
    ms_status status = MS_OK;
    if (!clear || !map->away) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu cells", cells);
    } else {
        memset(clear, 1, cells);
        for (size_t c = 0; c < count; c++) {
            mark_cells(clear, map, field, box, &covered[c]);
        }
        for (size_t c = 0; c < cells; c++) {
            clear[c] = clear[c] == 1;
        }
        status = ms_distance(map->away, clear, map->n, err);
    }
    for (size_t c = 0; c < cells && status == MS_OK; c++) {
        map->away[c] *= (float)map->size;
    }
    free(clear);
    return status;
}

/* May E~ of one of the voxels from <= i < to of a row change? It does where a new sphere covers, and may where the
 * nearest background was among that, as far as their old E~. */
static int may_change(const float *within, const uint16_t *first, int from, int to, float away, size_t first_new)
{
    int any = 0;
    for (int i = from; i < to; i++) {
        any |= (within[i] >= away) & (within[i] > 0);
    }
    return any || holds_new(first, from, to, first_new);
}

static void mark_row(ms_mss_field *field, const cell_map *map, const ms_mss_box *box, size_t first_new, int j, int k)
{
    const size_t start = ms_grid_index(&field->target->grid, 0, j, k);
    const size_t row = (size_t)j + (size_t)field->target->grid.n[1] * (size_t)k;
    uint8_t *stale = field->stale + row * count_blocks(field);
    const float *away = map->away + (size_t)map->n[0] * ((size_t)((j - box->lo[1]) / map->size) +
                                                         (size_t)map->n[1] * (size_t)((k - box->lo[2]) / map->size));
    for (int i = box->lo[0]; i < box->hi[0];) {
        const int cell = (i - box->lo[0]) / map->size, block = i / MS_DISTANCE_BLOCK;
        int to = box->lo[0] + (cell + 1) * map->size;
        to = to < (block + 1) * MS_DISTANCE_BLOCK ? to : (block + 1) * MS_DISTANCE_BLOCK;
        to = to < box->hi[0] ? to : box->hi[0];
        if (!stale[block]) {
            stale[block] =
                (uint8_t)may_change(field->within + start, field->raster.first + start, i, to, away[cell], first_new);
        }
        i = to;
    }
}

/* The voxels that have their nearest background in a box, at most. */
static ms_mss_box find_reach(const ms_mss_field *field, const ms_mss_box *box)
{
    return ms_mss_field_grow(box, (int)ceilf(field->deepest_within), field->target->grid.n);
}

/* Marks the blocks of a box whose E~ the spheres may change. */
static ms_status mark_stale(ms_mss_field *field, const ms_mss_box *reach, const covered_box *covered, size_t count,
                            ms_error *err)
{
    cell_map map = {.away = NULL};
    const ms_status status = map_cells(&map, field, reach, covered, count, err);
    if (status == MS_OK) {
#pragma omp parallel for schedule(dynamic, 4) if (count_box(reach) >= MS_GRID_THREADS_FROM)
        for (int k = reach->lo[2]; k < reach->hi[2]; k++) {
            for (int j = reach->lo[1]; j < reach->hi[1]; j++) {
                mark_row(field, &map, reach, covered->first_new, j, k);
            }
        }
    }
    free(map.away);
    return status;
}

/* Around each sphere, or around all at once where that is less to look at. */
static ms_status mark_all_stale(ms_mss_field *field, const covered_box *covered, size_t count, ms_error *err)
{
    ms_mss_box all = {{INT_MAX, INT_MAX, INT_MAX}, {0, 0, 0}};
    ms_status status = MS_OK;
    size_t sum = 0;
    memset(field->stale, 0, count_rows(field) * count_blocks(field));
    for (size_t c = 0; c < count; c++) {
        const ms_mss_box reach = find_reach(field, &covered[c].box);
        include_box(&all, reach.lo, reach.hi);
        sum += count_box(&reach);
    }
    if (count > 0 && count_box(&all) < sum) {
        return mark_stale(field, &all, covered, count, err);
    }
    for (size_t c = 0; c < count && status == MS_OK; c++) {
        const ms_mss_box reach = find_reach(field, &covered[c].box);
        status = mark_stale(field, &reach, &covered[c], 1, err);
    }
    return status;
}

/* Lists a box, as one with the last of the list where that is hardly more. */
static ms_status join_changed(ms_mss_field *field, const ms_mss_box *box, ms_error *err)
{
    if (field->n_changed > 0) {
        ms_mss_box *last = &field->changed[field->n_changed - 1], both = *last;
        include_box(&both, box->lo, box->hi);
        if ((double)count_box(&both) <= 1.2 * (double)(count_box(last) + count_box(box))) {
            *last = both;
            return MS_OK;
        }
    }
    return add_changed(field, box, err);
}

/* Lists boxes that hold what was marked, column of blocks by column, and takes note of how deep E~ is there. */
static ms_status list_changed(ms_mss_field *field, ms_error *err)
{
    const ms_grid *grid = &field->target->grid;
    const int blocks = (int)count_blocks(field);
    float deepest = field->deepest_within;
    ms_status status = MS_OK;
    for (int b = 0; b < blocks && status == MS_OK; b++) {
        const int x = b * MS_DISTANCE_BLOCK;
        const int end = x + MS_DISTANCE_BLOCK < grid->n[0] ? x + MS_DISTANCE_BLOCK : grid->n[0];
        ms_mss_box box = {{INT_MAX, INT_MAX, INT_MAX}, {0, 0, 0}};
        for (size_t row = 0; row < count_rows(field); row++) {
            if (field->stale[row * (size_t)blocks + (size_t)b]) {
                const int j = (int)(row % (size_t)grid->n[1]), k = (int)(row / (size_t)grid->n[1]);
                include_box(&box, (int[3]){x, j, k}, (int[3]){end, j + 1, k + 1});
                const float *within = field->within + row * (size_t)grid->n[0];
                for (int i = x; i < end; i++) {
                    deepest = within[i] > deepest ? within[i] : deepest;
                }
            }
        }
        status = box.hi[0] > 0 ? join_changed(field, &box, err) : MS_OK;
    }
    field->deepest_within = deepest;
    return status;
}

/* Adds spheres to S~; lists the boxes of what each has covered. */
static ms_status spread_balls(covered_box *covered, size_t *n_covered, ms_mss_field *field, const ms_ball *balls,
                              size_t count, ms_error *err)
{
    const ms_raster *raster = &field->raster;
    const size_t first_new = raster->n_balls;
    ms_status status = MS_OK;
    *n_covered = 0;
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        status = ms_raster_add(&field->raster, &balls[b], 1, err);
        if (status == MS_OK && raster->hi[0] > raster->lo[0]) {
            covered_box *next = &covered[(*n_covered)++];
            next->first_new = first_new;
            memcpy(next->box.lo, raster->lo, sizeof next->box.lo);
            memcpy(next->box.hi, raster->hi, sizeof next->box.hi);
        }
    }
    return status;
}

static void note_covered(ms_mss_field *field, const ms_mss_box *box)
{
#pragma omp parallel for if (count_box(box) >= MS_GRID_THREADS_FROM)
    for (int k = box->lo[2]; k < box->hi[2]; k++) {
        for (int j = box->lo[1]; j < box->hi[1]; j++) {
            const size_t row = ms_grid_index(&field->target->grid, 0, j, k);
            for (size_t v = row + (size_t)box->lo[0]; v < row + (size_t)box->hi[0]; v++) {
                field->covered[v] = field->raster.first[v] != MS_RASTER_NONE;
            }
        }
    }
}

ms_status ms_mss_field_start(ms_mss_field *field, ms_error *err)
{
    const int *n = field->target->grid.n;
    const size_t voxels = ms_grid_voxels(&field->target->grid);
    field->within = calloc(voxels, sizeof *field->within);
    field->covered = calloc(voxels, 1);
    field->stale = malloc(count_rows(field) * count_blocks(field));
    if (!field->within || !field->covered || !field->stale) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the field E~ of %zu voxels; use fewer cells", voxels);
    }
    ms_status status = MS_OK;
    if (field->raster.n_balls > 0) {
        const ms_mss_box all = {{0, 0, 0}, {n[0], n[1], n[2]}};
        note_covered(field, &all);
        status = ms_distance(field->within, field->covered, n, err);
        field->deepest_within = find_deepest_e(field->within, voxels);
    }
    return status == MS_OK ? ms_mss_field_touch_all(field, err) : status;
}

ms_status ms_mss_field_add(ms_mss_field *field, const ms_ball *balls, size_t count, ms_error *err)
{
    size_t n_covered = 0;
    covered_box *covered = malloc((count + 1) * sizeof *covered);
    field->n_changed = 0;
    if (!covered) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    ms_status status = spread_balls(covered, &n_covered, field, balls, count, err);
    for (size_t c = 0; c < n_covered; c++) {
        note_covered(field, &covered[c].box);
    }
    if (status == MS_OK) {
        status = mark_all_stale(field, covered, n_covered, err);
    }
    if (status == MS_OK) {
        status = ms_distance_blocks(field->within, field->covered, field->target->grid.n, field->stale, err);
    }
    free(covered);
    return status == MS_OK ? list_changed(field, err) : status;
}
