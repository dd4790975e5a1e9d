/** A generator with its options, as `-g NAME[:OPTION=VALUE,...]` names it. */
#ifndef MS_METHOD_H
#define MS_METHOD_H

#include "ms_generator.h"

typedef struct ms_method {
    char *text; /* as it was written: its name in tables */
    const ms_generator *generator;
    ms_settings settings;
} ms_method;

/**
 * Reads NAME or NAME:OPTION=VALUE,OPTION=VALUE; an option that is switched on needs no value.
 *
 * @param[out] method freed by ms_method_free; empty on failure
 * @return MS_OK; MS_ERR_ARG for an unknown generator or option (the message lists them) or a bad value; MS_ERR_NOMEM
 */
ms_status ms_method_parse(ms_method *method, const char *text, ms_error *err);

void ms_method_free(ms_method *method);

#endif
