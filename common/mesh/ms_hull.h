/** The convex hull of points. */
#ifndef MS_HULL_H
#define MS_HULL_H

#include "ms_mesh.h"

MS_C_BEGIN

/** Nonzero if this build can make hulls: it takes qhull (Meson's feature qhull). */
int ms_hull_is_built(void);

/**
 * @param[out] hull  closed, wound outward, without vertices that no triangle uses; ms_mesh_free frees it; empty on
 *                   failure
 * @param      point `count` points, in any unit
 * @return MS_OK; MS_ERR_SHAPE if the points span no volume, or are not finite; MS_ERR_LIMIT for more than 2^31 - 1;
 *         MS_ERR_NOMEM; MS_ERR_ARG if this build cannot make hulls
 *
 * Source: Barber, Dobkin & Huhdanpaa, ACM Trans. Math. Softw. 22 (1996) 469, by libqhull_r. Cost: O(count log count).
 */
ms_status ms_hull_build(ms_mesh *hull, const double (*point)[3], size_t count, ms_error *err);

MS_C_END

#endif
