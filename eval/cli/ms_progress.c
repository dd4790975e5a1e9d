#include "ms_progress.h"

#include <math.h>
#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "ms_signals.h"

enum { WIDTH = 79 }; /* a line that is broken could not be wiped */

/* Below these a time left would be a guess, and a line a flicker. */
static const double LEAST_SHARE = 0.01, LEAST_SECONDS = 0.5, INTERVAL = 0.25;

/* All that a signal can reach. */
static volatile sig_atomic_t is_interrupted, has_spheres;

/* There is one terminal. A thread of its own draws, so that no work has to call often for the line to move; what it
 * shares with those that tell is behind the lock. */
static struct terminal {
    pthread_mutex_t lock;
    pthread_cond_t closed;
    pthread_t thread;
    ms_progress_line line;
    char stage[48];
    double opened, share, told;     /* share of the part, NAN if not known, and when that was told */
    int is_open, is_drawn, is_left; /* to another who draws */
} terminal = {.lock = PTHREAD_MUTEX_INITIALIZER, .closed = PTHREAD_COND_INITIALIZER};

/* Without spheres there is nothing to keep, and it may be long until the first: the signal ends the program, as does a
 * second one. */
static void note_signal(int number)
{
    is_interrupted = 1;
    ms_signals_catch(number, NULL);
    if (!has_spheres) {
        raise(number);
    }
}

static void print_time(char *out, size_t size, double seconds)
{
    if (seconds < 60) {
        snprintf(out, size, "%.0f s", ceil(seconds));
    } else if (seconds < 3600) {
        snprintf(out, size, "%.0f min", ceil(seconds / 60));
    } else {
        snprintf(out, size, "%.1f h", seconds / 3600);
    }
}

/* Share of the whole; NAN if not known. */
static double whole_share(const struct terminal *t)
{
    const double part = isnan(t->share) && t->line.parts > 0 ? 0 : t->share;
    return t->line.parts > 0 ? ((double)t->line.part + part) / (double)t->line.parts : part;
}

/* What is left were all of the work as fast as that so far; NAN where it is known not to be, as of spheres of which the
 * first cost most, and where what was told last has taken longer than that. */
static double time_left(const struct terminal *t, double share, double now)
{
    const double began = t->line.began > 0 ? t->line.began : t->opened;
    const int is_even = t->line.goal == 0 || t->line.parts > 1;
    const double left = (t->told - began) * (1 - share) / share - (now - t->told);
    return is_even && share >= LEAST_SHARE && left > 0 ? left : (double)NAN;
}

/* The end of the line: share and time left, or time so far. */
static void print_share(char *out, size_t size, const struct terminal *t, double now)
{
    char text[32], percent[32] = "";
    const double share = whole_share(t), left = time_left(t, share, now);
    if (!isnan(share)) {
        snprintf(percent, sizeof percent, ", %.0f %%", floor(100 * fmin(share, 1)));
    }
    print_time(text, sizeof text, isnan(left) ? now - t->opened : left);
    snprintf(out, size, "%s, %s%s%s", percent, isnan(left) ? "" : "about ", text, isnan(left) ? "" : " left");
}

/* Within the lock. */
static void draw(struct terminal *t)
{
    char head[64] = "", tail[64], body[256];
    if (t->line.parts > 1) {
        snprintf(head, sizeof head, "%zu of %zu: ", t->line.part + 1, t->line.parts);
    }
    print_share(tail, sizeof tail, t, omp_get_wtime());
    snprintf(body, sizeof body, "%s%.100s%s%s", head, t->line.name, t->stage[0] ? ": " : "", t->stage);
    fprintf(stderr, "\r\033[K%.*s%s ", WIDTH - (int)strlen(tail) - 1, body, tail);
    fflush(stderr);
    t->is_drawn = 1;
}

/* Within the lock. */
static void wipe(struct terminal *t)
{
    if (t->is_drawn) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
        t->is_drawn = 0;
    }
}

/* Waits within the lock, which it gives away meanwhile. */
static void wait_interval(struct terminal *t)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += (long)(1e9 * INTERVAL);
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_cond_timedwait(&t->closed, &t->lock, &until);
}

static void *draw_often(void *context)
{
    struct terminal *t = context;
    pthread_mutex_lock(&t->lock);
    while (t->is_open) {
        wait_interval(t);
        if (t->is_open && omp_get_wtime() - t->opened >= LEAST_SECONDS) {
            draw(t);
        }
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

/* Signals are for the thread that works. */
static int start_thread(struct terminal *t)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&t->thread, NULL, draw_often, t);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return !failed;
}

void ms_progress_open(const ms_progress_line *line)
{
    struct terminal *t = &terminal;
    if (t->is_left) {
        return;
    }
    ms_progress_close();
    t->line = *line;
    t->stage[0] = '\0';
    t->opened = t->told = omp_get_wtime();
    t->share = (double)NAN;
    t->is_open = isatty(STDERR_FILENO);
    if (t->is_open && !start_thread(t)) {
        t->is_open = 0; /* no line, which nothing depends on */
    }
}

void ms_progress_leave(int is_left)
{
    terminal.is_left = is_left;
}

void ms_progress_close(void)
{
    struct terminal *t = &terminal;
    if (!t->is_open) {
        return;
    }
    pthread_mutex_lock(&t->lock);
    t->is_open = 0;
    wipe(t);
    pthread_cond_signal(&t->closed);
    pthread_mutex_unlock(&t->lock);
    pthread_join(t->thread, NULL);
}

void ms_progress_wipe(void)
{
    pthread_mutex_lock(&terminal.lock);
    wipe(&terminal);
    pthread_mutex_unlock(&terminal.lock);
}

static int note_stage(void *context, const char *stage, double share)
{
    struct terminal *t = context;
    pthread_mutex_lock(&t->lock);
    snprintf(t->stage, sizeof t->stage, "%s", stage);
    t->share = share;
    t->told = omp_get_wtime();
    pthread_mutex_unlock(&t->lock);
    return 0;
}

void ms_progress_stage(const char *stage)
{
    note_stage(&terminal, stage, (double)NAN);
}

static int note_spheres(void *context, size_t spheres, double dice)
{
    struct terminal *t = context;
    const double now = omp_get_wtime();
    has_spheres = spheres > 0;
    pthread_mutex_lock(&t->lock);
    if (isnan(dice)) {
        snprintf(t->stage, sizeof t->stage, "%zu spheres to begin with", spheres);
    } else {
        snprintf(t->stage, sizeof t->stage, "%zu spheres, D %.4f", spheres, dice);
    }
    if (t->line.goal > 0) {
        t->share = (double)spheres / (double)t->line.goal;
        t->told = now;
    }
    pthread_mutex_unlock(&t->lock);
    return is_interrupted;
}

void ms_progress_show(ms_run *run)
{
    run->progress = note_spheres;
    run->progress_context = &terminal;
    run->stage = note_stage;
    run->stage_context = &terminal;
}

static void say_remark(void *context, const char *sentence)
{
    ms_progress_wipe();
    fprintf(stderr, "%s: %s\n", ((const ms_progress_line *)context)->name, sentence);
}

void ms_progress_say_remarks(ms_run *run, ms_progress_line *line)
{
    run->remark = say_remark;
    run->remark_context = line;
}

void ms_progress_catch(int is_caught)
{
    has_spheres = 0;
    ms_signals_catch(SIGINT, is_caught ? note_signal : NULL);
    ms_signals_catch(SIGTERM, is_caught ? note_signal : NULL);
}
