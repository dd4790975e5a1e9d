/** Spheres fitted under the constraint that their union has the volume of the shape. Private to variational. */
#ifndef MS_VOLUME_HOLD_H
#define MS_VOLUME_HOLD_H

#include "ms_generator.h"
#include "ms_surface_fit.h"

/**
 * Fits spheres for the least |S xor U| among those with |U| = |S|. By Lagrange there is a price of volume at which
 * |S xor U| - price |U| is least there. It is sought while the fit goes on: raised where volume is lacking, lowered
 * where there is too much.
 *
 * What is left of the difference, 1e-3 and less as a rule, is the caller's to scale away.
 *
 * @param[in,out] ball `count` spheres of the least |S xor U| or D, in voxels; nothing but a least radius, equal radii
 *                     or symmetry may bind them
 * @param         run   is told of each fit
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_INTERRUPTED
 *
 * Source: dual ascent, Boyd et al., Found. Trends Mach. Learn. 3 (2011) 1, section 2.1, with steps that shorten where
 * the sign changes (Kesten, Ann. Math. Stat. 29 (1958) 41). Cost: 48 to 176 steps of the fit, and
 * one of ms_bulk_dice for each eight of them.
 */
ms_status ms_volume_hold(ms_ball *ball, size_t count, ms_surface_fit *fit, const ms_run *run, ms_error *err);

#endif
