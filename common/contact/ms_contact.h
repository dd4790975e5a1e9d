/** How a clump touches a plane and its like: over orientations and overlaps; and how it lies, beside its shape. */
#ifndef MS_CONTACT_H
#define MS_CONTACT_H

#include "mesh/ms_inertia.h"
#include "ms_support.h"

MS_C_BEGIN

enum { MS_CONTACT_MAX_OVERLAPS = 16 };

/** Minima of h less deep than this part of r_eq are no poses. */
#define MS_CONTACT_DEPTH 0.01

/** What is studied. */
typedef struct ms_contact_options {
    size_t orientations;                     /* that are drawn, 1 at least */
    double restitution;                      /* of one contact, above 0 and at most 1 */
    double overlap[MS_CONTACT_MAX_OVERLAPS]; /* parts of r_eq, above 0 and at most MS_CONTACT_MOST_OVERLAP */
    size_t n_overlaps;                       /* 1 at least */
    unsigned long seed;
} ms_contact_options;

/** The largest overlap / r_eq: what is pressed deeper is no contact of spheres. */
#define MS_CONTACT_MOST_OVERLAP 0.1

/** A contact of two bodies, or of one with a plane, against a single one: of spheres of r_eq that have the body's mass,
 * by Hertz, at the same overlap. Both ratios are those of a small change of the overlap. */
typedef struct ms_touch {
    size_t count;     /* of pairs that touch; 0 where the bodies pass each other */
    double stiffness; /* sum of root(R_i d_i / (R d)), N for N equal spheres; R: of curvature, d: overlap */
    double damping;   /* sum of (R_i d_i / (R d))^(1/4): an engine damps each contact by root(stiffness mass) */
} ms_touch;

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

/** A particle dragged over another, face on face: friction against normal force, over yaws and offsets. */
typedef struct ms_sled {
    double friction; /* mu of the spheres */
    double mean, largest;
    double slope_mean, slope_largest; /* (mu + tan t) / (1 - mu tan t); t: how steeply the upper one rises there */
    double jammed;                    /* part that no force moves, which the rest leaves out */
    double missed;                    /* part that passes without touching, likewise */
} ms_sled;

/** The clump dragged over its like, both on the face that most directions roll to. */
typedef struct ms_contact_sled {
    double overlap; /* part of r_eq */
    ms_sled sled[MS_CONTACT_N_FRICTIONS];
} ms_contact_sled;

/** A pose of rest: a minimum of the support function, where the centre of mass lies lowest over a plane. */
typedef struct ms_pose {
    double direction[3]; /* what points down, in the body's frame, of length 1 */
    double height;       /* of the centre of mass over the plane */
    double barrier;      /* how much higher the lowest way into another pose leads; INFINITY where there is no other */
    double share;        /* of all directions: those that roll into this one */
} ms_pose;

/** What the support function says of a body. */
typedef struct ms_contact_form {
    double mean_width;
    ms_pose *pose; /* lowest first; NULL for no body */
    size_t n_poses;
} ms_contact_form;

typedef struct ms_contact {
    double r_eq;                  /* radius of the ball of the particle's volume */
    ms_contact_form clump, shape; /* `shape` is empty without one */
    double rms;                   /* of the difference of the two support functions */
    size_t n_rows;
    ms_contact_row row[4 * MS_CONTACT_MAX_OVERLAPS];
    const ms_pose *face; /* of the sled: one of the clump's */
    size_t n_sleds;
    ms_contact_sled sled[MS_CONTACT_MAX_OVERLAPS];
} ms_contact;

/** What `mskit contact` studies where nothing else is asked for. */
MS_API ms_contact_options ms_contact_defaults(void);

/**
 * @param[out] contact ms_contact_free frees it; empty on failure
 * @param      clump   its carriers touch nothing
 * @param      body    what it stands for, in its unit and frame: volume and centre of mass count
 * @param      shape   about that centre; NULL without
 * @return MS_OK; MS_ERR_ARG for an option out of its bounds or an empty clump; MS_ERR_LIMIT where the clump reaches 500
 *         times as far as r_eq, or r_eq as far as that, so that units or frames are not the same; MS_ERR_NOMEM
 *
 * Cost: O(orientations overlaps n^2); the same bits at any number of threads.
 */
MS_API ms_status ms_contact_study(ms_contact *contact, const ms_clump *clump, const ms_body *body,
                                  const ms_support *shape, const ms_contact_options *options, ms_error *err);

/** The pose of `from` that lies nearest to a direction. @param[out] angle to it, radians */
MS_API const ms_pose *ms_contact_nearest(double *angle, const ms_contact_form *from, const double direction[3]);

MS_API void ms_contact_free(ms_contact *contact);

MS_C_END

#endif
