/** A particle as DEM engines take it: in metres, origin at the centre of mass, axes along the principal ones. */
#ifndef MS_TEMPLATE_H
#define MS_TEMPLATE_H

#include "ms_particle.h"

MS_C_BEGIN

typedef struct ms_template {
    ms_clump clump;       /* with masses and carriers if the source has them */
    ms_particle particle; /* scale 1, centre 0, a diagonal inertia whose moments ascend */
    double axis[3][3];    /* rows: the principal axes in the frame of the source (ms_inertia_principal) */
    double centre[3];     /* of mass, in the unit and frame of the source */
    double scale;         /* metres in the source's unit: template = scale * axis * (source - centre) */
} ms_template;

/**
 * Carries a clump into the frame of its particle.
 *
 * @param[out] made     the caller frees it; empty on failure
 * @param      particle what the clump stands for
 * @return MS_OK; MS_ERR_NOMEM; as ms_inertia_principal
 */
MS_API ms_status ms_template_make(ms_template *made, const ms_clump *clump, const ms_particle *particle, ms_error *err);

/**
 * Carries spheres and carriers in the frame of a template back into that of the source, in place.
 *
 * @param particle of the source, as ms_template_make had it
 * @return MS_OK; as ms_inertia_principal, and the clump is as it was
 */
MS_API ms_status ms_template_undo(ms_clump *clump, const ms_particle *particle, ms_error *err);

/** Distance from the origin to the farthest point of a sphere. */
MS_API double ms_template_reach(const ms_clump *clump);

MS_API void ms_template_free(ms_template *made);

MS_C_END

#endif
