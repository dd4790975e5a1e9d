/** What signals do that end the program. */
#ifndef MS_SIGNALS_H
#define MS_SIGNALS_H

/** Has the signals that end a program, as Ctrl-C or a library that gives up, remove files that are half written before
 * they do; those that are ignored, as nohup wants it, stay so. */
void ms_signals_end_cleanly(void);

/** Has one signal call this once, and end the program after that; NULL: end it at once. */
void ms_signals_catch(int number, void (*handler)(int number));

#endif
