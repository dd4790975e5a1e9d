/** Which of the maxima of E* become spheres in a step of MSS. Private to ms_mss. */
#ifndef MS_MSS_SELECT_H
#define MS_MSS_SELECT_H

#include "voxel/ms_raster.h"

/** A maximum of E* where a sphere may be placed; in voxels. */
typedef struct ms_mss_candidate {
    ms_ball ball;
    double rank;  /* the larger, the earlier */
    size_t voxel; /* the maximum at voxel resolution */
    double apart; /* squared distance to the nearest sphere so far; HUGE_VAL if there is none */
    double now;   /* work space: the same, within a step */
    double e;     /* E there, in voxels */
    int counted;  /* the rank is what the sphere gains now; else no less */
} ms_mss_candidate;

/** Is it as far from all spheres as delta_min demands? */
int ms_mss_select_is_apart(const ms_mss_candidate *candidate, double spacing);

/** What is demanded of the spheres of a step. */
typedef struct ms_mss_select_rule {
    double spacing;      /* delta_min, in voxels */
    double least_radius; /* smaller ones wait for a later step; in voxels */
    double least_rank;   /* those below wait too */
    int disjoint;        /* a set that overlaps one placed before in the step waits */
    double centroid[3];  /* of the target, in voxels */
    int one_set;         /* only the first set of equals (mirror images of one another) */
    int may_wait;        /* delta_min will shrink: a set that cannot be placed whole waits for that */
    /**
     * Sets the radius of the mean of a cluster, no larger than it has; 0 if there is no room for
     * a sphere.
     */
    int (*fit)(ms_ball *ball, void *context);
    void (*report)(size_t chosen, void *context); /* how many spheres the step has so far */
    void *context;
} ms_mss_select_rule;

/** Takes note of a new sphere in the distances `apart`. */
void ms_mss_select_keep_apart(ms_mss_candidate *candidates, size_t count, const ms_ball *sphere);

/**
 * Chooses spheres in descending rank, none closer than the spacing to another.
 *
 * Candidates of equal rank (mirror images; plateaus) are taken farthest from the spheres so
 * far first; the first sphere of all nearest to the target's centroid. Of those that are
 * equally far, those closer than the spacing to one another are replaced by their mean, so that
 * a pair across a plane of symmetry becomes one sphere on it; where the mean has no room (it
 * may lie in a gap) they wait, or the lowest voxel index wins. A symmetric target thus gives
 * symmetric spheres, unless the limit falls among equals: then the lower voxel index wins.
 *
 * @param[out]    chosen     room for `limit` balls
 * @param[in,out] candidates reordered
 * @param         spheres    those placed before
 * @return how many were chosen
 */
size_t ms_mss_select(ms_ball *chosen, size_t limit, ms_mss_candidate *candidates, size_t count, const ms_ball *spheres,
                     size_t n_spheres, const ms_mss_select_rule *rule);

#endif
