/** What others feel of a body's size: the region that no ball of a given radius, kept outside the body, can enter. */
#ifndef MS_ENVELOPE_H
#define MS_ENVELOPE_H

#include "clump/ms_clump.h"
#include "mesh/ms_mesh.h"

MS_C_BEGIN

/** A body by its distance function. */
typedef struct ms_envelope_body {
    const void *body;    /* borrowed */
    double lo[3], hi[3]; /* box that holds it */
    double volume;
    /** Distance from a place to the surface, negative inside. @param[out] nearest place of the surface */
    double (*distance)(double nearest[3], const void *body, const double place[3]);
} ms_envelope_body;

typedef struct ms_envelope {
    double volume;
    double error; /* of it: twice what twice as many cells along each side changed */
} ms_envelope;

/**
 * The closing of a body by a ball: what is left when all open balls of that radius which do not meet the body are taken
 * away. A ball and any other convex body is its own; a groove is filled as far as the ball leaves it; a cavity
 * that holds the ball stays. It lies between the body and its convex hull, so that its mean width is the body's.
 *
 * Where such a ball's centre may be is known by the distance to the body alone: where that is the radius or more. A
 * place belongs to the envelope if none of these centres is nearer to it than the radius. The nearest is sought from
 * the places of a lattice: by pushing each away from the nearest point of the body, again and again until it is as far
 * as the radius, which ends where the ball lies on two or three points at once; by trying those found for neighbours;
 * and by moving the best along the border of where centres may be. The body's own volume is given, so that only
 * what is between body and envelope is summed, over cells cut by both surfaces.
 *
 * @param radius of the ball, above 0
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: closing, Serra, Image Analysis and Mathematical Morphology (1982); of a molecule's atoms it is the
 * solvent-excluded volume (Connolly, J. Appl. Cryst. 16 (1983) 548). Cost: some 10^6 distances; all cores, the same
 * bits at any number of threads.
 */
MS_API ms_status ms_envelope_compute(ms_envelope *out, const ms_envelope_body *body, double radius, ms_error *err);

/**
 * The same of the union of the spheres of a clump, by several balls; not of its carriers, which touch nothing.
 *
 * @param[out] out    count values, of the balls of these radii
 * @param[out] volume of the union
 * @param      clump  with spheres
 * @return MS_OK; MS_ERR_ARG for an empty clump; MS_ERR_NOMEM
 */
MS_API ms_status ms_envelope_clump(ms_envelope *out, double *volume, const ms_clump *clump, const double *radius,
                                   size_t count, ms_error *err);

/**
 * The same of a closed mesh.
 *
 * @param[out] out    count values, of the balls of these radii
 * @param      volume of the mesh
 * @return MS_OK; MS_ERR_ARG for a mesh without triangles; MS_ERR_NOMEM
 */
MS_API ms_status ms_envelope_mesh(ms_envelope *out, const ms_mesh *mesh, double volume, const double *radius,
                                  size_t count, ms_error *err);

MS_C_END

#endif
