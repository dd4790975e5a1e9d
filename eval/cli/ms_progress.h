/** A line on the terminal that says what is at work and how far it has come, and the signal that ends it early. */
#ifndef MS_PROGRESS_H
#define MS_PROGRESS_H

#include "ms_generator.h"

/** What is at work. */
typedef struct ms_progress_line {
    const char *name;   /* borrowed until the line is closed */
    size_t goal;        /* spheres asked for where they come one after the other; 0: their number tells no share */
    size_t part, parts; /* how many parts of the whole are done, and how many there are; parts 0: this is the whole */
    double began;       /* when the first part did, by omp_get_wtime; 0: now */
} ms_progress_line;

/**
 * Draws the line, four times a second, until it is closed: name, stage, share and time left where the share is known,
 * else the time so far. Only if standard error is a terminal; a line that is open is closed first.
 */
void ms_progress_open(const ms_progress_line *line);

/** Nonzero: runs are side by side, who has the line draws it, and none is opened until zero is given. By the thread
 * that starts the others, before it does and when they have ended. */
void ms_progress_leave(int is_left);

/** What is at work now, how much of it being unknown. */
void ms_progress_stage(const char *stage);

/** Wipes the line and ends it. */
void ms_progress_close(void);

/** Wipes the line, if one is open, so that something else can be printed; it is drawn again soon. */
void ms_progress_wipe(void);

/** Has the run tell the line what it is at, and end at a signal that is caught. */
void ms_progress_show(ms_run *run);

/** Has the run's remarks printed on standard error, behind the name of the line, which is borrowed. */
void ms_progress_say_remarks(ms_run *run, ms_progress_line *line);

/**
 * Nonzero: the first SIGINT (Ctrl-C) or SIGTERM ends the run with the spheres so far; the second one, or the first
 * where there are none yet, the program. Zero: the first one the program, as without this. Signals that are ignored
 * remain so.
 */
void ms_progress_catch(int is_caught);

#endif
