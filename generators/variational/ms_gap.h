/** How far the surface of the shape is from the spheres. Private to variational. */
#ifndef MS_GAP_H
#define MS_GAP_H

#include <stdint.h>

#include "ms_mirror.h"
#include "voxel/ms_target.h"

/** What a voxel^3 of excess costs in voxels of mismatch: so much that none is left where it can be avoided. */
enum { MS_GAP_PRICE = 100 };

/** Places spread evenly over the surface, and which spheres are to come nearer to them. Lengths in voxels. */
typedef struct ms_gap {
    double bound; /* no part of the surface is to be farther from the spheres */
    double aim;   /* what the fits keep to: the bound, or less */
    size_t count, room;
    double (*place)[3]; /* above all planes of symmetry: there a sphere is nearer than its images */
    double area;        /* that a place stands for, voxel^2 */
    /* As of the last ms_gap_find: */
    double *away;      /* from the nearest sphere; negative within it */
    double *known;     /* what spheres have to travel before the place may come to be too far */
    uint32_t *nearest; /* that sphere */
    double travelled;
    uint32_t *far; /* places that are too far, sphere by sphere; */
    size_t *first; /* those of sphere s are far[first[s]] to far[first[s + 1] - 1] */
} ms_gap;

/**
 * Spreads places over the faces of the mesh, or over the voxels at the border of a volume.
 *
 * @param[out] gap  the caller frees it; empty on failure
 * @param      most spheres
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_gap_open(ms_gap *gap, const ms_target *target, const ms_mirror *mirror, double bound, size_t most,
                      ms_error *err);

/** Adds a place. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_gap_add(ms_gap *gap, const double place[3], const ms_mirror *mirror, ms_error *err);

/**
 * Lists the places that are farther from all spheres than `aim`, by the nearest sphere.
 *
 * @param ball   `count` spheres without mirror images
 * @param travel no sphere's surface has moved farther since the last call; HUGE_VAL: nothing is known
 *
 * Cost: for each place that may have come to be too far, all spheres; all cores, the same bits at any number of
 * threads.
 */
void ms_gap_find(ms_gap *gap, const ms_ball *ball, size_t count, double travel);

/** The sum over the places of area times what they are too far by, voxel^3. Cost: as ms_gap_find. */
double ms_gap_excess(ms_gap *gap, const ms_ball *ball, size_t count);

/** By how much the excess grows without each sphere. @param[out] loss `count` values. Cost: places x spheres. */
void ms_gap_losses(double *loss, ms_gap *gap, const ms_ball *ball, size_t count);

/** Of a volume: does the voxel belong to the surface: inside, with one of its six neighbours outside? */
int ms_gap_is_border(const ms_grid *grid, size_t voxel);

void ms_gap_close(ms_gap *gap);

/** A place that is too far, and from the nearest sphere how far. */
typedef struct ms_gap_far {
    double place[3], away;
} ms_gap_far;

/**
 * The largest distance of the surface from the spheres, sought everywhere: a part of a triangle that one sphere made
 * larger by the bound holds with its corners it holds as a whole, as balls are convex; else the part is cut in four.
 *
 * @param[out] largest within a hundredth of a voxel; the bound, if no part is farther
 * @param[out] far   of each sphere the place of the surface that is the farthest from it of those that it is the
 *                   nearest sphere of and that are farther than the bound; away is 0 where there is none. May be NULL
 * @param      all   `count` spheres, mirror images among them
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: triangles x spheres; all cores, the same bits at any number of threads.
 */
ms_status ms_gap_largest(double *largest, ms_gap_far *far, const ms_target *target, const ms_ball *all, size_t count,
                         double bound, ms_error *err);

#endif
