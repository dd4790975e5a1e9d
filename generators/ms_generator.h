/** The interface of all generators, and the table of them. */
#ifndef MS_GENERATOR_H
#define MS_GENERATOR_H

#include <stdint.h>

#include "clump/ms_clump.h"
#include "ms_option.h"
#include "ms_stop.h"
#include "voxel/ms_target.h"

MS_C_BEGIN

/**
 * Is told, often, how far a run has come: `spheres` so far, D of the last step (NAN if unknown).
 * @return nonzero: the run is to end. A nested one does with the next sphere, by MS_STOP_INTERRUPTED, and gives those
 *         so far; another goes on, since what it has is no clump yet
 */
typedef int (*ms_progress)(void *context, size_t spheres, double dice);

/**
 * Is told what a run is at, in a word or two, and how much of it all is done: from 0 to 1, NAN where that is not known.
 * The thread that called the generator calls this.
 * @return nonzero: the run is to end without a clump, by MS_ERR_INTERRUPTED
 */
typedef int (*ms_stage)(void *context, const char *stage, double share);

/** Is told in one sentence what about the input, though allowed, makes the result worse than it could be, and how to
 * mend it. */
typedef void (*ms_remark)(void *context, const char *sentence);

/** All that a generator is given. Everything is borrowed. */
typedef struct ms_run {
    const ms_target *target;
    ms_stop stop;
    const ms_settings *settings; /* of this generator's options; NULL: their defaults (ms_generator_run) */
    uint64_t seed;               /* for generators that draw random numbers */
    ms_progress progress;        /* NULL: nobody listens */
    void *progress_context;
    ms_stage stage; /* NULL: nobody listens */
    void *stage_context;
    ms_remark remark; /* NULL: nobody listens */
    void *remark_context;
} ms_run;

/**
 * One method. What all of them owe, whatever their options' defaults say, stands here and is checked on every one in
 * the table (tests/generators):
 *
 * - Asked for n spheres of a body that has room for them it gives n, in the order in which they matter, and says
 *   MS_STOP_SPHERES; each radius is above 0 and each centre within the box of the shape.
 * - A nested one gives the first k of n spheres when asked for k.
 * - The same run gives the same spheres to the last bit at any number of threads, and moved and scaled ones for a moved
 *   and scaled shape, up to rounding.
 * - It ends as soon as the stop rule holds and names the first reason in the order of ms_stop_reason; a nested one with
 *   the very sphere that made it hold. No sphere is smaller than the least radius: MS_STOP_RADIUS if it needed one.
 * - It takes any target of one voxel or more, of a mesh or a volume; each option has a help text, a default within its
 *   range, and a place on the page docs/methods/NAME.md.
 * - Its spheres stand for the shape: of a smooth tablet 20 of them reach D < 0.3 and coverage > 0.6, of a rough lump
 *   without a bound on their number eta 0.25, D 0.11, coverage 0.83 and inertia error 0.3. A baseline is spared this.
 */
typedef struct ms_generator {
    const char *name;         /* what --generator takes */
    const char *summary;      /* one line for `mskit generators` */
    const char *source;       /* the paper: authors, year, DOI or arXiv number */
    int nested;               /* nonzero: the first k spheres of a run are the clump of k spheres */
    const char *unnested_by;  /* a FLAG among its options under which a nested one is not; NULL if there is none */
    const char *cut_by;       /* a CHOICE among its options of which any but the first needs cut cells; NULL: none */
    const char *volume_by;    /* a FLAG among its options that has it find spheres of the shape's volume; NULL: none */
    double bytes_per_voxel;   /* that a run takes beyond the target's at its peak; 0: as ms_target_bytes */
    double bytes_per_square;  /* the same, for each square of the surface (ms_target_need) */
    double kept_bytes;        /* of those, a voxel: stay with the target for runs to come */
    int baseline;             /* nonzero: something plain to compare with, by name; promises no quality */
    const ms_option *options; /* ends with a NULL name */
    /**
     * REQUIRED. Target in, ordered spheres out, in the unit and frame of the shape. A nested method that chooses one
     * sphere after the other calls ms_nested_run (shared/ms_nested.h).
     *
     * @param[out] clump  empty on entry; the caller frees it; empty on failure
     * @param[out] reason MS_STOP_NOT on entry; what ended the run
     */
    ms_status (*generate)(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err);
} ms_generator;

/** The one that commands and ms_generate_file take where none is named: the least mismatch of nearly all shapes and
 * numbers of spheres (docs/comparison.md). */
#define MS_GENERATOR_DEFAULT "variational"

/** All generators; ends with NULL. */
MS_API extern const ms_generator *const ms_generators[];

/** Are the first k spheres of a run with these options the clump of k? @param settings NULL: defaults */
MS_API int ms_generator_is_nested(const ms_generator *generator, const ms_settings *settings);

/** What a run with these options takes beyond the target's bytes. @param settings NULL: defaults @param cut nonzero:
 * cut cells are counted, whatever the options say */
MS_API ms_target_need ms_generator_need(const ms_generator *generator, const ms_settings *settings, int cut);

/** The generator of that name, or NULL with a message that lists the names. */
MS_API const ms_generator *ms_generator_find(const char *name, ms_error *err);

/**
 * Runs a generator: checks what every generator would have to check, then calls it.
 *
 * @return MS_OK with at least one sphere; MS_ERR_ARG if nothing ends the run (no stop rule);
 *         MS_ERR_SHAPE if no sphere could be placed (the message names what ended the run), or if the spheres cover no
 *         voxel of the shape, so that nothing is known of them
 */
MS_API ms_status ms_generator_run(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator,
                                  const ms_run *run, ms_error *err);

/** The same for a clump that has to be whole. @return as ms_generator_run; MS_ERR_INTERRUPTED where the run's listener
 * ends it, whatever it has by then */
MS_API ms_status ms_generator_run_whole(ms_clump *clump, const ms_generator *generator, const ms_run *run,
                                        ms_error *err);

/** Has what a run remarks added to a text, sentences with "; " between; what it has no room for is cut. @param kept
 * borrowed while the run lasts */
MS_API void ms_generator_keep_remarks(ms_run *run, ms_error *kept);

/** For generators: tells the run's listener, if there is one, what the run is at. @return MS_OK; MS_ERR_INTERRUPTED */
MS_API ms_status ms_generator_stage(const ms_run *run, const char *stage, double share, ms_error *err);

/** For generators: tells the run's listener, if there is one, a sentence. */
MS_API void ms_generator_remark(const ms_run *run, const char *format, ...) MS_PRINTF(2, 3);

MS_C_END

#endif
