/** The clump of least work in a simulation whose mismatch is small enough: numbers of spheres and least radii tried. */
#ifndef MS_LEAST_WORK_H
#define MS_LEAST_WORK_H

#include <jansson.h>

#include "ms_flags.h"
#include "ms_generator.h"
#include "ms_least_work_search.h"

/* clang-format off */
#define MS_LEAST_WORK_FLAGS \
    {"least-work", 0, "dice=VALUE", \
     "up to 12 runs over numbers of spheres and least radii: the clump of least work n (r_eq / r_min)^P with such D"}, \
    {"work-power", 0, "P", "how the steps of a simulation go with its least radius (1); 0: not at all, fewest spheres"}
/* clang-format on */

/** What is asked for. Begins as {.power = 1}. */
typedef struct ms_least_work {
    double dice;   /* 0: nothing is */
    double power;  /* P */
    int has_power; /* it was given */
} ms_least_work;

/** Takes a flag if it is one of MS_LEAST_WORK_FLAGS. @param[out] taken 0 if it is not */
ms_status ms_least_work_flag(int *taken, ms_least_work *work, const char *name, const char *value, ms_error *err);

/** Refuses what does not go together. @param stop with neither default nor what `work` asks for */
ms_status ms_least_work_resolve(const ms_least_work *work, const ms_stop *stop, ms_error *err);

/**
 * Searches (ms_least_work_search) with a generator; says each run on stderr, and what it remarks. A run of which the
 * shape lets no clump be made (MS_ERR_SHAPE) is one that gave none; others that fail end the search.
 *
 * @param[out] clump    that of the run kept; the caller frees it; empty on failure
 * @param      run      its stop rule bounds the number of spheres and the least radius
 * @param      expected number of spheres to begin with
 * @return MS_OK; MS_ERR_LIMIT if none reaches D; as ms_generator_run and ms_metrics_compute
 */
ms_status ms_least_work_generate(ms_clump *clump, ms_least_work_tries *tries, const ms_least_work *work,
                                 const ms_generator *generator, const ms_run *run, size_t expected, size_t max_voxels,
                                 ms_error *err);

/** The stop rule of the run kept. */
ms_stop ms_least_work_stop(const ms_least_work_tries *tries);

/** What was asked for, and a row for each run; the caller owns it. */
json_t *ms_least_work_json(const ms_least_work_tries *tries, const ms_least_work *work);

#endif
