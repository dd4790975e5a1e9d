#include "ms_progress.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <unistd.h>

static void show_line(void *context, size_t spheres, double dice)
{
    ms_progress_line *line = context;
    const double now = omp_get_wtime();
    if (now - line->shown > 0.1) {
        line->shown = now;
        if (isnan(dice)) {
            fprintf(stderr, "\r%s: %zu spheres to begin with ", line->name, spheres);
        } else {
            fprintf(stderr, "\r\033[K%s: %zu spheres, D %.4f ", line->name, spheres, dice);
        }
    }
}

void ms_progress_show(ms_run *run, ms_progress_line *line)
{
    run->progress = isatty(STDERR_FILENO) ? show_line : NULL;
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
