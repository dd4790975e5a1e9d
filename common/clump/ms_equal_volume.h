/** A clump scaled so that its union has the particle's volume. */
#ifndef MS_EQUAL_VOLUME_H
#define MS_EQUAL_VOLUME_H

#include "mesh/ms_inertia.h"
#include "ms_clump.h"

MS_C_BEGIN

/** What was done. */
typedef struct ms_equal_volume {
    double scale;      /* of radii, and of distances from the centroid of the particle */
    double volume;     /* of the union afterwards, measured anew, in the clump's unit */
    double error;      /* of it / that of the particle - 1 */
    double mean_width; /* of the clump afterwards: mean over directions of the distance of two planes that hold it */
} ms_equal_volume;

/**
 * Scales a clump about the centroid of the body it stands for, radii and distances alike. Its masses and carriers are
 * dropped.
 *
 * @param[out] done zeros on failure
 * @param      body its volume and centroid are taken
 * @return MS_OK; MS_ERR_ARG for an empty clump or a body without volume; MS_ERR_NOMEM
 *
 * Source: Yuan 2019, section 5.3 (scales clumps to equal volume before each run); the mean width from the support
 * function max(c.u + r), which is exact for a union of balls. Cost: ms_union_measure, twice.
 */
MS_API ms_status ms_equal_volume_scale(ms_clump *clump, ms_equal_volume *done, const ms_body *body, ms_error *err);

/**
 * What is to be said of a clump that was scaled by more than a tenth: its spheres lie off the shape then.
 *
 * @param[in,out] remarks a sentence is added, with "; " behind what stands there (ms_error_add); left as it is of less
 * @param         done    of ms_equal_volume_scale
 */
MS_API void ms_equal_volume_remark(ms_error *remarks, const ms_equal_volume *done);

/** Mean over 2048 directions of the width of a clump that is not empty; good to 1e-3. */
MS_API double ms_equal_volume_width(const ms_clump *clump);

MS_C_END

#endif
