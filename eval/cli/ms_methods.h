/** The methods that a research command is given: generators with options, and clumps of other tools. */
#ifndef MS_METHODS_H
#define MS_METHODS_H

#include "ms_files.h"
#include "ms_generator.h"

enum { MS_METHODS_MAX = 64 };

/** One of them. */
typedef struct ms_method {
    char *name;                    /* of the generator, or as the user calls the clump */
    char *options;                 /* as the user wrote them, or the file of the clump; "" for none */
    const ms_generator *generator; /* NULL: a clump */
    ms_settings settings;
    ms_clump clump;
} ms_method;

/** A zeroed struct has none. */
typedef struct ms_methods {
    ms_method method[MS_METHODS_MAX];
    size_t count;
} ms_methods;

/**
 * Adds a generator from "NAME" or "NAME:OPTION=VALUE,...". A comma that no option of the generator follows belongs to
 * the value, as in plane=0,0,1,0.
 * @return MS_OK; MS_ERR_ARG; MS_ERR_LIMIT; MS_ERR_NOMEM; as ms_option_settings_set
 */
ms_status ms_methods_add(ms_methods *methods, const char *text, ms_error *err);

/** Adds a clump from "NAME=FILE", which is read at once. @return MS_OK; MS_ERR_ARG; as ms_read_clump */
ms_status ms_methods_add_clump(ms_methods *methods, const char *text, ms_error *err);

/**
 * Does each stand there once? Adds every generator but the baselines, by default options, if there is none yet.
 * @return MS_OK; MS_ERR_ARG; as ms_methods_add
 */
ms_status ms_methods_check(ms_methods *methods, ms_error *err);

/** Adds the files that methods read: clumps of other tools, and those to start from. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_methods_list_files(ms_files *files, const ms_methods *methods, ms_error *err);

/** The most that one takes, with what others leave with the target (ms_generator); 0: no generator. @param cut as
 * ms_generator_need */
ms_target_need ms_methods_need(const ms_methods *methods, int cut);

/** Number of clumps among them. */
size_t ms_methods_clumps(const ms_methods *methods);

void ms_methods_free(ms_methods *methods);

#endif
