#include "ms_mss_field.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "voxel/ms_distance.h"

/* How far S~ may stand out of S, in voxels, beyond the distance to its background that E gives; write-back checks. */
enum { STAND_OUT = 3 };

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

/* How far the voxels in the cells of a box are from those that ball b has covered first, at least. */
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

static void mark_cells(uint8_t *clear, const cell_map *map, const ms_mss_field *field, const ms_mss_box *box, size_t b,
                       const ms_mss_box *covered)
{
    for (int k = covered->lo[2]; k < covered->hi[2]; k++) {
        for (int j = covered->lo[1]; j < covered->hi[1]; j++) {
            const uint16_t *first = field->raster.first + ms_grid_index(&field->target->grid, 0, j, k);
            for (int i = covered->lo[0]; i < covered->hi[0]; i++) {
                if (first[i] == b) {
                    clear_around(clear, map, (i - box->lo[0]) / map->size, (j - box->lo[1]) / map->size,
                                 (k - box->lo[2]) / map->size);
                }
            }
        }
    }
}

static ms_status map_cells(cell_map *map, const ms_mss_field *field, const ms_mss_box *box, size_t b,
                           const ms_mss_box *covered, ms_error *err)
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
        mark_cells(clear, map, field, box, b, covered);
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

/* Where E~ may change: rows of a box, the voxels from <= i < to of each. */
typedef struct changed_rows {
    ms_mss_box box;
    int (*span)[2]; /* of row j of plane k: j - lo + rows * (k - lo); all of the box that was looked at */
    ms_mss_box within;
} changed_rows;

static int *measure_span(const changed_rows *c, int j, int k)
{
    const size_t rows = (size_t)(c->within.hi[1] - c->within.lo[1]);
    return c->span[(size_t)(j - c->within.lo[1]) + rows * (size_t)(k - c->within.lo[2])];
}

/*
 * The voxels of a row whose E~ may change by what ball b has covered: those voxels, and those that had their nearest
 * background voxel among them, which then was as far as their old E~.
 */
static void find_span(int span[2], const ms_mss_field *field, const cell_map *map, const ms_mss_box *box, size_t b,
                      int j, int k)
{
    const size_t start = ms_grid_index(&field->target->grid, box->lo[0], j, k);
    const float *within = field->within + start;
    const uint16_t *first = field->raster.first + start;
    const float *away = map->away + (size_t)map->n[0] * ((size_t)((j - box->lo[1]) / map->size) +
                                                         (size_t)map->n[1] * (size_t)((k - box->lo[2]) / map->size));
    const int n = box->hi[0] - box->lo[0];
    int from = n, to = 0;
    for (int cell = 0; cell < map->n[0]; cell++) {
        const int end = (cell + 1) * map->size < n ? (cell + 1) * map->size : n;
        for (int i = cell * map->size; i < end; i++) {
            if ((within[i] >= away[cell] && within[i] > 0) || first[i] == b) {
                from = i < from ? i : from;
                to = i + 1;
            }
        }
    }
    span[0] = box->lo[0] + from;
    span[1] = box->lo[0] + (from < to ? to : from);
}

/* @param[out] changed the caller frees its spans */
static ms_status find_changed(changed_rows *changed, const ms_mss_field *field, size_t b, const ms_mss_box *covered,
                              ms_error *err)
{
    const ms_mss_box reach = ms_mss_field_grow(covered, (int)ceilf(field->deepest_within), field->target->grid.n);
    const size_t rows = (size_t)(reach.hi[1] - reach.lo[1]) * (size_t)(reach.hi[2] - reach.lo[2]);
    cell_map map = {.away = NULL};
    ms_mss_box box = *covered;
    *changed = (changed_rows){.span = malloc(rows * sizeof *changed->span), .within = reach};
    ms_status status = changed->span ? map_cells(&map, field, &reach, b, covered, err)
                                     : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu rows", rows);
    if (status == MS_OK) {
#pragma omp parallel for schedule(dynamic, 4) reduction(hull : box) if (count_box(&reach) >= MS_GRID_THREADS_FROM)
        for (int k = reach.lo[2]; k < reach.hi[2]; k++) {
            for (int j = reach.lo[1]; j < reach.hi[1]; j++) {
                int *span = measure_span(changed, j, k);
                find_span(span, field, &map, &reach, b, j, k);
                if (span[0] < span[1]) {
                    include_box(&box, (int[3]){span[0], j, k}, (int[3]){span[1], j + 1, k + 1});
                }
            }
        }
    }
    free(map.away);
    changed->box = box;
    return status;
}

/* All voxels that may be the nearest background of a changed one: none is farther than E and what S~ stands out. */
static ms_mss_box find_surroundings(const ms_mss_field *field, const changed_rows *changed)
{
    const ms_grid *grid = &field->target->grid;
    const ms_mss_box *box = &changed->box;
    ms_mss_box part = *box;
#pragma omp parallel for reduction(hull : part) if (count_box(box) >= MS_GRID_THREADS_FROM)
    for (int k = box->lo[2]; k < box->hi[2]; k++) {
        for (int j = box->lo[1]; j < box->hi[1]; j++) {
            const float *e = field->target->distance + ms_grid_index(grid, 0, j, k);
            const int *span = measure_span(changed, j, k);
            int lo = box->hi[0], hi = box->lo[0], deepest = 0;
            for (int i = span[0]; i < span[1]; i++) {
                const int reach = (int)e[i] + 1 + STAND_OUT;
                deepest = reach > deepest ? reach : deepest;
                lo = i - reach < lo ? i - reach : lo;
                hi = i + reach >= hi ? i + reach + 1 : hi;
            }
            if (span[0] < span[1]) {
                include_box(&part, (int[3]){lo, j - deepest, k - deepest},
                            (int[3]){hi, j + deepest + 1, k + deepest + 1});
            }
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

/* Writes E~ of the changed voxels; 0 if a distance may be to background beyond the part. */
static int write_within(ms_mss_field *field, const float *distance, const ms_mss_box *part, const changed_rows *changed)
{
    const ms_grid *grid = &field->target->grid;
    const ms_mss_box *box = &changed->box;
    const size_t row = (size_t)(box->hi[0] - box->lo[0]), plane = row * (size_t)(box->hi[1] - box->lo[1]);
    float deepest = field->deepest_within;
    int exact = 1;
#pragma omp parallel for reduction(& : exact) reduction(max : deepest) if (count_box(box) >= MS_GRID_THREADS_FROM)
    for (int k = box->lo[2]; k < box->hi[2]; k++) {
        for (int j = box->lo[1]; j < box->hi[1]; j++) {
            const float *from = distance + plane * (size_t)(k - box->lo[2]) + row * (size_t)(j - box->lo[1]);
            float *within = field->within + ms_grid_index(grid, 0, j, k);
            const int *span = measure_span(changed, j, k);
            for (int i = span[0]; i < span[1]; i++) {
                const float d = from[i - box->lo[0]];
                exact &= d <= 1 + STAND_OUT || d <= (float)find_depth(part, grid->n, i, j, k);
                deepest = d > deepest ? d : deepest;
                within[i] = d;
            }
        }
    }
    field->deepest_within = deepest;
    return exact;
}

/* @param[out] done 0 if the part proved too small */
static ms_status update_part(int *done, ms_mss_field *field, const ms_mss_box *part, const changed_rows *changed,
                             ms_error *err)
{
    const ms_mss_box *box = &changed->box;
    int n[3], lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        n[a] = part->hi[a] - part->lo[a];
        lo[a] = box->lo[a] - part->lo[a];
        hi[a] = box->hi[a] - part->lo[a];
    }
    const size_t row = (size_t)(hi[0] - lo[0]), apart[2] = {row, row * (size_t)(hi[1] - lo[1])};
    uint8_t *covered = malloc(count_box(part));
    float *distance = malloc(count_box(box) * sizeof *distance);
    ms_status status = MS_OK;
    *done = 0;
    if (!covered || !distance) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", count_box(part));
    } else {
        copy_covered(covered, field, part);
        status = ms_distance_box(distance, apart, covered, n, lo, hi, err);
    }
    *done = status == MS_OK && write_within(field, distance, part, changed);
    free(covered);
    free(distance);
    return status;
}

/* What a sphere has covered first. */
typedef struct covered_box {
    size_t ball;
    ms_mss_box box;
} covered_box;

/* What transforming a part takes, in voxels of which a lower envelope is made along two axes. */
static size_t cost_of_part(const ms_mss_box *box, const ms_mss_box *part)
{
    const size_t lines_y = count_box(part) / (size_t)(part->hi[0] - part->lo[0]) * (size_t)(box->hi[0] - box->lo[0]);
    const size_t lines_z = lines_y / (size_t)(part->hi[1] - part->lo[1]) * (size_t)(box->hi[1] - box->lo[1]);
    return count_box(part) / 4 + (lines_y + lines_z) / 2;
}

/* That of the grid: background is passed over. */
static size_t cost_of_whole(const ms_target *target)
{
    return target->voxels + ms_grid_voxels(&target->grid) / 4;
}

/*
 * Brings E~ up to date where one sphere has covered voxels, unless the whole grid is sooner.
 *
 * @param[in,out] cost what the spheres before took
 * @param         left how many spheres there are with this one, which are taken to cost the same
 */
static ms_status update_around(int *done, size_t *cost, ms_mss_field *field, const covered_box *covered, size_t left,
                               ms_error *err)
{
    changed_rows changed;
    *done = 0;
    ms_status status = find_changed(&changed, field, covered->ball, &covered->box, err);
    if (status == MS_OK) {
        const ms_mss_box *box = &changed.box, part = find_surroundings(field, &changed);
        const size_t columns = count_box(box) / (size_t)(box->hi[2] - box->lo[2]) * (size_t)(part.hi[2] - part.lo[2]);
        const size_t bytes = count_box(&part) + sizeof(float) * (columns + count_box(box));
        const size_t here = cost_of_part(box, &part), all = ms_grid_voxels(&field->target->grid);
        if (*cost + left * here <= cost_of_whole(field->target) && bytes <= all / 4 * 7) {
            status = add_changed(field, box, err);
            status = status == MS_OK ? update_part(done, field, &part, &changed, err) : status;
        }
        *cost += here;
    }
    free(changed.span);
    return status;
}

/* Adds spheres to S~; lists the boxes of what each has covered. */
static ms_status spread_balls(covered_box *covered, size_t *n_covered, ms_mss_field *field, const ms_ball *balls,
                              size_t count, ms_error *err)
{
    const ms_raster *raster = &field->raster;
    ms_status status = MS_OK;
    *n_covered = 0;
    for (size_t b = 0; b < count && status == MS_OK; b++) {
        status = ms_raster_add(&field->raster, &balls[b], 1, err);
        if (status == MS_OK && raster->hi[0] > raster->lo[0]) {
            covered_box *next = &covered[(*n_covered)++];
            next->ball = raster->n_balls - 1;
            memcpy(next->box.lo, raster->lo, sizeof next->box.lo);
            memcpy(next->box.hi, raster->hi, sizeof next->box.hi);
        }
    }
    return status;
}

ms_status ms_mss_field_add(ms_mss_field *field, const ms_ball *balls, size_t count, ms_error *err)
{
    size_t n_covered = 0, cost = 0;
    int done = 1;
    covered_box *covered = malloc((count + 1) * sizeof *covered);
    field->n_changed = 0;
    if (!covered) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", count);
    }
    ms_status status = spread_balls(covered, &n_covered, field, balls, count, err);
    for (size_t b = 0; b < n_covered && done && status == MS_OK; b++) {
        status = update_around(&done, &cost, field, &covered[b], n_covered - b, err);
    }
    free(covered);
    return done || status != MS_OK ? status : update_whole(field, err);
}
