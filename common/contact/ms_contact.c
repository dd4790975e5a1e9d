#include "ms_contact.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "base/ms_vector.h"
#include "ms_place.h"
#include "ms_sled.h"

static const double PI = 3.14159265358979323846;

/* Directions along a quarter turn: one for each degree. */
enum { FINENESS = 90 };

/* Where the samples of a row are taken. */
typedef struct meetings {
    size_t count;
    ms_touch_place *place; /* of a second particle; against a plane u alone */
    double *weight;
} meetings;

static void free_meetings(meetings *p)
{
    free(p->place);
    free(p->weight);
}

static ms_status alloc_meetings(meetings *p, size_t count, ms_error *err)
{
    *p = (meetings){count, malloc(count * sizeof *p->place), malloc(count * sizeof *p->weight)};
    if (p->place && p->weight) {
        return MS_OK;
    }
    free_meetings(p);
    return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu orientations", count);
}

/* Drawn one after the other, so that they do not depend on the threads. */
static ms_status choose_meetings(meetings *p, ms_contact_against against, ms_contact_where where,
                                 const ms_contact_form *form, const ms_contact_options *options, ms_error *err)
{
    const int one_each = against == MS_CONTACT_PLANE && where == MS_CONTACT_POSES;
    ms_status status = alloc_meetings(p, one_each ? form->n_poses : options->orientations, err);
    if (status != MS_OK) {
        return status;
    }
    gsl_rng *random = ms_random_new(options->seed);
    if (!random) {
        free_meetings(p);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to draw orientations");
    }
    for (size_t i = 0; i < p->count; i++) {
        p->weight[i] = one_each ? form->pose[i].share : 1;
        if (one_each) {
            memcpy(p->place[i].u, form->pose[i].direction, sizeof p->place[i].u);
        } else if (where == MS_CONTACT_RANDOM) {
            p->place[i] = ms_place_anywhere(random);
        } else {
            const ms_pose *one = ms_place_pose(form->pose, form->n_poses, random),
                          *other = ms_place_pose(form->pose, form->n_poses, random);
            p->place[i] = ms_place_faces(one->direction, other->direction, 2 * PI * gsl_rng_uniform(random));
        }
    }
    ms_random_free(random);
    return MS_OK;
}

static int compare_samples(const void *one, const void *other)
{
    const ms_contact_sample *a = one, *b = other;
    const double by[][2] = {{(double)a->touch.count, (double)b->touch.count},
                            {a->touch.stiffness, b->touch.stiffness},
                            {a->touch.damping, b->touch.damping},
                            {a->weight, b->weight}};
    for (size_t k = 0; k < sizeof by / sizeof *by; k++) {
        if (by[k][0] != by[k][1]) {
            return by[k][0] < by[k][1] ? -1 : 1;
        }
    }
    return 0;
}

/* In the order of the samples, so that the sums are the same at any number of threads. */
static void sum_up_row(ms_contact_row *row, double single)
{
    double touching = 0, below = 0;
    row->least_restitution = (double)NAN; /* which fmin passes over */
    for (size_t i = 0; i < row->samples; i++) {
        const ms_touch *t = &row->sample[i].touch;
        const double weight = row->sample[i].weight;
        row->whole += weight;
        if (t->count == 0) {
            row->missed += weight;
            continue;
        }
        const double e = ms_touch_restitution(single, ms_touch_number(t));
        touching += weight;
        row->mean += weight * (double)t->count;
        row->stiffness += weight * t->stiffness;
        row->damping += weight * t->damping;
        row->restitution += weight * e;
        row->overdamped += e > 0 ? 0 : weight;
        row->most = t->count;
        row->most_stiffness = fmax(row->most_stiffness, t->stiffness);
        row->most_damping = fmax(row->most_damping, t->damping);
        row->least_restitution = fmin(row->least_restitution, e);
    }
    row->missed /= row->whole;
    double *const mean[] = {&row->mean, &row->stiffness, &row->damping, &row->restitution, &row->overdamped};
    for (size_t k = 0; k < sizeof mean / sizeof *mean; k++) {
        *mean[k] /= touching;
    }
    for (size_t i = 0; i < row->samples; i++) {
        below += row->sample[i].touch.count ? row->sample[i].weight / touching : 0;
        if (row->median == 0 && below >= 0.5 - 1e-12) {
            row->median = row->sample[i].touch.count;
        }
    }
}

static ms_status fill_contact_row(ms_contact_row *row, const meetings *p, const ms_support *clump, double r_eq,
                                  double single, ms_error *err)
{
    const size_t threads = (size_t)omp_get_max_threads();
    ms_sphere *turned = malloc(threads * clump->count * sizeof *turned);
    row->samples = p->count;
    row->sample = malloc(p->count * sizeof *row->sample);
    if (!turned || !row->sample) {
        free(turned);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the contacts of %zu orientations", p->count);
    }
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t i = 0; i < p->count; i++) {
        ms_sphere *own = turned + (size_t)omp_get_thread_num() * clump->count;
        row->sample[i].weight = p->weight[i];
        row->sample[i].touch = row->against == MS_CONTACT_PLANE
                                   ? ms_touch_plane(clump, p->place[i].u, r_eq, row->overlap * r_eq)
                                   : ms_touch_second(NULL, 0, own, clump, &p->place[i], r_eq, row->overlap * r_eq);
    }
    free(turned);
    qsort(row->sample, row->samples, sizeof *row->sample, compare_samples);
    sum_up_row(row, single);
    return MS_OK;
}

static ms_status fill_rows(ms_contact *c, const ms_support *clump, const ms_contact_options *options, ms_error *err)
{
    ms_status status = MS_OK;
    for (int kind = 0; kind < 4 && status == MS_OK; kind++) {
        meetings p;
        const ms_contact_against against = kind / 2 ? MS_CONTACT_PARTICLE : MS_CONTACT_PLANE;
        const ms_contact_where where = kind % 2 ? MS_CONTACT_POSES : MS_CONTACT_RANDOM;
        status = choose_meetings(&p, against, where, &c->clump, options, err);
        if (status != MS_OK) {
            return status;
        }
        for (size_t o = 0; o < options->n_overlaps && status == MS_OK; o++) {
            ms_contact_row *row = &c->row[c->n_rows++];
            *row = (ms_contact_row){.against = against, .where = where, .overlap = options->overlap[o]};
            status = fill_contact_row(row, &p, clump, c->r_eq, options->restitution, err);
        }
        free_meetings(&p);
    }
    return status;
}

static ms_status fill_sleds(ms_contact *c, const ms_support *clump, const ms_contact_options *options, ms_error *err)
{
    const double friction[MS_CONTACT_N_FRICTIONS] = {0, 0.3};
    ms_status status = MS_OK;
    c->face = c->clump.pose;
    for (size_t p = 1; p < c->clump.n_poses; p++) {
        c->face = c->clump.pose[p].share > c->face->share ? &c->clump.pose[p] : c->face;
    }
    for (size_t o = 0; o < options->n_overlaps && status == MS_OK; o++) {
        ms_contact_sled *s = &c->sled[c->n_sleds++];
        s->overlap = options->overlap[o];
        status = ms_sled_drag(s->sled, friction, MS_CONTACT_N_FRICTIONS, clump, c->face->direction, c->r_eq,
                              s->overlap * c->r_eq, options->orientations, options->seed, err);
    }
    return status;
}

/* The support function of a body, and its poses. */
static ms_status fill_form(ms_contact_form *form, double *height, const ms_support *body, const ms_directions *d,
                           double r_eq, ms_error *err)
{
    ms_poses_heights(height, body, d);
    form->mean_width = ms_poses_mean_width(height, d);
    return ms_poses_find(&form->pose, &form->n_poses, body, d, height, MS_CONTACT_DEPTH * r_eq, err);
}

static ms_status fill_forms(ms_contact *c, const ms_support *clump, const ms_support *shape, ms_error *err)
{
    ms_directions d;
    ms_status status = ms_directions_make(&d, FINENESS, err);
    if (status != MS_OK) {
        return status;
    }
    double *height = malloc(2 * d.count * sizeof *height);
    if (!height) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu directions", d.count);
    }
    if (status == MS_OK) {
        status = fill_form(&c->clump, height, clump, &d, c->r_eq, err);
    }
    if (status == MS_OK && shape) {
        status = fill_form(&c->shape, height + d.count, shape, &d, c->r_eq, err);
        c->rms = ms_poses_rms(height, height + d.count, &d);
    }
    free(height);
    ms_directions_free(&d);
    return status;
}

ms_contact_options ms_contact_defaults(void)
{
    return (ms_contact_options){
        .orientations = 1000, .restitution = 0.5, .overlap = {0.0005, 0.002, 0.01}, .n_overlaps = 3, .seed = 1};
}

static ms_status check_study(const ms_contact_options *options, ms_error *err)
{
    int in_bounds = options->orientations > 0 && options->restitution > 0 && options->restitution <= 1 &&
                    options->n_overlaps > 0 && options->n_overlaps <= MS_CONTACT_MAX_OVERLAPS;
    for (size_t o = 0; in_bounds && o < options->n_overlaps; o++) {
        in_bounds = options->overlap[o] > 0 && options->overlap[o] <= MS_CONTACT_MOST_OVERLAP;
    }
    return in_bounds ? MS_OK
                     : ms_fail(err, MS_ERR_ARG,
                               "a study of contacts takes one orientation at least, a restitution above 0 and at most "
                               "1, and 1 to %d overlaps above 0 and at most %g of r_eq",
                               MS_CONTACT_MAX_OVERLAPS, MS_CONTACT_MOST_OVERLAP);
}

/* Spheres in another unit than the body, or far off, would have poses and overlaps that mean nothing. */
static ms_status check_reach(const ms_support *clump, double r_eq, ms_error *err)
{
    enum { FACTOR = 500 }; /* that of a cylinder 27000 times as long as its radius, and below the 1000 of mm for m */
    double reach = 0;
    for (int side = 0; side < 6; side++) {
        double u[3] = {0};
        u[side / 2] = side % 2 ? 1 : -1;
        reach = fmax(reach, ms_support_height(clump, u));
    }
    return reach < FACTOR * r_eq && r_eq < FACTOR * reach
               ? MS_OK
               : ms_fail(err, MS_ERR_LIMIT,
                         "the clump reaches %g from a centre of mass about which r_eq is %g; check units and frame of "
                         "the spheres",
                         reach, r_eq);
}

ms_status ms_contact_study(ms_contact *contact, const ms_clump *clump, const ms_body *body, const ms_support *shape,
                           const ms_contact_options *options, ms_error *err)
{
    ms_support spheres = {0};
    *contact = (ms_contact){.r_eq = cbrt(3 * body->volume / (4 * PI))};
    ms_status status = check_study(options, err);
    if (status == MS_OK) {
        status = ms_support_from_clump(&spheres, clump, body->centroid, err);
    }
    if (status == MS_OK) {
        status = check_reach(&spheres, contact->r_eq, err);
    }
    if (status == MS_OK) {
        status = fill_forms(contact, &spheres, shape, err);
    }
    if (status == MS_OK) {
        status = fill_rows(contact, &spheres, options, err);
    }
    if (status == MS_OK) {
        status = fill_sleds(contact, &spheres, options, err);
    }
    ms_support_free(&spheres);
    if (status != MS_OK) {
        ms_contact_free(contact);
    }
    return status;
}

const ms_pose *ms_contact_nearest(double *angle, const ms_contact_form *from, const double direction[3])
{
    const ms_pose *nearest = NULL;
    *angle = (double)INFINITY;
    for (size_t p = 0; p < from->n_poses; p++) {
        double across[3];
        ms_cross(across, from->pose[p].direction, direction);
        const double to = atan2(sqrt(ms_dot(across, across)), ms_dot(from->pose[p].direction, direction));
        if (to < *angle) {
            *angle = to;
            nearest = &from->pose[p];
        }
    }
    return nearest;
}

void ms_contact_free(ms_contact *contact)
{
    if (contact) {
        for (size_t r = 0; r < contact->n_rows; r++) {
            free(contact->row[r].sample);
        }
        free(contact->clump.pose);
        free(contact->shape.pose);
        *contact = (ms_contact){0};
    }
}
