/** A particle in JSON: what its mass is, and the frame of its templates. Private to formats and the program. */
#ifndef MS_JSON_H
#define MS_JSON_H

#include <jansson.h>

#include "base/ms_file.h"
#include "clump/ms_particle.h"

/** The caller owns it; NULL without memory or for numbers that are not finite. */
json_t *ms_json_from_particle(const ms_particle *particle);

/**
 * The particle of a STEM.frame.json, or of the JSON of a clump.
 *
 * @param[out] particle zeros on failure
 * @param      name     of the file, for messages
 * @return MS_OK; MS_ERR_FORMAT with the name of the file and what is missing
 */
ms_status ms_json_read_particle(ms_particle *particle, const ms_bytes *bytes, const char *name, ms_error *err);

#endif
