/** The methods that a research command is given: generators with options, and clumps of other tools. */
#ifndef MS_METHODS_H
#define MS_METHODS_H

#include "ms_files.h"
#include "ms_generator.h"

enum { MS_METHODS_MAX = 64 };

/** A clump of another tool, of one shape. */
typedef struct ms_method_clump {
    char *file;
    ms_clump clump;
} ms_method_clump;

/** One of them. */
typedef struct ms_method {
    char *name;                    /* of the generator, or as the user calls the clump */
    char *options;                 /* as the user wrote them, or where the clumps are; "" for none */
    const ms_generator *generator; /* NULL: clumps of another tool */
    ms_settings settings;
    ms_method_clump *clump; /* n_clumps, one for each shape */
    size_t n_clumps;
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

/** Adds clumps of another tool from "NAME=FILE"; instead of the file a folder or a pattern of several.
 * ms_methods_read_clumps reads them. @return MS_OK; MS_ERR_ARG; MS_ERR_LIMIT; MS_ERR_NOMEM */
ms_status ms_methods_add_clump(ms_methods *methods, const char *text, ms_error *err);

/**
 * Reads the clumps of other tools, one for each shape. A file goes with the only shape, whatever its name. Of a folder
 * or a pattern, the one whose name without ending is that of the shape, or that and - or _ and more (grain-mss.csv of
 * grain.stl); where names of two shapes fit, with the longer one. Files that go with no shape are passed over.
 *
 * @return MS_OK; MS_ERR_ARG for a shape with no clump or with several; as ms_paths_add, ms_read_clump
 * Cost: O(files x shapes) names.
 */
ms_status ms_methods_read_clumps(ms_methods *methods, char *const *shape, size_t n_shapes, ms_error *err);

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
