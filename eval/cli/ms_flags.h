/** Command line flags: one table per command gives parsing and help. */
#ifndef MS_FLAGS_H
#define MS_FLAGS_H

#include "base/ms_choice.h"
#include "base/ms_error.h"
#include "ms_option.h"

/* Exit codes of the program. */
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

/** One flag. A table of them ends with a NULL name. */
typedef struct ms_flag {
    const char *name;     /* --name */
    char letter;          /* -l; 0 without */
    const char *argument; /* what the help calls its argument; NULL if it takes none */
    const char *help;
} ms_flag;

/** One command. */
typedef struct ms_command {
    const char *name;
    const char *summary; /* one line */
    const char *usage;   /* what stands behind `mskit NAME` */
    const char *example; /* a whole command line */
    const ms_flag *flags;
    /** @return an exit code */
    int (*run)(const struct ms_command *command, int argc, char **argv);
    /** In its place, of a command that tells of the others: all of them, NULL-ended. */
    int (*run_of_all)(const struct ms_command *command, const struct ms_command *const *all, int argc, char **argv);
} ms_command;

/** The command that was typed; NULL if it is none of these, and all are offered. */
const ms_command *ms_flags_find_command(ms_choice *choice, const ms_command *const *all);

/**
 * Is told of each flag found. `name` is one of the table, or an option of any generator.
 * @return MS_OK; else the message is printed and the exit code is EXIT_USAGE
 */
typedef ms_status (*ms_flag_handler)(void *context, const char *name, const char *value, ms_error *err);

/* What ms_flags_parse returns where there is work to do. */
enum { MS_FLAGS_GO_ON = -1 };

/**
 * Parses the flags of a command; --help prints the help. Flags may stand anywhere; words move
 * behind them. An empty word is refused, and an empty name behind a flag.
 *
 * @param[out] first_word index in argv of the first word that is no flag
 * @param      generator_options nonzero: options of generators are flags too
 * @return MS_FLAGS_GO_ON, or the exit code with which the command is over
 */
int ms_flags_parse(int *first_word, const ms_command *command, int generator_options, int argc, char **argv,
                   ms_flag_handler handler, void *context);

/** Prints "mskit NAME: message" to stderr. @return EXIT_FAILED */
int ms_flags_fail(const ms_command *command, const ms_error *err);

/** The same with the usage of the command. @return EXIT_USAGE */
int ms_flags_wrong_usage(const ms_command *command, const char *message);

/**
 * The same where the number of words is another than the command takes. Names the first of those that are too many.
 *
 * @param takes what it takes, as "takes one shape"
 * @param most  words that it takes at most
 * @param word  those given, count of them
 */
int ms_flags_wrong_words(const ms_command *command, const char *takes, int most, int count, char *const *word);

/** Refuses what the flags say: wrong usage, unless just memory was lacking. @return EXIT_USAGE or EXIT_FAILED */
int ms_flags_refuse(const ms_command *command, ms_status status, const ms_error *err);

/** A number that the user wrote. @return MS_OK; MS_ERR_ARG if it is none from lo to hi */
ms_status ms_flags_number(double *value, const char *name, const char *text, double lo, double hi, ms_error *err);

/** The same, a whole number. */
ms_status ms_flags_whole(double *value, const char *name, const char *text, double lo, double hi, ms_error *err);

#endif
