/* mskit help NAME, mskit version. */
#include <stdio.h>

#include "base/ms_version.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "ms_commands.h"
#include "ms_generator.h"

static const ms_flag JSON_FLAGS[] = {{"json", 0, NULL, "as JSON"}, {0}};
static const ms_flag NO_FLAGS[] = {{0}};

static ms_status take_json(void *context, const char *name, const char *value, ms_error *err)
{
    (void)name;
    (void)value;
    (void)err;
    *(int *)context = 1;
    return MS_OK;
}

static void default_text(char text[64], const ms_option *o)
{
    double value = o->fallback;
    const ms_settings one = {.options = o, .value = &value};
    ms_option_settings_text(text, 64, &one, 0);
}

static void print_option(const ms_option *o)
{
    char text[64];
    default_text(text, o);
    printf("  %s", o->name);
    switch (o->type) {
    case MS_OPTION_FLAG:
        printf("  (%s)", text);
        break;
    case MS_OPTION_INTEGER:
    case MS_OPTION_REAL:
        printf("=%s  (%g to %g%s%s)", text, o->min, o->max, o->unit ? " " : "", o->unit ? o->unit : "");
        break;
    case MS_OPTION_CHOICE:
        printf("=%s  (%s)", text, o->choices);
        break;
    case MS_OPTION_PLANE:
        printf("=A,B,C,D");
        break;
    case MS_OPTION_CLUMP:
        printf("=FILE");
        break;
    }
    printf("\n      %s\n", o->help);
}

static void print_generator(const ms_generator *generator)
{
    printf("%s: %s\n%s\nprefixes are clumps themselves: %s\n\n"
           "options (--set NAME=VALUE, or --NAME VALUE; --NAME alone of those that are off):\n",
           generator->name, generator->summary, generator->source, generator->nested ? "yes" : "no");
    for (const ms_option *o = generator->options; o->name; o++) {
        print_option(o);
    }
}

/* Range, unit and choices are null where they do not apply. */
static json_t *option_json(const ms_option *o)
{
    static const char *const TYPES[] = {
        [MS_OPTION_FLAG] = "flag",     [MS_OPTION_INTEGER] = "integer", [MS_OPTION_REAL] = "real",
        [MS_OPTION_CHOICE] = "choice", [MS_OPTION_PLANE] = "plane",     [MS_OPTION_CLUMP] = "clump"};
    const int is_number = o->type == MS_OPTION_INTEGER || o->type == MS_OPTION_REAL;
    const int has_default = is_number || o->type == MS_OPTION_FLAG || o->type == MS_OPTION_CHOICE;
    char text[64];
    default_text(text, o);
    return json_pack("{s:s,s:s,s:s?,s:o,s:o,s:s?,s:s?,s:s}", "name", o->name, "type", TYPES[o->type], "default",
                     has_default ? text : NULL, "min", is_number ? json_real(o->min) : json_null(), "max",
                     is_number ? json_real(o->max) : json_null(), "unit", o->unit, "choices", o->choices, "help",
                     o->help);
}

static json_t *generator_json(const ms_generator *generator)
{
    json_t *list = json_array();
    for (const ms_option *o = generator->options; o->name; o++) {
        ms_json_object_append(&list, option_json(o));
    }
    return json_pack("{s:s,s:s,s:s,s:b,s:o}", "name", generator->name, "summary", generator->summary, "source",
                     generator->source, "nested", generator->nested, "options", list);
}

static json_t *command_json(const ms_command *command)
{
    json_t *list = json_array();
    for (const ms_flag *f = command->flags; f->name; f++) {
        const char letter[2] = {f->letter, '\0'};
        ms_json_object_append(&list, json_pack("{s:s,s:s?,s:s?,s:s}", "name", f->name, "letter",
                                               f->letter ? letter : NULL, "argument", f->argument, "help", f->help));
    }
    return json_pack("{s:s,s:s,s:s,s:s,s:o}", "name", command->name, "summary", command->summary, "usage",
                     command->usage, "example", command->example, "flags", list);
}

static int print_command(const ms_command *other)
{
    int first;
    char name[] = "mskit", help[] = "--help", *words[] = {name, help, NULL};
    return ms_flags_parse(&first, other, 0, 2, words, NULL, NULL);
}

static int fail_help(const ms_command *command, ms_choice *choice)
{
    ms_error err;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        ms_choice_offer(choice, (*g)->name);
    }
    ms_choice_fail(choice, &err, "there is no command and no generator '%s'", choice->typed);
    return ms_flags_wrong_usage(command, err.text);
}

static int run_help(const ms_command *command, const ms_command *const *all, int argc, char **argv)
{
    int first, json = 0;
    ms_error err;
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_json, &json);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes the name of one generator or command", 1, argc - first,
                                    argv + first);
    }
    ms_choice choice = {.typed = argv[first]};
    const ms_command *other = ms_flags_find_command(&choice, all);
    const ms_generator *generator = other ? NULL : ms_generator_find(argv[first], NULL);
    if (!other && !generator) {
        return fail_help(command, &choice);
    }
    if (json) {
        const ms_status status =
            ms_report_print(stdout, generator ? generator_json(generator) : command_json(other), &err);
        return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
    }
    if (other) {
        return print_command(other);
    }
    print_generator(generator);
    return EXIT_DONE;
}

const ms_command ms_command_help = {
    .name = "help",
    .summary = "show the options of a method, or the flags of a command",
    .usage = "[NAME] [--json]",
    .example = "mskit help mss",
    .flags = JSON_FLAGS,
    .run_of_all = run_help,
};

static int run_version(const ms_command *command, int argc, char **argv)
{
    int first;
    const int code = ms_flags_parse(&first, command, 0, argc, argv, NULL, NULL);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (first < argc) {
        return ms_flags_wrong_words(command, "takes no words", 0, argc - first, argv + first);
    }
    puts("mskit " MS_VERSION);
    return EXIT_DONE;
}

const ms_command ms_command_version = {
    .name = "version",
    .summary = "print the version; --version and -V do the same",
    .usage = "[--help]",
    .example = "mskit version",
    .flags = NO_FLAGS,
    .run = run_version,
};
