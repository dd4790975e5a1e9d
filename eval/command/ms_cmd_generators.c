/* mskit generators, mskit help NAME: both drawn from the one table. */
#include <stdio.h>
#include <string.h>

#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "ms_commands.h"
#include "ms_generator.h"

static const ms_flag NO_FLAGS[] = {{0}};
static const ms_flag JSON_FLAGS[] = {{"json", 0, NULL, "as JSON"}, {0}};

static ms_status take_json(void *context, const char *name, const char *value, ms_error *err)
{
    (void)name;
    (void)value;
    (void)err;
    *(int *)context = 1;
    return MS_OK;
}

static ms_status take_none(void *context, const char *name, const char *value, ms_error *err)
{
    (void)context;
    (void)value;
    return ms_fail(err, MS_ERR_ARG, "--%s does not belong here", name);
}

static int run_generators(const ms_command *command, int argc, char **argv)
{
    int first, json = 0;
    ms_error err;
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_json, &json);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (first < argc) {
        return ms_flags_wrong_usage(command, "takes no words");
    }
    json_t *list = json ? json_array() : NULL;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if (json) {
            ms_json_object_append(&list, json_pack("{s:s,s:s,s:s,s:b,s:b}", "name", (*g)->name, "summary",
                                                   (*g)->summary, "source", (*g)->source, "nested", (*g)->nested,
                                                   "baseline", (*g)->baseline));
        } else {
            printf("%-12s %s%s\n%-12s %s\n", (*g)->name, (*g)->summary,
                   strcmp((*g)->name, MS_GENERATOR_DEFAULT) == 0 ? " (the default)" : "", "", (*g)->source);
        }
    }
    if (json && ms_report_print(stdout, list, &err) != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    return EXIT_DONE;
}

const ms_command ms_command_generators = {
    .name = "generators",
    .summary = "list the methods",
    .usage = "[--json]",
    .example = "mskit generators",
    .flags = JSON_FLAGS,
    .run = run_generators,
};

static void print_option(const ms_option *o)
{
    char text[64];
    double value = o->fallback;
    const ms_settings one = {.options = o, .value = &value};
    ms_option_settings_text(text, sizeof text, &one, 0);
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

static int run_help(const ms_command *command, int argc, char **argv)
{
    int first;
    ms_error err;
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_none, NULL);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_usage(command, "takes the name of one generator or command");
    }
    const ms_generator *generator = ms_generator_find(argv[first], &err);
    if (!generator) {
        return ms_flags_wrong_usage(command, err.text);
    }
    printf("%s: %s\n%s\nprefixes are clumps themselves: %s\n\n"
           "options (--set NAME=VALUE, or --NAME VALUE):\n",
           generator->name, generator->summary, generator->source, generator->nested ? "yes" : "no");
    for (const ms_option *o = generator->options; o->name; o++) {
        print_option(o);
    }
    return EXIT_DONE;
}

const ms_command ms_command_help = {
    .name = "help",
    .summary = "show the options of a method, or the flags of a command",
    .usage = "[NAME]",
    .example = "mskit help mss",
    .flags = NO_FLAGS,
    .run = run_help,
};
