/** Objects and lists of jansson that are filled step by step: where memory ends, all of it is gone and not a part. */
#ifndef MS_JSON_OBJECT_H
#define MS_JSON_OBJECT_H

#include <jansson.h>

/**
 * Adds a value to an object, which becomes NULL if the value or the object is, or for want of memory; so the end alone
 * has to be looked at.
 *
 * @param value taken over in any case
 */
void ms_json_object_set(json_t **object, const char *key, json_t *value);

/** The same for a list. */
void ms_json_object_append(json_t **list, json_t *value);

/** Adds all that is in another object, which is given up. */
void ms_json_object_merge(json_t **object, json_t *other);

#endif
