#include "ms_inscribed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_climb.h"
#include "ms_coarse_view.h"
#include "ms_coverage_count.h"

/* It is counted on every k-th voxel so that the mean radius is about as many of them, until the last moves. A finer
 * count takes longer and gains little. */
static const double RESOLUTION = 12;
enum { MOST_STEP = 6 };

/* Steps of the moves, in those: the first, of spheres about one that was added or dropped, while others may yet come,
 * and the last of all. */
static const double FIRST = 4, AGAIN = 2, ROUGH = 0.5, LAST = 0.1;

/* Part of a step within which a climb has led back. */
static const double BACK = 0.1;

/* Rounds of moves with one step; exchanges: more gain little; one of so many spheres is exchanged at a time, and chosen
 * from so many for each. */
enum { ROUNDS = 6, EXCHANGES = 2, PART = 10, OFFERS = 20 };

/* Spheres, what they cover, and which of them are to be moved. */
typedef struct inscribed {
    const ms_surface_fit *fit;
    const ms_target *target;
    ms_coarse_view view; /* where it is counted */
    ms_coverage_count o;
    ms_ball *ball;
    size_t count;
    uint8_t *stale;
} inscribed;

int ms_inscribed_applies(const ms_surface_fit *fit)
{
    const ms_bounds *b = &fit->bounds;
    const ms_target *target = fit->field->target;
    const int *across = fit->mirror.across;
    return b->protrusion == 0 && !b->equal && !(b->planes && b->planes->n_planes > 0) && target->closest &&
           target->closed && !(across[0] || across[1] || across[2]);
}

static int64_t find_gain(const inscribed *s, const ms_ball *ball)
{
    const ms_ball seen = ms_coarse_view_ball(&s->view, ball);
    return ms_coverage_count_gain(&s->o, &seen);
}

static int64_t find_loss(const inscribed *s, const ms_ball *ball)
{
    const ms_ball seen = ms_coarse_view_ball(&s->view, ball);
    return ms_coverage_count_loss(&s->o, &seen);
}

static void add_ball(inscribed *s, const ms_ball *ball)
{
    const ms_ball seen = ms_coarse_view_ball(&s->view, ball);
    ms_coverage_count_add(&s->o, &seen);
}

static void remove_ball(inscribed *s, const ms_ball *ball)
{
    const ms_ball seen = ms_coarse_view_ball(&s->view, ball);
    ms_coverage_count_remove(&s->o, &seen);
}

/* What may gain by the change of a sphere: those that it touches, or nearly. */
static void mark_near(inscribed *s, const ms_ball *changed, double reach)
{
    for (size_t b = 0; b < s->count; b++) {
        const double r = s->ball[b].radius + changed->radius + reach;
        s->stale[b] |= ms_squared_distance(s->ball[b].centre, changed->centre) < r * r;
    }
}

/* The sphere after one of 8 moves and the climb from there: a step to either side along each axis, or none, or the way
 * up that the radii about it tell: in corners the axes lead nowhere. 0 if there is none such. */
static int climb_from(ms_ball *out, double radius[6], const ms_ball *ball, int which, double step, const inscribed *s)
{
    const double slope[3] = {radius[0] - radius[1], radius[2] - radius[3], radius[4] - radius[5]};
    const double steepest = sqrt(ms_dot(slope, slope));
    *out = *ball;
    if (which < 6) {
        out->centre[which / 2] += which % 2 ? -step : step;
    }
    for (int a = 0; a < 3 && which == 7 && steepest > 0; a++) {
        out->centre[a] += step * slope[a] / steepest;
    }
    const double first = ms_climb(out, s->target, step);
    if (which < 6) {
        radius[which] = first;
    }
    return out->radius >= s->fit->bounds.least &&
           ms_squared_distance(out->centre, ball->centre) >= BACK * step * BACK * step;
}

/* Makes the best move of a sphere; 0 if none is better than to stay. */
static int move_on_axis(inscribed *s, size_t b, double step)
{
    const ms_ball before = s->ball[b];
    ms_ball best = before, tried;
    double radius[6] = {0};
    remove_ball(s, &before);
    const int64_t stay = find_gain(s, &before);
    int64_t most = stay;
    for (int which = 0; which < 8 && step < before.radius; which++) {
        const int64_t gain = climb_from(&tried, radius, &before, which, step, s) ? find_gain(s, &tried) : stay;
        if (gain > most) {
            most = gain;
            best = tried;
        }
    }
    s->ball[b] = best;
    add_ball(s, &best);
    return most > stay;
}

/* Moves those that are marked, and in turn what they come to touch, by ever shorter steps. */
static void move_marked(inscribed *s, uint8_t *ever, double first, double last)
{
    memcpy(ever, s->stale, s->count);
    for (double step = first * s->view.step; step > last * s->view.step; step /= 2) {
        size_t moved = s->count;
        memcpy(s->stale, ever, s->count);
        for (int round = 0; round < ROUNDS && 10 * moved >= s->count; round++) {
            moved = 0;
            for (size_t b = 0; b < s->count; b++) {
                const ms_ball before = s->ball[b];
                const int is_stale = s->stale[b];
                s->stale[b] = 0;
                if (is_stale && move_on_axis(s, b, step)) {
                    moved++;
                    mark_near(s, &before, step);
                    mark_near(s, &s->ball[b], step);
                }
            }
            for (size_t b = 0; b < s->count; b++) {
                ever[b] |= s->stale[b];
            }
        }
    }
    memset(s->stale, 0, s->count);
}

/* Inscribed spheres in the place of voxels that nothing covers, evenly among them; `shift` chooses which. */
static size_t list_offers(ms_ball *offer, size_t most, const inscribed *s, size_t shift)
{
    const ms_grid *grid = s->o.grid;
    const size_t voxels = ms_grid_voxels(grid);
    size_t bare = 0, passed = 0, count = 0;
    for (size_t v = 0; v < voxels; v++) {
        bare += grid->inside[v] && !s->o.covers[v];
    }
    const size_t each = bare / most + 1;
    for (size_t v = 0; v < voxels; v++) {
        if (grid->inside[v] && !s->o.covers[v] && passed++ % each == shift % each) {
            int voxel[3];
            ms_grid_voxel(voxel, grid->n, v);
            const ms_ball at = {.centre = {voxel[0], voxel[1], voxel[2]}};
            offer[count++] = ms_coarse_view_target_ball(&s->view, &at);
        }
    }
    return count;
}

/* Has them climb; gains of those that are not inscribed, or too small, are 0. */
static void value_offers(ms_ball *offer, int64_t *gain, size_t count, const inscribed *s)
{
    const ms_surface_fit *fit = s->fit;
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t c = 0; c < count; c++) {
        gain[c] = 0;
        if (ms_bounds_most_radius(&fit->bounds, fit->field, offer[c].centre) > 0) {
            ms_climb(&offer[c], s->target, FIRST * s->view.step);
            gain[c] = offer[c].radius < fit->bounds.least ? 0 : find_gain(s, &offer[c]);
        }
    }
}

/* The offer of most gain; that of others is no more than it was before spheres were added. */
static size_t find_best_offer(const ms_ball *offer, int64_t *gain, size_t count, const inscribed *s)
{
    for (;;) {
        size_t best = 0;
        for (size_t c = 1; c < count; c++) {
            best = gain[c] > gain[best] ? c : best;
        }
        const int64_t now = gain[best] > 0 ? find_gain(s, &offer[best]) : gain[best];
        if (now >= gain[best]) {
            return best;
        }
        gain[best] = now;
    }
}

static ms_status add_best(inscribed *s, size_t more, size_t shift, ms_error *err)
{
    const size_t most = OFFERS * more;
    ms_ball *offer = malloc((most + 1) * sizeof *offer);
    int64_t *gain = malloc((most + 1) * sizeof *gain);
    const ms_status status =
        offer && gain ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres to choose from", most);
    const size_t offers = status == MS_OK ? list_offers(offer, most, s, shift) : 0;
    if (offers > 0) {
        value_offers(offer, gain, offers, s);
    }
    for (size_t i = 0; i < more && offers > 0; i++) {
        const size_t best = find_best_offer(offer, gain, offers, s);
        if (gain[best] <= 0) {
            break;
        }
        s->ball[s->count] = offer[best];
        s->stale[s->count++] = 1;
        add_ball(s, &offer[best]);
        mark_near(s, &offer[best], 0);
    }
    free(offer);
    free(gain);
    return status;
}

static void drop_least(inscribed *s)
{
    size_t least = 0;
    int64_t smallest = INT64_MAX;
    for (size_t b = 0; b < s->count; b++) {
        const int64_t loss = find_loss(s, &s->ball[b]);
        if (loss < smallest) {
            smallest = loss;
            least = b;
        }
    }
    const ms_ball gone = s->ball[least];
    remove_ball(s, &gone);
    s->count--;
    s->ball[least] = s->ball[s->count];
    s->stale[least] = s->stale[s->count];
    mark_near(s, &gone, 0);
}

/* Replaces the spheres, and what is counted, by other ones. */
static void take_back(inscribed *s, const ms_ball *kept, size_t count)
{
    for (size_t b = 0; b < s->count; b++) {
        remove_ball(s, &s->ball[b]);
    }
    for (size_t b = 0; b < count; b++) {
        add_ball(s, &kept[b]);
    }
    memcpy(s->ball, kept, count * sizeof *kept);
    s->count = count;
}

/* Adds a part of the spheres, drops as many, and takes that back if no more is covered. */
static ms_status exchange_part(inscribed *s, ms_ball *kept, uint8_t *ever, size_t shift, ms_error *err)
{
    const size_t count = s->count;
    const int64_t before = s->o.mismatch;
    memcpy(kept, s->ball, count * sizeof *kept);
    const ms_status status = add_best(s, count / PART + 1, shift, err);
    move_marked(s, ever, AGAIN, ROUGH);
    while (s->count > count) {
        drop_least(s);
    }
    move_marked(s, ever, AGAIN, ROUGH);
    if (s->o.mismatch >= before) {
        take_back(s, kept, count);
    }
    return status;
}

/* Counts on every step-th voxel from now on. */
static ms_status begin_count(inscribed *s, int step, ms_error *err)
{
    ms_ball *seen = malloc((s->count + 1) * sizeof *seen);
    ms_coverage_count_close(&s->o);
    ms_coarse_view_free(&s->view);
    ms_status status = seen ? ms_coarse_view_make(&s->view, s->target, s->target->distance, step, err)
                            : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", s->count);
    for (size_t b = 0; b < s->count && status == MS_OK; b++) {
        seen[b] = ms_coarse_view_ball(&s->view, &s->ball[b]);
    }
    if (status == MS_OK) {
        status = ms_coverage_count_open(&s->o, &s->view.grid, seen, s->count, err);
    }
    free(seen);
    return status;
}

static int choose_count_step(const inscribed *s)
{
    double sum = 0;
    for (size_t b = 0; b < s->count; b++) {
        sum += s->ball[b].radius;
    }
    const double step = sum / (double)s->count / RESOLUTION;
    return step < 2 ? 1 : (int)fmin(step, MOST_STEP);
}

static ms_status improve_all(inscribed *s, ms_ball *kept, uint8_t *ever, ms_error *err)
{
    ms_status status = begin_count(s, choose_count_step(s), err);
    if (status == MS_OK) {
        memset(s->stale, 1, s->count);
        move_marked(s, ever, FIRST, ROUGH);
    }
    for (size_t e = 0; e < EXCHANGES && status == MS_OK; e++) {
        status = exchange_part(s, kept, ever, e, err);
    }
    if (status == MS_OK) {
        status = begin_count(s, 1, err);
    }
    if (status == MS_OK) {
        memset(s->stale, 1, s->count);
        move_marked(s, ever, ROUGH, LAST);
    }
    return status;
}

ms_status ms_inscribed_improve(ms_ball *ball, size_t count, const ms_surface_fit *fit, ms_error *err)
{
    const size_t room = count + count / PART + 1;
    inscribed s = {.fit = fit,
                   .target = fit->field->target,
                   .ball = malloc(room * sizeof *s.ball),
                   .count = count,
                   .stale = malloc(room)};
    ms_ball *kept = malloc((count + 1) * sizeof *kept);
    uint8_t *ever = malloc(room);
    ms_status status =
        s.ball && s.stale && kept && ever ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", room);
    if (status == MS_OK && count > 0) {
        memcpy(s.ball, ball, count * sizeof *ball);
        status = begin_count(&s, 1, err);
        const int64_t before = s.o.mismatch;
        status = status == MS_OK ? improve_all(&s, kept, ever, err) : status;
        if (status == MS_OK && s.o.mismatch < before) {
            memcpy(ball, s.ball, count * sizeof *ball);
        }
    }
    ms_coverage_count_close(&s.o);
    ms_coarse_view_free(&s.view);
    free(s.ball);
    free(s.stale);
    free(kept);
    free(ever);
    return status;
}
