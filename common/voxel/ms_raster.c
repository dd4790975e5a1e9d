#include "ms_raster.h"

#include <limits.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_cut_left.h"
#include "ms_window.h"

/* From a voxel's centre to the farthest of its samples, sqrt(3) 3/8, and what ON_SURFACE may add: a ball whose surface
 * is farther from the centre holds no sample. */
static const double FARTHEST_SAMPLE = 0.6496;

/* A voxel whose centre lies within the ball by this, in squared distance, is covered: of every two samples opposite
 * each other one is no farther from the ball's centre than sqrt(d^2 + 3 (3/8)^2), d that of the voxel's; rounded up. */
static const double SURELY_COVERED = 0.422;

/* Samples on a ball's surface but for rounding belong to it, so that mirror images agree. */
static const double ON_SURFACE = 1e-9;

/* Sample points per voxel and axis, at -3/8, -1/8, 1/8, 3/8 from the centre: 64 bits in all. */
enum { SAMPLES = 4, HALF_OF_SAMPLES = 32 };

/* Voxels of a row in a word. */
enum { WORD = 64 };

static size_t words_of_row(const ms_grid *grid)
{
    return ((size_t)grid->n[0] + WORD - 1) / WORD;
}

ms_status ms_raster_alloc(ms_raster *raster, const ms_grid *grid, ms_voxel_rule rule, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(grid), words = words_of_row(grid) * (size_t)grid->n[1] * (size_t)grid->n[2];
    memset(raster, 0, sizeof *raster);
    raster->grid = grid;
    raster->rule = rule;
    raster->first = malloc(voxels * sizeof *raster->first);
    raster->vacant = malloc(words * sizeof *raster->vacant);
    raster->partial = calloc((size_t)grid->n[2], sizeof *raster->partial);
    raster->left = grid->cells ? ms_cut_left_build(grid->cells) : NULL;
    if (!raster->first || !raster->vacant || !raster->partial || (grid->cells && !raster->left)) {
        ms_raster_free(raster);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the union on %zu voxels; use fewer cells", voxels);
    }
    const size_t plane = voxels / (size_t)grid->n[2], words_of_plane = words / (size_t)grid->n[2];
#pragma omp parallel for schedule(static) if (voxels >= MS_GRID_THREADS_FROM)
    for (int k = 0; k < grid->n[2]; k++) {
        memset(raster->first + plane * (size_t)k, 0xff, plane * sizeof *raster->first);
        memset(raster->vacant + words_of_plane * (size_t)k, 0xff, words_of_plane * sizeof *raster->vacant);
    }
    return MS_OK;
}

void ms_raster_free(ms_raster *raster)
{
    if (raster) {
        free(raster->first);
        free(raster->vacant);
        free(raster->ball);
        free(raster->tally);
        ms_cut_left_free(raster->left);
        free(raster->buried);
        for (int k = 0; raster->partial && k < raster->grid->n[2]; k++) {
            free(raster->partial[k].slot);
        }
        free(raster->partial);
        memset(raster, 0, sizeof *raster);
    }
}

/* The vacant voxels of a row. */
static uint64_t *find_vacant(const ms_raster *raster, int j, int k)
{
    const ms_grid *grid = raster->grid;
    return raster->vacant + words_of_row(grid) * ((size_t)j + (size_t)grid->n[1] * (size_t)k);
}

/* What one thread has to know and to count while it works through planes. */
typedef struct worker {
    ms_raster *raster;
    size_t from;      /* the first new ball */
    ms_tally *tally;  /* of the new balls */
    int lo[3], hi[3]; /* box of what was covered */
    int out_of_memory;
} worker;

/* Which of the voxel's sample points lie in the ball, 16 bits for those of equal x; (dx, dy, dz) from the ball's centre
 * to the voxel's. By signs of differences, since compilers make vector code of that for any processor. */
static uint64_t sample_mask(double dx, double dy, double dz, double radius_squared)
{
    double square[SAMPLES];
    uint64_t outside[SAMPLES] = {0};
    for (int a = 0; a < SAMPLES; a++) {
        const double x = dx + 0.25 * a - 0.375;
        square[a] = x * x;
    }
    for (int c = 0; c < SAMPLES; c++) {
        const double z = dz + 0.25 * c - 0.375;
        for (int b = 0; b < SAMPLES; b++) {
            const double y = dy + 0.25 * b - 0.375, rest = radius_squared - z * z - y * y;
#pragma omp simd
            for (int a = 0; a < SAMPLES; a++) {
                const union {
                    double value;
                    uint64_t bits;
                } left = {rest - square[a]};
                outside[a] = outside[a] << 1 | left.bits >> 63;
            }
        }
    }
    return ~(outside[0] | outside[1] << 16 | outside[2] << 32 | outside[3] << 48);
}

/* What the balls so far cover of a voxel that they do not cover. */
struct ms_raster_slot {
    uint32_t voxel;  /* of the plane, and one; 0: free */
    uint32_t centre; /* nonzero: they hold its centre */
    uint64_t mask;   /* and these of its samples */
};

static uint32_t hash_voxel(uint32_t voxel, uint32_t room)
{
    return voxel * 2654435769u >> 7 & (room - 1); /* Knuth's multiplicative hashing; the room is a power of two */
}

/* Twice the room for a plane's slots. @return 0 without memory */
static int grow_slots(ms_raster_partial *partial)
{
    const uint32_t room = partial->room ? 2 * partial->room : 64;
    struct ms_raster_slot *slot = calloc(room, sizeof *slot);
    if (!slot) {
        return 0;
    }
    for (uint32_t s = 0; s < partial->room; s++) {
        uint32_t at = hash_voxel(partial->slot[s].voxel, room);
        if (partial->slot[s].voxel) {
            while (slot[at].voxel) {
                at = (at + 1) & (room - 1);
            }
            slot[at] = partial->slot[s];
        }
    }
    free(partial->slot);
    partial->slot = slot;
    partial->room = room;
    return 1;
}

/* The slot of a voxel of a plane, new ones empty; NULL without memory. */
static struct ms_raster_slot *find_slot(ms_raster_partial *partial, uint32_t voxel)
{
    if (4 * partial->used >= 3 * partial->room && !grow_slots(partial)) {
        return NULL;
    }
    uint32_t at = hash_voxel(voxel + 1, partial->room);
    while (partial->slot[at].voxel && partial->slot[at].voxel != voxel + 1) {
        at = (at + 1) & (partial->room - 1);
    }
    partial->used += partial->slot[at].voxel == 0;
    partial->slot[at].voxel = voxel + 1;
    return &partial->slot[at];
}

/* Does the union of ball b and those before it cover more than half of the voxel? Where half
 * of the samples are covered, the centre decides: a ball of radius 1/2 on a voxel's centre,
 * 0.52 of the voxel, covers 32 of 64 and has to cover the voxel (MSS 2.3). */
static int covers_half(worker *w, size_t b, int i, int j, int k)
{
    const ms_ball *ball = &w->raster->ball[b];
    const double dx = i - ball->centre[0], dy = j - ball->centre[1], dz = k - ball->centre[2];
    const double reach = ball->radius + FARTHEST_SAMPLE, away = dx * dx + dy * dy + dz * dz;
    const double square = ball->radius * ball->radius + ON_SURFACE;
    const int centre = away <= square;
    const uint64_t mask = away > reach * reach ? 0 : sample_mask(dx, dy, dz, square);
    if (mask == 0 && !centre) {
        return 0; /* nothing new in this voxel */
    }
    if (__builtin_popcountll(mask) + centre > HALF_OF_SAMPLES) {
        return 1;
    }
    struct ms_raster_slot *slot =
        find_slot(&w->raster->partial[k], (uint32_t)i + (uint32_t)w->raster->grid->n[0] * (uint32_t)j);
    if (!slot) {
        w->out_of_memory = 1;
        return 0;
    }
    slot->mask |= mask;
    slot->centre |= (uint32_t)centre;
    return __builtin_popcountll(slot->mask) + (int)slot->centre > HALF_OF_SAMPLES;
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

/* Bits from..to-1 of a word that begins with voxel `base`. */
static uint64_t word_mask(int base, int from, int to)
{
    const uint64_t above = from > base ? UINT64_MAX << (from - base) : UINT64_MAX;
    return above & (to < base + WORD ? UINT64_MAX >> (base + WORD - to) : UINT64_MAX);
}

/* Is any voxel of a row that no ball covers from `from` to `to` - 1? */
static int is_vacant(const ms_raster *raster, int j, int k, int from, int to)
{
    const uint64_t *vacant = find_vacant(raster, j, k);
    uint64_t any = 0;
    for (int base = from / WORD * WORD; base < to; base += WORD) {
        any |= vacant[base / WORD] & word_mask(base, from, to);
    }
    return any != 0;
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
    uint64_t *vacant = find_vacant(raster, j, k);
    row_sums sums = {.lo = INT_MAX, .hi = INT_MIN};
    const int from = ms_window_first(x - outer, n), to = ms_window_end(x + outer, n);
    const int full_from = inner < 0 ? to : ms_window_first(x - inner, n),
              full_to = inner < 0 ? to : ms_window_end(x + inner, n);
    for (int base = from / WORD * WORD; base < to; base += WORD) {
        uint64_t *word = vacant + base / WORD;
        for (uint64_t bits = *word & word_mask(base, from, to); bits; bits &= bits - 1) {
            const int i = base + __builtin_ctzll(bits);
            if ((i >= full_from && i < full_to) || covers_half(w, b, i, j, k)) {
                *word ^= bits & -bits;
                cover_voxel(&sums, first, inside, i, b);
            }
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
    const double outer = ball->radius + (half ? FARTHEST_SAMPLE : 0);
    const double inner = half ? half_chord(ball->radius, SURELY_COVERED) : ball->radius;
    const double dz = k - ball->centre[2], reach = half_chord(outer, dz * dz);
    if (reach < 0) {
        return;
    }
    const int *n = w->raster->grid->n;
    const int from = ms_window_first(ball->centre[1] - reach, n[1]), to = ms_window_end(ball->centre[1] + reach, n[1]);
    const int first = ms_window_first(ball->centre[0] - reach, n[0]),
              end = ms_window_end(ball->centre[0] + reach, n[0]);
    for (int j = from; j < to; j++) {
        if (is_vacant(w->raster, j, k, first, end)) {
            const double dy = j - ball->centre[1], away = dy * dy + dz * dz;
            const double chord = half_chord(outer, away);
            if (chord >= 0) {
                cover_row(w, b, j, k, chord, half_chord(inner, away));
            }
        }
    }
}

/* One that lies within another covers nothing of its own. */
static void find_buried(ms_raster *raster, size_t from)
{
    for (size_t b = from; b < raster->n_balls; b++) {
        const ms_ball *ball = &raster->ball[b];
        for (size_t other = 0; other < b && !raster->buried[b]; other++) {
            const double depth = raster->ball[other].radius - ball->radius;
            raster->buried[b] =
                depth >= 0 && ms_squared_distance(raster->ball[other].centre, ball->centre) <= depth * depth;
        }
    }
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

/* Do the new balls hold so many voxels that a second thread has woken before they are covered? */
static int are_many_voxels(const ms_raster *raster, size_t first_new)
{
    double sum = 0;
    for (size_t b = first_new; b < raster->n_balls && sum < MS_GRID_THREADS_FROM; b++) {
        sum += 8 * pow(raster->ball[b].radius, 3);
    }
    return sum >= MS_GRID_THREADS_FROM && ms_grid_voxels(raster->grid) >= MS_GRID_THREADS_FROM;
}

static ms_status cover_balls(ms_raster *raster, size_t first_new, ms_error *err)
{
    int from, to, out_of_memory = 0;
    plane_range(&from, &to, raster, first_new);
    for (int a = 0; a < 3; a++) {
        raster->lo[a] = INT_MAX;
        raster->hi[a] = INT_MIN;
    }
    omp_lock_t merging;
    omp_init_lock(&merging);
#pragma omp parallel reduction(| : out_of_memory) if (are_many_voxels(raster, first_new))
    {
        worker w = {
            .raster = raster, .from = first_new, .lo = {INT_MAX, INT_MAX, INT_MAX}, .hi = {INT_MIN, INT_MIN, INT_MIN}};
        w.tally = calloc(raster->n_balls - first_new, sizeof *w.tally);
        w.out_of_memory = !w.tally;
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
        out_of_memory = w.out_of_memory;
    }
    omp_destroy_lock(&merging);
    if (raster->hi[0] < raster->lo[0]) {
        memset(raster->lo, 0, sizeof raster->lo);
        memset(raster->hi, 0, sizeof raster->hi);
    }
    return out_of_memory
               ? ms_fail(err, MS_ERR_NOMEM, "no memory for the union of %zu spheres; use fewer cells", raster->n_balls)
               : MS_OK;
}

/* The cells, of the lattice that they were cut on, which a larger grid continues. */
static void cover_cells(ms_raster *raster, size_t first_new)
{
    const ms_grid *grid = raster->grid;
    for (size_t b = first_new; grid->cells && b < raster->n_balls; b++) {
        ms_ball ball = raster->ball[b];
        for (int a = 0; a < 3; a++) {
            ball.centre[a] += rint((grid->origin[a] - grid->cells->origin[a]) / grid->h);
        }
        if (!raster->buried[b]) {
            raster->tally[b].cut = ms_cut_left_cover(raster->left, &ball, NULL);
        }
    }
}

ms_status ms_raster_add(ms_raster *raster, const ms_ball *balls, size_t count, ms_error *err)
{
    const size_t first_new = raster->n_balls;
    memset(raster->lo, 0, sizeof raster->lo);
    memset(raster->hi, 0, sizeof raster->hi);
    if (count == 0) {
        return MS_OK;
    }
    ms_status status = append_balls(raster, balls, count, err);
    if (status == MS_OK) {
        find_buried(raster, first_new);
        status = cover_balls(raster, first_new, err);
        cover_cells(raster, first_new);
    }
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
