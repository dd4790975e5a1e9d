#include "ms_grain_how.h"

#include <string.h>

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

uint64_t ms_grain_how_add_text(uint64_t sum, const char *text)
{
    do { /* the 0 byte, too, so that texts stay apart */
        sum = (sum ^ (unsigned char)*text) * UINT64_C(1099511628211);
    } while (*text++);
    return sum;
}

void ms_grain_how_note(ms_grain_how *how, const char *name, const char *value)
{
    /* On the rows: assembly and report are made of the clumps afterwards. */
    static const char *const WITHOUT_EFFECT[] = {"output",  "resume",     "part",     "merge",        "dry-run", "json",
                                                 "threads", "max-memory", "assembly", "most-overlap", "report"};
    for (size_t w = 0; w < sizeof WITHOUT_EFFECT / sizeof *WITHOUT_EFFECT; w++) {
        if (strcmp(name, WITHOUT_EFFECT[w]) == 0) {
            return;
        }
    }
    how->given += ms_grain_how_add_text(ms_grain_how_add_text(0, name), value ? value : "");
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
