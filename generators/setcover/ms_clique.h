/**
 * What may be removed from a set of voxels without a change of its topology: simple voxels
 * and cliques, judged on a neighbourhood of 3x3x3. The object is 26-connected (through
 * corners), the background 6-connected (through faces).
 *
 * A neighbourhood is a word of 27 bits: voxel (x, y, z), each coordinate -1, 0 or 1 from the
 * centre, is bit (x+1) + 3 (y+1) + 9 (z+1). So the bits have the order of the indices of a
 * grid with x fastest.
 *
 * Source: G. Bertrand, M. Couprie, Powerful parallel and symmetric 3D thinning schemes based
 * on critical kernels, J. Math. Imaging Vis. 48 (2014) 134; Yuan 2019, 2.1 to 2.3.
 */
#ifndef MS_CLIQUE_H
#define MS_CLIQUE_H

#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/* The bit of the voxel in the middle. */
enum { MS_CLIQUE_CENTRE = 13 };

/**
 * Is the centre simple (Yuan, theorem 1)? So it is if its 26 neighbours in the object are one
 * piece, and the background among its 18 nearest neighbours is one piece where it touches
 * the centre's faces; neither may be missing.
 *
 * @param object which of the 27 voxels are of the object; the centre's own bit does not matter
 * Cost: about 20 ns, by bit-parallel flooding; no table.
 */
int ms_clique_is_simple(uint32_t object);

/**
 * Is the centre the voxel to keep of a critical clique of that rank (2, 1 or 0), the one of
 * lowest index?
 *
 * A clique of rank r is the set of all voxels of the object around a face of dimension r
 * (square, edge, corner), if no face of higher dimension is common to them all. It is
 * critical if the voxels next to all of its voxels cannot be reduced to one voxel by removing
 * simple voxels: one of them has to stay.
 *
 * @param object which of the 27 voxels are of the object; the centre is
 * @param free   which of them are to be removed, a subset of object; only cliques of these count
 */
int ms_clique_keeps(uint32_t object, uint32_t free, int rank);

MS_C_END

#endif
