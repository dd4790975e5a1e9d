#include "ms_surface_fit.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "ms_caps.h"
#include "ms_cholesky.h"
#include "ms_exposed.h"

/* Ridge added to the normal equations, as part of the sum of weights: a cap that is nearly flat does not tell a move
 * of its centre from a change of its radius. */
static const double RIDGE = 1e-3;

/* No step is longer than this part of the radius: the equations are linear. */
static const double LONGEST_STEP = 0.25;

/* Part of the last step that is made again: chains of spheres settle sooner. */
static const double MOMENTUM = 0.5;

/* Weight of places that stick out farther than is allowed: what still does so after the fit is cut away, which costs
 * more than to fit by it. */
static const double STIFF = 1000;

/* Weight of what pulls pieces together, in that of all else at the sphere. */
static const double TIE = 3;

/* Distances below this, in voxels, weigh the same: 1 / |phi| has to be bounded. */
static const double NEAR = 0.25;

/* Part of the points of the first level that have to be exposed, or the next level with twice as many is taken; above
 * the other, the one before. More take longer. */
static const double ENOUGH = 0.12, PLENTY = 0.3;

static const double FOUR_PI = 12.566370614359172954;

/* The steps that the spheres want to make. */
typedef struct move {
    double centre[3], radius;
    double along[3]; /* how the centre's step changes with the radius's */
    double weight;   /* by how much the sum of squares rises with the square of another radius; 0: nothing is exposed */
} move;

/* All that a step works with. */
typedef struct workspace {
    ms_caps_window window;
    uint8_t *level; /* of the lattice, for each sphere: the more of it is covered, the more points */
    move *move;
    ms_tie *tie; /* what pulls spheres together */
    size_t ties;
    double (*velocity)[4]; /* what was made of the last steps, before damping: centre, radius */
} workspace;

/* The least sum of squares; the last row of the decomposition tells how it rises with the radius. */
static void solve_move(move *out, double a[4][4], double b[4])
{
    ms_cholesky_decompose(a);
    ms_cholesky_solve_lower(a, b, 4);
    ms_cholesky_solve_upper(a, b, 4);
    for (int c = 0; c < 3; c++) {
        out->centre[c] = b[c];
        out->along[c] = -a[3][c];
    }
    out->radius = b[3];
    out->weight = a[3][3] * a[3][3];
    ms_cholesky_solve_upper(a, out->along, 3);
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

/* The normal equations of a sphere's step; the lower triangle. */
typedef struct normal_equations {
    double a[4][4], b[4], weight;
} normal_equations;

static void find_place(double place[3], const ms_ball *ball, const double normal[3])
{
    for (int c = 0; c < 3; c++) {
        place[c] = ball->centre[c] + ball->radius * normal[c];
    }
}

/* A place with this normal that is to move by -phi along it. */
static void add_equation(normal_equations *e, const double normal[3], double phi, double w)
{
    const double row[4] = {normal[0], normal[1], normal[2], 1};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j <= i; j++) {
            e->a[i][j] += w * row[i] * row[j];
        }
        e->b[i] -= w * phi * row[i];
    }
    e->weight += w;
}

static double find_size(double phi)
{
    return fabs(phi) > NEAR ? fabs(phi) : NEAR;
}

/* `beyond`: how far the place is beyond a plane; below 0: it is not. */
static void add_place(normal_equations *e, const ms_surface_fit *fit, const ms_ball *ball, const double normal[3],
                      double beyond)
{
    double place[3];
    find_place(place, ball, normal);
    const double away = ms_signed_distance_at(fit->field, place), phi = away > beyond ? away : beyond;
    const double price = phi > 0 ? 1 - fit->slant : 1 + fit->slant;
    const double w = (beyond > 0 || phi > fit->bounds.protrusion ? STIFF : 1) * price;
    add_equation(e, normal, phi, w / find_size(phi));
}

/* Places beyond planes, whether they are covered or not: of the first level, as they are not to weigh but to stop. */
static void add_places_beyond(normal_equations *e, const ms_surface_fit *fit, const ms_ball *ball)
{
    const ms_lattice_level *level = &fit->lattice->level[0];
    for (int p = 0; p < level->points; p++) {
        double normal[3], place[3];
        ms_lattice_normal(normal, fit->lattice, level->direction[p]);
        find_place(place, ball, normal);
        const double beyond = ms_bounds_beyond_planes(&fit->bounds, &fit->field->target->grid, ball->centre, place);
        if (beyond > 0) {
            add_place(e, fit, ball, normal, beyond);
        }
    }
}

/* Places of the surface that no sphere is near enough to and this one is the nearest to: one of the sphere's own is to
 * move towards each. `share`: of the surface that a point of the sphere stands for. */
static void add_far_places(normal_equations *e, const ms_gap *gap, const ms_ball *ball, uint32_t self, double share)
{
    for (size_t i = gap->first[self]; i < gap->first[self + 1]; i++) {
        const double *place = gap->place[gap->far[i]], too_far = gap->away[gap->far[i]] - gap->aim;
        const double way = sqrt(ms_squared_distance(place, ball->centre));
        double normal[3];
        for (int c = 0; c < 3; c++) {
            normal[c] = (place[c] - ball->centre[c]) / way;
        }
        add_equation(e, normal, -too_far, MS_GAP_PRICE * gap->area / share / find_size(too_far));
    }
}

/* What pulls this sphere to another piece outweighs all that holds it. */
static void add_ties(normal_equations *e, const workspace *work, uint32_t self)
{
    const double weight = e->weight > 0 ? e->weight : 1;
    for (size_t t = 0; t < work->ties; t++) {
        if (work->tie[t].ball == self) {
            add_equation(e, work->tie[t].normal, -work->tie[t].away, TIE * weight);
        }
    }
}

static move find_move(const ms_surface_fit *fit, const workspace *work, ms_exposed *exposed, uint32_t self)
{
    const ms_ball *ball = &work->window.ball[self];
    const int points = fit->lattice->level[0].points;
    normal_equations e = {.weight = 0};
    move out = {.weight = 0};
    if (!(ball->radius > 0)) {
        return out;
    }
    const int level =
        ms_exposed_find(exposed, fit->lattice, &work->window, self, work->level[self], (int)(ENOUGH * points));
    work->level[self] = (uint8_t)(exposed->count > PLENTY * points && level > 0 ? level - 1 : level);
    for (int p = 0; p < exposed->count; p++) {
        add_place(&e, fit, ball, exposed->normal[p], -HUGE_VAL);
    }
    if (fit->gap) {
        add_far_places(&e, fit->gap, ball, self, FOUR_PI * ball->radius * ball->radius / exposed->points);
    }
    if (fit->bounds.planes && fit->bounds.planes->n_planes > 0) {
        add_places_beyond(&e, fit, ball);
    }
    add_ties(&e, work, self);
    if (e.weight > 0) {
        for (int i = 0; i < 4; i++) {
            e.a[i][i] += RIDGE * e.weight;
        }
        solve_move(&out, e.a, e.b);
        out.weight /= exposed->points;
        keep_to_planes(&out, &fit->mirror, ball);
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

/* Returns how far the sphere's surface moves at most. */
static double make_move(ms_ball *ball, double velocity[4], const move *step, double damping, double least)
{
    const ms_ball before = *ball;
    for (int c = 0; c < 4; c++) {
        velocity[c] = MOMENTUM * velocity[c] + (c < 3 ? step->centre[c] : step->radius);
    }
    const double longest = LONGEST_STEP * ball->radius, length = damping * sqrt(ms_dot(velocity, velocity));
    const double part = length > longest ? damping * longest / length : damping;
    for (int c = 0; c < 3; c++) {
        ball->centre[c] += part * velocity[c];
    }
    ball->radius = fmax(ball->radius + fmin(fmax(damping * velocity[3], -longest), longest), least);
    return sqrt(ms_squared_distance(ball->centre, before.centre)) + fabs(ball->radius - before.radius);
}

static void free_workspace(workspace *work)
{
    ms_caps_window_free(&work->window);
    free(work->move);
    free(work->velocity);
    free(work->level);
    free(work->tie);
}

static ms_status alloc_workspace(workspace *work, const ms_surface_fit *fit, size_t count, ms_error *err)
{
    const int *across = fit->mirror.across;
    const size_t images = count << (across[0] + across[1] + across[2]);
    *work = (workspace){.move = malloc((count + 1) * sizeof *work->move),
                        .velocity = calloc(count + 1, sizeof *work->velocity)};
    work->level = calloc(count + 1, sizeof *work->level);
    ms_status status = MS_OK;
    if (!ms_caps_window_alloc(&work->window, images) || !work->move || !work->velocity || !work->level) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to fit %zu spheres", count);
    }
    if (status != MS_OK) {
        free_workspace(work);
    }
    return status;
}

/* The moves of all spheres; 0 without memory. */
static int find_moves(const ms_surface_fit *fit, workspace *work, const ms_ball *ball, size_t count)
{
    work->window.count = ms_mirror_expand(work->window.ball, ball, count, &fit->mirror);
    ms_caps_sort(&work->window);
    int enough = 1;
#pragma omp parallel reduction(&& : enough)
    {
        ms_exposed exposed;
        enough = ms_exposed_alloc(&exposed, fit->lattice, work->window.count);
#pragma omp for schedule(dynamic, 4)
        for (size_t s = 0; s < count; s++) {
            if (exposed.normal && (!fit->moving || fit->moving[s])) {
                work->move[s] = find_move(fit, work, &exposed, (uint32_t)s);
            }
        }
        ms_exposed_free(&exposed);
    }
    return enough;
}

ms_status ms_surface_fit_steps(ms_surface_fit *fit, ms_ball *ball, size_t count, int steps, const double damping[2],
                               ms_error *err)
{
    workspace work;
    double travel = HUGE_VAL;
    ms_status status = alloc_workspace(&work, fit, count, err);
    if (status != MS_OK) {
        return status;
    }
    if (fit->bounds.equal) {
        make_equal(ball, count);
    }
    for (int step = 0; step < steps && status == MS_OK; step++, fit->turns++) {
        const double d = damping[0] + (damping[1] - damping[0]) * step / fmax(1, steps - 1);
        ms_lattice_turn(fit->lattice, (unsigned long)(fit->seed * 1000003u + fit->turns));
        if (fit->gap) {
            ms_gap_find(fit->gap, ball, count, travel);
        }
        free(work.tie);
        work.tie = NULL;
        if (fit->connected &&
            (status = ms_connect_find(&work.tie, &work.ties, ball, count, &fit->mirror, err)) != MS_OK) {
            break;
        }
        if (!find_moves(fit, &work, ball, count)) {
            status = ms_fail(err, MS_ERR_NOMEM, "no memory to fit %zu spheres", count);
            break;
        }
        if (fit->bounds.equal) {
            share_radius(work.move, ball, count, &fit->mirror);
        }
        travel = 0;
        for (size_t s = 0; s < count; s++) {
            if (fit->moving && !fit->moving[s]) {
                continue;
            }
            travel = fmax(travel, make_move(&ball[s], work.velocity[s], &work.move[s], d, fit->bounds.least));
        }
    }
    free_workspace(&work);
    return status;
}
