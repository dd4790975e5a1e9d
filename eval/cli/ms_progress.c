#include "ms_progress.h"

#include <math.h>
#include <omp.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

/* All that a signal can reach. */
static volatile sig_atomic_t is_interrupted, has_spheres;

/* Without spheres there is nothing to keep, and it may be long until the first: the signal does what it would without
 * this, as SA_RESETHAND has put that back. */
static void note_signal(int number)
{
    is_interrupted = 1;
    if (!has_spheres) {
        raise(number);
    }
}

static int show_line(void *context, size_t spheres, double dice)
{
    ms_progress_line *line = context;
    const double now = omp_get_wtime();
    has_spheres = spheres > 0;
    if (line->is_terminal && now - line->shown > 0.1) {
        line->shown = now;
        if (isnan(dice)) {
            fprintf(stderr, "\r%s: %zu spheres to begin with ", line->name, spheres);
        } else {
            fprintf(stderr, "\r\033[K%s: %zu spheres, D %.4f ", line->name, spheres, dice);
        }
    }
    return is_interrupted;
}

void ms_progress_show(ms_run *run, ms_progress_line *line)
{
    line->is_terminal = isatty(STDERR_FILENO);
    run->progress = show_line;
    run->progress_context = line;
}

static void say_remark(void *context, const char *sentence)
{
    const ms_progress_line *line = context;
    ms_progress_clear(line);
    fprintf(stderr, "%s: %s\n", line->name, sentence);
}

void ms_progress_say_remarks(ms_run *run, ms_progress_line *line)
{
    run->remark = say_remark;
    run->remark_context = line;
}

void ms_progress_clear(const ms_progress_line *line)
{
    if (line->shown > 0) {
        fputs("\r\033[K", stderr);
    }
}

void ms_progress_catch(int is_caught)
{
    const int numbers[] = {SIGINT, SIGTERM};
    has_spheres = 0;
    for (size_t s = 0; s < sizeof numbers / sizeof *numbers; s++) {
        struct sigaction before, action = {.sa_flags = (int)SA_RESETHAND};
        action.sa_handler = is_caught ? note_signal : SIG_DFL;
        sigemptyset(&action.sa_mask);
        if (sigaction(numbers[s], NULL, &before) == 0 && before.sa_handler != SIG_IGN) { /* as nohup wants it */
            sigaction(numbers[s], &action, NULL);
        }
    }
}
