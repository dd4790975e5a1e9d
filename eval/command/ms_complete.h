/** Which words can stand at a place of a command line, drawn from the tables of the program: what shells ask for. */
#ifndef MS_COMPLETE_H
#define MS_COMPLETE_H

#include <stddef.h>
#include <stdio.h>

#include "cli/ms_flags.h"

/**
 * Prints the words that can take the place of the last one, each on a line; names with an '=' behind them take a value.
 * The line "/", which is no such word, says that files can stand there, too.
 *
 * @param all the commands, NULL-ended
 * @param word of the command line behind `mskit`, up to that which is being typed
 * @param count 1 or more
 */
void ms_complete_print(FILE *stream, const ms_command *const *all, char *const *word, size_t count);

#endif
