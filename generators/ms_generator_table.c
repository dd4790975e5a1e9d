/* The table of methods, and what looks them up. */
#include "ms_generator_list.h"

#include "base/ms_choice.h"

#define TABLE_ROW(name) &ms_generator_##name,
const ms_generator *const ms_generators[] = {MS_GENERATOR_LIST(TABLE_ROW) NULL};

const ms_generator *ms_generator_find(const char *name, ms_error *err)
{
    ms_choice choice = {.typed = name};
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if (ms_choice_offer(&choice, (*g)->name)) {
            return *g;
        }
    }
    ms_choice_fail(&choice, err, "there is no generator '%s'", name);
    return NULL;
}
