/** Independent runs side by side: what compare, stability and scene are lists of. */
#ifndef MS_QUEUE_H
#define MS_QUEUE_H

#include <stddef.h>

#include "base/ms_error.h"

/** The place at which a run is worked on. */
typedef struct ms_queue_place ms_queue_place;

/** A list of runs. */
typedef struct ms_queue {
    size_t count; /* runs */
    size_t done;  /* of a run taken up: done before, for the line of progress alone */
    int threads;  /* in all */
    int in_turn;  /* nonzero: one run after the other, each with all threads, as where times are the result */
    void *context;

    /** The work of a run, on any thread, with one thread for itself (omp_get_max_threads). What it gives, or why it
     * failed, is kept in the context, where no other run may write. */
    void (*work)(void *context, size_t run, ms_queue_place *place);

    /**
     * Takes what a run gave, in the order of the list, one at a time, as soon as all runs before it are taken: a row on
     * the disk, words for people. What is not MS_OK ends the queue.
     *
     * @param[in,out] failed counts runs that failed, for the line of progress
     */
    ms_status (*take)(void *context, size_t run, size_t *failed, ms_error *err);
} ms_queue;

/**
 * Works through the list; runs begin in its order. A line on the terminal says how far it is. With one run, or one
 * thread, everything is done by the caller's thread, which then has all threads for each run.
 *
 * @return MS_OK; as take, when the runs that had begun are done
 */
ms_status ms_queue_run(const ms_queue *queue, ms_error *err);

/**
 * Before a run takes so much memory: one that takes more than an equal share of what all may take waits until no other
 * run works; from there to its end it has all threads, and no other begins.
 *
 * @param bytes of this run
 * @param most  of all runs together
 */
void ms_queue_need_memory(ms_queue_place *place, double bytes, double most);

/** Around waiting for another run, which may itself wait for this one: from pause to resume this one is not at work. */
void ms_queue_pause(ms_queue_place *place);
void ms_queue_resume(ms_queue_place *place);

/** How many other runs may work beside this one. */
int ms_queue_beside(const ms_queue_place *place);

#endif
