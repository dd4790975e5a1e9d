/* The table of methods, and what looks them up: the one file of the interface that knows them. */
#include <stdio.h>
#include <string.h>

#include "fcm/ms_fcm.h"
#include "ms_generator.h"
#include "mss/ms_mss.h"
#include "setcover/ms_setcover.h"
#include "variational/ms_variational.h"

const ms_generator *const ms_generators[] = {
    &ms_generator_mss, &ms_generator_setcover, &ms_generator_fcm, &ms_generator_variational, NULL,
};

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
