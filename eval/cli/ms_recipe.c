#include "ms_recipe.h"

#include <stdio.h>
#include <string.h>

ms_status ms_recipe_assignment(char name[64], const char **value, const char *flag, const char *text, ms_error *err)
{
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : strlen(text);
    if (length == 0 || length >= 64) {
        return ms_fail(err, MS_ERR_ARG, "--%s '%.200s' is not of the form name=value", flag, text);
    }
    memcpy(name, text, length);
    name[length] = 0;
    *value = equals ? equals + 1 : NULL;
    return MS_OK;
}

static int is_option(const char *name)
{
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if (ms_option_find((*g)->options, name)) {
            return 1;
        }
    }
    return 0;
}

/* Which options there are is known when all flags are read: the generator may come last. */
static ms_status take_wish(ms_recipe *recipe, const char *name, const char *text, ms_error *err)
{
    if (recipe->n_wishes == MS_RECIPE_MAX_OPTIONS) {
        return ms_fail(err, MS_ERR_LIMIT, "more than %d options of the generator", MS_RECIPE_MAX_OPTIONS);
    }
    recipe->wish[recipe->n_wishes++] = (ms_wish){name, text};
    return MS_OK;
}

ms_status ms_recipe_flag(int *taken, ms_recipe *recipe, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "generator") == 0) {
        recipe->name = value;
        return MS_OK;
    }
    if (strcmp(name, "seed") == 0) {
        return ms_flags_whole(&recipe->seed, name, value, 0, 9007199254740992.0, err);
    }
    if (strcmp(name, "set") == 0) {
        return take_wish(recipe, NULL, value, err);
    }
    if (is_option(name)) {
        return take_wish(recipe, name, value, err);
    }
    *taken = 0;
    return MS_OK;
}

/* An option that another generator has: which ones is said. */
static ms_status set_wish(ms_recipe *recipe, const char *name, const char *value, ms_error *err)
{
    char names[128] = "";
    for (const ms_generator *const *g = ms_generators; *g && !ms_option_find(recipe->generator->options, name); g++) {
        if (ms_option_find((*g)->options, name)) {
            const size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s-g %s", used ? " or " : "", (*g)->name);
        }
    }
    return names[0] ? ms_fail(err, MS_ERR_ARG, "%s has no option '%s'; give %s beside it", recipe->name, name, names)
                    : ms_option_settings_set(&recipe->settings, name, value, err);
}

ms_status ms_recipe_resolve(ms_recipe *recipe, ms_error *err)
{
    recipe->generator = ms_generator_find(recipe->name, err);
    ms_status status =
        recipe->generator ? ms_option_settings_init(&recipe->settings, recipe->generator->options, err) : MS_ERR_ARG;
    if (status == MS_OK && recipe->equal_volume && recipe->generator->volume_by) {
        status = ms_option_settings_set(&recipe->settings, recipe->generator->volume_by, NULL, err);
    }
    for (int w = 0; w < recipe->n_wishes && status == MS_OK; w++) {
        const ms_wish *wish = &recipe->wish[w];
        char name[64];
        const char *value = wish->text;
        if (!wish->name) {
            status = ms_recipe_assignment(name, &value, "set", wish->text, err);
        }
        if (status == MS_OK) {
            status = set_wish(recipe, wish->name ? wish->name : name, value, err);
        }
    }
    return status;
}

void ms_recipe_free(ms_recipe *recipe)
{
    ms_option_settings_free(&recipe->settings);
}
