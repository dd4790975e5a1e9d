/** The interface of all generators, and the table of them. */
#ifndef MS_GENERATOR_H
#define MS_GENERATOR_H

#include <stdint.h>

#include "clump/ms_clump.h"
#include "ms_option.h"
#include "ms_stop.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/** Is told, often, how far a run has come: `spheres` so far, D of the last step (NAN if unknown). */
typedef void (*ms_progress)(void *context, size_t spheres, double dice);

/** All that a generator is given. Everything is borrowed. */
typedef struct ms_run {
    const ms_target *target;
    ms_stop stop;
    const ms_settings *settings; /* of this generator's options */
    uint64_t seed;               /* for generators that draw random numbers */
    ms_progress progress;        /* NULL: nobody listens */
    void *progress_context;
} ms_run;

/** One method. */
typedef struct ms_generator {
    const char *name;         /* what --generator takes */
    const char *summary;      /* one line for `mskit generators` */
    const char *source;       /* the paper: authors, year, DOI or arXiv number */
    int nested;               /* nonzero: the first k spheres of a run are the clump of k spheres */
    const ms_option *options; /* ends with a NULL name */
    /**
     * REQUIRED. Target in, ordered spheres out, in the unit and frame of the shape; the same
     * spheres to the last bit for the same run, whatever the number of threads.
     *
     * @param[out] clump  empty on entry; the caller frees it; empty on failure
     * @param[out] reason what ended the run
     */
    ms_status (*generate)(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err);
} ms_generator;

/** All generators; ends with NULL. */
extern const ms_generator *const ms_generators[];

/** The generator of that name, or NULL with a message that lists the names. */
const ms_generator *ms_generator_find(const char *name, ms_error *err);

/**
 * Runs a generator: checks what every generator would have to check, then calls it.
 *
 * @return MS_OK with at least one sphere; MS_ERR_ARG if nothing ends the run (no stop rule);
 *         MS_ERR_SHAPE if no sphere could be placed (the message names what ended the run)
 */
ms_status ms_generator_run(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator, const ms_run *run,
                           ms_error *err);

MS_C_END

#endif
