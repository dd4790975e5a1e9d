/* The table of methods, and what looks them up. */
#include "ms_generator_list.h"

#include <stdio.h>
#include <string.h>

#define TABLE_ROW(name) &ms_generator_##name,
const ms_generator *const ms_generators[] = {MS_GENERATOR_LIST(TABLE_ROW) NULL};

const ms_generator *ms_generator_find(const char *name, ms_error *err)
{
    char names[256] = "";
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if (strcmp((*g)->name, name) == 0) {
            return *g;
        }
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", (*g)->name);
    }
    ms_fail(err, MS_ERR_ARG, "there is no generator '%s'; choose from %s", name, names);
    return NULL;
}
