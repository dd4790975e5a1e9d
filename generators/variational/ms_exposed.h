/** The places of a sphere's surface that no other sphere covers. Private to variational. */
#ifndef MS_EXPOSED_H
#define MS_EXPOSED_H

#include "ms_caps.h"
#include "ms_lattice.h"

/** One sphere at a time; each thread has its own. */
typedef struct ms_exposed {
    ms_caps_list caps;      /* what others cover of it */
    ms_caps *coarse, *fine; /* those that reach to a group */
    double (*normal)[3];    /* at the places, in the spheres' frame */
    int count;
    int points; /* each place stands for 1 / points of the sphere */
} ms_exposed;

/**
 * @param[out] out   the caller frees it; empty on failure
 * @param      count spheres, images among them
 * @return nonzero; 0 without memory
 */
int ms_exposed_alloc(ms_exposed *out, const ms_lattice *lattice, size_t count);

/**
 * Lists the places of one sphere that no other covers, on the first level of the lattice from `level` up that has at
 * least `enough` of them, or the last.
 *
 * @param s sorted
 * @return the level
 *
 * Cost: points of the level's groups that are not covered as a whole x neighbours.
 */
int ms_exposed_find(ms_exposed *out, const ms_lattice *lattice, const ms_caps_window *s, uint32_t self, int level,
                    int enough);

/** How far below the surface at a normal the other spheres begin, in radii: 1 where there is none before the centre. */
double ms_exposed_depth(const ms_exposed *e, const double normal[3]);

void ms_exposed_free(ms_exposed *e);

#endif
