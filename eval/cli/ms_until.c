#include "ms_until.h"

#include <string.h>

#include "base/ms_text.h"
#include "ms_recipe.h"

enum { DEFAULT_SPHERES = 50 };

static ms_status take_until(ms_stop *stop, const char *text, ms_error *err)
{
    char name[64];
    const char *value = NULL;
    double number;
    ms_status status = ms_recipe_assignment(name, &value, "until", text, err);
    if (status != MS_OK) {
        return status;
    }
    const ms_word word = {value, value ? strlen(value) : 0};
    ms_stop known = {0};
    status = ms_stop_set(&known, name, 1, err); /* is there such a measure? */
    if (status == MS_OK && (word.length == 0 || !ms_text_to_double(&number, &word))) {
        return ms_fail(err, MS_ERR_ARG, "--until '%s' is not of the form MEASURE=VALUE, as %s=0.05", text, name);
    }
    return status == MS_OK ? ms_stop_set(stop, name, number, err) : status;
}

ms_status ms_until_min_radius(double *radius, const char *value, ms_error *err)
{
    return ms_flags_number(radius, "min-radius", value, 1e-300, 1e300, err);
}

ms_status ms_until_flag(int *taken, ms_stop *stop, const char *name, const char *value, ms_error *err)
{
    double number;
    *taken = 1;
    if (strcmp(name, "until") == 0) {
        return take_until(stop, value, err);
    }
    if (strcmp(name, "min-radius") == 0) {
        return ms_until_min_radius(&stop->radius, value, err);
    }
    if (strcmp(name, "spheres") == 0) {
        const ms_status status = ms_flags_whole(&number, name, value, 1, MS_CLUMP_MAX_SPHERES, err);
        stop->spheres = status == MS_OK ? (size_t)number : 0;
        return status;
    }
    *taken = 0;
    return MS_OK;
}

void ms_until_resolve(ms_stop *stop)
{
    if (ms_stop_is_none(stop)) {
        stop->spheres = DEFAULT_SPHERES;
    }
}
