/** A particle in JSON: what its mass is, and the frame of its templates. Private to readers and writers of clumps. */
#ifndef MS_PARTICLE_JSON_H
#define MS_PARTICLE_JSON_H

#include <jansson.h>

#include "clump/ms_particle.h"

/** The caller owns it; NULL without memory or for numbers that are not finite. */
json_t *ms_particle_json_write(const ms_particle *particle);

/** @param[out] particle zeros on failure. @return MS_OK; MS_ERR_FORMAT with the name of the file and what is missing */
ms_status ms_particle_json_read(ms_particle *particle, const json_t *json, const char *name, ms_error *err);

#endif
