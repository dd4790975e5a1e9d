/** A line on the terminal that says how far a run has come, and the signal that ends it early. */
#ifndef MS_PROGRESS_H
#define MS_PROGRESS_H

#include "ms_generator.h"

/** What the line says; it begins with the name. */
typedef struct ms_progress_line {
    const char *name;
    double shown; /* when; 0: not yet */
    int is_terminal;
} ms_progress_line;

/** Has the run tell the line how far it is, which is shown if standard error is a terminal, and end at a signal that is
 * caught. The line is borrowed. */
void ms_progress_show(ms_run *run, ms_progress_line *line);

/** Has the run's remarks printed on standard error, behind the name of the line. The line is borrowed. */
void ms_progress_say_remarks(ms_run *run, ms_progress_line *line);
/**
 * Nonzero: the first SIGINT (Ctrl-C) or SIGTERM ends the run with the spheres so far; the second one, or the first
 * where there are none yet, the program. Zero: the first one the program, as without this. Signals that are ignored
 * remain so.
 */
void ms_progress_catch(int is_caught);

/** Wipes what was shown. */
void ms_progress_clear(const ms_progress_line *line);

#endif
