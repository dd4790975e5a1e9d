#include "ms_random_spheres.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_random.h"

/* Centres drawn at a time; their radii are found in parallel. */
enum { BATCH = 8192 };

typedef struct filling {
    const ms_target *target;
    const ms_nodes *nodes;
    double lo[3], hi[3]; /* box of the centres, in voxels */
    size_t *group;       /* of each node, which of those that count; NULL: itself */
    size_t n_counted;    /* nodes that count */
    uint8_t *covered;    /* one per node that counts */
    size_t n_covered;
    ms_ball *ball; /* as many as `room` */
    size_t count, room;
    gsl_rng *random;
} filling;

/* The box of the nodes; of a volume that of its voxels. */
static void find_inside_box(filling *f)
{
    for (int a = 0; a < 3; a++) {
        f->lo[a] = HUGE_VAL;
        f->hi[a] = -HUGE_VAL;
        for (size_t n = 0; n < f->nodes->count; n++) {
            f->lo[a] = fmin(f->lo[a], f->nodes->at[n][a]);
            f->hi[a] = fmax(f->hi[a], f->nodes->at[n][a]);
        }
        f->lo[a] -= f->target->mesh ? 0 : 0.5;
        f->hi[a] += f->target->mesh ? 0 : 0.5;
    }
}

static ms_status open_filling(filling *f, const ms_target *target, const ms_nodes *nodes,
                              const ms_random_spheres_rule *rule, ms_error *err)
{
    *f = (filling){.target = target, .nodes = nodes, .n_counted = nodes->count};
    find_inside_box(f);
    if (rule->thinned > 0) {
        const ms_status status = ms_nodes_group(&f->group, &f->n_counted, nodes, rule->thinned, err);
        if (status != MS_OK) {
            return status;
        }
    }
    f->covered = calloc(f->n_counted, sizeof *f->covered);
    f->random = ms_random_new((unsigned long)rule->seed);
    if (!f->covered || !f->random) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to fill a shape of %zu nodes", f->nodes->count);
    }
    return MS_OK;
}

static void close_filling(filling *f)
{
    free(f->group);
    free(f->covered);
    ms_random_free(f->random);
}

/* Draws a centre; 0 if it is outside. */
static int draw_centre(double centre[3], filling *f)
{
    const ms_grid *grid = &f->target->grid;
    int voxel[3];
    for (int a = 0; a < 3; a++) {
        centre[a] = f->lo[a] + (f->hi[a] - f->lo[a]) * gsl_rng_uniform(f->random);
    }
    for (int a = 0; a < 3; a++) {
        voxel[a] = (int)rint(centre[a]);
        if (voxel[a] < 0 || voxel[a] >= grid->n[a]) {
            return 0;
        }
        centre[a] = f->target->mesh ? centre[a] : voxel[a];
    }
    return grid->inside[ms_grid_index(grid, voxel[0], voxel[1], voxel[2])];
}

double ms_random_spheres_radius(size_t *touched, const double centre[3], const ms_target *target, const ms_nodes *nodes,
                                const ms_random_spheres_rule *rule)
{
    double distance;
    const size_t nearest = ms_nodes_nearest(&distance, nodes, centre, rule->norm);
    if (touched) {
        *touched = nearest;
    }
    return distance + rule->offset + (target->mesh ? 0 : 0.5);
}

static ms_status make_room_for_spheres(filling *f, ms_error *err)
{
    if (f->room - f->count < BATCH) {
        const size_t room = f->room + f->room / 2 + 2 * BATCH;
        ms_ball *grown = realloc(f->ball, room * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres that fill the shape", room);
        }
        f->ball = grown;
        f->room = room;
    }
    return MS_OK;
}

static int is_full(const filling *f, const ms_random_spheres_rule *rule)
{
    return f->count >= rule->least && (double)f->n_covered >= rule->nodes_covered * (double)f->n_counted;
}

/* ms_nodes_visit. */
static void cover_node(void *context, size_t node)
{
    filling *f = context;
    uint8_t *covered = &f->covered[f->group ? f->group[node] : node];
    f->n_covered += !*covered;
    *covered = 1;
}

/* Keeps the spheres of a batch, one after the other, until the shape is full. */
static void keep_spheres(filling *f, size_t drawn, const size_t *touched, const ms_random_spheres_rule *rule)
{
    for (size_t b = 0; b < drawn && !is_full(f, rule); b++) {
        const ms_ball *ball = &f->ball[f->count++];
        cover_node(f, touched[b]);
        if (rule->within) {
            ms_nodes_visit_within(f->nodes, ball->centre, ball->radius, cover_node, f);
        }
    }
}

static void draw_batch(filling *f, size_t tries, const ms_random_spheres_rule *rule)
{
    size_t drawn = 0, touched[BATCH];
    ms_ball *ball = f->ball + f->count;
    for (size_t t = 0; t < tries; t++) {
        drawn += draw_centre(ball[drawn].centre, f) != 0;
    }
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t b = 0; b < drawn; b++) {
        ball[b].radius = ms_random_spheres_radius(&touched[b], ball[b].centre, f->target, f->nodes, rule);
    }
    keep_spheres(f, drawn, touched, rule);
}

static ms_status out_of_tries(const filling *f, const ms_random_spheres_rule *rule, ms_error *err)
{
    const double share = 100 * (double)f->n_covered / (double)f->n_counted;
    return ms_fail(err, MS_ERR_LIMIT,
                   "%zu random centres gave %zu spheres that touch %.1f %% of %zu nodes, not %g %%; "
                   "lower nodes-covered, raise tries, or coarsen the mesh",
                   rule->tries, f->count, share, f->n_counted, 100 * rule->nodes_covered);
}

ms_status ms_random_spheres(ms_ball **ball, size_t *count, size_t *counted, const ms_target *target,
                            const ms_nodes *nodes, const ms_random_spheres_rule *rule, ms_error *err)
{
    filling f;
    *ball = NULL;
    *count = 0;
    ms_status status = open_filling(&f, target, nodes, rule, err);
    *counted = f.n_counted;
    for (size_t left = rule->tries; status == MS_OK && !is_full(&f, rule);) {
        const size_t tries = left < BATCH ? left : BATCH;
        left -= tries;
        if (tries == 0) {
            status = out_of_tries(&f, rule, err);
        } else if ((status = make_room_for_spheres(&f, err)) == MS_OK) {
            draw_batch(&f, tries, rule);
            if (rule->progress) {
                rule->progress(rule->progress_context, f.count, (double)NAN);
            }
        }
    }
    if (status == MS_OK) {
        *ball = f.ball;
        *count = f.count;
    } else {
        free(f.ball);
    }
    close_filling(&f);
    return status;
}
