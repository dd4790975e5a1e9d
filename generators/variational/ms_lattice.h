/** Directions spread evenly over a sphere, turned at random. Private to variational. */
#ifndef MS_LATTICE_H
#define MS_LATTICE_H

#include <gsl/gsl_rng.h>

#include "base/ms_error.h"

/** Directions near one another: they are covered together, or looked at one by one. */
typedef struct ms_lattice_group {
    float centre[3];
    float cosine, sine; /* of the angle from the centre to the farthest */
    int first, count;   /* of the finer groups, or of the directions */
} ms_lattice_group;

/** A Fibonacci lattice: points of equal areas along a spiral, in the order of their groups. */
typedef struct ms_lattice_level {
    int points, fines, coarses;
    float (*direction)[3];
    ms_lattice_group *fine, *coarse; /* groups of directions, and groups of those */
} ms_lattice_level;

/** Each level has twice the points of the one before. */
enum { MS_LATTICE_LEVELS = 6 };

typedef struct ms_lattice {
    ms_lattice_level level[MS_LATTICE_LEVELS];
    double turn[3][3]; /* from the lattice's frame to the spheres' */
    gsl_rng *rng;
} ms_lattice;

/**
 * @param[out] lattice the caller frees it; empty on failure; not turned
 * @param      points  of the first level
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_lattice_alloc(ms_lattice *lattice, int points, ms_error *err);

/** Turns it by a random quaternion, uniform among rotations: the same for the same seed. */
void ms_lattice_turn(ms_lattice *lattice, unsigned long seed);

/** One of its directions in the spheres' frame. */
void ms_lattice_normal(double normal[3], const ms_lattice *lattice, const float direction[3]);

void ms_lattice_free(ms_lattice *lattice);

#endif
