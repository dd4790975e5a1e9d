/** How the clump of a grain is made: the flags of `generate` about method, grid and stop rule. */
#ifndef MS_GRAIN_HOW_H
#define MS_GRAIN_HOW_H

#include "cli/ms_input.h"
#include "cli/ms_recipe.h"
#include "ms_stop.h"

/** Begins as ms_grain_how_default. */
typedef struct ms_grain_how {
    ms_recipe recipe;
    ms_input_flags input;
    ms_stop stop;
    uint64_t given; /* ms_grain_how_note */
} ms_grain_how;

ms_grain_how ms_grain_how_default(void);

/** Takes a flag if it is one of method, grid or stop rule. @param[out] taken 0 if it is not */
ms_status ms_grain_how_flag(int *taken, ms_grain_how *how, const char *name, const char *value, ms_error *err);

/**
 * Notes a flag in the checksum `given`, so that runs can be told apart. The order of flags does not count, nor do flags
 * that no row and no file depends on: of folder, part, threads and memory.
 *
 * @param value NULL without
 */
void ms_grain_how_note(ms_grain_how *how, const char *name, const char *value);

/** FNV-1a of a text behind others. @param sum of those */
uint64_t ms_grain_how_add_text(uint64_t sum, const char *text);

/** What follows from the flags together; ms_grain_how_free in any case. @return MS_OK; as ms_recipe_resolve */
ms_status ms_grain_how_resolve(ms_grain_how *how, ms_error *err);

void ms_grain_how_free(ms_grain_how *how);

#endif
