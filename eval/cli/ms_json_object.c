#include "ms_json_object.h"

static void give_up(json_t **json)
{
    json_decref(*json);
    *json = NULL;
}

void ms_json_object_set(json_t **object, const char *key, json_t *value)
{
    if (json_object_set_new(*object, key, value) != 0) {
        give_up(object);
    }
}

void ms_json_object_append(json_t **list, json_t *value)
{
    if (json_array_append_new(*list, value) != 0) {
        give_up(list);
    }
}

void ms_json_object_merge(json_t **object, json_t *other)
{
    if (json_object_update(*object, other) != 0) {
        give_up(object);
    }
    json_decref(other);
}
