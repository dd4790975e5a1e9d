/* The table of methods, and what looks them up: the one file of the interface that knows them. */
#include "base/ms_choice.h"
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
    ms_choice choice = {.typed = name};
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if (ms_choice_offer(&choice, (*g)->name)) {
            return *g;
        }
    }
    ms_choice_fail(&choice, err, "there is no generator '%s'", name);
    return NULL;
}
