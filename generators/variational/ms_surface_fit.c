#include "ms_surface_fit.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* Ridge added to the normal equations, as part of the sum of weights. */
static const double RIDGE = 1e-3;

/* No step is longer than this part of the radius. */
static const double LONGEST_STEP = 0.25;

/* Part of the last step that is made again: chains of spheres settle sooner. */
static const double MOMENTUM = 0.5;

/* Weight of places that stick out farther than is allowed. */
static const double STIFF = 1000;

/* Spheres larger than the mean radius times this are few. */
static const double LARGE = 1.5;

/* Distances below this, in voxels, weigh the same. */
static const double NEAR = 0.25;

/* Spheres in the order of their left ends along x, so that those near one are found in a window as
 * wide as the widest. The few that are much larger than the mean stand apart: they would make all
 * windows wide. */
typedef struct end {
    double left;
    uint32_t ball;
} end;

typedef struct sweep {
    size_t count;
    ms_ball *ball;  /* those that are fitted, and behind them their images */
    end *end;       /* in order, and behind them the large ones */
    size_t n_small; /* in order */
    double widest;  /* diameter of those */
} sweep;

/* The parts of a sphere's surface that others cover: u.axis > least for the normals u there. Blocks of them are
 * compared at once. */
enum { BLOCK = 8 };
typedef struct caps {
    float axis[3][BLOCK]; /* to the other centres, in radii */
    float least[BLOCK];
} caps;

/* The steps that the spheres want to make. */
typedef struct move {
    double centre[3], radius;
    double along[3]; /* how the centre's step changes with the radius's */
    double weight;   /* by how much the sum of squares rises with the square of another radius; 0: nothing is exposed */
} move;

/* All that a step works with. */
typedef struct workspace {
    sweep sweep;
    double (*direction)[3]; /* as of the Fibonacci lattice, and turned */
    double (*turned)[3];
    float (*normal)[3]; /* the turned ones again */
    move *move;
    double (*velocity)[4]; /* what was made of the last steps, before damping: centre, radius */
    gsl_rng *rng;
} workspace;

static int compare_ends(const void *a, const void *b)
{
    const end *p = a, *q = b;
    return p->left != q->left ? (p->left > q->left) - (p->left < q->left) : (p->ball > q->ball) - (p->ball < q->ball);
}

static void sort_ends(sweep *s)
{
    double sum = 0;
    size_t large = s->count;
    for (size_t b = 0; b < s->count; b++) {
        sum += s->ball[b].radius;
    }
    s->widest = LARGE * 2 * sum / (double)s->count;
    s->n_small = 0;
    for (size_t b = 0; b < s->count; b++) {
        const end e = {s->ball[b].centre[0] - s->ball[b].radius, (uint32_t)b};
        s->end[2 * s->ball[b].radius <= s->widest ? s->n_small++ : --large] = e;
    }
    qsort(s->end, s->n_small, sizeof *s->end, compare_ends);
}

static void set_cap(caps *block, size_t at, const ms_ball *ball, const ms_ball *other, double square)
{
    const double r = ball->radius;
    for (int c = 0; c < 3; c++) {
        block->axis[c][at] = (float)((other->centre[c] - ball->centre[c]) / r);
    }
    block->least[at] = (float)((square + (r - other->radius) * (r + other->radius)) / (2 * r * r));
}

/* What other spheres cover of one's surface; returns how many blocks. */
static size_t find_caps(caps *block, const sweep *s, uint32_t self)
{
    const ms_ball *ball = &s->ball[self];
    const double from = ball->centre[0] - ball->radius - s->widest, to = ball->centre[0] + ball->radius;
    size_t low = 0, high = s->n_small, found = 0;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        *(s->end[middle].left < from ? &low : &high) = middle + (s->end[middle].left < from);
    }
    while (low < s->count) {
        const end *e = &s->end[low++];
        if (low <= s->n_small && !(e->left < to)) {
            low = s->n_small;
            continue;
        }
        const ms_ball *other = &s->ball[e->ball];
        const double reach = ball->radius + other->radius;
        const double square = ms_squared_distance(ball->centre, other->centre);
        const double deep = ball->radius - other->radius; /* those inside cover nothing of it */
        if (e->ball != self && square < reach * reach && !(deep > 0 && square < deep * deep)) {
            set_cap(&block[found / BLOCK], found % BLOCK, ball, other, square);
            found++;
        }
    }
    for (; found % BLOCK; found++) {
        for (int c = 0; c < 3; c++) {
            block[found / BLOCK].axis[c][found % BLOCK] = 0;
        }
        block[found / BLOCK].least[found % BLOCK] = 1; /* covers nothing */
    }
    return found / BLOCK;
}

/* Is the place with this normal covered? The block that covers it is tried first next time. */
static int is_covered(size_t *first, const caps *block, size_t blocks, const float normal[3])
{
    for (size_t b = 0; b < blocks; b++) {
        const size_t at = b == 0 ? *first : b <= *first ? b - 1 : b;
        const caps *c = &block[at];
        int covered = 0;
#pragma omp simd reduction(| : covered)
        for (int i = 0; i < BLOCK; i++) {
            covered |= c->axis[0][i] * normal[0] + c->axis[1][i] * normal[1] + c->axis[2][i] * normal[2] > c->least[i];
        }
        if (covered) {
            *first = at;
            return 1;
        }
    }
    return 0;
}

/* Cholesky's decomposition of a positive definite matrix, in place. */
static void decompose(double a[4][4])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++) {
                sum -= a[i][k] * a[j][k];
            }
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
    }
}

/* Solves l x = b and l^T x = b for the first n unknowns, x in place of b. */
static void solve_lower(double l[4][4], double *b, int n)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) {
            b[i] -= l[i][k] * b[k];
        }
        b[i] /= l[i][i];
    }
}

static void solve_upper(double l[4][4], double *b, int n)
{
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) {
            b[i] -= l[k][i] * b[k];
        }
        b[i] /= l[i][i];
    }
}

/* The least sum of squares; the last row of the decomposition tells how it rises with the radius. */
static void solve_move(move *out, double a[4][4], double b[4])
{
    decompose(a);
    solve_lower(a, b, 4);
    solve_upper(a, b, 4);
    for (int c = 0; c < 3; c++) {
        out->centre[c] = b[c];
        out->along[c] = -a[3][c];
    }
    out->radius = b[3];
    out->weight = a[3][3] * a[3][3];
    solve_upper(a, out->along, 3);
}

/* A sphere on a plane of symmetry moves along it. */
static void keep_to_planes(move *m, const ms_mirror *planes, const ms_ball *ball)
{
    for (int a = 0; a < 3; a++) {
        if (ms_mirror_holds(planes, ball, a)) {
            m->centre[a] = m->along[a] = 0;
        }
    }
}

/* How far a place is beyond the planes, in voxels; -HUGE_VAL if it is not. */
static double beyond_planes(const ms_surface_fit *fit, const double centre[3], const double place[3])
{
    const ms_grid *grid = &fit->field->target->grid;
    double from[3], to[3], unused;
    ms_target_from_voxels(from, &unused, grid, centre, 0);
    ms_target_from_voxels(to, &unused, grid, place, 0);
    const double beyond = ms_planes_beyond(fit->bounds.planes, from, to) / grid->h;
    return beyond > 0 ? beyond : -HUGE_VAL;
}

static move find_move(const ms_surface_fit *fit, const workspace *work, caps *block, uint32_t self)
{
    const ms_ball *ball = &work->sweep.ball[self];
    const size_t blocks = find_caps(block, &work->sweep, self);
    const int walled = fit->bounds.planes && fit->bounds.planes->n_planes > 0;
    size_t first = 0;
    double a[4][4] = {{0}}, b[4] = {0};
    double weight = 0;
    move out = {.weight = 0};
    for (int p = 0; p < fit->points && ball->radius > 0; p++) {
        const double row[4] = {work->turned[p][0], work->turned[p][1], work->turned[p][2], 1};
        const double place[3] = {ball->centre[0] + ball->radius * row[0], ball->centre[1] + ball->radius * row[1],
                                 ball->centre[2] + ball->radius * row[2]};
        const double beyond = walled ? beyond_planes(fit, ball->centre, place) : -HUGE_VAL;
        if (!(beyond > 0) && is_covered(&first, block, blocks, work->normal[p])) {
            continue;
        }
        const double away = ms_signed_distance_at(fit->field, place), phi = away > beyond ? away : beyond;
        const double size = fabs(phi) > NEAR ? fabs(phi) : NEAR;
        const double w = (beyond > 0 || phi > fit->bounds.protrusion ? STIFF : 1) / size;
        for (int i = 0; i < 4; i++) {
            for (int j = 0; j <= i; j++) {
                a[i][j] += w * row[i] * row[j];
            }
            b[i] -= w * phi * row[i];
        }
        weight += w;
    }
    if (weight > 0) {
        for (int i = 0; i < 4; i++) {
            a[i][i] += RIDGE * weight;
        }
        solve_move(&out, a, b);
        keep_to_planes(&out, &fit->ms_mirror, ball);
    }
    return out;
}

/* Begins with the mean of all radii. */
static void make_equal(ms_ball *ball, size_t count)
{
    double sum = 0;
    for (size_t s = 0; s < count; s++) {
        sum += ball[s].radius;
    }
    for (size_t s = 0; s < count; s++) {
        ball[s].radius = sum / (double)count;
    }
}

/* One radius for all: the one of the least sum of squares over all spheres, which are of one radius now. */
static void share_radius(move *moves, const ms_ball *ball, size_t count, const ms_mirror *planes)
{
    double sum = 0, weight = 0;
    for (size_t s = 0; s < count; s++) {
        const double images = (double)ms_mirror_images(planes, &ball[s]);
        sum += images * moves[s].weight * moves[s].radius;
        weight += images * moves[s].weight;
    }
    for (size_t s = 0; s < count && weight > 0; s++) {
        for (int c = 0; c < 3; c++) {
            moves[s].centre[c] += moves[s].along[c] * (sum / weight - moves[s].radius);
        }
        moves[s].radius = sum / weight;
    }
}

static void make_move(ms_ball *ball, double velocity[4], const move *step, double damping)
{
    for (int c = 0; c < 4; c++) {
        velocity[c] = MOMENTUM * velocity[c] + (c < 3 ? step->centre[c] : step->radius);
    }
    const double longest = LONGEST_STEP * ball->radius, length = damping * sqrt(ms_dot(velocity, velocity));
    const double part = length > longest ? damping * longest / length : damping;
    for (int c = 0; c < 3; c++) {
        ball->centre[c] += part * velocity[c];
    }
    ball->radius += fmin(fmax(damping * velocity[3], -longest), longest);
}

/* Signed distance of a place, exact where there is a mesh: the look-up cuts off the ridges. */
static double exact_distance(const ms_signed_distance *field, const double place[3])
{
    const ms_target *target = field->target;
    double p[3], unused;
    if (!target->closest || !target->closed) {
        return ms_signed_distance_at(field, place);
    }
    ms_target_from_voxels(p, &unused, &target->grid, place, 0);
    return ms_closest_signed_distance(target->closest, p) / target->grid.h;
}

int ms_surface_fit_is_bounded(const ms_surface_fit_bounds *bounds)
{
    return bounds->protrusion < HUGE_VAL || (bounds->planes && bounds->planes->n_planes > 0);
}

double ms_surface_fit_most_radius(const ms_surface_fit *fit, const double centre[3])
{
    const ms_grid *grid = &fit->field->target->grid;
    const double bound = fit->bounds.protrusion;
    double most = bound < HUGE_VAL ? bound - exact_distance(fit->field, centre) : HUGE_VAL, place[3], unused;
    if (fit->bounds.planes) {
        ms_target_from_voxels(place, &unused, grid, centre, 0);
        most = fmin(most, ms_planes_distance(fit->bounds.planes, place) / grid->h);
    }
    return most;
}

void ms_surface_fit_confine(const ms_surface_fit *fit, ms_ball *ball, size_t count)
{
    double least = HUGE_VAL;
    for (size_t s = 0; s < count; s++) {
        ball[s].radius = fmax(0, fmin(ball[s].radius, ms_surface_fit_most_radius(fit, ball[s].centre)));
        least = fmin(least, ball[s].radius);
    }
    for (size_t s = 0; s < count && fit->bounds.equal; s++) {
        ball[s].radius = least;
    }
}

/* Points of equal areas along a spiral. */
static void fill_directions(double (*direction)[3], int points)
{
    const double turn = acos(-1.0) * (3 - sqrt(5.0));
    for (int p = 0; p < points; p++) {
        const double z = 1 - (2 * p + 1.0) / points, r = sqrt(1 - z * z);
        direction[p][0] = r * cos(turn * p);
        direction[p][1] = r * sin(turn * p);
        direction[p][2] = z;
    }
}

/* Turns them by a random quaternion, uniform among rotations. */
static void turn_directions(workspace *work, const ms_surface_fit *fit)
{
    double q[4], square = 0;
    gsl_rng_set(work->rng, (unsigned long)(fit->seed * 1000003u + fit->turns));
    for (int i = 0; i < 4; i++) {
        q[i] = gsl_ran_gaussian(work->rng, 1);
        square += q[i] * q[i];
    }
    const double s = 2 / square, w = q[0], x = q[1], y = q[2], z = q[3];
    const double turn[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                               {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                               {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
    for (int p = 0; p < fit->points; p++) {
        for (int c = 0; c < 3; c++) {
            work->turned[p][c] = ms_dot(turn[c], work->direction[p]);
            work->normal[p][c] = (float)work->turned[p][c];
        }
    }
}

static void work_free(workspace *work)
{
    free(work->sweep.ball);
    free(work->sweep.end);
    free(work->direction);
    free(work->turned);
    free(work->normal);
    free(work->move);
    free(work->velocity);
    if (work->rng) {
        gsl_rng_free(work->rng);
    }
}

static ms_status work_alloc(workspace *work, const ms_surface_fit *fit, size_t count, ms_error *err)
{
    const int *across = fit->ms_mirror.across;
    const size_t points = (size_t)fit->points, images = count << (across[0] + across[1] + across[2]);
    *work = (workspace){.sweep = {.ball = malloc((images + 1) * sizeof *work->sweep.ball),
                                  .end = malloc((images + 1) * sizeof *work->sweep.end)},
                        .direction = malloc(points * sizeof *work->direction),
                        .turned = malloc(points * sizeof *work->turned),
                        .normal = malloc(points * sizeof *work->normal),
                        .move = malloc((count + 1) * sizeof *work->move),
                        .velocity = calloc(count + 1, sizeof *work->velocity),
                        .rng = gsl_rng_alloc(gsl_rng_mt19937)};
    if (!work->sweep.ball || !work->sweep.end || !work->direction || !work->turned || !work->normal || !work->move ||
        !work->velocity || !work->rng) {
        work_free(work);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to fit %zu spheres", count);
    }
    fill_directions(work->direction, fit->points);
    return MS_OK;
}

/* The moves of all spheres; 0 without memory. */
static int find_moves(const ms_surface_fit *fit, workspace *work, const ms_ball *ball, size_t count)
{
    work->sweep.count = ms_mirror_expand(work->sweep.ball, ball, count, &fit->ms_mirror);
    sort_ends(&work->sweep);
    int enough = 1;
#pragma omp parallel reduction(&& : enough)
    {
        caps *block = malloc((work->sweep.count / BLOCK + 1) * sizeof *block);
        enough = block != NULL;
#pragma omp for schedule(dynamic, 4)
        for (size_t s = 0; s < count; s++) {
            if (block) {
                work->move[s] = find_move(fit, work, block, (uint32_t)s);
            }
        }
        free(block);
    }
    return enough;
}

ms_status ms_surface_fit_steps(ms_surface_fit *fit, ms_ball *ball, size_t count, int steps, const double damping[2],
                               ms_error *err)
{
    workspace work;
    ms_status status = work_alloc(&work, fit, count, err);
    if (status != MS_OK) {
        return status;
    }
    if (fit->bounds.equal) {
        make_equal(ball, count);
    }
    for (int step = 0; step < steps && status == MS_OK; step++, fit->turns++) {
        const double d = damping[0] + (damping[1] - damping[0]) * step / fmax(1, steps - 1);
        turn_directions(&work, fit);
        if (!find_moves(fit, &work, ball, count)) {
            status = ms_fail(err, MS_ERR_NOMEM, "no memory to fit %zu spheres", count);
            break;
        }
        if (fit->bounds.equal) {
            share_radius(work.move, ball, count, &fit->ms_mirror);
        }
        for (size_t s = 0; s < count; s++) {
            make_move(&ball[s], work.velocity[s], &work.move[s], d);
            ball[s].radius = fmax(ball[s].radius, fit->bounds.least);
        }
    }
    work_free(&work);
    return status;
}
