/** Volume and surface of a union of spheres, without a grid. */
#ifndef MS_UNION_H
#define MS_UNION_H

#include "ms_clump.h"

MS_C_BEGIN

/**
 * Volume and surface area of the union of the spheres, exact but for rounding. The area has what faces the outside and
 * what faces a cavity that the spheres enclose; the volume is without such cavities.
 *
 * @param[out] volume, area  in the clump's unit, cubed and squared; 0 for an empty clump and on failure
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: the exposed part of each sphere is bounded by arcs (Connolly, J. Appl. Cryst. 16 (1983) 548); both integrals
 * go over these arcs by Stokes' theorem, the volume by the divergence theorem before. Where arcs meet in one point a
 * wrong order of them costs rounding only, not a whole sphere as with the theorem of Gauss and Bonnet.
 * Cost: O(n k^2 log k) for k spheres that touch one; all cores, the same bits at any number of threads.
 */
MS_API ms_status ms_union_measure(double *volume, double *area, const ms_clump *clump, ms_error *err);

MS_C_END

#endif
