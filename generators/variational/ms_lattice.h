/** Directions spread evenly over a sphere, turned at random. Private to variational. */
#ifndef MS_LATTICE_H
#define MS_LATTICE_H

#include <gsl/gsl_rng.h>

#include "base/ms_error.h"

/** A Fibonacci lattice: points of equal areas along a spiral. */
typedef struct ms_lattice {
    int points;
    double (*direction)[3];
    double (*turned)[3];
    float (*normal)[3]; /* the turned ones again */
    gsl_rng *rng;
} ms_lattice;

/** @param[out] lattice the caller frees it; empty on failure. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_lattice_alloc(ms_lattice *lattice, int points, ms_error *err);

/** Turns it by a random quaternion, uniform among rotations: the same for the same seed. */
void ms_lattice_turn(ms_lattice *lattice, unsigned long seed);

void ms_lattice_free(ms_lattice *lattice);

#endif
