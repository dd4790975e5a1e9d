/** A line on the terminal that says how far a run has come. */
#ifndef MS_PROGRESS_H
#define MS_PROGRESS_H

#include "ms_generator.h"

/** What the line says; it begins with the name. */
typedef struct ms_progress_line {
    const char *name;
    double shown; /* when; 0: not yet */
} ms_progress_line;

/** Has the run tell the line how far it is, if standard error is a terminal. The line is borrowed. */
void ms_progress_show(ms_run *run, ms_progress_line *line);

/** Has the run's remarks printed on standard error, behind the name of the line. The line is borrowed. */
void ms_progress_say_remarks(ms_run *run, ms_progress_line *line);

/** Wipes what was shown. */
void ms_progress_clear(const ms_progress_line *line);

#endif
