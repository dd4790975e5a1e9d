#include "ms_queue.h"

#include <omp.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Shared by all places, under the lock. */
typedef struct queue_state {
    const ms_queue *queue;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int places;         /* that take runs */
    size_t next, taken; /* the first run that has not begun, that has not been taken */
    size_t failed;
    char *is_done;    /* of each run */
    int working;      /* runs at work, the owner among them */
    int waiting;      /* runs that wait until they are alone */
    int is_owned;     /* a run is alone */
    int is_taking;    /* a thread takes what runs gave */
    ms_status status; /* of the take that failed */
    ms_error *err;
    double start;
    int is_terminal;
} queue_state;

struct ms_queue_place {
    queue_state *state;
    int is_alone; /* the run here */
};

/* Called under the lock. */
static void show_line(const queue_state *s)
{
    if (!s->is_terminal || s->taken == 0) {
        return;
    }
    const size_t all = s->queue->done + s->queue->count;
    const double left = (omp_get_wtime() - s->start) / (double)s->taken * (double)(s->queue->count - s->taken);
    fprintf(stderr, "\r\033[K%zu of %zu runs", s->queue->done + s->taken, all);
    if (s->failed) {
        fprintf(stderr, ", %zu failed", s->failed);
    }
    fprintf(stderr, left < 90 ? ", %.0f s left " : ", %.0f min left ", left < 90 ? left : left / 60);
}

static void clear_line(const queue_state *s)
{
    if (s->is_terminal) {
        fputs("\r\033[K", stderr);
    }
}

/* Takes all that is done and next, unless another thread is at it. Called under the lock, which is open meanwhile. */
static void take_done(queue_state *s)
{
    if (s->is_taking) {
        return;
    }
    s->is_taking = 1;
    while (s->status == MS_OK && s->taken < s->queue->count && s->is_done[s->taken]) {
        const size_t run = s->taken;
        size_t failed = 0;
        clear_line(s);
        pthread_mutex_unlock(&s->lock);
        const ms_status status = s->queue->take(s->queue->context, run, &failed, s->err);
        pthread_mutex_lock(&s->lock);
        s->status = status;
        s->taken += status == MS_OK;
        s->failed += failed;
        show_line(s);
    }
    s->is_taking = 0;
}

/* Called under the lock, which is open during the work. */
static void work_on(queue_state *s, size_t run)
{
    ms_queue_place place = {.state = s, .is_alone = s->places == 1};
    s->working++;
    pthread_mutex_unlock(&s->lock);
    omp_set_num_threads(place.is_alone ? s->queue->threads : 1);
    s->queue->work(s->queue->context, run, &place);
    pthread_mutex_lock(&s->lock);
    s->working--;
    s->is_owned = 0; /* was it this one or nobody */
    s->is_done[run] = 1;
    pthread_cond_broadcast(&s->changed);
    take_done(s);
}

static void *work_through(void *context)
{
    queue_state *s = context;
    pthread_mutex_lock(&s->lock);
    for (;;) {
        while ((s->waiting || s->is_owned) && s->status == MS_OK && s->next < s->queue->count) {
            pthread_cond_wait(&s->changed, &s->lock);
        }
        if (s->status != MS_OK || s->next >= s->queue->count) {
            break;
        }
        work_on(s, s->next++);
    }
    pthread_mutex_unlock(&s->lock);
    return NULL;
}

/* The caller's thread and others; where the system gives none, fewer. */
static void work_side_by_side(queue_state *s)
{
    pthread_t *thread = malloc((size_t)s->places * sizeof *thread);
    int started = 0;
    while (thread && started < s->places - 1 && pthread_create(&thread[started], NULL, work_through, s) == 0) {
        started++;
    }
    work_through(s);
    for (int t = 0; t < started; t++) {
        pthread_join(thread[t], NULL);
    }
    free(thread);
}

ms_status ms_queue_run(const ms_queue *queue, ms_error *err)
{
    const int threads = omp_get_max_threads();
    const size_t most = queue->in_turn ? 1 : (size_t)queue->threads;
    queue_state s = {.queue = queue, .err = err, .start = omp_get_wtime(), .is_terminal = isatty(STDERR_FILENO)};
    s.places = (int)(queue->count < most ? queue->count : most);
    if (queue->count == 0) {
        return MS_OK;
    }
    s.is_done = calloc(queue->count, 1);
    if (!s.is_done) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a list of %zu runs", queue->count);
    }
    pthread_mutex_init(&s.lock, NULL);
    pthread_cond_init(&s.changed, NULL);
    work_side_by_side(&s);
    clear_line(&s);
    pthread_cond_destroy(&s.changed);
    pthread_mutex_destroy(&s.lock);
    free(s.is_done);
    omp_set_num_threads(threads);
    return s.status;
}

/* While it waits it is not at work, so that two large runs do not wait for each other. */
static void wait_alone(ms_queue_place *place)
{
    queue_state *s = place->state;
    pthread_mutex_lock(&s->lock);
    s->working--;
    s->waiting++;
    pthread_cond_broadcast(&s->changed);
    while (s->working > 0) {
        pthread_cond_wait(&s->changed, &s->lock);
    }
    s->waiting--;
    s->working++;
    s->is_owned = place->is_alone = 1;
    pthread_mutex_unlock(&s->lock);
    omp_set_num_threads(s->queue->threads);
}

void ms_queue_need_memory(ms_queue_place *place, double bytes, double most)
{
    if (!place->is_alone && bytes > most / place->state->places) {
        wait_alone(place);
    }
}

void ms_queue_pause(ms_queue_place *place)
{
    queue_state *s = place->state;
    pthread_mutex_lock(&s->lock);
    s->working--;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->lock);
}

void ms_queue_resume(ms_queue_place *place)
{
    queue_state *s = place->state;
    pthread_mutex_lock(&s->lock);
    while (s->is_owned) {
        pthread_cond_wait(&s->changed, &s->lock);
    }
    s->working++;
    pthread_mutex_unlock(&s->lock);
}

int ms_queue_beside(const ms_queue_place *place)
{
    return place->is_alone ? 0 : place->state->places - 1;
}
