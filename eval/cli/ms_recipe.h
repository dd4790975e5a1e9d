/** Which generator, with which options and seed: flags of the commands that run one. */
#ifndef MS_RECIPE_H
#define MS_RECIPE_H

#include "ms_flags.h"
#include "ms_generator.h"

enum { MS_RECIPE_MAX_OPTIONS = 256 };

/* clang-format off */
#define MS_RECIPE_FLAGS \
    {"generator", 'g', "NAME", "the method (" MS_GENERATOR_DEFAULT "); mskit generators lists them"}, \
    {"set", 0, "OPTION=VALUE", "an option of the method (mskit help NAME); --OPTION VALUE does the same, " \
     "--OPTION of one that is off"}, \
    {"seed", 0, "S", "seed of methods that draw random numbers (1)"}
/* clang-format on */

/** An option of the generator as it was written. */
typedef struct ms_wish {
    const char *name; /* NULL: `text` is OPTION=VALUE */
    const char *text;
} ms_wish;

/** Begins as {.name = MS_GENERATOR_DEFAULT, .seed = 1}. */
typedef struct ms_recipe {
    const char *name;
    ms_wish wish[MS_RECIPE_MAX_OPTIONS];
    int n_wishes;
    double seed;
    int equal_volume;              /* clumps will be scaled to the shape's volume: a method that can, holds it itself */
    const ms_generator *generator; /* after ms_recipe_resolve */
    ms_settings settings;
} ms_recipe;

/**
 * Takes a flag if it is one of MS_RECIPE_FLAGS or an option of any generator.
 * @param[out] taken 0 if it is not
 */
ms_status ms_recipe_flag(int *taken, ms_recipe *recipe, const char *name, const char *value, ms_error *err);

/** Finds the generator and gives it its options. ms_recipe_free in any case. @return MS_OK; MS_ERR_ARG; MS_ERR_NOMEM */
ms_status ms_recipe_resolve(ms_recipe *recipe, ms_error *err);

void ms_recipe_free(ms_recipe *recipe);

/** Cuts "name=value", which a flag was given, in two. @param[out] value NULL without '=' @return MS_OK; MS_ERR_ARG
 * without a name */
ms_status ms_recipe_assignment(char name[64], const char **value, const char *flag, const char *text, ms_error *err);

#endif
