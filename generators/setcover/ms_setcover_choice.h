/** Which spheres setcover takes, from coarse to fine. Private to setcover. */
#ifndef MS_SETCOVER_CHOICE_H
#define MS_SETCOVER_CHOICE_H

#include <stddef.h>

#include "ms_setcover_candidates.h"
#include "shared/ms_cover.h"

/** A choice under way. */
typedef struct ms_setcover_choice {
    const ms_setcover_pool *pool; /* with starts */
    ms_cover *cover;              /* of the pool's balls, by the rule MS_COVER_ADMITTED */
    double scale;                 /* those that stand for cells of this side, or larger, are fitted */
    double next;                  /* the largest side of the others; 0: all are fitted */
    double finest;                /* the smallest side, whose candidates are left until nothing else adds any voxel */
    double least;                 /* radius, in voxels */
    int dropped;                  /* nonzero: some were smaller */
} ms_setcover_choice;

/** Starts with none fitted; the pool and the cover are borrowed. Spheres below the least radius are not taken. */
ms_setcover_choice ms_setcover_choice_start(const ms_setcover_pool *pool, ms_cover *cover, double least);

/**
 * Takes the sphere that covers the most voxels not yet covered, nearly.
 *
 * How far apart candidates have to lie goes with what they add: where spheres lie s apart on a medial surface, what
 * is left between them is of the order of s^3. So those that stand for large cells are fitted and looked at first,
 * the others once the best gain has fallen far enough. The best of them is then moved along the medial surface as
 * long as it covers more (pattern search: Hooke & Jeeves 1961), since the better places lie between the candidates.
 *
 * @return how many voxels it covers that were not covered; 0: none does, and nothing was taken
 * Cost: a search among the faces for each candidate, and some ten for each of the first spheres; all cores, the same
 * bits at any number of them.
 */
size_t ms_setcover_choose(ms_ball *ball, ms_setcover_choice *choice);

#endif
