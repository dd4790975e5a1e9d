/** A shape that several runs of a queue work on: read by the first that needs it, freed by the last. */
#ifndef MS_SHARED_INPUT_H
#define MS_SHARED_INPUT_H

#include <pthread.h>

#include "cli/ms_input.h"
#include "ms_queue.h"

/** How it is read, as by ms_input_read. @param[in,out] flags those of its target, where the name says others */
typedef ms_status (*ms_shared_input_reader)(ms_input *input, const char *name, ms_input_flags *flags, ms_error *err);

/** A shape and its target, or why there is none. */
typedef struct ms_shared_input {
    const char *name; /* borrowed */
    ms_shared_input_reader read;
    ms_input_flags flags;
    size_t users; /* runs that are still to need it */
    int is_made;
    ms_status status;
    ms_error cause; /* where status is not MS_OK */
    double bytes;   /* of the target and a run on it */
    ms_input input; /* without a target: what is known of the file */
    pthread_mutex_t lock;
} ms_shared_input;

/** Nothing is read yet. @param users runs that will call ms_shared_input_release */
void ms_shared_input_begin(ms_shared_input *shared, const char *name, ms_shared_input_reader read,
                           const ms_input_flags *flags, size_t users);

/**
 * Has it made, if it is not yet, or waits until another run has made it. A target too large for one of several runs
 * side by side has this run wait until it is alone (ms_queue_need_memory, by --max-memory).
 *
 * @param place of the run
 * @return whether there is a target: shared->status
 */
ms_status ms_shared_input_need(ms_shared_input *shared, ms_queue_place *place);

/** A run that needed it, or was to, is done. */
void ms_shared_input_release(ms_shared_input *shared);

/** Frees what is left where runs did not come to their end. */
void ms_shared_input_end(ms_shared_input *shared);

#endif
