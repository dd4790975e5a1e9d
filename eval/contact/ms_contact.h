/** How a clump touches a plane and its like: over orientations and overlaps; and how it lies, beside its shape. */
#ifndef MS_CONTACT_H
#define MS_CONTACT_H

#include "ms_poses.h"
#include "ms_sled.h"
#include "ms_touch.h"

enum { MS_CONTACT_MAX_OVERLAPS = 16 };

/** Minima of h less deep than this part of r_eq are no poses. */
#define MS_CONTACT_DEPTH 0.01

typedef struct ms_contact_options {
    size_t orientations;                     /* that are drawn, 1 at least */
    double restitution;                      /* of one contact */
    double overlap[MS_CONTACT_MAX_OVERLAPS]; /* parts of r_eq */
    size_t n_overlaps;
    unsigned long seed;
} ms_contact_options;

typedef enum ms_contact_against { MS_CONTACT_PLANE, MS_CONTACT_PARTICLE } ms_contact_against;
typedef enum ms_contact_where { MS_CONTACT_RANDOM, MS_CONTACT_POSES } ms_contact_where;

/** One orientation. */
typedef struct ms_contact_sample {
    ms_touch touch;
    double weight; /* part of ms_contact_row.whole */
} ms_contact_sample;

/** The contacts against one thing at one overlap. Means are over those that touch, NAN where none does. */
typedef struct ms_contact_row {
    ms_contact_against against;
    ms_contact_where where;
    double overlap; /* part of r_eq */
    size_t samples;
    ms_contact_sample *sample; /* fewest contacts first */
    double whole;              /* sum of their weights, in this order, so that parts of it are 1 at most */
    double missed;             /* part that passed without touching */
    double mean;               /* number of contacts */
    size_t median, most;
    double stiffness, most_stiffness, damping, most_damping; /* of ms_touch */
    double restitution, least_restitution;
    double overdamped; /* part of which nothing rebounds */
} ms_contact_row;

/* Frictions of the sled: none, and 0.3. */
enum { MS_CONTACT_N_FRICTIONS = 2 };

/** The clump dragged over its like, both on the face that most directions roll to. */
typedef struct ms_contact_sled {
    double overlap; /* part of r_eq */
    ms_sled sled[MS_CONTACT_N_FRICTIONS];
} ms_contact_sled;

/** What the support function says of a body. */
typedef struct ms_contact_form {
    double mean_width;
    ms_pose *pose; /* lowest first; NULL for no body */
    size_t n_poses;
} ms_contact_form;

typedef struct ms_contact {
    double r_eq;
    ms_contact_form clump, shape; /* `shape` is empty without one */
    double rms;                   /* of the difference of the two support functions */
    size_t n_rows;
    ms_contact_row row[4 * MS_CONTACT_MAX_OVERLAPS];
    const ms_pose *face; /* of the sled: one of the clump's */
    size_t n_sleds;
    ms_contact_sled sled[MS_CONTACT_MAX_OVERLAPS];
} ms_contact;

/**
 * @param[out] contact ms_contact_free frees it; empty on failure
 * @param      clump   about the centre of mass
 * @param      shape   about the same; NULL without
 * @param      r_eq    radius of the ball of the particle's volume
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: O(orientations overlaps n^2); the same bits at any number of threads.
 */
ms_status ms_contact_study(ms_contact *contact, const ms_support *clump, const ms_support *shape, double r_eq,
                           const ms_contact_options *options, ms_error *err);

/** The pose of `from` that lies nearest to a direction. @param[out] angle to it, radians */
const ms_pose *ms_contact_nearest(double *angle, const ms_contact_form *from, const double direction[3]);

void ms_contact_free(ms_contact *contact);

#endif
