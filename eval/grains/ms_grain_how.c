#include "ms_grain_how.h"

#include "cli/ms_until.h"

ms_grain_how ms_grain_how_default(void)
{
    ms_grain_how how = {.recipe = {.name = MS_GENERATOR_DEFAULT, .seed = 1}};
    ms_input_defaults(&how.input);
    how.input.quiet = 1;
    return how;
}

ms_status ms_grain_how_flag(int *taken, ms_grain_how *how, const char *name, const char *value, ms_error *err)
{
    ms_status status = ms_input_flag(taken, &how->input, name, value, err);
    if (!*taken) {
        status = ms_until_flag(taken, &how->stop, name, value, err);
    }
    return *taken ? status : ms_recipe_flag(taken, &how->recipe, name, value, err);
}

ms_status ms_grain_how_resolve(ms_grain_how *how, ms_error *err)
{
    ms_until_resolve(&how->stop);
    return ms_recipe_resolve(&how->recipe, err);
}

void ms_grain_how_free(ms_grain_how *how)
{
    ms_recipe_free(&how->recipe);
}
