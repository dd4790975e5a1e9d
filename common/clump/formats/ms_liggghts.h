/** What the scripts of LIGGGHTS share. Private to the writers of formats. */
#ifndef MS_LIGGGHTS_H
#define MS_LIGGGHTS_H

#include <stdio.h>

#include "clump/ms_packing.h"

/** What a script begins with: style of atoms, units, boundaries. */
extern const char ms_liggghts_style[];

/** How many spheres the file of a template has. LIGGGHTS takes no multisphere of one sphere: a second one stands in it,
 * of half its radius, where nothing touches it. Mass and inertia are given and do not change by it. */
size_t ms_liggghts_spheres(const ms_clump *clump);

/** Sum of the cubes of their radii. */
double ms_liggghts_cubes(const ms_clump *clump);

/** The line of a template, tK of multisphere type k, in the file NAME.liggghts. Mass and inertia that are given do not
 * go with its scale: they are those of the scaled particle. @param seed a prime above 10000 */
void ms_liggghts_template(FILE *stream, const ms_placed *placed, size_t k, unsigned seed);

/** The next prime: seeds must be primes above 10000, each another. */
unsigned ms_liggghts_seed(unsigned after);

#endif
