/** Makes spheres one piece that keeps to its bounds. Private to variational. */
#ifndef MS_CONNECT_HOLD_H
#define MS_CONNECT_HOLD_H

#include "ms_surface_fit.h"

/** Fits spheres until they are one piece, or as near to that as they come. @return MS_OK; MS_ERR_NOMEM. Cost: up to 100
 * steps of the fit */
ms_status ms_connect_fit(ms_ball *ball, size_t count, ms_surface_fit *fit, ms_error *err);

/**
 * Grows the spheres at the ends of what is still apart by what is lacking, as far as the bounds let them; what cannot
 * be joined so is dropped, so that the largest piece is left.
 *
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_connect_hold(ms_ball *ball, size_t *count, ms_surface_fit *fit, ms_error *err);

#endif
