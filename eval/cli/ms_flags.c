#include "ms_flags.h"

#include <float.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_text.h"
#include "ms_generator.h"

/* Room for the flags of a command and the options of all generators. */
enum { MAX_FLAGS = 128, HELP_COLUMN = 28 };

const ms_command *ms_flags_find_command(ms_choice *choice, const ms_command *const *all)
{
    for (const ms_command *const *c = all; *c; c++) {
        if (ms_choice_offer(choice, (*c)->name)) {
            return *c;
        }
    }
    return NULL;
}

static void print_flag(const ms_flag *flag)
{
    char left[64];
    snprintf(left, sizeof left, "  %c%c%s--%s%s%s", flag->letter ? '-' : ' ', flag->letter ? flag->letter : ' ',
             flag->letter ? ", " : "  ", flag->name, flag->argument ? " " : "", flag->argument ? flag->argument : "");
    if (strlen(left) < HELP_COLUMN) {
        printf("%-*s%s\n", HELP_COLUMN, left, flag->help);
    } else {
        printf("%s\n%*s%s\n", left, HELP_COLUMN, "", flag->help);
    }
}

static void print_help(const ms_command *command)
{
    printf("mskit %s: %s\n\nusage: mskit %s %s\n\n", command->name, command->summary, command->name, command->usage);
    for (const ms_flag *flag = command->flags; flag->name; flag++) {
        print_flag(flag);
    }
    printf("  -h, --help                print this\n\nexample: %s\n", command->example);
}

/* What getopt works on. */
typedef struct flag_tables {
    struct option longs[MAX_FLAGS];
    char shorts[2 * MAX_FLAGS + 2];
    size_t count;
} flag_tables;

static void add_long(flag_tables *t, const char *name, int has_argument, int value)
{
    for (size_t f = 0; f < t->count; f++) {
        if (strcmp(t->longs[f].name, name) == 0) {
            return; /* two generators may share an option */
        }
    }
    if (t->count + 1 < MAX_FLAGS) {
        t->longs[t->count++] = (struct option){name, has_argument, NULL, value};
    }
}

static void make_tables(flag_tables *t, const ms_command *command, int generator_options)
{
    char *letter = t->shorts;
    memset(t, 0, sizeof *t);
    *letter++ = ':'; /* a missing argument is told from an unknown flag */
    for (const ms_flag *flag = command->flags; flag->name; flag++) {
        add_long(t, flag->name, flag->argument ? required_argument : no_argument, 0);
        if (flag->letter) {
            *letter++ = flag->letter;
            *letter = ':';
            letter += flag->argument != NULL;
        }
    }
    strcpy(letter, "h");
    add_long(t, "help", no_argument, 'h');
    for (const ms_generator *const *g = ms_generators; generator_options && *g; g++) {
        for (const ms_option *o = (*g)->options; o->name; o++) {
            add_long(t, o->name, o->type == MS_OPTION_FLAG ? no_argument : required_argument, 0);
        }
    }
}

/* How many flags begin like this word, and which of them is the first; only it, if that is its whole name. */
static size_t find_flags(const char **first, const flag_tables *t, const char *word, size_t length)
{
    size_t found = 0;
    for (size_t f = 0; f < t->count; f++) {
        if (strncmp(t->longs[f].name, word, length) == 0) {
            *first = found ? *first : t->longs[f].name;
            found++;
        }
        if (strlen(t->longs[f].name) == length && memcmp(t->longs[f].name, word, length) == 0) {
            *first = t->longs[f].name;
            return 1;
        }
    }
    return found;
}

static ms_status fail_no_flag(ms_error *err, const flag_tables *t, const char *dashes, const char *word, size_t length)
{
    ms_choice choice = {.typed = word, .length = length};
    for (size_t f = 0; f < t->count; f++) {
        ms_choice_offer(&choice, t->longs[f].name);
    }
    const int near = choice.nearest[0] != '\0';
    return ms_fail(err, MS_ERR_ARG, "there is no flag %s%.*s%s%s%s", dashes, (int)length, word,
                   near ? "; did you mean --" : "", choice.nearest, near ? "?" : "");
}

/* Of a method: these stand behind --help. */
static int is_option(const flag_tables *t, const char *name)
{
    size_t f = 0;
    while (t->longs[f].name != name && t->longs[f].val != 'h') {
        f++;
    }
    return t->longs[f].name != name;
}

/* A word behind two dashes. */
static ms_status fail_long(ms_error *err, const flag_tables *t, const char *word)
{
    const size_t length = strcspn(word, "=");
    const char *first = NULL;
    const size_t found = find_flags(&first, t, word, length);
    if (found == 1) {
        return is_option(t, first) ? ms_fail(err, MS_ERR_ARG, "--%s takes no argument; --set %s=0 is off", first, first)
                                   : ms_fail(err, MS_ERR_ARG, "--%s takes no argument", first);
    }
    return found > 1 ? ms_fail(err, MS_ERR_ARG, "--%.*s may be short for %zu flags, as --%s; write more of it",
                               (int)length, word, found, first)
                     : fail_no_flag(err, t, "--", word, length);
}

/* Says which flag getopt did not take, and why, in a sentence. It stands behind a whole word, but within one of
 * several letters, as -cells. */
static int refuse_flag(const ms_command *command, const flag_tables *t, int found, int argc, char **argv)
{
    ms_error err;
    const char *word = argv[optind - 1];
    if (found == ':') {
        ms_fail(&err, MS_ERR_ARG, "%s takes an argument", word);
    } else if (optopt && optopt != 'h') {
        const char letter = (char)optopt, *at = optind < argc ? argv[optind] : "";
        word = at[0] == '-' && at[1] == letter ? at + 1 : &letter;
        fail_no_flag(&err, t, "-", word, word == &letter ? 1 : strcspn(word, "="));
    } else {
        fail_long(&err, t, word + 2);
    }
    fprintf(stderr, "mskit %s: %s (mskit %s --help lists the flags)\n", command->name, err.text, command->name);
    return EXIT_USAGE;
}

static const char *name_of_letter(const ms_command *command, int letter)
{
    for (const ms_flag *flag = command->flags; flag->name; flag++) {
        if (flag->letter == letter) {
            return flag->name;
        }
    }
    return "";
}

/* Is an argument of the flag the name of a file or a folder? What else is empty the commands refuse by what it is. */
static int takes_path(const ms_command *command, const char *name)
{
    for (const ms_flag *flag = command->flags; flag->name; flag++) {
        if (strcmp(flag->name, name) == 0) {
            return flag->argument && (strcmp(flag->argument, "FILE") == 0 || strcmp(flag->argument, "SHAPE") == 0 ||
                                      strcmp(flag->argument, "DIR") == 0);
        }
    }
    return 0;
}

/* No name is empty. */
static ms_status check_words(int count, char *const *word, ms_error *err)
{
    for (int w = 0; w < count; w++) {
        if (word[w][0] == '\0') {
            return ms_fail(err, MS_ERR_ARG, "word %d is empty where a name should stand; is a variable not set?",
                           w + 1);
        }
    }
    return MS_OK;
}

int ms_flags_parse(int *first_word, const ms_command *command, int generator_options, int argc, char **argv,
                   ms_flag_handler handler, void *context)
{
    flag_tables t;
    int found, at = 0;
    ms_error err;
    opterr = 0;                  /* its messages would be ours and more */
    unsetenv("POSIXLY_CORRECT"); /* flags may stand anywhere */
    make_tables(&t, command, generator_options);
    while ((found = getopt_long(argc, argv, t.shorts, t.longs, &at)) != -1) {
        if (found == 'h') {
            print_help(command);
            return EXIT_DONE;
        }
        if (found == '?' || found == ':') {
            return refuse_flag(command, &t, found, argc, argv);
        }
        const char *flag = found == 0 ? t.longs[at].name : name_of_letter(command, found);
        const ms_status status =
            optarg && optarg[0] == '\0' && takes_path(command, flag)
                ? ms_fail(&err, MS_ERR_ARG, "--%s '' is an empty name; is a variable not set?", flag)
                : handler(context, flag, optarg, &err);
        if (status != MS_OK) {
            return ms_flags_refuse(command, status, &err);
        }
    }
    *first_word = optind;
    const ms_status status = check_words(argc - optind, argv + optind, &err);
    return status == MS_OK ? MS_FLAGS_GO_ON : ms_flags_refuse(command, status, &err);
}

int ms_flags_fail(const ms_command *command, const ms_error *err)
{
    fprintf(stderr, "mskit %s: %s\n", command->name, err->text);
    return EXIT_FAILED;
}

int ms_flags_wrong_usage(const ms_command *command, const char *message)
{
    fprintf(stderr, "mskit %s: %s\nusage: mskit %s %s\n", command->name, message, command->name, command->usage);
    return EXIT_USAGE;
}

int ms_flags_wrong_words(const ms_command *command, const char *takes, int most, int count, char *const *word)
{
    ms_error err;
    if (count <= most) {
        return ms_flags_wrong_usage(command, takes);
    }
    ms_fail(&err, MS_ERR_ARG, "%s; '%.200s' is one too many", takes, word[most]);
    return ms_flags_wrong_usage(command, err.text);
}

int ms_flags_refuse(const ms_command *command, ms_status status, const ms_error *err)
{
    return status == MS_ERR_NOMEM ? ms_flags_fail(command, err) : ms_flags_wrong_usage(command, err->text);
}

ms_status ms_flags_number(double *value, const char *name, const char *text, double lo, double hi, ms_error *err)
{
    const ms_word word = {text, strlen(text)};
    if (word.length == 0 || !ms_text_to_double(value, &word) || !(*value >= lo && *value <= hi)) {
        if (lo == DBL_MIN) {
            return hi == DBL_MAX
                       ? ms_fail(err, MS_ERR_ARG, "--%s '%s' is not a number above 0", name, text)
                       : ms_fail(err, MS_ERR_ARG, "--%s '%s' is not a number above 0, up to %.16g", name, text, hi);
        }
        return ms_fail(err, MS_ERR_ARG, "--%s '%s' is not a number from %.16g to %.16g", name, text, lo, hi);
    }
    return MS_OK;
}

ms_status ms_flags_whole(double *value, const char *name, const char *text, double lo, double hi, ms_error *err)
{
    ms_status status = ms_flags_number(value, name, text, lo, hi, err);
    if (status == MS_OK && *value != floor(*value)) {
        status = ms_fail(err, MS_ERR_ARG, "--%s '%s' is not a whole number", name, text);
    }
    return status;
}
