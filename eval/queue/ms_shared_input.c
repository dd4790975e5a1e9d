#include "ms_shared_input.h"

#include <string.h>

void ms_shared_input_begin(ms_shared_input *shared, const char *name, ms_shared_input_reader read,
                           const ms_input_flags *flags, size_t users)
{
    memset(shared, 0, sizeof *shared);
    shared->name = name;
    shared->read = read;
    shared->flags = *flags;
    shared->flags.threads = 0; /* as many as the run has */
    shared->users = users;
    pthread_mutex_init(&shared->lock, NULL);
}

static ms_status make_input(ms_shared_input *shared, ms_queue_place *place)
{
    ms_status status = shared->read(&shared->input, shared->name, &shared->flags, &shared->cause);
    if (status == MS_OK) {
        shared->bytes = ms_input_bytes(&shared->input, &shared->flags);
        ms_queue_need_memory(place, shared->bytes, shared->flags.max_memory);
        status = ms_input_target(&shared->input, &shared->flags, &shared->cause);
    }
    if (status == MS_OK) {
        status = ms_input_describe(&shared->input, &shared->cause);
    }
    return status;
}

ms_status ms_shared_input_need(ms_shared_input *shared, ms_queue_place *place)
{
    if (pthread_mutex_trylock(&shared->lock) != 0) { /* another run makes it */
        ms_queue_pause(place);
        pthread_mutex_lock(&shared->lock);
        pthread_mutex_unlock(&shared->lock);
        ms_queue_resume(place); /* not under the lock, which the run that is alone may need */
    } else {
        if (!shared->is_made) {
            shared->status = make_input(shared, place);
            shared->is_made = 1;
        }
        pthread_mutex_unlock(&shared->lock);
    }
    if (shared->status == MS_OK) { /* each run on it takes memory of its own */
        ms_queue_need_memory(place, shared->bytes, shared->flags.max_memory);
    }
    return shared->status;
}

void ms_shared_input_release(ms_shared_input *shared)
{
    pthread_mutex_lock(&shared->lock);
    const int is_last = --shared->users == 0;
    pthread_mutex_unlock(&shared->lock);
    if (is_last) {
        ms_input_free(&shared->input);
    }
}

void ms_shared_input_end(ms_shared_input *shared)
{
    if (shared->users > 0) {
        ms_input_free(&shared->input);
    }
    pthread_mutex_destroy(&shared->lock);
}
