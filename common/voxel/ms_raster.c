#include "ms_raster.h"

#include <limits.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* Half the diagonal of a voxel: a ball's surface farther from the centre misses the voxel. */
static const double HALF_DIAGONAL = 0.86602540378443871;

/* Samples on a ball's surface but for rounding belong to it, so that mirror images agree. */
static const double ON_SURFACE = 1e-9;

/* Sample points per voxel and axis, at -3/8, -1/8, 1/8, 3/8 from the centre: 64 bits in all. */
enum { SAMPLES = 4, HALF_OF_SAMPLES = 32 };

ms_status ms_raster_alloc(ms_raster *raster, const ms_grid *grid, ms_voxel_rule rule, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(grid);
    memset(raster, 0, sizeof *raster);
    raster->grid = grid;
    raster->rule = rule;
    raster->first = malloc(voxels * sizeof *raster->first);
    if (!raster->first) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", voxels);
    }
    memset(raster->first, 0xff, voxels * sizeof *raster->first);
    return MS_OK;
}

void ms_raster_free(ms_raster *raster)
{
    if (raster) {
        free(raster->first);
        free(raster->ball);
        free(raster->tally);
        free(raster->buried);
        memset(raster, 0, sizeof *raster);
    }
}

/* Earlier balls that may share a border voxel with each new one, one list behind the other. */
typedef struct neighbours {
    size_t *start; /* of each new ball; one more at the end */
    uint16_t *ball;
    size_t used, capacity;
} neighbours;

/* What one thread has to know and to count while it works through planes. */
typedef struct worker {
    ms_raster *raster;
    size_t from;                  /* the first new ball */
    const neighbours *neighbours; /* earlier balls whose border voxels each new one may share */
    ms_tally *tally;              /* of the new balls */
    int lo[3], hi[3];             /* box of what was covered */
} worker;

/* Which of the voxel's sample points lie in the ball; (dx, dy, dz) from the ball's centre to
 * the voxel's. */
static uint64_t sample_mask(double dx, double dy, double dz, double radius_squared)
{
    uint64_t mask = 0;
    int bit = 0;
    for (int c = 0; c < SAMPLES; c++) {
        const double z = dz + 0.25 * c - 0.375;
        for (int b = 0; b < SAMPLES; b++) {
            const double y = dy + 0.25 * b - 0.375, rest = radius_squared - z * z - y * y;
            for (int a = 0; a < SAMPLES; a++) {
                const double x = dx + 0.25 * a - 0.375;
                mask |= (uint64_t)(x * x <= rest) << bit++;
            }
        }
    }
    return mask;
}

/* The samples of a voxel in a ball; sets *centre if its centre is too. */
static uint64_t ball_mask(int *centre, const ms_ball *ball, int i, int j, int k)
{
    const double dx = i - ball->centre[0], dy = j - ball->centre[1], dz = k - ball->centre[2];
    const double reach = ball->radius + HALF_DIAGONAL, away = dx * dx + dy * dy + dz * dz;
    if (away > reach * reach) {
        return 0;
    }
    const double square = ball->radius * ball->radius + ON_SURFACE;
    *centre |= away <= square;
    return sample_mask(dx, dy, dz, square);
}

/* Does the union of ball b and those before it cover more than half of the voxel? Where half
 * of the samples are covered, the centre decides: a ball of radius 1/2 on a voxel's centre,
 * 0.52 of the voxel, covers 32 of 64 and has to cover the voxel (MSS 2.3). */
static int covers_half(const worker *w, size_t b, int i, int j, int k)
{
    int centre = 0;
    uint64_t mask = ball_mask(&centre, &w->raster->ball[b], i, j, k);
    if (mask == 0 && !centre) {
        return 0; /* nothing new in this voxel */
    }
    const size_t *range = w->neighbours->start + (b - w->from);
    for (size_t at = range[0]; at < range[1] && __builtin_popcountll(mask) <= HALF_OF_SAMPLES; at++) {
        mask |= ball_mask(&centre, &w->raster->ball[w->neighbours->ball[at]], i, j, k);
    }
    return __builtin_popcountll(mask) + centre > HALF_OF_SAMPLES;
}

/* Sums over the voxels of one row that a ball covers first. */
typedef struct row_sums {
    int64_t count, inside, i, ii;
    int lo, hi;
} row_sums;

static void cover_voxel(row_sums *sums, uint16_t *first, const uint8_t *inside, int i, size_t b)
{
    first[i] = (uint16_t)b;
    sums->count++;
    sums->inside += inside[i];
    sums->i += i;
    sums->ii += (int64_t)i * i;
    sums->lo = i < sums->lo ? i : sums->lo;
    sums->hi = i >= sums->hi ? i + 1 : sums->hi;
}

static void add_row(worker *w, size_t b, const row_sums *s, int j, int k)
{
    ms_tally *t = &w->tally[b - w->from];
    const int64_t row[6] = {s->ii, s->count * j * j, s->count * k * k, s->count * j * k, s->i * k, s->i * j};
    const int lo[3] = {s->lo, j, k}, hi[3] = {s->hi, j + 1, k + 1};
    t->inside += s->inside;
    t->outside += s->count - s->inside;
    t->first[0] += s->i;
    t->first[1] += s->count * j;
    t->first[2] += s->count * k;
    for (int m = 0; m < 6; m++) {
        t->second[m] += row[m];
    }
    for (int a = 0; a < 3; a++) {
        w->lo[a] = lo[a] < w->lo[a] ? lo[a] : w->lo[a];
        w->hi[a] = hi[a] > w->hi[a] ? hi[a] : w->hi[a];
    }
}

/* Half the chord of a ball of this radius at a squared distance from its centre; -1 if none. */
static double half_chord(double radius, double distance_squared)
{
    const double square = radius * radius - distance_squared;
    return radius > 0 && square >= 0 ? sqrt(square) : -1;
}

static int clamp_index(double value, int lo, int hi)
{
    return value < lo ? lo : value > hi ? hi : (int)value;
}

/* One row of voxels: those between first[outer] are looked at, those within `inner` of the
 * centre are covered without looking. */
static void cover_row(worker *w, size_t b, int j, int k, double outer, double inner)
{
    ms_raster *raster = w->raster;
    const int n = raster->grid->n[0];
    const double x = raster->ball[b].centre[0];
    const size_t start = ms_grid_index(raster->grid, 0, j, k);
    uint16_t *first = raster->first + start;
    const uint8_t *inside = raster->grid->inside + start;
    row_sums sums = {.lo = INT_MAX, .hi = INT_MIN};
    const int from = clamp_index(ceil(x - outer), 0, n), to = clamp_index(floor(x + outer) + 1, 0, n);
    const int full_from = inner < 0 ? to : clamp_index(ceil(x - inner), from, to);
    const int full_to = inner < 0 ? to : clamp_index(floor(x + inner) + 1, full_from, to);
    for (int i = from; i < to; i++) {
        const int full = i >= full_from && i < full_to;
        if (first[i] == MS_RASTER_NONE && (full || covers_half(w, b, i, j, k))) {
            cover_voxel(&sums, first, inside, i, b);
        }
    }
    if (sums.count) {
        add_row(w, b, &sums, j, k);
    }
}

static void cover_plane(worker *w, size_t b, int k)
{
    const ms_ball *ball = &w->raster->ball[b];
    const int half = w->raster->rule == MS_VOXEL_HALF;
    const double outer = ball->radius + (half ? HALF_DIAGONAL : 0);
    const double inner = ball->radius - (half ? HALF_DIAGONAL : 0);
    const double dz = k - ball->centre[2], reach = half_chord(outer, dz * dz);
    if (reach < 0) {
        return;
    }
    const int n = w->raster->grid->n[1];
    const int from = clamp_index(ceil(ball->centre[1] - reach), 0, n);
    const int to = clamp_index(floor(ball->centre[1] + reach) + 1, 0, n);
    for (int j = from; j < to; j++) {
        const double dy = j - ball->centre[1], away = dy * dy + dz * dz;
        const double chord = half_chord(outer, away);
        if (chord >= 0) {
            cover_row(w, b, j, k, chord, half_chord(inner, away));
        }
    }
}

static int add_neighbour(neighbours *list, size_t ball)
{
    if (list->used == list->capacity) {
        const size_t capacity = 2 * list->capacity + 256;
        uint16_t *grown = realloc(list->ball, capacity * sizeof *grown);
        if (!grown) {
            return 0;
        }
        list->ball = grown;
        list->capacity = capacity;
    }
    list->ball[list->used++] = (uint16_t)ball;
    return 1;
}

/* Lists the neighbours of one ball. One that lies within another covers nothing of its own and
 * is buried: it gets no list and stands in none. @return 0 without memory */
static int list_neighbours(neighbours *list, ms_raster *raster, size_t b)
{
    const ms_ball *ball = &raster->ball[b];
    const size_t before = list->used;
    for (size_t other = 0; other < b; other++) {
        const ms_ball *o = &raster->ball[other];
        const double away = ms_squared_distance(o->centre, ball->centre);
        const double reach = o->radius + ball->radius + 2 * HALF_DIAGONAL, depth = o->radius - ball->radius;
        if (raster->buried[other] || away > reach * reach) {
            continue;
        }
        if (depth >= 0 && away <= depth * depth) {
            raster->buried[b] = 1;
            list->used = before;
            return 1;
        }
        if (!add_neighbour(list, other)) {
            return 0;
        }
    }
    return 1;
}

static ms_status find_neighbours(neighbours *list, ms_raster *raster, size_t from, ms_error *err)
{
    const size_t count = raster->n_balls - from;
    *list = (neighbours){.start = malloc((count + 1) * sizeof *list->start)};
    int complete = list->start != NULL;
    for (size_t b = from; complete && b < raster->n_balls; b++) {
        list->start[b - from] = list->used;
        complete = list_neighbours(list, raster, b);
    }
    if (!complete) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the neighbours of %zu spheres", count);
    }
    list->start[count] = list->used;
    return MS_OK;
}

static ms_status append_balls(ms_raster *raster, const ms_ball *balls, size_t count, ms_error *err)
{
    if (count > MS_RASTER_MAX_BALLS - raster->n_balls) {
        return ms_fail(err, MS_ERR_LIMIT, "more than %d spheres in a clump", MS_RASTER_MAX_BALLS);
    }
    for (size_t b = 0; b < count; b++) {
        const double *c = balls[b].centre;
        const double r = balls[b].radius;
        if (!isfinite(c[0]) || !isfinite(c[1]) || !isfinite(c[2]) || !isfinite(r) || r < 0) {
            return ms_fail(err, MS_ERR_ARG,
                           "sphere %zu has the centre (%g, %g, %g) and the radius %g, in voxels; a "
                           "centre must be finite and a radius not below 0",
                           b + 1, c[0], c[1], c[2], r);
        }
    }
    const size_t needed = raster->n_balls + count;
    if (needed > raster->capacity) {
        const size_t capacity = needed + needed / 2 + 16;
        ms_ball *ball = realloc(raster->ball, capacity * sizeof *ball);
        raster->ball = ball ? ball : raster->ball;
        ms_tally *tally = ball ? realloc(raster->tally, capacity * sizeof *tally) : NULL;
        raster->tally = tally ? tally : raster->tally;
        uint8_t *buried = tally ? realloc(raster->buried, capacity) : NULL;
        raster->buried = buried ? buried : raster->buried;
        if (!buried) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", needed);
        }
        raster->capacity = capacity;
    }
    memcpy(raster->ball + raster->n_balls, balls, count * sizeof *balls);
    memset(raster->tally + raster->n_balls, 0, count * sizeof *raster->tally);
    memset(raster->buried + raster->n_balls, 0, count);
    raster->n_balls = needed;
    return MS_OK;
}

/* The planes that any new ball touches. */
static void plane_range(int *from, int *to, const ms_raster *raster, size_t first_new)
{
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (size_t b = first_new; b < raster->n_balls; b++) {
        lo = fmin(lo, raster->ball[b].centre[2] - raster->ball[b].radius - 1);
        hi = fmax(hi, raster->ball[b].centre[2] + raster->ball[b].radius + 1);
    }
    *from = clamp_index(floor(lo), 0, raster->grid->n[2]);
    *to = clamp_index(ceil(hi) + 1, *from, raster->grid->n[2]);
}

/* Sums are of integers, so that their order does not matter. */
static void merge_sums(ms_raster *raster, const worker *w)
{
    for (size_t b = w->from; b < raster->n_balls; b++) {
        ms_tally_add(&raster->tally[b], &w->tally[b - w->from]);
    }
    for (int a = 0; a < 3; a++) {
        raster->lo[a] = w->lo[a] < raster->lo[a] ? w->lo[a] : raster->lo[a];
        raster->hi[a] = w->hi[a] > raster->hi[a] ? w->hi[a] : raster->hi[a];
    }
}

static ms_status cover_balls(ms_raster *raster, size_t first_new, const neighbours *list, ms_error *err)
{
    int from, to, out_of_memory = 0;
    plane_range(&from, &to, raster, first_new);
    for (int a = 0; a < 3; a++) {
        raster->lo[a] = INT_MAX;
        raster->hi[a] = INT_MIN;
    }
    omp_lock_t merging;
    omp_init_lock(&merging);
#pragma omp parallel reduction(| : out_of_memory) if (ms_grid_voxels(raster->grid) >= MS_GRID_THREADS_FROM)
    {
        worker w = {.raster = raster,
                    .from = first_new,
                    .neighbours = list,
                    .lo = {INT_MAX, INT_MAX, INT_MAX},
                    .hi = {INT_MIN, INT_MIN, INT_MIN}};
        w.tally = calloc(raster->n_balls - first_new, sizeof *w.tally);
        out_of_memory = !w.tally;
#pragma omp for schedule(dynamic, 1)
        for (int k = from; k < to; k++) {
            for (size_t b = first_new; w.tally && b < raster->n_balls; b++) {
                if (!raster->buried[b]) {
                    cover_plane(&w, b, k);
                }
            }
        }
        if (w.tally) {
            omp_set_lock(&merging); /* a named critical section would be a symbol for all to see */
            merge_sums(raster, &w);
            omp_unset_lock(&merging);
        }
        free(w.tally);
    }
    omp_destroy_lock(&merging);
    if (raster->hi[0] < raster->lo[0]) {
        memset(raster->lo, 0, sizeof raster->lo);
        memset(raster->hi, 0, sizeof raster->hi);
    }
    return out_of_memory ? ms_fail(err, MS_ERR_NOMEM, "no memory to sum up %zu spheres", raster->n_balls) : MS_OK;
}

ms_status ms_raster_add(ms_raster *raster, const ms_ball *balls, size_t count, ms_error *err)
{
    const size_t first_new = raster->n_balls;
    neighbours list = {0};
    memset(raster->lo, 0, sizeof raster->lo);
    memset(raster->hi, 0, sizeof raster->hi);
    if (count == 0) {
        return MS_OK;
    }
    ms_status status = append_balls(raster, balls, count, err);
    if (status == MS_OK) {
        status = find_neighbours(&list, raster, first_new, err);
    }
    if (status == MS_OK) {
        status = cover_balls(raster, first_new, &list, err);
    }
    free(list.start);
    free(list.ball);
    return status;
}

ms_status ms_raster_union(ms_tally *sum, const ms_grid *grid, ms_voxel_rule rule, const ms_ball *balls, size_t count,
                          ms_error *err)
{
    ms_raster raster;
    *sum = (ms_tally){0};
    ms_status status = ms_raster_alloc(&raster, grid, rule, err);
    if (status == MS_OK) {
        status = ms_raster_add(&raster, balls, count, err);
    }
    for (size_t b = 0; status == MS_OK && b < raster.n_balls; b++) {
        ms_tally_add(sum, &raster.tally[b]);
    }
    ms_raster_free(&raster);
    return status;
}
