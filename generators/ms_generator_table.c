/* The table of methods: the one file of the interface that knows them. */
#include "ms_generator.h"

#include "fcm/ms_fcm.h"
#include "mss/ms_mss.h"
#include "setcover/ms_setcover.h"
#include "variational/ms_variational.h"

const ms_generator *const ms_generators[] = {
    &ms_generator_mss, &ms_generator_setcover, &ms_generator_fcm, &ms_generator_variational, NULL,
};
