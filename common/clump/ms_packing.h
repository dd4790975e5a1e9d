/** Clumps in their places, as a scan has them: where they overlap, and how far they have to shrink until they do not.
 * A mixture is the same without places: kinds of particles, each with a share; in a scene each has a count, and all are
 * in one vessel. Private. */
#ifndef MS_PACKING_H
#define MS_PACKING_H

#include "ms_particle.h"

/** A clump in its place. */
typedef struct ms_placed {
    size_t number;        /* what messages call it */
    char *name;           /* of its template, without ending, from the folder of the packing; fits scripts; owned */
    ms_clump clump;       /* in the frame of the template, metres; owned */
    ms_particle particle; /* of the template: mass and a diagonal inertia; zeros where masses are not known */
    double centre[3];     /* of mass, metres */
    double turn[4];       /* w, x, y, z: from the frame of the template into that of the packing */
    double size;          /* radius of the ball of equal volume, metres */
    double scale;         /* of its spheres and their distances from the centre; mass and inertia are as they were */
    double share;         /* in a mixture: of all particles, by number */
    size_t count;         /* in a scene: particles of this kind */
} ms_placed;

/** A zeroed struct is empty. */
typedef struct ms_packing {
    ms_placed *placed;
    size_t count;
    double width[2]; /* of a scene's vessel: a box along x and y, or a cylinder's diameter twice; metres; 0: any box */
    int is_round;    /* it is a cylinder */
} ms_packing;

/** Two clumps that are in or near each other. */
typedef struct ms_overlap {
    size_t first, second; /* indices, first < second */
    double depth;         /* largest of r + r' - distance over a sphere of each; below 0 it is a gap */
    double relative;      /* depth / the smaller size */
    size_t contacts;      /* pairs of spheres that overlap */
} ms_overlap;

typedef struct ms_overlaps {
    ms_overlap *pair; /* by first, then second */
    size_t count, capacity;
} ms_overlaps;

/** A sphere of a clump in its place. */
ms_sphere ms_packing_sphere(const ms_placed *placed, size_t sphere);

/** Box around all spheres; there is one. */
void ms_packing_box(double lo[3], double hi[3], const ms_packing *packing);

/**
 * All pairs of clumps whose relative depth is above -near.
 *
 * @param[out] overlaps freed by ms_packing_overlaps_free; empty on failure
 * @param      near     0: those that overlap
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: O(n log n) of clumps, by cells of the mean of their lengths, and the spheres of each pair that reach into the
 * other's box.
 */
ms_status ms_packing_overlaps(ms_overlaps *overlaps, const ms_packing *packing, double near, ms_error *err);
void ms_packing_overlaps_free(ms_overlaps *overlaps);

/**
 * Shrinks clumps, each about its own centre, until no relative depth is above `most`: in rounds, by 1/100 each clump
 * that is deeper in another one. Masses, inertia and places stay; the volume of a clump's spheres goes with scale^3.
 *
 * @return MS_OK; MS_ERR_LIMIT where a clump would lose nine tenths of its size, as one that is there twice;
 *         MS_ERR_NOMEM
 */
ms_status ms_packing_shrink(ms_packing *packing, double most, ms_error *err);

void ms_packing_free(ms_packing *packing);

#endif
